# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where pieces begin and end, and that covariances lose nothing by them."""

from __future__ import annotations

import math
from importlib.resources import files

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from test.model.drives import (
    ROBOT,
    Ticks,
    figure_eight,
    random_drive,
    rolled,
    speeded_up,
    square,
    then,
)
from test.plain_twin import plain_run
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.pieces import Piece, kind_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

HEADING_OF_A_COUNT = (4.0e-4**2 + 5.8e-4**2) * 2.0 * math.pi * 0.05 / 2000 / 0.35**2
"""Variance of the heading once both wheels of `ROBOT` have gone one count [rad²]."""


def worst_eigenvalue_error(robot: Robot, ticks: Ticks) -> float:
    """Published covariances against the plain twin's, at every message after 0.5 m of travel.

    Travel is the mean of both wheels' paths. Before, the smallest eigenvalue belongs to
    micrometres and hangs on single counts.
    """
    published = trajectory(robot, *ticks).covariance.matrix()[1:]
    _, plain = plain_run(robot, ticks.left, ticks.right, substeps=2)
    left, right = np.abs(np.diff(ticks.left)), np.abs(np.diff(ticks.right))
    travel = 0.5 * np.cumsum(left * robot.left_tick + right * robot.right_tick)
    judged = travel >= 0.5
    ratios = np.linalg.eigvalsh(published[judged]) / np.linalg.eigvalsh(plain[judged])
    return float(np.abs(ratios - 1.0).max())


# Covariances are those of every single message.


@pytest.mark.parametrize("rate", [20.0, 50.0, 200.0])
def test_a_square_takes_twenty_times_fewer_pieces_than_messages_and_loses_nothing(
    rate: float,
) -> None:
    ticks = square(rate=rate)
    pieces = trajectory(ROBOT, *ticks).pieces
    assert len(ticks.time) >= 20 * len(pieces)
    assert worst_eigenvalue_error(ROBOT, ticks) < 0.01


def test_the_recorded_square_loses_nothing_either() -> None:
    """Wheels of a physics engine, which slip, settle and shudder when they start and stop."""
    path = files("werrimbi_odom") / "recordings" / "square" / "ticks.csv"
    with path.open() as table:
        time, left, right = np.loadtxt(table, delimiter=",", skiprows=1, usecols=(0, 1, 2)).T
    ticks = Ticks(time, left, right)
    assert len(ticks.time) >= 20 * len(trajectory(ROBOT, *ticks).pieces)
    assert worst_eigenvalue_error(ROBOT, ticks) < 0.01


@pytest.mark.parametrize("seed", range(6))
def test_random_driving_loses_nothing(seed: int) -> None:
    ticks = random_drive(seed)
    assert len(ticks.time) > 10 * len(trajectory(ROBOT, *ticks).pieces)
    assert worst_eigenvalue_error(ROBOT, ticks) < 0.01


@pytest.mark.evidence
@pytest.mark.parametrize("seed", range(100, 300))
def test_random_driving_loses_nothing_with_many_seeds(seed: int) -> None:
    assert worst_eigenvalue_error(ROBOT, random_drive(seed, duration=60.0)) < 0.01


def test_a_curvature_that_changes_all_the_time_loses_nothing() -> None:
    assert worst_eigenvalue_error(ROBOT, figure_eight()) < 0.01


@pytest.mark.parametrize(
    "robot",
    [Robot(0.16, 0.033, 4096, 4096), Robot(1.5, 0.3, 3600, 3600), Robot(0.35, 0.05, 2000, 500)],
    ids=["small robot", "large robot", "unequal encoders"],
)
def test_other_robots_lose_nothing(robot: Robot) -> None:
    for ticks in (square(robot), random_drive(1, robot), figure_eight(robot)):
        assert worst_eigenvalue_error(robot, ticks) < 0.01


# One curvature, one piece.

