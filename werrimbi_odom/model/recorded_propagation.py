# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses, their errors and the pieces along the steps of a whole run, in arrays.

Two implementations give the same results: `march`, step by step as compiled code, where numba is
installed and the run is long enough; and array operations here, on the pieces cut by
`pieces_recorded`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.compiled import compiled, compiled_for
from werrimbi_odom.model.covariance import (
    PathNoise,
    PoseCovariance,
    carried,
    noise_of_wheel_variances,
    path_noise,
    piece_covariance,
    plus,
)
from werrimbi_odom.model.effects_over_run import AfterEffects
from werrimbi_odom.model.end_of_piece import NOTHING, PieceRule
from werrimbi_odom.model.exact_moments import PathMoments
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pieces_recorded import Cut, cut
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.scalar_loop import March, Marching, follow, march, sums_of
from werrimbi_odom.model.uncertainty import Uncertainty, after_piece, with_lost_travel

_BLOCK = 8192  # steps per block: their arrays stay in the cache

Lost = Mapping[int, WheelTravel[float]]
"""Variance of travel that no counter saw [m²], by the index of the step before which it was
lost."""


class PathInPieces(NamedTuple):
    """Result for n steps, grouped into m pieces."""

    poses: Floats
    """x, y, yaw before the first step and after each, shape (3, n + 1)."""
    covariances: Floats
    """Covariances of these poses, shape (6, n + 1)."""
    mean_shift: Floats | None
    """Mean of the true position minus (x, y), shape (2, n + 1); None without exact moments."""
    start: NDArray[np.intp]
    """First step of each piece, shape (m,)."""
    sums: Floats
    """Left and right travel, and motion along, sideways and in yaw, of each piece; shape (5, m)."""
    reset: Mapping[int, PoseCovariance[float]]
    """Covariance at the start of each piece that follows lost travel, by piece."""


def course_of(
    robot: Robot,
    rule: PieceRule,
    start: Pose,
    errors: Uncertainty[float],
    steps: AfterEffects,
    lost: Lost,
) -> PathInPieces:
    """Integrate all steps from a start pose and its errors."""
    machine = compiled_for(steps.travel.left.size, march)
    if machine is not None and errors.moments is None:
        return _marched(machine, robot, rule, start, errors.covariance, steps, lost)
    return _in_arrays(robot, rule, start, errors, steps, lost)


def _marched(
    machine: March,
    robot: Robot,
    rule: PieceRule,
    start: Pose,
    covariance: PoseCovariance[float],
    steps: AfterEffects,
    lost: Lost,
) -> PathInPieces:
    count = steps.travel.left.size
    poses, covariances = np.empty((3, count + 1)), np.empty((6, count + 1))
    poses[:, 0], covariances[:, 0] = start, covariance
    starts, sums = np.empty(count, dtype=np.intp), np.empty((5, count))
    travel = WheelTravel(*map(np.ascontiguousarray, steps.travel))
    motion = BodyMotion(*map(np.ascontiguousarray, steps.motion))
    reset: dict[int, PoseCovariance[float]] = {}
    at, pieces = Marching(start, covariance, start, covariance, 0.0, NOTHING), 0
    wheels = robot.wheel_noise
    for some in _blocks(count, lost):
        if some.start in lost:
            if pieces:
                sums[:, pieces - 1] = sums_of(at.stretch)
            unseen = noise_of_wheel_variances(*lost[some.start], robot.track)
            known = with_lost_travel(Uncertainty(at.covariance), unseen, at.pose.yaw).covariance
            reset[pieces] = known
            earlier = at.earlier + at.stretch.travelled
            at = Marching(at.pose, known, at.pose, known, earlier, NOTHING)
        after = slice(some.start + 1, some.stop + 1)
        at, pieces = machine(
            rule,
            wheels,
            at,
            WheelTravel(travel.left[some], travel.right[some]),
            BodyMotion(motion.along[some], motion.sideways[some], motion.turn[some]),
            poses[:, after],
            covariances[:, after],
            starts,
            sums,
            pieces,
            some.start,
        )
    if pieces:
        sums[:, pieces - 1] = sums_of(at.stretch)
    return PathInPieces(
        poses, covariances, None, starts[:pieces].copy(), sums[:, :pieces].copy(), reset
    )


