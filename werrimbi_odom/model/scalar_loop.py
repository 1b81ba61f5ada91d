# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run as scalar operations, step by step: the functions that `compiled` compiles.

They do what `Odometer` does at each message, by the same functions, so results agree to the last
bit (but for `follow`, of fits alone: to the last digits). In plain Python they would be as slow as
the odometer; for that case `pieces_recorded` and `recorded_propagation` have array operations.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.covariance import PoseCovariance, after_stretch, path_noise_of
from werrimbi_odom.model.encoder_online import Counts
from werrimbi_odom.model.end_of_piece import NOTHING, PieceRule, PieceSums, extended
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pace import REMEMBERED, seen
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.reading_checks import CountRule, Reading, undoubted
from werrimbi_odom.model.robot import WheelNoise


class Marching(NamedTuple):
    """Pose of the robot, and the open piece."""

    pose: Pose
    covariance: PoseCovariance[float]
    """Covariance of the pose."""
    start: Pose
    """Pose at the start of the piece."""
    covariance_start: PoseCovariance[float]
    """Covariance of that pose."""
    earlier: float
    """Travel u of the earlier pieces [m]."""
    stretch: PieceSums


class Heard(NamedTuple):
    """Recent message intervals and wheel speeds, as in `Pace`."""

    usual: float
    """The usual interval [s]."""
    fastest: float
    """Fastest turn rate of a wheel [turns/s]; `newer` is that of the newer messages."""
    newer: float
    room: int
    """Number of messages until only the newer ones are remembered."""


def read_on(
    rule: CountRule,
    time: Floats,
    left: Counts,
    right: Counts,
    row: int,
    stamps: Floats,
    heard: Heard,
    lasted: float,
    steps: Floats,
) -> tuple[int, Heard, float]:
    """Process rows of a record from `row` on that pass all checks, as an `Encoder` does.

    `time`, `left`, `right` (rows,). `row`: the previous row is the last accepted one. `stamps`
    (k,): remembered stamps, up to the last accepted one. `heard`, `lasted`: state up to there, and
    the interval over which the last step was checked [s]. `steps` (3, rows): output for each of
    these rows: duration, and travel of the wheels. Result: the first doubtful row, or the number of
    rows; then `heard` and `lasted` up to there.
    """
    usual, fastest, newer, room = heard
    at = row
    while at < time.size:
        now = Reading(time[at], left[at], right[at])
        last = Reading(time[at - 1], left[at - 1], right[at - 1])
        plain, step = undoubted(rule, now, last, usual, fastest)
        if not plain:
            break
        steps[0, at] = now.time - last.time
        steps[1, at], steps[2, at] = step.left, step.right
        known = stamps.size + at - row + 1
        first = max(known - REMEMBERED - 1, 0)
        oldest = stamps[first] if first < stamps.size else time[row + first - stamps.size]
        usual = (now.time - oldest) / (known - first - 1)
        fastest, newer, room = seen(step.rate, fastest, newer, room)
        lasted = step.lasted
        at += 1
    return at, Heard(usual, fastest, newer, room), lasted


def onward(
    rule: PieceRule,
    wheels: WheelNoise,
    at: Marching,
    travel: WheelTravel[float],
    motion: BodyMotion[float],
) -> tuple[bool, Marching]:
    """Whether the piece continues with the step or ends before it; and the state after the step."""
    pose, covariance, start, covariance_start, earlier, stretch = at
    dx, dy = displacement(motion, pose.yaw)
    after = Pose(pose.x + dx, pose.y + dy, pose.yaw + motion.turn)
    goes_on, longer = extended(rule, start, earlier, stretch, travel, motion, after)
    if not goes_on:
        start, covariance_start = pose, covariance
        earlier += abs(stretch.left) + abs(stretch.right)
        longer = extended(rule, start, earlier, NOTHING, travel, motion, after)[1]
    noise = path_noise_of(wheels, longer.left, longer.right)
    dx, dy = after.x - start.x, after.y - start.y
    now = after_stretch(covariance_start, longer.motion, noise, longer.chord, dx, dy)
    return goes_on, Marching(after, now, start, covariance_start, earlier, longer)


