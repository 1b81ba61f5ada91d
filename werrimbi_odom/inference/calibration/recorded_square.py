# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Return position error of one recorded square, as UMBmark measures it with a tape."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration.squares import CountedSquare, Squares
from werrimbi_odom.model.encoder_online import Counts, EncoderLimits
from werrimbi_odom.model.encoder_recorded import wheel_steps
from werrimbi_odom.model.motion import WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class SquareRecording:
    """One recorded drive: n rows of counters, m of reference, on one clock."""

    name: str
    """Name of the run, for error messages."""
    time: Floats
    left: Counts
    right: Counts
    """Stamps [s] and cumulative counts, shape (n,)."""
    reference_time: Floats
    reference_x: Floats
    reference_y: Floats
    reference_yaw: Floats
    """[s, m, m, rad]; NaN where not measured, shape (m,)."""


@dataclass(frozen=True, slots=True)
class RecordedSquare:
    """One square: sense +1 anticlockwise, -1 clockwise; offset [m] as in `Squares`."""

    sense: int
    offset: Floats
    driven: CountedSquare


@dataclass(frozen=True, slots=True)
class _Path:
    """Dead reckoning from the first measured position to the last, from the origin along x."""

    time: Floats
    travel: WheelTravel[Floats]
    x: Floats
    y: Floats
    yaw: Floats


def squares_of(recorded: Sequence[RecordedSquare], side: float) -> Squares:
    """Combine recorded squares of both senses.

    InputError if a sense is missing or has too few runs.
    """
    cw = [run for run in recorded if run.sense < 0]
    ccw = [run for run in recorded if run.sense > 0]
    return Squares(
        side,
        np.array([run.offset for run in cw]).reshape(-1, 2),
        np.array([run.offset for run in ccw]).reshape(-1, 2),
        tuple(run.driven for run in cw),
        tuple(run.driven for run in ccw),
    )


def recorded_square(
    record: SquareRecording, robot: Robot, side: float, limits: EncoderLimits | None = None
) -> RecordedSquare:
    """End position of a recorded square, measured minus odometry.

    Both paths start at the first measured position with the first measured heading. A small heading
    error rotates both ends about the start alike, so it hardly changes their difference. InputError
    if the drive is not one closed square of that side, or the robot has effects.
    """
    if robot.effects:
        raise InputError(
            f"UMBmark knows base and radii alone, and the robot file holds "
            f"{', '.join(applied.name for applied in robot.effects)}: take `calibrate fit`"
        )
    rows = np.flatnonzero(np.isfinite(record.reference_x) & np.isfinite(record.reference_y))
    if rows.size < 2:
        raise InputError(
            f"{record.name}: the reference needs a position at the start and at the end"
        )
    path = _reckoned(record, robot, rows, limits)
    sense = _sense(record.name, path)
    corners = _corners(path, sense)
    first_leg = math.atan2(path.y[corners[0]], path.x[corners[0]])
    _check_legs(record.name, path, corners, side)
    facing = _facing(record, rows, path, int(corners[0]), first_leg)
    x, y = record.reference_x[rows], record.reference_y[rows]
    measured = _turned(x[-1] - x[0], y[-1] - y[0], -facing)
    reckoned = _turned(path.x[-1], path.y[-1], -first_leg)
    gap = min(float(np.hypot(*measured)), float(np.hypot(*reckoned)))
    if gap > rules.LAP_TOLERANCE * side:
        raise InputError(
            f"{record.name}: the square is not closed: it ends {gap:.2f} m from its start, by "
            "odometry and by the reference. Drive all four legs, back to the mark"
        )
    return RecordedSquare(sense, measured - reckoned, CountedSquare(path.travel, -first_leg))


