# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What compare_node computes, without its messages."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
import pytest
from scipy import stats

pytest.importorskip("rclpy")

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.consistency import chi_squared_quantile
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.trajectory import trajectory
from werrimbi_odom.ros.compare_legs import LASTS, Both, LegCutter, LegError, Window
from werrimbi_odom.ros.compare_track import OdometryTrack, TimedPose

TRUE = WhiteNoiseRobot()
SIGMA_XY, SIGMA_YAW = 1e-3, 2e-3
REFERENCE = PoseCovariance(SIGMA_XY**2, 0.0, 0.0, SIGMA_XY**2, 0.0, SIGMA_YAW**2)
STILL = BodyMotion(0.0, 0.0, 0.0)
UNKNOWN = BodyMotion(math.nan, math.nan, math.nan)


@cache
def legs_of(
    seed: int,
    noise: float = 1.0,
    constant: float | None = None,
    seconds: float = 200.0,
    sigmas: tuple[float, float] = (SIGMA_XY, SIGMA_YAW),
    stated: PoseCovariance[float] = REFERENCE,
) -> list[LegError]:
    """Legs of a wandering drive, with the odometry of a believed robot.

    The reference errs with `sigmas`, and is said to err with `stated`.
    """
    random = np.random.default_rng(seed)
    run: Any = drive(
        TRUE, wandering(random, seconds), random, sigma_xy=sigmas[0], sigma_yaw=sigmas[1], every=7
    )
    counts = (part.astype(np.int64) for part in (run.ticks.left, run.ticks.right))
    path = trajectory(TRUE.entered(noise=noise), run.ticks.time, *counts)
    covariances = np.array(path.covariance).T
    if constant is not None:
        covariances[:] = np.array(PoseCovariance(constant, 0.0, 0.0, constant, 0.0, constant))
    track = OdometryTrack()
    cutter, legs = LegCutter(1.0), []
    # The reference's instants fall between two messages of the odometry.
    reference = run.reference
    row = 0
    for time, x, y, yaw, entries in zip(
        path.time.tolist(),
        path.x.tolist(),
        path.y.tolist(),
        path.yaw.tolist(),
        covariances.tolist(),
        strict=True,
    ):
        track.add(TimedPose(time, Pose(x, y, yaw), PoseCovariance(*entries)), UNKNOWN)
        while row < reference.time.size and reference.time[row] <= track.newest:
            at = float(reference.time[row])
            measured = Pose(
                *(float(part[row]) for part in (reference.x, reference.y, reference.yaw))
            )
            odometry = track.at(at)
            row += 1
            if odometry is None:
                continue
            leg, ends = cutter.take(Both(odometry, TimedPose(at, measured, stated)))
            if leg is not None and ends:
                legs.append(leg)
    return legs


def test_an_honest_covariance_has_a_nees_of_one_and_covers_95_percent() -> None:
    legs = [leg for seed in range(6) for leg in legs_of(seed)]
    window = Window(len(legs))
    for leg in legs:
        window.take(leg.deviation, leg.grows)
    low, high = window.bounds()
    assert window.count == len(legs) > 300
    assert low < window.nees < high
    assert abs(window.coverage - 0.95) < 3.0 * math.sqrt(0.95 * 0.05 / window.count)


def test_legs_share_no_pose_and_are_independent() -> None:
    """Errors of neighbours do not go together, as they would through a pose that both have."""
    errors = []
    for seed in range(6):
        legs = legs_of(seed)
        scaled = [leg.error / np.sqrt(np.diag(leg.covariance)) for leg in legs]
        errors.append(np.array(scaled))
    before = np.concatenate([part[:-1] for part in errors])
    after = np.concatenate([part[1:] for part in errors])
    together = (before * after).mean(axis=0)
    assert (np.abs(together) < 3.5 / math.sqrt(len(before))).all()


