# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of real robots: where they are, and what makes them from public repositories."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

_ROOT = Path(__file__).parents[2]
_PLACES = (_ROOT / "recordings", _ROOT.parent / "shared" / "data")
"""Of this checkout; or of several checkouts beside each other, which need them but once."""

RECORDINGS = Path(
    os.environ.get(
        "WERRIMBI_DATA", next((place for place in _PLACES if place.is_dir()), _PLACES[0])
    )
)
ROBOTS = RECORDINGS / "robots"
MISSING = "no recordings of real robots: `make recordings` gets them (WERRIMBI_DATA: another place)"
TURTLEBOT3_BAGS = RECORDINGS / "bags" / "turtlebot3"
"""As they were published (docs/turtlebot3.md)."""

with_recordings = pytest.mark.skipif(not ROBOTS.is_dir(), reason=MISSING)
