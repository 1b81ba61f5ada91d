# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The noise of legs: closed forms of their steps, each carried to its leg's end, and summed.

Twice: by arrays, and step by step in single numbers, the lines that `compiled` makes machine
code of.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.covariance import (
    PoseCovariance,
    carried,
    covariance_of_bend,
    covariance_over,
    entire,
    noise_of_wheel_variances,
)
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, chord_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.reference_view import View


@dataclass(frozen=True, slots=True)
class DrivenPath:
    """Poses of the nodes of all runs, one after the other; only differences mean anything."""

    motion: BodyMotion[Floats]
    travel: WheelTravel[Floats]
    position: NDArray[np.complex128]
    yaw: Floats


def noise_of_legs(
    path: DrivenPath, runs: Concatenated, track: float, view: View
) -> tuple[Floats, Floats]:
    """Covariance of the legs for unit noise of the left wheel, and of the right; (m, 3, 3) each.

    As the reference sees it, in the frame of its own at each leg's start.
    """
    facing = path.yaw[runs.begin] + view.yaw
    arm = complex(view.ahead, view.left) * np.exp(1j * path.yaw[runs.end])
    marker = path.position[runs.end] + arm
    machine = compiled(step_by_step)
    if machine is None:
        found = _by_arrays(path, runs, track, facing, marker)
    else:
        found = np.empty((6, 2, runs.count))
        travel = WheelTravel(*map(np.ascontiguousarray, path.travel))
        motion = BodyMotion(*map(np.ascontiguousarray, path.motion))
        places = path.position.view(np.float64).reshape(-1, 2)
        ends = marker.view(np.float64).reshape(-1, 2)
        machine(runs.begin, runs.end, travel, motion, places, path.yaw, track, facing, ends, found)
    left_part, right_part = PoseCovariance(*found).matrix()
    return left_part, right_part


def step_by_step(
    begin: NDArray[np.intp],
    end: NDArray[np.intp],
    travel: WheelTravel[Floats],
    motion: BodyMotion[Floats],
    places: Floats,
    yaw: Floats,
    track: float,
    facing: Floats,
    ends: Floats,
    found: Floats,
) -> None:
    """Fill `found`, (6, 2, m): the covariance of m legs for each wheel.

    `begin`, `end` (m,): first steps of the legs, and one past the last. `places`, `yaw` (n + 1, 2):
    poses before each of the n steps, and at the end. `facing` (m,): heading of the axes in which a
    leg is told [rad]. `ends` (m, 2): where the point is that is measured, at the legs' ends [m].
    """
    for leg in range(begin.size):
        cos, sin = math.cos(facing[leg]), math.sin(facing[leg])
        for entry in range(6):
            found[entry, 0, leg] = found[entry, 1, leg] = 0.0
        for step in range(begin[leg], end[leg]):
            moved = BodyMotion(motion.along[step], motion.sideways[step], motion.turn[step])
            chord = chord_of(moved.turn, yaw[step] - facing[leg])
            bent = entire(0.5 * moved.turn, chord.shrink)
            dx, dy = ends[leg, 0] - places[step + 1, 0], ends[leg, 1] - places[step + 1, 1]
            ahead, aside = cos * dx + sin * dy, cos * dy - sin * dx
            rolled = abs(travel.left[step]), abs(travel.right[step])
            for wheel in range(2):
                left, right = (rolled[0], 0.0) if wheel == 0 else (0.0, rolled[1])
                noise = noise_of_wheel_variances(left, right, track)
                own = carried(covariance_of_bend(moved, noise, chord, bent), ahead, aside)
                found[0, wheel, leg] += own.xx
                found[1, wheel, leg] += own.xy
                found[2, wheel, leg] += own.xyaw
                found[3, wheel, leg] += own.yy
                found[4, wheel, leg] += own.yyaw
                found[5, wheel, leg] += own.yawyaw


def _by_arrays(
    path: DrivenPath,
    runs: Concatenated,
    track: float,
    facing: Floats,
    marker: NDArray[np.complex128],
) -> Floats:
    leg = np.repeat(np.arange(runs.count), runs.end - runs.begin)
    found, inside = np.zeros((6, 2, runs.count)), runs.inside
    for begin in range(0, leg.size, _BLOCK):
        block = slice(begin, begin + _BLOCK)
        steps, own_leg = inside[block], leg[block]
        motion = BodyMotion(*(part[steps] for part in path.motion))
        left, right = (np.abs(side[steps]) for side in path.travel)
        none = np.zeros_like(left)
        noise = noise_of_wheel_variances(np.stack([left, none]), np.stack([none, right]), track)
        chord = chord_of(motion.turn, path.yaw[steps] - facing[own_leg])
        own = covariance_over(motion, noise, chord)
        lever = np.exp(-1j * facing[own_leg]) * (marker[own_leg] - path.position[steps + 1])
        moved = np.stack(carried(own, lever.real, lever.imag))
        first = np.concatenate([[0], np.flatnonzero(np.diff(own_leg)) + 1])
        found[..., own_leg[first]] += np.add.reduceat(moved, first, axis=-1)
    return found


_BLOCK = 8192
"""Steps at a time: what they take fits in the processor's cache."""