def integrated(start: Pose, motion: BodyMotion[Floats]) -> Floats:
    """x, y, yaw before the first step and after each, shape (3, n + 1).

    Steps are processed in blocks whose arrays stay in the cache, which halves the time.
    """
    poses = np.empty((3, motion.turn.size + 1))
    poses[:, 0] = start
    poses[2, 1:] = motion.turn
    np.cumsum(poses[2], out=poses[2])
    for steps in _blocks(motion.turn.size):
        part = BodyMotion(*(values[steps] for values in motion))
        poses[:2, 1:][:, steps] = displacement(part, poses[2, steps])
    np.cumsum(poses[:2], axis=1, out=poses[:2])
    return poses


def followed(motion: BodyMotion[Floats]) -> tuple[NDArray[np.complex128], Floats]:
    """Return position and yaw from zero on, shape (n + 1,) each; the fastest form of `integrated`.

    For repeated passes over one run.
    """
    position = np.empty(motion.turn.size + 1, dtype=np.complex128)
    machine = compiled(follow)
    if machine is None:
        x, y, yaw = integrated(Pose(), motion)
        position.real, position.imag = x, y
    else:
        yaw = np.empty(position.size)
        position[0] = yaw[0] = 0.0
        steps = BodyMotion(*map(np.ascontiguousarray, motion))
        machine(steps, position.view(np.float64).reshape(-1, 2), yaw)
    return position, yaw


def _in_arrays(
    robot: Robot,
    rule: PieceRule,
    start: Pose,
    errors: Uncertainty[float],
    steps: AfterEffects,
    lost: Lost,
) -> PathInPieces:
    poses = integrated(start, steps.motion)
    count = steps.travel.left.size
    broken = np.zeros(count, dtype=np.bool_)
    broken[list(lost)] = True
    x, y, yaw = poses
    pieces = cut(rule, steps.travel, steps.motion, x, y, yaw, broken)
    end = np.append(pieces.start[1:], count)[: pieces.start.size]
    sums = np.stack([part[end - 1] for part in (*pieces.travel, *pieces.motion)])
    unseen = {at: noise_of_wheel_variances(*travel, robot.track) for at, travel in lost.items()}
    starts = _chained(robot, pieces.start, end, sums, poses, errors, unseen)
    covariances, shift = _at_every_step(robot, pieces, poses, starts, errors)
    place = {step: at for at, step in enumerate(pieces.start.tolist())} if lost else {}
    reset = {
        place[step]: PoseCovariance(*(float(c[place[step]]) for c in starts.covariance))
        for step in lost
    }
    return PathInPieces(poses, covariances, shift, pieces.start, sums, reset)


def _blocks(count: int, breaks: Lost | None = None) -> Iterator[slice]:
    """Yield blocks of at most `_BLOCK` steps, none of them across a break."""
    first = 0
    for last in [*sorted(breaks or ()), count]:
        for begin in range(first, last, _BLOCK):
            yield slice(begin, min(begin + _BLOCK, last))
        first = last


