# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two wheels whose counters come on topics of their own, at different rates."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.files.read_run import read_run

MS = 10**6


def turned(ms: Any) -> Any:
    """Counts of a wheel that speeds up and slows down, at some instants."""
    return np.rint(2000.0 * (np.asarray(ms) / 1e3 - np.cos(np.asarray(ms) / 1e3))).astype(int)


def sent(ros: Any, every: dict[str, int], bits: int = 32, wraps: int = 0) -> list[Any]:
    entries = []
    for side, period in every.items():
        for ms in range(period, 4000, period):
            count = int(turned(ms))
            if wraps:
                count = (count + 2 ** (wraps - 1)) % 2**wraps - 2 ** (wraps - 1)
            entries.append((f"/{side}_ticks", ms * MS, ros.count(count, bits)))
    return sorted(entries, key=lambda each: each[1])


@pytest.mark.parametrize(("left", "right"), [(50, 33), (20, 70)])
@pytest.mark.parametrize(("bits", "wraps", "lines"), [(32, 0, ()), (16, 11, ["encoder_bits: 11"])])
def test_both_are_taken_at_the_same_instants(
    tmp_path: Path,
    ros: Any,
    robot: Any,
    left: int,
    right: int,
    bits: int,
    wraps: int,
    lines: Any,
) -> None:
    """Wheels that turn alike go straight; paired with the nearest they would swing to and fro."""
    entries = sent(ros, {"left": left, "right": right}, bits, wraps)
    run = read_run(ros.write(tmp_path / "bag", entries), robot(*lines))
    apart = np.unwrap(run.ticks.left - run.ticks.right, period=2**wraps if wraps else 2**40)
    assert np.ptp(apart) <= 2, "counts, by rounding"
    np.testing.assert_allclose(np.diff(run.ticks.time), max(left, right) / 1e3, atol=1e-9)
    assert any("of different rates" in note for note in run.notes)


def test_timers_of_one_rate_keep_their_skew(tmp_path: Path, ros: Any, robot: Any) -> None:
    """The node pairs them so too, and the skew is an effect that it applies."""
    entries = sent(ros, {"left": 50, "right": 51})
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert not any("of different rates" in note for note in run.notes)
