# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Live and recorded are one odometry: row by row or in arrays, whatever the counters do."""

from __future__ import annotations

from array import array
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from test.model.drives import ROBOT, Ticks, random_drive, square, then
from test.model.records import Record, records
from werrimbi_odom.model import encoder_recorded, pieces_recorded, recorded_propagation
from werrimbi_odom.model.covariance import CERTAIN, PoseCovariance
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.pieces import Piece
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.quick_odometer import QuickOdometer
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import Trajectory, trajectory

TOLERANCE = 1e-9


class Live:
    """What an odometer said, message by message; arrays with a row for each estimate."""

    def __init__(self, odometer: Odometer, ticks: Ticks) -> None:
        self.rows: list[int] = []
        self.pieces: list[Piece] = []
        numbers = array("d")
        columns = (column.tolist() for column in ticks)
        for row, message in enumerate(zip(*columns, strict=True)):
            estimate = odometer.update(*message)
            if estimate is None:
                continue
            self.rows.append(row)
            numbers.append(estimate.time)
            numbers.extend(estimate.pose)
            numbers.extend(estimate.covariance)
            numbers.extend(estimate.mean_shift or (0.0, 0.0))
            if estimate.closed is not None:
                self.pieces.append(estimate.closed)
        self.pieces.append(odometer.piece)
        table = np.array(numbers).reshape(-1, 12)
        self.time, self.pose, self.covariance, self.shift = np.split(table, [1, 4, 10], axis=1)


def assert_same(one: np.ndarray | Sequence[float], other: np.ndarray | Sequence[float]) -> None:
    one, other = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
    assert one.shape == other.shape
    if one.size:
        assert np.abs(one - other).max() <= TOLERANCE * max(1.0, np.abs(other).max())


def assert_same_covariances(one: np.ndarray, other: np.ndarray, rounding: float = 0.0) -> None:
    """Rows of six entries, each against the standard deviations that it belongs to.

    `rounding` is what position variances may be off by beside that [m²].
    """
    assert one.shape == other.shape
    position = np.sqrt(other[:, 0] + other[:, 3] + rounding / TOLERANCE)
    yaw = np.sqrt(other[:, 5])
    scale = np.stack([position, position, yaw, position, yaw, yaw], axis=-1)
    scale *= np.stack([position, position, position, position, position, yaw], axis=-1)
    assert (np.abs(one - other) <= TOLERANCE * scale).all()


def assert_same_pieces(one: Sequence[Piece], other: Sequence[Piece], rounding: float) -> None:
    assert [piece.kind for piece in one] == [piece.kind for piece in other]
    for times in ("time_start", "time_end"):
        assert [getattr(p, times) for p in one] == [getattr(p, times) for p in other]
    for values in ("start", "travel", "motion"):
        assert_same([getattr(p, values) for p in one], [getattr(p, values) for p in other])
    first, second = (
        np.array([p.covariance_start for p in part]).reshape(-1, 6) for part in (one, other)
    )
    assert_same_covariances(first, second, rounding)


def assert_one_odometry(
    odometer: Odometer, ticks: Ticks, recorded: Trajectory, rounding: float = 0.0
) -> None:
    live = Live(odometer, ticks)
    assert recorded.tally == odometer.tally
    assert recorded.row[1:].tolist() == live.rows
    assert (recorded.time[1:] == live.time[:, 0]).all()
    assert_same(live.pose, np.stack([recorded.x, recorded.y, recorded.yaw], axis=-1)[1:])
    assert_same_covariances(live.covariance, np.stack(recorded.covariance, axis=-1)[1:], rounding)
    if recorded.mean_shift is not None:
        assert_same(live.shift, np.stack(recorded.mean_shift, axis=-1)[1:])
    assert_same_pieces(live.pieces if live.rows else [], recorded.pieces, rounding)


def has_a_row(ticks: Ticks) -> bool:
    return bool(
        (np.isfinite(ticks.time) & np.isfinite(ticks.left) & np.isfinite(ticks.right)).any()
    )


@settings(max_examples=40, deadline=None)
@given(records(), st.sampled_from([1, 3, 20, None]))
def test_live_and_recorded_agree_whatever_the_counters_do(
    record: Record, together: int | None
) -> None:
    """Also where `trajectory` looks at so few rows together that every seam is met."""
    robot, limits, ticks = record
    with rows_together(together):
        if has_a_row(ticks):
            recorded = trajectory(robot, *ticks, limits=limits)
            assert_one_odometry(Odometer(robot, limits=limits), ticks, recorded)
        else:
            with pytest.raises(ValueError, match="no row has a finite time"):
                trajectory(robot, *ticks, limits=limits)


@contextmanager
def rows_together(count: int | None) -> Iterator[None]:
    """How many rows are worked at once is a matter of speed alone."""
    if count is None:
        yield
        return
    sizes = [
        (encoder_recorded, "_STRETCH", count),
        (encoder_recorded, "_BLOCK", 2 * count),
        (pieces_recorded, "_FEW", count),
        (pieces_recorded, "_MANY", 3 * count),
        (pieces_recorded, "_SHORT", count),
        (recorded_propagation, "_BLOCK", count),
    ]
    with ExitStack() as stack:
        for size in sizes:
            stack.enter_context(patch.object(*size))
        yield