def march(
    rule: PieceRule,
    wheels: WheelNoise,
    at: Marching,
    travels: WheelTravel[Floats],
    motions: BodyMotion[Floats],
    poses: Floats,
    covariances: Floats,
    starts: NDArray[np.intp],
    sums: Floats,
    pieces: int,
    done: int,
) -> tuple[Marching, int]:
    """Process n steps from the state `at`, and end pieces where they must.

    `travels`, `motions` (n,): the steps. `poses`, `covariances` (3, n): output: x, y, yaw and the
    covariance after each step. `starts`, `sums` (m,): output from index `pieces` on: the first step
    of each piece that starts here, counted from the beginning of the run; and the sums over each
    piece that ends here: travel of the wheels, and motion along, sideways and in yaw. `pieces`,
    `done`: number of pieces started, and of steps done so far. Result: state afterwards, and the
    number of pieces started by then.
    """
    for step in range(motions.turn.size):
        travel = WheelTravel(travels.left[step], travels.right[step])
        motion = BodyMotion(motions.along[step], motions.sideways[step], motions.turn[step])
        before = at
        goes_on, at = onward(rule, wheels, at, travel, motion)
        if not goes_on:
            last = pieces - 1
            whole = sums_of(before.stretch)
            sums[0, last], sums[1, last], sums[2, last], sums[3, last], sums[4, last] = whole
        if before.stretch.empty or not goes_on:
            starts[pieces] = done + step
            pieces += 1
        poses[0, step], poses[1, step], poses[2, step] = at.pose
        xx, xy, xyaw, yy, yyaw, yawyaw = at.covariance
        covariances[0, step], covariances[1, step], covariances[2, step] = xx, xy, xyaw
        covariances[3, step], covariances[4, step], covariances[5, step] = yy, yyaw, yawyaw
    return at, pieces


def follow(motion: BodyMotion[Floats], position: Floats, yaw: Floats) -> None:
    """Integrate the steps of a run; see `recorded_propagation.followed`.

    The direction is turned by each step: less than half the cost of the cosine and the sine of each
    heading. These are taken now and then, before rounding errors grow. `position` (n + 1, 2): the
    first row is input; the others are output, as are those of `yaw`, shape (n + 1,).
    """
    along, sideways, turn = motion
    cos, sin = 1.0, 0.0
    for step in range(turn.size):
        if step % _ANEW == 0:
            cos, sin = math.cos(yaw[step]), math.sin(yaw[step])
        half = 0.5 * turn[step]
        shrink, half_cos = _sinc_and_cos(half)
        half_sin = half * shrink
        cos, sin = cos * half_cos - sin * half_sin, sin * half_cos + cos * half_sin
        dx, dy = cos * along[step] - sin * sideways[step], sin * along[step] + cos * sideways[step]
        position[step + 1, 0] = position[step, 0] + shrink * dx
        position[step + 1, 1] = position[step, 1] + shrink * dy
        cos, sin = cos * half_cos - sin * half_sin, sin * half_cos + cos * half_sin
        yaw[step + 1] = yaw[step] + turn[step]


_ANEW = 64
"""Steps after which `follow` computes the direction from the heading."""


def _sinc_and_cos(angle: float) -> tuple[float, float]:
    """sin(x) / x, and the cosine; by series to the last digit where the angle is small [rad]."""
    t = angle * angle
    if t > 0.01:
        return math.sin(angle) / angle, math.cos(angle)
    sinc = 1.0 - t * (1 / 6 - t * (1 / 120 - t * (1 / 5040 - t / 362880)))
    return sinc, 1.0 - t * (1 / 2 - t * (1 / 24 - t * (1 / 720 - t / 40320)))


March = Callable[..., tuple[Marching, int]]
"""`march`, or its compiled version."""


def sums_of(stretch: PieceSums) -> tuple[float, float, float, float, float]:
    """Sums over a piece: travel of the wheels, and motion along, sideways and in yaw."""
    along, sideways, turn = stretch.motion
    return stretch.left, stretch.right, along, sideways, turn
