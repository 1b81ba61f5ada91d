# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Progress reports of long work: to a bar, a page, or nowhere."""

from __future__ import annotations

from collections.abc import Callable

Show = Callable[[float, str], None]
"""Callback with the share done, and what is being done."""


def silent(share: float, words: str) -> None:
    """Show nothing."""
