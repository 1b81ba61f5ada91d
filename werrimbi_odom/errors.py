# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The one family of errors that a user can mend; the command line turns them into one line."""

from __future__ import annotations

import difflib
from collections.abc import Sequence


class InputError(ValueError):
    """Something given by the user cannot be used; the message names the place and the mend."""


def nearest(name: str, known: Sequence[str]) -> str:
    """How to go on after an unknown name: with the one that may be meant; "" where none is near."""
    within = [item for item in known if name in item]
    near = difflib.get_close_matches(name, known, n=1)
    found = near or difflib.get_close_matches(name, within, n=1, cutoff=0.0)
    return f"; the nearest known one is {found[0]}" if found else ""
