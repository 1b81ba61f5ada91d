# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The error class for faulty input; the command line shows it as one line."""

from __future__ import annotations

import difflib
from collections.abc import Sequence


class InputError(ValueError):
    """Input of the user that cannot be used; the message names the place and the remedy."""


def nearest(name: str, known: Sequence[str]) -> str:
    """Suffix of a message on an unknown name: the nearest known one; "" if none is near."""
    within = [item for item in known if name in item]
    near = difflib.get_close_matches(name, known, n=1)
    found = near or difflib.get_close_matches(name, within, n=1, cutoff=0.0)
    return f"; the nearest known one is {found[0]}" if found else ""
