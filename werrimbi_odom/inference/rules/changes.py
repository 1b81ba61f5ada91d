# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What changed from drive to drive, and which of it is told."""

from __future__ import annotations

MOST_CHANGES = 40
"""Changes that are looked for, one after the other: one every nine days of a year. Chosen: more
are no changes but a scatter from drive to drive, which is estimated as such."""

DATED = 1e8
"""Stamps [s] above this are dates: no clock that begins with a drive shows three years."""

TREND_DRIVES = 4
"""Drives after the one at which a trend begins, at the least. Chosen: of three a step in the middle
lies as near a line as noise lets one see."""
