# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Travel between the counters' readings, where the reference looks and the encoders do not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from test.model.drives import ROBOT
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.legs.cutting import MatchedRun, every_pose, record_of
from werrimbi_odom.model.pose import Floats


def matched(time: Floats, counts: Floats, seen: Floats) -> MatchedRun:
    """Both wheels alike, and a reference whose poses do not matter here."""
    nowhere = np.zeros(seen.size)
    ticks = Ticks(time, counts, counts, {})
    run = Run("run", Path("run"), ticks, Reference(seen, *[nowhere] * 3))
    return every_pose(record_of(run, ROBOT))


def travelled(run: MatchedRun) -> Floats:
    """Counts of the left wheel from the first reference pose to each [1]."""
    sums = np.concatenate([[0.0], np.cumsum(run.left)])[run.ends]
    return np.asarray(sums - sums[0])


@pytest.mark.parametrize("hertz", [10.0, 20.0, 50.0])
def test_starts_and_stops_keep_their_shape_however_seldom_counters_are_read(hertz: float) -> None:
    """1 m/s² to 0.5 m/s, and back to rest."""

    def way(at: Floats) -> Floats:
        """In metres."""
        fine = np.linspace(0.0, 4.0, 40_001)
        speed = np.clip(np.minimum(fine - 0.73, 3.14 - fine), 0.0, 0.5)
        return np.interp(at, fine, np.concatenate([[0.0], np.cumsum(speed[1:] * 1e-4)]))

    time, seen = np.arange(0.0, 4.0, 1.0 / hertz), np.arange(0.05, 3.8, 0.01)
    found = travelled(matched(time, way(time) / ROBOT.left_tick, seen)) * ROBOT.left_tick
    wrong = np.abs(found - (way(seen) - way(seen[:1])))
    straight = np.abs(np.interp(seen, time, way(time)) - way(seen))
    assert straight.max() > 0.9 * 1.0 / hertz**2 / 8.0  # a straight line cuts the corner
    assert wrong.max() < 0.5 * straight.max()
    assert np.sqrt(np.mean(wrong**2)) < 0.25 * np.sqrt(np.mean(straight**2))


@given(st.lists(st.integers(-40, 40), min_size=3, max_size=40), st.integers(1, 9))
def test_counts_between_two_readings_lie_between_theirs(steps: list[int], parts: int) -> None:
    counts = np.cumsum(np.concatenate([[0.0], steps]))
    time = np.arange(counts.size, dtype=np.float64)
    seen = np.linspace(0.0, time[-1], parts * (time.size - 1) + 1)
    found = travelled(matched(time, counts, seen))
    before = counts[np.minimum(seen.astype(int), counts.size - 2)]
    after = counts[np.minimum(seen.astype(int), counts.size - 2) + 1]
    assert (found >= np.minimum(before, after) - 1e-9).all()
    assert (found <= np.maximum(before, after) + 1e-9).all()
    at_messages = np.isclose(seen, np.round(seen))
    np.testing.assert_allclose(found[at_messages], counts, atol=1e-9)