RESOLUTIONS = st.sampled_from([60.0, 500.0, 2000.0, 20000.0])
CURVATURES = {
    "line": (1.0, 1.0),
    "line, backwards": (-1.0, -1.0),
    "wide arc": (1.0, 1.004),
    "arc": (1.0, 0.6),
    "arc, backwards": (-0.3, -1.0),
    "spin": (-1.0, 1.0),
    "pivot": (0.0, 1.0),
    "arc about a point between the wheels": (-0.35, 1.0),
}


shares = st.floats(-1.0, 1.0)


@st.composite
def speed_profiles(draw: st.DrawFn) -> np.ndarray:
    """Travel of the faster wheel at each sample [m]: any speeds, with stops, up to 20 m."""
    stretches = st.tuples(
        st.floats(0.0, 2.0) | st.just(0.0),  # speed [m/s]
        st.integers(1, 80),  # samples
    )
    speeds = [np.full(samples, speed) for speed, samples in draw(st.lists(stretches, min_size=1))]
    rate = draw(st.sampled_from([10.0, 50.0, 333.0]))
    travel = np.cumsum(np.concatenate([[0.0], *speeds])) / rate
    return travel[travel <= 20.0]


@settings(max_examples=100)
@given(
    curvature=st.sampled_from(sorted(CURVATURES.values())) | st.tuples(shares, shares),
    travel=speed_profiles(),
    track=st.sampled_from([0.15, 0.35, 1.0]),
    left_ticks=RESOLUTIONS,
    right_ticks=RESOLUTIONS,
    phase=st.floats(0.0, 1.0),
)
@example((1.0, 1.004), np.arange(5000) * 0.01, 0.35, 60.0, 60.0, 0.0)
@example((-1.0, 1.0), np.arange(5000) * 0.01, 0.35, 60.0, 60.0, 0.0)
@example((0.99, 1.0), np.arange(4000) * 0.03, 0.15, 200.0, 200.0, 0.5)
@example((0.22, 1.0), np.arange(1200) * 0.001, 0.35, 60.0, 500.0, 0.5)
def test_driving_of_constant_curvature_is_one_piece_whatever_the_speed(
    curvature: tuple[float, float],
    travel: np.ndarray,
    track: float,
    left_ticks: float,
    right_ticks: float,
    phase: float,
) -> None:
    robot = Robot(track, 0.05, left_ticks, right_ticks)
    left, right = (share * travel for share in curvature)
    ticks = rolled(robot, 50.0, left, right, phase)
    assert len(trajectory(robot, *ticks).pieces) <= 1


@pytest.mark.parametrize("curvature", CURVATURES)
def test_a_piece_knows_its_length_turn_and_radius(curvature: str) -> None:
    speeds = speeded_up(3.0, 0.5, rate=50.0)
    travel = np.append(0.0, np.cumsum(speeds) / 50.0)
    left, right = (share * travel[-1] for share in CURVATURES[curvature])
    ticks = rolled(ROBOT, 50.0, *(share * travel for share in CURVATURES[curvature]))
    (piece,) = trajectory(ROBOT, *ticks).pieces
    count = ROBOT.left_tick
    assert piece.length == pytest.approx(0.5 * (left + right), abs=count)
    assert piece.turn == pytest.approx((right - left) / ROBOT.track, abs=2 * count / ROBOT.track)
    assert piece.radius == (piece.length / piece.turn if piece.turn else math.inf)
    assert piece.time_start == ticks.time[0]
    assert piece.time_end == ticks.time[-1]


def test_a_square_is_four_lines_and_four_spins() -> None:
    pieces = trajectory(ROBOT, *square()).pieces
    assert [piece.kind for piece in pieces] == ["line", "spin"] * 4
    for piece in pieces:
        expected = 4.0 if piece.kind == "line" else 0.0
        assert piece.length == pytest.approx(expected, abs=0.002)
        assert piece.turn == pytest.approx(0.0 if expected else 0.5 * math.pi, abs=0.01)


