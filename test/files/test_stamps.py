# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps of a bag's topics."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from werrimbi_odom.files.bag import opened_bag
from werrimbi_odom.files.stamps import stamps_of

MS = 10**6


def test_the_rate_of_messages_in_bursts_is_how_many_come_a_second(tmp_path: Path, ros: Any) -> None:
    """Motion capture over a radio: ten poses within a millisecond, ten times a second."""
    entries = []
    for burst in range(1, 40):
        for n in range(10):
            at = burst * 100 * MS + n * MS // 10
            entries.append(("/pose", at, ros.pose(at, 0.0, 0.0, 0.0)))
    with opened_bag(ros.write(tmp_path / "bag", entries)) as bag:
        stamps = stamps_of(bag, ["/pose"])["/pose"]
    assert stamps.rate == pytest.approx(100.0, rel=0.05)
    assert stamps.bursts > 0.8