def test_no_leg_spans_a_silence_of_the_reference() -> None:
    """A pose each 4 cm, 3 s without any while the robot drives on, and poses again."""
    cutter, ended = LegCutter(1.0), []
    for tick in range(2000):
        time = 0.02 * tick
        if tick % 5 or 20.0 < time < 23.0:
            continue
        way = 0.4 * time
        odometry = TimedPose(
            time, Pose(way, 0.0, 0.0), PoseCovariance(time, 0, 0, time, 0, time), way
        )
        leg, ends = cutter.take(Both(odometry, TimedPose(time, Pose(way, 0.0, 0.0), REFERENCE)))
        if ends:
            assert leg is not None
            ended.append(leg.time)
    # A leg each 2.6 s from the first pose and from the first after the silence.
    lengths = np.diff(ended)
    spans = (np.array(ended[:-1]) < 20.0) & (np.array(ended[1:]) > 23.0)
    assert spans.sum() == 1
    assert lengths[~spans] == pytest.approx(2.6, abs=0.11)
    first_after = min(end for end in ended if end > 23.0)
    assert first_after == pytest.approx(23.0 + 2.5, abs=0.11)


@pytest.mark.parametrize(("noise", "said"), [(0.25, "too small"), (4.0, "too large")])
def test_a_dishonest_covariance_is_said_and_which_way(noise: float, said: str) -> None:
    window = Window(60)
    for leg in legs_of(1, noise):
        window.take(leg.deviation, leg.grows)
    honest, words = window.verdict()
    assert not honest
    assert said in words


def test_a_perfect_reference_with_the_usual_sigmas_is_said_to_be_a_reason() -> None:
    xy, yaw = rules.TAPE_XY**2, rules.TAPE_YAW**2
    window = Window(60)
    for leg in legs_of(1, sigmas=(1e-9, 1e-9), stated=PoseCovariance(xy, 0.0, 0.0, xy, 0.0, yaw)):
        window.take(leg.deviation, leg.grows)
    honest, words = window.verdict()
    assert not honest
    assert window.nees < 0.3
    assert "or reference_sigma_xy and _yaw larger than the reference's noise" in words


@pytest.mark.evidence
def test_an_honest_window_is_seldom_called_dishonest() -> None:
    """Over 600 legs, a window of 20 that slides."""
    honest = 0
    windows = 0
    for seed in range(10, 20):
        window = Window(20)
        for leg in legs_of(seed):
            window.take(leg.deviation, leg.grows)
            honest += window.verdict()[0]
            windows += 1
    assert windows > 500
    assert honest >= 0.995 * windows


def test_a_constant_covariance_is_said_to_be_no_covariance_of_a_path() -> None:
    window = Window(20)
    for leg in legs_of(2, constant=1e-3):
        window.take(leg.deviation, leg.grows)
    assert window.count == 0
    honest, words = window.verdict()
    assert not honest
    assert "does not grow" in words


def test_one_jump_of_the_reference_is_told_from_a_covariance_that_is_wrong() -> None:
    window = Window(20)
    for deviation in [3.0] * 19 + [5_000.0] + [3.0] * (LASTS - 1):
        window.take(deviation, True)
    assert "one leg makes 99% of it" in window.verdict()[1]


def test_a_day_of_honest_legs_is_no_alarm() -> None:
    """Windows overlap: one alone is outside by chance once in 24,000 legs, and five times here."""
    legs, alarms, before = 60_000, 0, True
    window = Window(20)
    for deviation in np.random.default_rng(1801).chisquare(3, legs).tolist():
        window.take(deviation, True)
        quiet, before = before, window._outside < LASTS
        alarms += quiet and not before
    assert alarms == 0


def test_it_is_said_once_it_has_lasted() -> None:
    window = Window(20)
    for deviation in [3.0] * 20 + [200.0] * (LASTS - 1):
        window.take(deviation, True)
    assert window.verdict()[0]
    assert "may be too small, more legs will tell" in window.verdict()[1]
    window.take(3.0, True)
    assert not window.verdict()[0]


def test_nothing_is_said_of_the_first_few_legs() -> None:
    window = Window(20)
    for _ in range(4):
        window.take(1e6, True)
    assert window.verdict() == (True, "4 of the 5 legs driven that a verdict needs")


