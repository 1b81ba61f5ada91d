# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference that leaps away and comes back was wrong meanwhile: no leg is of those poses."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import reference_of
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import NoDriving, Run
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.prepared_runs import for_fit, prepare
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.report.phrases import left_out_words

MACHINE = WhiteNoiseRobot()
ROBOT = MACHINE.entered()
AWAY = (20.01, 20.81)
"""Between two poses of the reference [s]."""


@pytest.fixture(scope="module")
def run() -> Run:
    random = np.random.default_rng(7)
    return drive(MACHINE, wandering(random, 60.0), random, every=1)


def exchanged(
    run: Run, begin: float, end: float, turn: float = 0.9, x: float = 0.03, bodily: bool = False
) -> Run:
    """Markers exchanged between two moments; `bodily`: the offset turns with the robot."""
    seen = reference_of(run)
    away = ((seen.time > begin) & (seen.time < end)).astype(np.float64)
    off = away * x * (np.exp(1j * seen.yaw) if bodily else 1.0)
    other = replace(seen, x=seen.x + off.real, y=seen.y + off.imag, yaw=seen.yaw + away * turn)
    return replace(run, reference=other)


def found_in(run: Run) -> tuple[NoDriving, ...]:
    return with_no_driving(run, ROBOT).no_driving or ()


@pytest.mark.parametrize("bodily", [False, True])
@pytest.mark.parametrize(("turn", "x"), [(0.9, 0.03), (-0.2, 0.0), (0.0, 0.4)])
def test_a_reference_that_leaps_away_and_comes_back_is_told_with_its_times(
    run: Run, turn: float, x: float, bodily: bool
) -> None:
    (part,) = found_in(exchanged(run, *AWAY, turn, x, bodily and turn != 0.0))
    assert part.why == "gap"
    assert (part.begin, part.end) == pytest.approx(AWAY, abs=0.01)
    told = re.search(r"turned by (\d+)°|elsewhere by (\S+) m", part.words)
    assert told is not None
    assert float(told[1] or told[2]) == pytest.approx(
        np.degrees(abs(turn)) or x, abs=1.0 if turn else 0.01
    )


def test_a_pose_that_came_twice_hides_no_lapse(run: Run) -> None:
    seen = reference_of(exchanged(run, *AWAY))
    twice = seen.chosen(np.sort(np.append(np.arange(seen.time.size), 500)))
    (part,) = found_in(replace(run, reference=twice))
    assert (part.begin, part.end) == pytest.approx(AWAY, abs=0.01)


def test_a_sound_reference_one_wrong_pose_and_a_place_that_is_lost_are_no_lapse(run: Run) -> None:
    assert found_in(run) == ()
    assert found_in(exchanged(run, 20.01, 20.03)) == ()
    assert found_in(exchanged(run, 20.01, 99.0)) == ()
    assert found_in(exchanged(run, 20.01, 40.0)) == (), "which third was wrong, nobody knows"


def test_a_reference_that_has_not_come_back_as_the_drive_ends_is_no_lapse(run: Run) -> None:
    """Which of its two places was wrong nobody knows."""
    last = float(reference_of(run).time[-1])
    assert all(part.why != "gap" for part in found_in(exchanged(run, last - 0.7, last + 1.0)))


def test_what_a_reference_does_once_a_second_is_no_lapse(run: Run) -> None:
    for second in range(5, 55):
        run = exchanged(run, second + 0.01, second + 0.31, 0.1, 0.0)
    assert found_in(run) == ()


def test_markers_that_are_exchanged_for_a_second_spoil_no_judgement(run: Run) -> None:
    """The legs between both leaps began with a heading that was 51 degrees off: NEES 100."""
    found = compare([exchanged(run, *AWAY)], ROBOT, EvaluationOptions(leg=0.25))
    wheels = run.ticks.left * ROBOT.left_tick + run.ticks.right * ROBOT.right_tick
    assert found.runs[0].distance_m == pytest.approx(0.5 * np.abs(np.diff(wheels)).sum())
    assert 0.6 < found.main.all.figures.nees < 1.4
    assert found.main.all.outliers == 0
    (line,) = left_out_words(found.left_out)
    assert line.startswith("From 20.0 s to 20.8 s of simulated the reference was turned by 5")


@pytest.mark.parametrize("delay", [0.0, 0.04])
def test_no_leg_of_a_fit_begins_or_ends_while_markers_are_exchanged(run: Run, delay: float) -> None:
    """Whatever delay a fit then finds."""
    seen = reference_of(run)
    late = replace(run, reference=replace(seen, time=seen.time + delay))
    given = with_no_driving(exchanged(late, *(each + delay for each in AWAY)), ROBOT)
    robot = replace(ROBOT, effects=(find("reference_delay").using(delay=delay),))
    (legs,) = for_fit(prepare([given], robot, EvaluationOptions()), robot)
    ends = legs.record.measured.time[legs.rows]
    assert not ((ends > AWAY[0]) & (ends < AWAY[1])).any()
    assert (ends < AWAY[0]).any()
    assert (ends > AWAY[1]).any()