@pytest.mark.parametrize(
    ("motion", "kind"),
    [
        (BodyMotion(4.0, 0.0, 0.0), "line"),
        (BodyMotion(-4.0, 0.0, 0.04), "line"),
        (BodyMotion(4.0, 0.0, 0.06), "arc"),
        (BodyMotion(0.02, 0.0, 0.04), "arc"),
        (BodyMotion(0.0, 0.0, 0.06), "spin"),
        (BodyMotion(0.0, 0.0, 0.001), "spin"),
        (BodyMotion(0.01, 0.0, 1.5), "spin"),
        (BodyMotion(0.1, 0.0, 1.5), "arc"),
        (BodyMotion(0.0, 0.0, 0.0), "line"),
    ],
)
def test_pieces_are_called_what_a_person_would_call_them(
    motion: BodyMotion[float], kind: str
) -> None:
    assert kind_of(motion, 0.35) == kind


# A reversal ends a piece: noise goes with the distance travelled, and sums of travel would forget.


def out_and_back(left: float, right: float) -> Ticks:
    travel = np.append(0.0, np.cumsum(speeded_up(1.0, 0.4, rate=50.0)) / 50.0)
    there = rolled(ROBOT, 50.0, left * travel, right * travel)
    back = rolled(ROBOT, 50.0, -left * travel, -right * travel)
    return then(there, back)


@pytest.mark.parametrize(
    ("left", "right"), [(1.0, 1.0), (-1.0, 1.0), (0.0, 1.0), (1.0, 0.0), (0.02, 1.0)]
)
def test_a_wheel_that_reverses_ends_a_piece(left: float, right: float) -> None:
    ticks = out_and_back(left, right)
    pieces = trajectory(ROBOT, *ticks).pieces
    assert len(pieces) == 2
    turned = ticks.time[-1] / 2.0
    assert pieces[1].time_start == pytest.approx(turned, abs=0.3)
    travelled = pieces[0].travel.left + pieces[0].travel.right
    assert travelled == pytest.approx(left + right, abs=0.003)


