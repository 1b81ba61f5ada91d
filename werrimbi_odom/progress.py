# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Progress callback of long work: a bar, a page, or nothing."""

from __future__ import annotations

from collections.abc import Callable

Show = Callable[[float, str], None]
"""Called with the share done and a description of the current step."""


def silent(share: float, words: str) -> None:
    """Show nothing."""
