# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A filter that others wrote, downstream of the odometry: filterpy's EKF, with a fix now and then.

The robot shares no formula with us (test/white_noise_robot.py). The filter takes the published
odometry as increments of the pose, each with the covariance that the messages state for it, and
every 20 seconds a fix of x, y and yaw. NEES of its errors over 40 drives must lie within the 95 %
bounds of chi-squared, whether the robot goes slowly or fast. With a constant covariance, as
diff_drive_controller publishes one, it cannot: a constant that is tuned to one way of driving is
wrong for the next.

`python test/ros/test_ekf_filterpy.py` prints the table of docs/robot.md.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy import stats

from test.white_noise_robot import RATE, WhiteNoiseRobot, drive, wandering
from werrimbi_odom.model.covariance import PoseCovariance, carried
from werrimbi_odom.model.pose import Pose, between, compose, wrap
from werrimbi_odom.model.trajectory import Trajectory, trajectory

kalman = pytest.importorskip("filterpy.kalman", reason="needs filterpy (pip install .[test])")

ROOT = Path(__file__).parents[2]
TRUE = WhiteNoiseRobot()
BELIEVED = TRUE.entered()
DRIVES = 40
SECONDS = 60.0
PACES = {"slow": 0.2, "as tuned": 1.0, "fast": 4.0}
"""Times as fast as the drives on which the constant is tuned."""
FIX_EVERY = 20.0
"""Seconds from one fix to the next."""
FIX = np.diag([0.01, 0.01, 0.02])
"""Standard deviations of a fix: x, y [m], yaw [rad]."""
STEP = 5
"""Odometry messages in one prediction of the filter: 10 Hz."""
SECOND = round(RATE) // STEP


class Driven(NamedTuple):
    """One drive: odometry at the filter's rate, and the truth at the same instants."""

    poses: list[Pose]
    covariances: list[PoseCovariance[float]]
    truth: list[Pose]


@functools.cache
def drives(pace: str) -> list[Driven]:
    """Drives with lines, curves, spins, stops and reversing."""
    found = []
    for seed in range(DRIVES):
        random = np.random.default_rng(1000 + seed)
        speed, rate = wandering(random, SECONDS)
        commands = PACES[pace] * speed, PACES[pace] * rate
        run: Any = drive(TRUE, commands, random, sigma_xy=0.0, sigma_yaw=0.0, every=STEP)
        counts = (part.astype(np.int64) for part in (run.ticks.left, run.ticks.right))
        path: Trajectory = trajectory(BELIEVED, run.ticks.time, *counts)
        rows = range(0, run.ticks.time.size, STEP)
        reference = run.reference
        found.append(
            Driven(
                [Pose(float(path.x[r]), float(path.y[r]), float(path.yaw[r])) for r in rows],
                [PoseCovariance(*(float(part[r]) for part in path.covariance)) for r in rows],
                [
                    Pose(float(x), float(y), float(yaw))
                    for x, y, yaw in zip(reference.x, reference.y, reference.yaw, strict=True)
                ],
            )
        )
    return found


# --------------------------------------------------------------- what the odometry promises

Promise = Callable[[Driven, int], np.ndarray]
"""Covariance of the increment into a row, in the frame of the robot at its start, shape (3, 3)."""


def published(driven: Driven, row: int) -> np.ndarray:
    """P₂ - J P₁ Jᵀ of two published covariances: what the stretch between them has added."""
    start, end = driven.poses[row - 1], driven.poses[row]
    before = carried(driven.covariances[row - 1], end.x - start.x, end.y - start.y)
    added = PoseCovariance(*np.subtract(driven.covariances[row], before).tolist()).matrix()
    cos, sin = math.cos(start.yaw), math.sin(start.yaw)
    back = np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(back @ added @ back.T)


@functools.cache
def tuned_promise() -> np.ndarray:
    """The best constant for one way of driving: the mean of the true covariance there."""
    there = drives("as tuned")
    each = [published(driven, row) for driven in there for row in range(1, len(driven.poses))]
    return np.diag(np.mean(each, axis=0).diagonal())


def tuned(_: Driven, __: int) -> np.ndarray:
    """Better than anyone has it who does not know the truth."""
    return tuned_promise()


def of_diffbot(_: Driven, __: int) -> np.ndarray:
    """twist_covariance_diagonal as in ros2_control's DiffBot: 0.001 m²/s², 0.01 rad²/s².

    Each message's error of speed, drawn anew, moves the pose by its interval; a variance of zero
    is 1e-9 to robot_localization.
    """
    return np.diag([0.001, 1e-9, 0.01]) * STEP / RATE**2


PROMISES: dict[str, Promise] = {
    "as `odom_node` publishes it": published,
    "constant, as in ros2_control's DiffBot": of_diffbot,
    "constant, tuned at the middle pace": tuned,
}


