# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Travel between the counters' readings, where the reference looks and the encoders do not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.prediction import predict
from werrimbi_odom.inference.legs import count_interpolation
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.cutting import cut_for_fit, every_pose, match
from werrimbi_odom.inference.legs.matched_run import MatchedRun, divided
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.model.effect import AppliedEffect
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


def test_the_counters_of_a_run_are_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    made: list[Run] = []
    work = count_interpolation._counted
    monkeypatch.setattr(
        count_interpolation, "_counted", lambda run, *rest: made.append(run) or work(run, *rest)
    )
    time, seen = np.arange(0.0, 4.0, 0.02), np.arange(0.05, 3.8, 0.01)
    ticks, nowhere = Ticks(time, 100.0 * time, 100.0 * time, {}), np.zeros(seen.size)
    run = with_no_driving(Run("run", Path("run"), ticks, Reference(seen, *[nowhere] * 3)), ROBOT)
    record_of(run, ROBOT)
    assert len(made) == 1
    record_of(run, replace(ROBOT, wheel_separation_multiplier=1.1))
    assert len(made) == 2


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


@pytest.mark.parametrize(("hertz", "together"), [(30.0, 1), (50.0, 1), (99.0, 1), (200.0, 4)])
def test_a_fit_takes_fast_messages_together_and_its_legs_stay(hertz: float, together: int) -> None:
    """It brakes and turns at once, in the legs of a fit from pose to pose of a tracker."""
    time = np.arange(0.0, 30.0, 1.0 / hertz)
    speed, rate = 0.4 + 0.4 * np.sin(2.5 * time), 1.5 * np.cos(1.1 * time)
    wheels = (np.cumsum(speed + sign * 0.5 * ROBOT.track * rate) / hertz for sign in (-1.0, 1.0))
    counts = (np.concatenate([[0.0], wheel[:-1]]) / ROBOT.left_tick for wheel in wheels)
    seen = np.arange(0.013, 29.0, 0.037)
    reference = Reference(seen, *[np.zeros(seen.size)] * 3)
    record = record_of(Run("run", Path("run"), Ticks(time, *counts, {}), reference), ROBOT)
    found = cut_for_fit(record, ROBOT, 1.0)
    every = divided(record, found.rows)
    assert np.median(np.diff(found.time)) == pytest.approx(together / hertz)
    assert together * rules.RATE_OF_FIT <= max(hertz, rules.RATE_OF_FIT)
    assert found.time.size < every.time.size / together + found.ends.size + 2
    assert np.array_equal(found.time[found.ends], every.time[every.ends])
    assert travelled(found) == pytest.approx(travelled(every), abs=1e-6)
    shown, plainly = (predict(ROBOT, run, None).relative for run in (found, every))
    assert np.abs(shown - plainly)[:, :2].max() < 2e-5
    assert np.abs(shown - plainly)[:, 2].max() < 1e-9


def test_legs_are_as_long_as_the_way_of_a_robot_whose_wheel_counts_backwards() -> None:
    """By its counters alone it spins; what the file says of them is heard."""
    time = np.arange(0.0, 40.0, 0.05)
    counts = 0.15 * time / ROBOT.left_tick
    seen = np.arange(0.0, 39.9, 0.1)
    reference = Reference(seen, 0.15 * seen, np.zeros(seen.size), np.zeros(seen.size))
    reversed_one = AppliedEffect(find("right_wheel_reversed"), {})
    robots = ROBOT, replace(ROBOT, effects=(reversed_one,))
    legs = []
    for robot, right in zip(robots, (counts, -counts), strict=True):
        run = Run("run", Path("run"), Ticks(time, counts, right, {}), reference)
        legs.append(match(run, robot, 0.25).rows.size - 1)
    assert legs[0] == legs[1] == pytest.approx(0.15 * 39.8 / 0.25, abs=1.0)
