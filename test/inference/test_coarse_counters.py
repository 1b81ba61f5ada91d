# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Encoder discs with few slots: a count is centimetres, and a late clock is still a late clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.evidence import in_evidence
from test.inference.driven import COARSE, COMMON, common, of_coarse_counts
from werrimbi_odom.effects import find
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.verdict import verdict_of
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import values_of
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.prediction import predicted_legs
from werrimbi_odom.inference.fitting.quantisation import quantisation
from werrimbi_odom.inference.legs.count_interpolation import Counters, summed
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.driven_motion import features
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.simulation import (
    TrueRobot,
    free,
    hide,
    record,
    write_robot_file,
    write_run,
)
from werrimbi_odom.simulation.hidden import Peculiarity
from werrimbi_odom.simulation.sensors import ReferenceSensor

LATE = 0.04


def driven(
    folder: Path,
    counts: int,
    hidden: Sequence[Peculiarity] = (),
    drives: int = 3,
    reference: ReferenceSensor | None = None,
    rate: float = 50.0,
    seconds: float = 60.0,
) -> tuple[RobotFile, list[Run]]:
    """Some drives with so many counts in a turn."""
    each = float(counts)
    true = TrueRobot(
        left_wheel_noise=4.0e-4,
        right_wheel_noise=5.8e-4,
        left_ticks_per_revolution=each,
        right_ticks_per_revolution=each,
    )
    robot = wo.read_robot(write_robot_file(true, folder / "robot.yaml"))
    runs = []
    for number in range(drives):
        speed = 0.25 + 0.05 * number
        manoeuvre = free(
            seconds, seed=number, speed=speed, yaw_rate=2.5 * speed, acceleration=speed
        )
        recording = record(
            true,
            manoeuvre,
            seed=100 + number,
            hidden=hidden,
            reference=reference,
            ticks_rate_hz=rate,
        )
        runs.append(wo.read_run(write_run(recording, folder / str(number)), robot))
    return robot, runs


@pytest.mark.evidence
@pytest.mark.parametrize("counts", [20, in_evidence(40)])
def test_a_late_clock_is_no_backlash(tmp_path: Path, counts: int) -> None:
    """Legs that were cut at the steps of the counters told 9 mm of backlash, for certain."""
    late = hide("reference_delay", LATE, seed=1).peculiarity
    file, drives = driven(tmp_path, counts, [late])
    found = diagnose(drives[:2], file.robot, COMMON, holdout=drives[2:])
    assert found.found == ("reference_delay",)
    assert values_of(found, "reference_delay")["delay"].value == pytest.approx(LATE, rel=0.15)


@pytest.mark.evidence
@pytest.mark.parametrize("counts", [100, in_evidence(60)])
def test_slip_is_no_late_clock(tmp_path: Path, counts: int) -> None:
    """Accelerations of single messages are of the counters' steps: a late clock explained more."""
    slip = hide("longitudinal_slip", 0.04, seed=1).peculiarity
    file, drives = driven(tmp_path, counts, [slip])
    effects = common("longitudinal_slip", "coulomb_slip")
    found = diagnose(drives[:2], file.robot, effects, holdout=drives[2:])
    assert found.effect == "longitudinal_slip"
    share = values_of(found, "longitudinal_slip")["coefficient"]
    assert abs(share.value - 0.04) < 3.0 * share.std < 0.02


@pytest.mark.evidence
def test_nothing_is_nothing_and_what_is_not_asked_is_said(tmp_path: Path) -> None:
    robot, drives = driven(tmp_path, 40, drives=2, seconds=40.0)
    found = wo.diagnose(robot, drives[:1], holdout=drives[1:])
    assert found.to_dict()["verdict"] == "none"
    words = " ".join(found.summary().split())
    assert "A count of a wheel is 7.9 mm" in words
    assert "(coulomb_slip) are not looked for, and would look like longitudinal_slip" in words


def test_counts_err_along_the_path_and_in_heading_and_never_sideways() -> None:
    """Drawn: what two counters read, and where the robot then is."""
    robot = replace(COARSE, right_ticks_per_revolution=40.0)
    random, heading, many = np.random.default_rng(1), 0.7, 200_000
    left, right = (
        tick * random.uniform(-0.5, 0.5, many) for tick in (robot.left_tick, robot.right_tick)
    )
    along, turn = 0.5 * (left + right), (right - left) / robot.track
    drawn = np.stack([along * np.cos(heading), along * np.sin(heading), turn])
    told = quantisation(robot, np.array([heading]))[0]
    unit = np.sqrt(np.diagonal(told))
    assert np.cov(drawn) / np.outer(unit, unit) == pytest.approx(
        told / np.outer(unit, unit), abs=0.01
    )
    across = np.array([-np.sin(heading), np.cos(heading), 0.0])
    assert across @ told @ across == pytest.approx(0.0, abs=1e-12)
    anywhere = quantisation(robot, np.linspace(0.0, 2.0 * np.pi, 1000, endpoint=False))
    assert quantisation(robot, np.array([np.nan]))[0] == pytest.approx(
        anywhere.mean(axis=0), abs=1e-12
    )


