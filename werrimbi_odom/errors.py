# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors that a user can correct; the command line prints them in one line."""

from __future__ import annotations

import difflib
from collections.abc import Sequence


class InputError(ValueError):
    """An input is not usable; the message names the place and the remedy."""


class TooFewLegsError(InputError):
    """Drives that were measured at too few places for a diagnosis."""


def nearest(name: str, known: Sequence[str]) -> str:
    """Suggest the closest known name, as the end of a message; "" if none is close."""
    within = [item for item in known if name in item]
    near = difflib.get_close_matches(name, known, n=1)
    found = near or difflib.get_close_matches(name, within, n=1, cutoff=0.0)
    return f"; the nearest known one is {found[0]}" if found else ""
