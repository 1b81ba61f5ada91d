# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""UMBmark from recorded drives: the physics engine's, broken ones, and a real robot's."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import record_of
from test.recorded_robots import ROBOTS, with_recordings
from werrimbi_odom.effects import find
from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.calibration.recorded_square import (
    SquareRecording,
    recorded_square,
    squares_of,
)
from werrimbi_odom.inference.calibration.squares import e_max_syst
from werrimbi_odom.inference.calibration.umbmark import recomputed, umbmark
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.simulation import TrueRobot, figure_eight, record, square

ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0)
TRUE = TrueRobot(0.35 * 1.02, 0.05 * 1.005, 0.05 * 0.995)
SIDE = 1.0
DATA = ROBOTS / "optitrack_robot"


def driven(sense: str, seed: int, **options: float) -> SquareRecording:
    manoeuvre = figure_eight(0.6) if sense == "eight" else square(SIDE, sense, **options)
    drive = record(TRUE, manoeuvre, seed=seed)
    return record_of(f"run {seed}", drive)


@pytest.fixture(scope="module")
def drives() -> list[SquareRecording]:
    return [driven(sense, seed) for seed in (1, 2) for sense in ("cw", "ccw")]


def cut(drive: SquareRecording, share: float) -> SquareRecording:
    """The drive, stopped after a share of its time."""
    ticks = drive.time < share * drive.time[-1]
    seen = drive.reference_time < share * drive.time[-1]
    return SquareRecording(
        drive.name,
        drive.time[ticks],
        drive.left[ticks],
        drive.right[ticks],
        drive.reference_time[seen],
        drive.reference_x[seen],
        drive.reference_y[seen],
        drive.reference_yaw[seen],
    )


def rows(drive: SquareRecording, which: list[int]) -> SquareRecording:
    """The drive with some of its reference rows."""
    return replace(
        drive,
        reference_time=drive.reference_time[which],
        reference_x=drive.reference_x[which],
        reference_y=drive.reference_y[which],
        reference_yaw=drive.reference_yaw[which],
    )


def test_squares_of_the_engine_give_its_base_and_radii(drives: list[SquareRecording]) -> None:
    squares = squares_of([recorded_square(drive, ROBOT, SIDE) for drive in drives], SIDE)
    assert len(squares.cw) == len(squares.ccw) == 2
    result = umbmark(squares, ROBOT)
    for estimate, true in ((result.base, 1.02), (result.left, 1.005), (result.right, 0.995)):
        assert estimate.std < 2e-3
        assert abs(estimate.value - true) < 1.96 * estimate.std
    again = recomputed(squares, ROBOT, result.factors)
    assert e_max_syst(again) < 0.003 < 0.1 < result.e_max


def test_a_square_says_its_own_sense(drives: list[SquareRecording]) -> None:
    assert [recorded_square(drive, ROBOT, SIDE).sense for drive in drives] == [-1, 1, -1, 1]


def test_start_and_end_by_tape_are_enough(drives: list[SquareRecording]) -> None:
    whole = recorded_square(drives[0], ROBOT, SIDE)
    last = drives[0].reference_time.size - 1
    taped = recorded_square(rows(drives[0], [0, last]), ROBOT, SIDE)
    np.testing.assert_allclose(taped.offset, whole.offset, atol=1e-9)


def test_without_a_measured_heading_the_first_leg_gives_the_direction(
    drives: list[SquareRecording],
) -> None:
    drive = drives[1]
    blind = replace(drive, reference_yaw=np.full(drive.reference_yaw.size, np.nan))
    whole, by_leg = (recorded_square(one, ROBOT, SIDE) for one in (drive, blind))
    # The first leg bends by beta = 29 mrad, half of which turns the measured end about the start.
    np.testing.assert_allclose(by_leg.offset, whole.offset, atol=0.02 * np.hypot(*whole.offset))
    with pytest.raises(InputError, match="which way the first leg led"):
        recorded_square(rows(blind, [0, drive.reference_yaw.size - 1]), ROBOT, SIDE)


def test_a_heading_that_is_off_hardly_matters(drives: list[SquareRecording]) -> None:
    drive = drives[0]
    askew = replace(drive, reference_yaw=drive.reference_yaw + 0.01)
    one, other = (recorded_square(each, ROBOT, SIDE).offset for each in (drive, askew))
    assert np.hypot(*(one - other)) < 0.011 * np.hypot(*one)


