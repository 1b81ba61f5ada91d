# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Names of measured columns in what a draft writes: users call them what they like."""

from __future__ import annotations

import json
import re
import unicodedata

_TAKEN = frozenset({"v", "|v|", "w", "|w|", "time", "distance", "speed", "yaw_rate", "direction"})
"""Symbols and variables of the robot's own in laws of two variables."""


def quoted(name: str) -> str:
    """Python code for it."""
    return json.dumps(name, ensure_ascii=False)


def as_text(name: str) -> str:
    """For a docstring, and the words of a parameter."""
    return name.replace("\\", "/").replace('"', "'")


def symbol_of(name: str) -> str:
    """For a formula; not the symbol of another quantity."""
    return f"column_{name}" if name in _TAKEN else as_text(name)


def identifier_of(words: str) -> str:
    """Part of an effect's name: small letters, digits, and one underscore between them."""
    plain = unicodedata.normalize("NFKD", words).encode("ascii", "ignore").decode().lower()
    return re.sub(r"[^a-z0-9]+", "_", plain).strip("_") or "column"