@pytest.mark.parametrize("freedom", [15, 60, 300])
def test_the_bounds_are_those_of_chi_squared(freedom: int) -> None:
    for p in (0.025, 0.975):
        exact = stats.chi2.ppf(p, freedom)
        assert chi_squared_quantile(p, freedom) == pytest.approx(exact, rel=0.005)
    # Where it is off, far out with few legs, it is slower to raise an alarm.
    low, high = 0.5 - rules.HONEST_CHANCE / 2, 0.5 + rules.HONEST_CHANCE / 2
    assert 0.92 < chi_squared_quantile(low, freedom) / stats.chi2.ppf(low, freedom) < 1.0
    assert 1.0 < chi_squared_quantile(high, freedom) / stats.chi2.ppf(high, freedom) < 1.01


# ------------------------------------------------------------------ the track

CERTAIN = PoseCovariance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_between_two_messages_the_robot_is_on_the_arc() -> None:
    track = OdometryTrack()
    track.add(TimedPose(0.0, Pose(1.0, 2.0, 0.3), CERTAIN), STILL)
    turn, radius = 0.8, 0.6
    end = Pose(
        1.0 + radius * (math.sin(0.3 + turn) - math.sin(0.3)),
        2.0 - radius * (math.cos(0.3 + turn) - math.cos(0.3)),
        0.3 + turn,
    )
    assert track.add(TimedPose(1.0, end, CERTAIN), BodyMotion(0.48, 0.0, 0.8)) == "next"
    found = track.at(0.25)
    assert found is not None
    assert found.pose.x == pytest.approx(1.0 + radius * (math.sin(0.5) - math.sin(0.3)), abs=1e-12)
    assert found.pose.y == pytest.approx(2.0 - radius * (math.cos(0.5) - math.cos(0.3)), abs=1e-12)
    assert found.path == pytest.approx(0.12)
    assert found.turned == pytest.approx(0.2)


def test_a_large_old_heading_error_does_not_blur_the_interval() -> None:
    """A stretch within one interval is as sure as its share of it, however unsure its start is."""
    unsure = PoseCovariance(4.0, 0.0, 0.0, 4.0, 0.0, 0.5)
    track = OdometryTrack()
    track.add(TimedPose(0.0, Pose(), unsure), STILL)
    step = 0.05
    swung = PoseCovariance(4.0, 0.0, 0.0, 4.0 + step**2 * 0.5, step * 0.5, 0.5)
    grown = swung._replace(xx=swung.xx + 1e-6)
    track.add(TimedPose(0.1, Pose(step, 0.0, 0.0), grown), BodyMotion(0.5, 0.0, 0.0))
    half = track.at(0.05)
    assert half is not None
    assert half.covariance.xx - 4.0 == pytest.approx(0.5e-6)
    assert half.covariance.yy == pytest.approx(4.0 + (0.5 * step) ** 2 * 0.5)


def test_a_pose_that_was_set_begins_anew() -> None:
    track = OdometryTrack()
    track.add(TimedPose(0.0, Pose(), CERTAIN), STILL)
    assert track.add(TimedPose(0.1, Pose(0.05, 0.0, 0.0), CERTAIN), BodyMotion(0.5, 0, 0)) == "next"
    assert track.add(TimedPose(0.2, Pose(3.0, 0.0, 0.0), CERTAIN), BodyMotion(0.5, 0, 0)) == "set"
    assert track.at(0.15) is None
    assert track.add(TimedPose(0.2, Pose(3.0, 0.0, 0.0), CERTAIN), STILL) == "old"
    assert track.add(TimedPose(-9.0, Pose(3.0, 0.0, 0.0), CERTAIN), STILL) == "back"


def test_across_a_gap_nobody_knows_where_the_robot_was() -> None:
    track = OdometryTrack()
    track.add(TimedPose(0.0, Pose(), CERTAIN), STILL)
    track.add(TimedPose(5.0, Pose(), CERTAIN), STILL)
    assert track.at(2.0) is None