def _reckoned(
    record: SquareRecording, robot: Robot, rows: NDArray[np.intp], limits: EncoderLimits | None
) -> _Path:
    """Odometry from the first measured position to the last; at rest outside its rows."""
    steps = wheel_steps(robot, record.time, record.left, record.right, limits)
    if steps.first_row < 0 or steps.time.size == 0:
        raise InputError(f"{record.name}: fewer than two usable rows of ticks")
    node = np.concatenate([record.time[[steps.first_row]], steps.time])
    begin, end = record.reference_time[rows[0]], record.reference_time[rows[-1]]
    if not (np.diff(node) > 0.0).all() or not begin < node[-1] or not end > node[0]:
        raise InputError(
            f"{record.name}: the reference (t_s {begin:g} to {end:g}) and the ticks ({node[0]:g} "
            f"to {node[-1]:g}) do not overlap, or a clock was set back; both need the same clock"
        )
    inside = node[(node > begin) & (node < end)]
    time = np.concatenate([[begin], inside, [end]])
    travel = WheelTravel(
        *(
            np.diff(np.interp(time, node, np.concatenate([[0.0], np.cumsum(part)])))
            for part in (steps.left, steps.right)
        )
    )
    motion = wheels_to_body(travel, robot.track)
    yaw = np.concatenate([[0.0], np.cumsum(motion.turn)])
    dx, dy = displacement(motion, yaw[:-1])
    x, y = (np.concatenate([[0.0], np.cumsum(part)]) for part in (dx, dy))
    return _Path(time, travel, x, y, yaw)


def _sense(name: str, path: _Path) -> int:
    turned = float(path.yaw[-1])
    if abs(abs(turned) - 2.0 * math.pi) > rules.TURN_TOLERANCE:
        raise InputError(
            f"{name}: the square is not closed: by odometry the heading turns by "
            f"{math.degrees(turned):.0f} degrees in all, one lap by 360. Turn the last corner too, "
            "and record each lap as a run of its own. If it was one whole lap, the robot file's "
            "base or radii are far off: `calibrate fit` finds them"
        )
    return 1 if turned > 0.0 else -1


def _corners(path: _Path, sense: int) -> NDArray[np.intp]:
    """Rows halfway through each of the four corners."""
    turned = sense * path.yaw
    half_way = (np.arange(4) + 0.5) * 0.5 * math.pi
    return np.array([int(np.argmax(turned >= angle)) for angle in half_way])


def _check_legs(name: str, path: _Path, corners: NDArray[np.intp], side: float) -> None:
    """Check for four straight legs of the given side, and no other motion."""
    ends = np.concatenate([[0], corners, [path.x.size - 1]])
    straight = np.hypot(np.diff(path.x[ends]), np.diff(path.y[ends]))[:4]
    steps = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(path.x), np.diff(path.y)))])
    driven = np.diff(steps[ends])
    wrong = np.abs(np.concatenate([straight, driven[:4]]) - side) > rules.LEG_TOLERANCE * side
    if wrong.any() or driven[4] > rules.LEG_TOLERANCE * side:
        shown = ", ".join(f"{length:.2f}" for length in driven[:4])
        raise InputError(
            f"{name}: not a square of side {side:g} m: by odometry its legs are {shown} m, and "
            f"{driven[4]:.2f} m follow the last corner. A square begins and ends at a corner, and "
            "a run holds one square and nothing else; are the side and wheel_radius right?"
        )


def _facing(
    record: SquareRecording, rows: NDArray[np.intp], path: _Path, corner: int, first_leg: float
) -> float:
    """Direction of the first leg in the frame of the reference [rad]."""
    yaw = float(record.reference_yaw[rows[0]])
    if math.isfinite(yaw):
        return yaw + first_leg
    x, y = record.reference_x[rows], record.reference_y[rows]
    if rows.size == 2:
        raise InputError(
            f"{record.name}: two measured positions do not say which way the first leg led; "
            "measure the heading at the start, or positions on the way"
        )
    when = record.reference_time[rows]
    at_corner = [np.interp(path.time[corner], when, part) for part in (x, y)]
    return math.atan2(at_corner[1] - y[0], at_corner[0] - x[0])


def _turned(x: float, y: float, angle: float) -> Floats:
    cos, sin = math.cos(angle), math.sin(angle)
    return np.array([cos * x - sin * y, sin * x + cos * y])