def _chained(
    robot: Robot,
    begin: NDArray[np.intp],
    end: NDArray[np.intp],
    sums: Floats,
    poses: Floats,
    errors: Uncertainty[float],
    unseen: Mapping[int, PathNoise[float]],
) -> Uncertainty[Floats]:
    """Propagate the errors from piece to piece; return those at the start of each, shape (m,)."""
    parts: list[Uncertainty[Floats]] = []
    for some in _blocks(begin.size):
        yaw = poses[2, begin[some]]
        dx, dy = poses[:2, end[some]] - poses[:2, begin[some]]
        left, right, *motion = sums[:, some]
        noise, body = path_noise(robot, left, right), BodyMotion(*motion)
        steps = zip(begin[some].tolist(), yaw.tolist(), dx.tolist(), dy.tolist(), strict=True)
        chain: list[Uncertainty[float]] = []
        if errors.moments is None:
            own = zip(*(p.tolist() for p in piece_covariance(body, noise, yaw)), strict=True)
            for (step, heading, x, y), added in zip(steps, own, strict=True):
                if step in unseen:
                    errors = with_lost_travel(errors, unseen[step], heading)
                chain.append(errors)
                errors = Uncertainty(plus(carried(errors.covariance, x, y), PoseCovariance(*added)))
        else:
            rows = zip(*(p.tolist() for p in (*body, *noise)), strict=True)
            for (step, heading, x, y), row in zip(steps, rows, strict=True):
                if step in unseen:
                    errors = with_lost_travel(errors, unseen[step], heading)
                chain.append(errors)
                piece = BodyMotion(*row[:3]), PathNoise(*row[3:])
                errors = after_piece(errors, *piece, heading, x, y)
        parts.append(_as_columns(chain))
    return _joined(parts)


def _at_every_step(
    robot: Robot,
    pieces: Cut,
    poses: Floats,
    starts: Uncertainty[Floats],
    at_start: Uncertainty[float],
) -> tuple[Floats, Floats | None]:
    """Errors after every step: the chain up to its piece, then the piece in closed form."""
    x, y, yaw = poses
    count = x.size - 1
    lengths = np.diff(np.append(pieces.start, count))
    piece = np.repeat(np.arange(lengths.size), lengths)
    covariance = np.empty((6, count + 1))
    covariance[:, 0] = at_start.covariance
    shift = np.zeros((2, count + 1))
    exact = at_start.moments is not None
    for block in _blocks(count):
        own_piece = piece[block]
        begin = pieces.start[own_piece]
        after = slice(block.start + 1, block.stop + 1)
        noise = path_noise(robot, pieces.travel.left[block], pieces.travel.right[block])
        errors = after_piece(
            Uncertainty(
                PoseCovariance(*(column[own_piece] for column in starts.covariance)),
                PathMoments(*(column[own_piece] for column in starts.moments))
                if starts.moments is not None
                else None,
            ),
            BodyMotion(*(part[block] for part in pieces.motion)),
            noise,
            yaw[begin],
            x[after] - x[begin],
            y[after] - y[begin],
        )
        covariance[:, after] = errors.covariance
        if errors.mean_shift is not None:
            shift[:, after] = errors.mean_shift
    return covariance, shift if exact else None


def _as_columns(chain: list[Uncertainty[float]]) -> Uncertainty[Floats]:
    """Errors at the starts of all pieces as arrays of shape (m,)."""
    covariance = PoseCovariance(*np.array([each.covariance for each in chain]).reshape(-1, 6).T)
    moments = [each.moments for each in chain if each.moments is not None]
    if not moments:
        return Uncertainty(covariance)
    columns = (np.array(column) for column in zip(*moments, strict=True))
    return Uncertainty(covariance, PathMoments(*columns))


def _joined(parts: list[Uncertainty[Floats]]) -> Uncertainty[Floats]:
    if len(parts) == 1:
        return parts[0]
    if not parts:
        return _as_columns([])
    whole = [np.concatenate(c) for c in zip(*(p.covariance for p in parts), strict=True)]
    if parts[0].moments is None:
        return Uncertainty(PoseCovariance(*whole))
    moments = zip(*(p.moments for p in parts if p.moments is not None), strict=True)
    return Uncertainty(
        PoseCovariance(*whole), PathMoments(*(np.concatenate(column) for column in moments))
    )