@pytest.mark.parametrize("wired", [(), ("wheels_swapped",)])
def test_a_late_heading_reads_the_counts_that_a_late_pose_does(wired: Sequence[str]) -> None:
    """Rounded less by a straight line between messages, it seemed the better law, for certain."""
    legs = concatenated(match_for_fit([of_coarse_counts(1)], COARSE, 0.5))
    mistakes = tuple(find(name).using() for name in wired)
    headings = [
        predicted_legs(Model(replace(COARSE, effects=(*mistakes, late)), ({},)), legs)[:, 2]
        for name in ("reference_delay", "reference_heading_delay")
        for late in (find(name).using(delay=0.123),)
    ]
    assert np.ptp(headings[0]) > 0.1
    np.testing.assert_allclose(*headings, atol=1e-9)


@pytest.mark.parametrize("share", [0.0, 0.15, 0.35, 0.5, 0.75])
def test_counts_err_less_between_messages(share: float) -> None:
    """Drawn: whole counts of wheels at many speeds, and what is read of them between messages."""
    random, time, fine = np.random.default_rng(1), np.arange(4001.0), np.arange(40001) / 10.0
    told, errors = 0.0, []
    for speed in np.geomspace(0.2, 10.0, 12):  # counts a message
        rates = speed * (1.0 + 0.5 * np.sin(np.cumsum(random.normal(0.0, 0.05, fine.size))))
        rolled = random.uniform() + np.cumsum(rates) / 10.0
        counts = np.floor(np.interp(time, fine, rolled))
        counters = Counters(time, counts, counts, 0.0, 0.0)
        at = time[5:-5] + share
        errors.append(np.var(np.interp(at, fine, rolled) - counters.at(at)[:, 0]))
        told = float(counters.rounding_at(at).mean())
    assert 12.0 * np.mean(errors) == pytest.approx(told, rel=0.06)


@pytest.mark.parametrize("counts", [2.0, 6.0, 10.0, 16.0])
def test_speeds_tell_nothing_of_what_is_beyond_a_count(counts: float) -> None:
    """Drawn: a sound wheel. A late clock was a slip where ten counts came in a message."""
    random, time = np.random.default_rng(1), np.arange(40001.0) / 30.0
    swing = 1.0 + 0.3 * np.sin(np.cumsum(random.normal(0.0, 0.05, time.size)))
    rolled = summed(counts * swing[1:])
    whole = np.floor(rolled)
    counters = Counters(time, whole, whole, 0.0, 0.0)
    told = _speed(counters) - _speed(replace(counters, left=rolled, right=rolled))
    beyond = (rolled - whole)[1:]
    assert abs(np.corrcoef(told, beyond)[0, 1]) < 0.1


def _speed(counters: Counters) -> Floats:
    """Speed of the left wheel that laws of slip use, after each message [counts/s]."""
    rates, lasted = counters.rates, np.diff(counters.time)
    gone = np.diff(counters.left) if rates is None else rates[0, 1:] * lasted
    drive = features(COARSE, lasted, WheelTravel(gone, gone), (0.0, 0.0), {})
    return np.asarray(drive.found("left_smooth_speed").end)


@pytest.mark.evidence
@pytest.mark.parametrize("counts", [60, 200])
def test_counts_hide_no_noise_of_the_reference(tmp_path: Path, counts: int) -> None:
    """Half of it was told, and a sound robot's covariance said to be too small (NEES 1.6)."""
    cameras = ReferenceSensor(27.3, sigma_xy=4e-4, sigma_yaw=1e-3)
    robot, drives = driven(tmp_path, counts, reference=cameras, rate=10.0, seconds=40.0)
    found = wo.compare(robot, drives).to_dict()
    [told] = found["reference"]
    assert told["sigma_xy"] == pytest.approx(4e-4, rel=0.15)
    assert told["sigma_yaw"] == pytest.approx(1e-3, rel=0.15)
    assert found["verdict"]["good"]


def test_a_sound_robot_with_few_counts_is_told_to_be_sound() -> None:
    """It was told to have a covariance that is too large, and a reference that jumped."""
    runs = [of_coarse_counts(seed) for seed in range(1, 9)]
    found = compare(runs, COARSE)
    assert verdict_of(found).good
    assert not found.legs.outlier.any()
