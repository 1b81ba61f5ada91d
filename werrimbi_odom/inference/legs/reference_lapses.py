# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Lapses of a reference: from one pose to the next it is elsewhere, and later it comes back.

So errs a tracker that exchanged two markers, or a scan match at the wrong place. Both leaps are
seen from the reference and the wheels, whatever model is true; the poses between are wrong.
Single wrong poses: `stray_poses`.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import NoDriving, Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.measured_motion import runs_of
from werrimbi_odom.inference.legs.windows import leaps_of
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot


def lapses(counters: Counters, reference: Reference, robot: Robot) -> list[NoDriving]:
    """Find the stretches in which the reference had leapt away, in order.

    They begin and end midway between a right pose and a wrong one. A gyro has no place to leap
    from. `reference`: with strictly ascending stamps.
    """
    known = reference.has_position
    if known.sum() < rules.NO_DRIVING_POSES:
        return []
    of_turns = known & reference.has_yaw
    turns = wrap_all(np.diff(reference.yaw[of_turns])).astype(np.complex128)
    ways = np.diff(reference.x[known]) + 1j * np.diff(reference.y[known])
    off_by = [
        (f"turned by {math.degrees(leap):.0f}°", begin, end)
        for begin, end, leap in _away(
            reference.time[of_turns], turns, counters, robot, rules.NO_DRIVING_TURN, 2 / robot.track
        )
    ]
    off_by += [
        (f"elsewhere by {leap:.2f} m", begin, end)
        for begin, end, leap in _away(
            reference.time[known], ways, counters, robot, rules.NO_DRIVING_WAY, 1.0
        )
        if all(end <= first or begin >= last for _, first, last in off_by)
    ]
    return sorted(
        NoDriving(begin, end, "gap", f"the reference was {words} at once, and then back: {_WHY}")
        for words, begin, end in off_by
    )


_WHY = "a mistake of its own, as of a tracker that mistook its markers"


def _away(
    time: Floats,
    seen: NDArray[np.complex128],
    counters: Counters,
    robot: Robot,
    least: float,
    per_way: float,
) -> list[tuple[float, float, float]]:
    """Begin and end of each lapse [s], and how far it was [rad or m].

    `time` (n,), `seen` (n - 1,): stamps of the poses, and the steps between them. `least`: a leap
    that matters. `per_way`: the most that is measured per way of both wheels.
    """
    rare = time.size < rules.NO_DRIVING_POSES
    if rare or float(np.median(np.diff(time))) >= rules.NO_DRIVING_LEAP_WITHIN:
        return []
    travel = [
        np.abs(np.diff(np.interp(time, counters.time, counts))) * tick
        for counts, tick in (
            (counters.left, robot.left_tick),
            (counters.right, robot.right_tick),
        )
    ]
    leaps, usual = leaps_of(seen, 0.5 * per_way * (travel[0] + travel[1]))
    at = runs_of(leaps)
    steps = [(seen - usual)[first : last + 1] for first, last in at]
    sizes = [each.sum() for each in steps]
    most = rules.JUMP_RARE * time.size
    found: list[tuple[int, int, float]] = []
    for number, (first, _) in enumerate(at):
        leap = abs(sizes[number])
        # A wrong pose or two, after which it is where it would be: noise is all that remains.
        stray = leap < rules.JUMP_LASTS * float(np.abs(steps[number]).max())
        if leap < least or stray or (found and first < found[-1][1]):
            continue
        left = np.abs(np.cumsum(sizes[number:]))
        back = np.flatnonzero(left < rules.JUMP_LASTS * leap)
        last = at[number + int(back[0])][1] + 1 if back.size else math.inf  # never
        if rules.STRAY_AT_ONCE < last - first - 1 < most:
            found.append((first, int(last), leap))
    # What a reference does all the time, as one that is corrected once a second, is no lapse.
    if sum(last - first for first, last, _ in found) > most:
        return []
    middle = 0.5 * (time[1:] + time[:-1])
    return [(float(middle[first]), float(middle[last - 1]), leap) for first, last, leap in found]