def test_coming_back_undoes_no_variance_but_that_of_a_flicker() -> None:
    """Until it is clear that a wheel has reversed, a count or two could be a flicker."""
    ticks = out_and_back(1.0, 1.0)
    covariance = trajectory(ROBOT, *ticks).covariance
    there = covariance.yawyaw[ticks.time.size // 2]
    assert covariance.yawyaw[-1] == pytest.approx(2.0 * there, rel=1e-3)  # a count is 2e-4 of it
    assert np.diff(covariance.yawyaw).min() > -2.0 * HEADING_OF_A_COUNT


def test_one_wheel_reversing_under_way_ends_a_piece_although_the_robot_goes_on() -> None:
    """A curve that tightens until the inner wheel goes back."""
    travel = np.arange(200) * 0.005
    outwards = rolled(ROBOT, 50.0, 0.1 * travel, travel)
    inwards = rolled(ROBOT, 50.0, -0.1 * travel, travel)
    first, *_, last = trajectory(ROBOT, *then(outwards, inwards)).pieces
    assert first.travel.left > 0.0 > last.travel.left


# Encoders that flicker, and rest.


def flickering(count: int, seed: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).integers(0, 2, count)


def at_rest_after_two_metres(samples: int) -> Ticks:
    drive = rolled(
        ROBOT, 50.0, *(2 * [np.append(0.0, np.cumsum(speeded_up(2.0, 0.5, 50.0)) / 50.0)])
    )
    still = np.zeros(samples, dtype=np.int64)
    return then(drive, Ticks(np.arange(samples) / 50.0, still, still))


@pytest.mark.parametrize("wheels", [(1, 0), (0, 1), (1, 1), (1, -1)])
def test_a_count_that_flickers_at_rest_neither_cuts_nor_grows_anything(
    wheels: tuple[int, int],
) -> None:
    ticks = at_rest_after_two_metres(5000)
    start = ticks.time.size - 5000
    for counts, size, seed in zip((ticks.left, ticks.right), wheels, (3, 4), strict=True):
        counts[start:-1] += size * flickering(4999, seed)
    result = trajectory(ROBOT, *ticks)
    assert len(result.pieces) == 1
    before, after = (result.covariance.matrix()[at] for at in (start - 1, -1))
    assert np.abs(after - before).max() < 1e-12 * before.max()
    one_count = 4.0 * ROBOT.left_tick / 2.0
    at_rest = np.linalg.eigvalsh(result.covariance.matrix()[start:])
    assert np.abs(at_rest / np.linalg.eigvalsh(before) - 1.0).max() < 2.0 * one_count


def test_a_coarse_encoder_that_flickers_beside_a_fine_one_has_not_reversed() -> None:
    robot = Robot(0.35, 0.05, 60, 20000)
    travel = np.append(0.0, np.cumsum(speeded_up(2.0, 0.5, 50.0)) / 50.0)
    ticks = rolled(robot, 50.0, travel, travel)
    ticks.left[::2] -= 1
    assert len(trajectory(robot, *ticks).pieces) == 1


def test_a_robot_that_flickers_before_it_ever_moves_stays_certain_to_a_count() -> None:
    odometer = Odometer(ROBOT)
    pieces: list[Piece] = []
    for at, count in enumerate(flickering(10_000).tolist()):
        estimate = odometer.update(0.02 * at, 100 + count, 500 - count)
        if estimate is not None and estimate.closed is not None:
            pieces.append(estimate.closed)
    assert not pieces
    assert odometer.covariance().yawyaw <= 1.000001 * HEADING_OF_A_COUNT


def test_at_rest_the_covariance_does_not_grow_and_on_a_stop_none_is_lost() -> None:
    ticks = at_rest_after_two_metres(3000)
    published = trajectory(ROBOT, *ticks).covariance.matrix()
    moving, resting = published[:-3000], published[-3000:]
    assert (resting == moving[-1]).all()
    assert (np.diff(np.trace(moving, axis1=1, axis2=2)) > -1e-18).all()


def test_controllers_that_tie_the_covariance_to_the_present_speed_lose_or_invent_it() -> None:
    """Two customs: a fixed matrix for moving and one for rest; a fixed one added each message."""
    ticks = at_rest_after_two_metres(3000)
    speed = np.append(0.0, np.diff(ticks.left))
    ours = trajectory(ROBOT, *ticks).covariance.yawyaw
    by_speed = np.where(speed > 0, 1e-3, 1e-9)
    by_message = 1e-9 * np.arange(ticks.time.size)
    stop = ticks.time.size - 3000
    assert by_speed[-1] < 1e-5 * by_speed[stop // 2], "forgets on a stop what two metres cost"
    assert by_message[-1] > 5.0 * by_message[stop], "grows while nothing moves"
    assert ours[-1] == ours[stop] > ours[stop // 2] > 0.0


@pytest.mark.parametrize("stops", [1, 10, 100])
def test_stop_and_go_costs_no_more_than_going(stops: int) -> None:
    once = np.append(0.0, np.cumsum(speeded_up(2.0, 0.5, 50.0)) / 50.0)
    share = np.append(0.0, np.cumsum(speeded_up(2.0 / stops, 0.5, 50.0)) / 50.0)
    rest = np.full(20, share[-1])
    travel = np.concatenate([at * share[-1] + np.concatenate([share, rest]) for at in range(stops)])
    through, halting = (trajectory(ROBOT, *rolled(ROBOT, 50.0, way, way)) for way in (once, travel))
    assert len(halting.pieces) == 1
    gone, halted = (np.array(run.covariance)[:, -1] for run in (through, halting))
    assert np.abs(halted - gone).max() < 1e-3 * np.abs(gone).max()
