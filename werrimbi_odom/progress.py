# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How long work tells how far it is, to whoever wants to know: a bar, a page, or nobody."""

from __future__ import annotations

from collections.abc import Callable

Show = Callable[[float, str], None]
"""Told the share done, and what is being done."""


def silent(share: float, words: str) -> None:
    """Show nothing."""