def test_one_sense_or_too_few_are_refused(drives: list[SquareRecording]) -> None:
    found = [recorded_square(drive, ROBOT, SIDE) for drive in drives]
    with pytest.raises(InputError, match=r"2 more ccw \(0 given\)"):
        squares_of([found[0], found[2]], SIDE)
    with pytest.raises(InputError, match=r"1 more cw \(1 given\)"):
        squares_of(found[1:], SIDE)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (
            lambda: cut(driven("cw", 5), 0.7),
            "run 5: the square is not closed: by odometry the heading turns by -",
        ),
        (lambda: driven("ccw", 6, laps=2), "run 6: the square is not closed.*a run of its own"),
        (lambda: driven("eight", 7), "run 7: the square is not closed"),
    ],
    ids=["three legs", "two laps", "an eight"],
)
def test_what_is_no_closed_square_is_refused(
    make: Callable[[], SquareRecording], says: str
) -> None:
    drive = make()
    with pytest.raises(InputError, match=says):
        recorded_square(drive, ROBOT, SIDE)


def test_a_square_of_another_side_is_refused(drives: list[SquareRecording]) -> None:
    with pytest.raises(InputError, match=r"not a square of side 2 m.*1\.00"):
        recorded_square(drives[0], ROBOT, 2.0)


def test_a_square_begun_in_the_middle_of_a_side_is_refused(drives: list[SquareRecording]) -> None:
    drive = drives[1]
    middle = int(np.searchsorted(drive.reference_time, 1.7))
    late = rows(drive, list(range(middle, drive.reference_time.size)))
    with pytest.raises(InputError, match="begins and ends at a corner"):
        recorded_square(late, ROBOT, SIDE)


def test_a_square_whose_legs_differ_is_refused() -> None:
    """All four corners, but it does not come back to the mark."""
    from werrimbi_odom.simulation import moves

    legs = [1.0, 1.09, 1.0, 0.8]
    steps = [step for leg in legs for step in ((leg, 0.0), (0.0, np.pi / 2))]
    drive = record(TrueRobot(), moves("askew", steps), seed=9)
    wanted = record_of("run 9", drive)
    with pytest.raises(InputError, match="run 9: not a square"):
        recorded_square(wanted, ROBOT, SIDE)


def test_a_reference_that_cannot_be_used_is_refused(drives: list[SquareRecording]) -> None:
    drive = drives[0]
    nothing = np.full(drive.reference_x.size, np.nan)
    with pytest.raises(InputError, match="a position at the start and at the end"):
        recorded_square(replace(drive, reference_x=nothing), ROBOT, SIDE)
    with pytest.raises(InputError, match="do not overlap"):
        recorded_square(replace(drive, reference_time=drive.reference_time + 1e6), ROBOT, SIDE)


def test_a_robot_with_effects_is_for_the_fit(drives: list[SquareRecording]) -> None:
    drift = AppliedEffect(find("sideways_drift"))
    with pytest.raises(InputError, match="sideways_drift: take `calibrate fit`"):
        recorded_square(drives[0], replace(ROBOT, effects=(drift,)), SIDE)


def optitrack(name: str) -> SquareRecording:
    ticks = np.genfromtxt(DATA / name / "ticks.csv", delimiter=",", skip_header=1)
    seen = np.genfromtxt(DATA / name / "reference.csv", delimiter=",", skip_header=1)
    return SquareRecording(name, *ticks.T[:3], *seen.T[:4])


@with_recordings
def test_a_real_robot() -> None:
    """The OptiTrack robot's six squares of 1.7 m: 104 mm, of which its scatter is left."""
    robot = Robot(0.2, 0.042, 2796.8, 2796.8)
    names = sorted(path.name for path in DATA.glob("square_*"))
    assert len(names) == 6
    squares = squares_of([recorded_square(optitrack(name), robot, 1.7) for name in names], 1.7)
    result = umbmark(squares, robot)
    assert result.e_max == pytest.approx(0.104, abs=0.001)
    assert result.base.value == pytest.approx(1.0085, abs=3e-4)
    assert result.ratio.value == pytest.approx(0.9990, abs=1e-4)
    assert e_max_syst(recomputed(squares, robot, result.factors)) < result.e_max / 20
    with pytest.raises(InputError, match="not closed"):
        recorded_square(optitrack("circular_231220200121_01"), robot, 1.7)
