# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robots that were put elsewhere while their reference was silent, as in a pause of the recording.

The wheels stood, so there is no travel by which such a silence is a gap, and no window spans it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import NoDriving, Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot


def moved_in_silence(counters: Counters, reference: Reference, robot: Robot) -> list[NoDriving]:
    """Find silences after which the robot is elsewhere although its wheels stood, in order.

    A localiser that begins anew looks the same. The match of a scan with those before it tells
    nothing of a silence.
    """
    if reference.own_axes:
        return []
    places, headings = (reference.chosen(k) for k in (reference.has_position, reference.has_yaw))
    ways = np.diff(places.x) + 1j * np.diff(places.y)
    turns = wrap_all(np.diff(headings.yaw)).astype(np.complex128)
    found: dict[tuple[float, float], list[str]] = {}
    for time, steps, least, per_way, words, unit in (
        (places.time, ways, rules.NO_DRIVING_WAY, 1.0, "{:.2f} m", 1.0),
        (
            headings.time,
            turns,
            rules.NO_DRIVING_TURN,
            2.0 / robot.track,
            "{:.0f}°",
            math.radians(1.0),
        ),
    ):
        for at in _elsewhere(time, steps, counters, robot, least, per_way):
            ends = float(time[at]), float(time[at + 1])
            found.setdefault(ends, []).append(words.format(abs(steps[at]) / unit))
    return [
        NoDriving(*ends, "carried", f"{_WORDS} {' and '.join(found[ends])}")
        for ends in sorted(found)
    ]


_WORDS = (
    "the reference was silent and the wheels stood, and afterwards the robot was elsewhere (it was "
    "moved meanwhile, or the reference began anew), by"
)


def _elsewhere(
    time: Floats,
    steps: NDArray[np.complex128],
    counters: Counters,
    robot: Robot,
    least: float,
    per_way: float,
) -> list[int]:
    """Which steps of the reference, between poses at `time`, span such a silence.

    `least`: a step that matters [m or rad]. `per_way`: the most that is measured per way of a
    wheel.
    """
    if time.size < rules.NO_DRIVING_POSES:
        return []
    duration = np.diff(time)
    silent = duration > max(rules.SILENT_TO_MOVE, rules.GAP_INTERVALS * float(np.median(duration)))
    noise = np.abs(np.diff(steps))[~silent[1:] & ~silent[:-1]]
    if not silent.any() or not noise.size:
        return []
    least = max(least, rules.JUMP_SCATTER * MEDIAN_TO_SIGMA * float(np.median(noise)))
    stands = rules.NO_DRIVING_TREMBLES + 2.0 * max(robot.left_tick, robot.right_tick)

    def rolled(begin: float, end: float) -> float:
        inside = counters.time[(counters.time > begin) & (counters.time < end)]
        counts = counters.at(np.concatenate([[begin], inside, [end]]))
        return float(max(np.ptp(counts, axis=0) * (robot.left_tick, robot.right_tick)))

    found = []
    for at in np.flatnonzero(silent & (np.abs(steps) > least)).tolist():
        begin, end = float(time[at]), float(time[at + 1])
        # Clocks that are apart put the robot's last or first way into the silence.
        could = per_way * rolled(begin - rules.JUMP_LATE, end + rules.JUMP_LATE)
        if rolled(begin, end) <= stands and abs(steps[at]) > least + could:
            found.append(at)
    return found