@settings(max_examples=25, deadline=None)
@given(records(faults=False))
def test_live_and_recorded_agree_on_exact_moments(record: Record) -> None:
    """Exact moments are differences of squares of displacements, and round as these do."""
    robot, limits, ticks = record
    robot = replace(robot, covariance_order="exact")
    recorded = trajectory(robot, *ticks, limits=limits)
    far = np.ptp(recorded.x) ** 2 + np.ptp(recorded.y) ** 2
    assert_one_odometry(Odometer(robot, limits=limits), ticks, recorded, rounding=1e-15 * far)


@settings(max_examples=25, deadline=None)
@given(
    st.integers(0, 1000),
    st.sampled_from([(0.003, 0.01), (0.0003, 0.001), (0.03, 0.1), (0.0, 0.0)]),
    st.sampled_from([60.0, 2000.0, 50_000.0]),
)
def test_live_and_recorded_agree_at_any_tolerance_and_resolution(
    seed: int, tolerance: tuple[float, float], ticks_per_revolution: float
) -> None:
    robot = Robot(0.35, 0.05, ticks_per_revolution, ticks_per_revolution)
    ticks = random_drive(seed, robot, duration=15.0)
    rule = PieceTolerance(*tolerance)
    assert_one_odometry(Odometer(robot, rule), ticks, trajectory(robot, *ticks, tolerance=rule))


@pytest.mark.evidence
def test_live_and_recorded_agree_on_a_million_ticks() -> None:
    """Squares and wild driving by turns, and every ten thousand messages something goes wrong."""
    lap, wander = square(), random_drive(7, duration=60.0)
    part = then(then(lap, wander), square(rate=200.0, side=2.0))
    repeats = 1_000_000 // part.time.size + 1
    steps = np.tile(np.diff(np.array(part)), repeats)[:, :999_999]
    time, left, right = np.cumsum(np.insert(steps, 0, 0.0, axis=1), axis=1)
    ticks = Ticks(time, left.astype(np.int64), right.astype(np.int64))
    for at in range(5_000, 1_000_000, 50_000):
        ticks.time[at] = ticks.time[at - 1]
        ticks.left[at + 10_000 :] -= ticks.left[at + 10_000]
        ticks.right[at + 10_000 :] -= ticks.right[at + 10_000]
        ticks.left[at + 20_000] += 1_000_000
        ticks.time[at + 30_000 :] += 5.0
        ticks.time[at + 40_000 :] -= 20.0
    limits = EncoderLimits(max_wheel_speed=2.0)
    recorded = trajectory(ROBOT, *ticks, limits=limits)
    assert recorded.time.size > 999_000
    assert min(recorded.tally.resets, recorded.tally.clock_jumps) >= 19
    assert_one_odometry(Odometer(ROBOT, limits=limits), ticks, recorded)


def test_both_start_from_a_pose_that_is_itself_uncertain() -> None:
    pose = Pose(2.0, -1.0, 2.5)
    covariance = PoseCovariance(1e-4, 2e-5, 1e-5, 3e-4, -2e-5, 4e-5)
    odometer = Odometer(ROBOT)
    odometer.set_pose(pose, covariance)
    ticks = random_drive(3, duration=10.0)
    recorded = trajectory(ROBOT, *ticks, start=pose, covariance=covariance)
    assert_one_odometry(odometer, ticks, recorded)
    assert (recorded.x[0], recorded.y[0], recorded.yaw[0]) == pose
    assert tuple(entry[0] for entry in recorded.covariance) == covariance


def test_set_pose_ends_the_piece_and_goes_on_from_there() -> None:
    ticks = random_drive(5, duration=20.0)
    first, second = (Ticks(*(c[part] for c in ticks)) for part in (np.s_[:500], np.s_[499:]))
    odometer = Odometer(ROBOT)
    before = Live(odometer, first)
    ended = odometer.set_pose(Pose(1.0, 2.0, 3.0))
    assert ended.time_end == before.time[-1]
    assert odometer.covariance() == CERTAIN
    after = Live(odometer, Ticks(*(column[1:] for column in second)))
    recorded = trajectory(ROBOT, *second, start=Pose(1.0, 2.0, 3.0))
    assert_same(after.pose, np.stack([recorded.x, recorded.y, recorded.yaw], axis=-1)[1:])
    assert_same_covariances(after.covariance, np.stack(recorded.covariance, axis=-1)[1:])


@settings(max_examples=25, deadline=None)
@given(records(faults=False), st.integers(1, 2**20))
def test_the_first_message_and_the_counters_zero_move_nothing(record: Record, zero: int) -> None:
    """Odometry starts where it is told to, wherever the counters happen to stand."""
    robot, _, ticks = record
    assume(robot.encoder_bits == 0)
    here = trajectory(robot, *ticks, limits=EncoderLimits(1e9))
    there = trajectory(
        robot, ticks.time, ticks.left + zero, ticks.right - zero, limits=EncoderLimits(1e9)
    )
    assert (here.x[0], here.y[0], here.yaw[0]) == (0.0, 0.0, 0.0)
    assert_same(here.x, there.x)
    assert_same(here.yaw, there.yaw)