# --------------------------------------------------------------- the filter


def filtered(driven: Driven, promise: Promise, seed: int) -> np.ndarray:
    """NEES at each second of a drive, over 3 degrees of freedom, shape (seconds,)."""
    random = np.random.default_rng(seed)
    ekf = kalman.ExtendedKalmanFilter(dim_x=3, dim_z=3)
    ekf.x = np.array(driven.truth[0], dtype=float)
    ekf.P = 1e-12 * np.eye(3)
    ekf.R = FIX**2
    found = []
    for row in range(1, len(driven.poses)):
        step = between(driven.poses[row - 1], driven.poses[row])
        cos, sin = math.cos(ekf.x[2]), math.sin(ekf.x[2])
        ekf.F = np.array(
            [
                [1.0, 0.0, -sin * step.x - cos * step.y],
                [0.0, 1.0, cos * step.x - sin * step.y],
                [0.0, 0.0, 1.0],
            ]
        )
        turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        ekf.Q = turn @ promise(driven, row) @ turn.T
        end = np.array(compose(Pose(*ekf.x), step))
        ekf.predict_x = lambda u=0, end=end: setattr(ekf, "x", end)
        ekf.predict()
        truth = np.array(driven.truth[row])
        if row % round(FIX_EVERY * SECOND) == 0:
            fix = truth + FIX.diagonal() * random.standard_normal(3)
            ekf.update(fix, lambda x: np.eye(3), lambda x: x, residual=difference)
        if row % SECOND == 0:
            error = difference(ekf.x, truth)
            found.append(error @ np.linalg.solve(ekf.P + 1e-12 * np.eye(3), error) / 3.0)
    return np.array(found)


def difference(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    apart = one - other
    apart[2] = wrap(float(apart[2]))
    return np.asarray(apart)


@functools.cache
def nees(name: str, pace: str) -> np.ndarray:
    """Shape (drives, seconds)."""
    each = enumerate(drives(pace))
    return np.array([filtered(driven, PROMISES[name], seed) for seed, driven in each])


def bounds() -> tuple[float, float]:
    """95 % of the mean NEES of all drives at one instant, of a filter that is consistent."""
    freedom = 3 * DRIVES
    low, high = (stats.chi2.ppf([0.025, 0.975], freedom) / freedom).tolist()
    return low, high


def inside(name: str, pace: str) -> float:
    """Share of instants whose mean NEES over the drives is within its bounds."""
    low, high = bounds()
    mean = nees(name, pace).mean(axis=0)
    return float(((low <= mean) & (mean <= high)).mean())


def table() -> str:
    """For docs/robot.md."""
    head = "".join(f" {pace} |" for pace in PACES)
    lines = [f"| covariance of the odometry |{head}", "|---|---|---|---|"]
    for name in PROMISES:
        cells = (f" {nees(name, p).mean():.2f}, {inside(name, p):.0%} |" for p in PACES)
        lines.append(f"| {name} |{''.join(cells)}")
    return "\n".join(lines) + "\n"


# --------------------------------------------------------------- tests

OURS = "as `odom_node` publishes it"
TUNED = "constant, tuned at the middle pace"


OF_EACH_PACE = pytest.mark.parametrize(
    "pace", [pytest.param(pace, marks=[pytest.mark.evidence] * (pace != "fast")) for pace in PACES]
)


@OF_EACH_PACE
def test_with_the_published_covariance_the_filter_is_consistent(pace: str) -> None:
    low, high = bounds()
    assert low < nees(OURS, pace).mean() < high
    # Not 95 %: instants between the same two fixes share their errors, so they fall out together.
    assert inside(OURS, pace) >= 0.75


@OF_EACH_PACE
def test_with_a_constant_covariance_it_is_not(pace: str) -> None:
    assert inside("constant, as in ros2_control's DiffBot", pace) < 0.2


@pytest.mark.evidence
def test_nor_is_it_with_one_that_was_tuned() -> None:
    low, high = bounds()
    assert nees(TUNED, "slow").mean() < low
    assert nees(TUNED, "fast").mean() > high
    assert inside(TUNED, "slow") < 0.2
    assert inside(TUNED, "fast") < 0.2


@pytest.mark.evidence
def test_the_docs_show_these_figures() -> None:
    page = (ROOT / "docs" / "robot.md").read_text(encoding="utf-8")
    numbers = re.compile(r"\d+(?:\.\d+)?")
    for line in table().splitlines()[2:]:
        name = line.split("|")[1].strip()
        kept = next(row for row in page.splitlines() if row.startswith(f"| {name} |"))
        pairs = zip(numbers.findall(kept), numbers.findall(line), strict=True)
        for before, now in pairs:
            assert float(now) == pytest.approx(float(before), rel=0.02, abs=1.01)


if __name__ == "__main__":
    print(table(), end="")