def test_every_row_of_the_record_has_its_latest_entry() -> None:
    ticks = random_drive(2, duration=2.0)
    ticks.time[:3] = np.nan
    ticks.time[10] = ticks.time[9]
    result = trajectory(ROBOT, *ticks)
    at = result.expanded(ticks.time.size)
    assert at[:4].tolist() == [0, 0, 0, 0]
    assert result.row[at[10]] == 9
    assert at[-1] == result.time.size - 1


def test_distance_counts_both_ways() -> None:
    odometer = Odometer(ROBOT)
    for time, count in enumerate([0, 100, 200, 100, 0]):
        odometer.update(time, count, count)
    assert odometer.distance == pytest.approx(400 * ROBOT.left_tick)


def test_the_twist_is_the_mean_over_the_interval_and_knows_its_noise_and_quantisation() -> None:
    odometer = Odometer(ROBOT)
    odometer.update(0.0, 0, 0)
    estimate = odometer.update(0.5, 100, 140)
    assert estimate is not None
    left, right = 100 * ROBOT.left_tick, 140 * ROBOT.right_tick
    assert estimate.twist.along == pytest.approx((left + right) / 2 / 0.5)
    assert estimate.twist.turn == pytest.approx((right - left) / 0.35 / 0.5)
    noise_left = 4.0e-4**2 * left + ROBOT.left_tick**2 / 6
    noise_right = 5.8e-4**2 * right + ROBOT.right_tick**2 / 6
    speed, cross, yaw_rate = estimate.twist_covariance
    assert speed == pytest.approx((noise_left + noise_right) / 4 / 0.25)
    assert yaw_rate == pytest.approx((noise_left + noise_right) / 0.35**2 / 0.25)
    assert cross == pytest.approx((noise_right - noise_left) / (2 * 0.35) / 0.25)


@pytest.mark.parametrize("late", [0.0, 0.3])
def test_a_driver_that_sends_several_at_once_makes_no_speed(late: float) -> None:
    """At 50 Hz and 0.5 m/s it hangs, then sends what waited 20 microseconds apart."""
    odometer = Odometer(ROBOT)
    counts = np.arange(200) * 0.01 / ROBOT.left_tick
    stamps = 0.02 * np.arange(200.0)
    hung = stamps[100:104].max() + late
    stamps[100:104] = hung + 2e-5 * np.arange(4)
    stamps[104:] += late
    speeds = []
    for time, count in zip(stamps.tolist(), counts.tolist(), strict=True):
        estimate = odometer.update(time, count, count)
        if estimate is not None:
            speeds.append(estimate.twist.along)
            assert estimate.twist_covariance.speed < 1e-3
    assert max(speeds) < 0.55
    assert speeds[-1] == pytest.approx(0.5)


@pytest.mark.parametrize("quick", [False, True])
@pytest.mark.parametrize(("silent", "period"), [(10.0, 0.02), (1.5, 0.02), (0.0, 0.004)])
def test_after_a_pause_and_at_another_rate_the_twist_is_that_of_the_last_messages(
    silent: float, period: float, quick: bool
) -> None:
    """At 0.5 m/s: 50 Hz, then silence at rest, then 50 Hz again; or at once five times as often."""
    odometer = QuickOdometer(ROBOT) if quick else Odometer(ROBOT)
    stamps = np.concatenate([0.02 * np.arange(500.0), 9.98 + silent + period * np.arange(1, 200)])
    way = 0.5 * np.concatenate([0.02 * np.arange(500.0), 9.98 + period * np.arange(1, 200)])
    counts = way / ROBOT.left_tick
    late = []
    for row, (time, count) in enumerate(zip(stamps.tolist(), counts.tolist(), strict=True)):
        estimate = odometer.update(time, count, count)
        if row > 500:  # the first after the pause has all of the pause
            assert estimate is not None
            assert estimate.twist.along == pytest.approx(0.5)
            late.append(estimate.late.duration)
    assert max(late) < 0.05


def test_what_waited_over_a_pause_makes_no_speed() -> None:
    """A driver is silent for two seconds, and then sends ten messages at once."""
    odometer = Odometer(ROBOT)
    counts = np.arange(300) * 0.01 / ROBOT.left_tick
    stamps = 0.02 * np.arange(300.0)
    stamps[100:] += 2.0
    stamps[100:110] = stamps[110] - 2e-5 * np.arange(10, 0, -1)
    speeds = [
        estimate.twist.along
        for row in zip(stamps.tolist(), counts.tolist(), counts.tolist(), strict=True)
        if (estimate := odometer.update(*row)) is not None
    ]
    assert max(speeds) < 0.55
    assert speeds[-1] == pytest.approx(0.5)


def test_an_empty_record_is_refused_in_words() -> None:
    nothing = np.empty(0)
    with pytest.raises(ValueError, match="no row has a finite time and finite counts"):
        trajectory(ROBOT, nothing, nothing, nothing)
