# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""States of a robot over time: standing, driving, held, carried, not recorded, not known."""

from __future__ import annotations

import itertools
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.instants import instants
from werrimbi_odom.files.run import NoDriving, by_hand
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.gaps import gaps_in
from werrimbi_odom.inference.legs.windows import standing_below
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

_GRID = 0.1  # [s]
_REACH = 60.0  # as far as the grid reaches into silences [s]
SLID = (
    "the wheels turned and the scans stood still: the robot was held or against a wall, or the "
    "scans slid along a bare one"
)
LOST = "the robot drove, and its heading is not known: it was held or carried before or after"
What = Literal["stood", "drove", "held", "slid", "carried", "lost", "silent"]
"""`slid`: held, or its scans slid. `lost`: it drove, with a heading that is not known. `silent`: it
moved, and no counts came."""


class TimeSpan(NamedTuple):
    """A stretch of a drive in one state."""

    begin: float
    """Time in the run's own clock [s]."""
    end: float
    what: What


class DrivenAmount(NamedTuple):
    """Total driving, without stretches that are held, carried, or not recorded."""

    spans: tuple[TimeSpan, ...]
    way: float
    """Path by the wheels [m]."""
    turned: float
    """Absolute turning by the wheels [rad]."""
    reversals: int
    """Changes between forwards and backwards."""
    one_curve: bool = False
    """Whether it turned by the same share of its way throughout: on one circle."""


def driven(
    counters: Counters,
    robot: Robot,
    no_driving: tuple[NoDriving, ...],
    unseen: tuple[tuple[float, float], ...] = (),
) -> DrivenAmount:
    """Segment a drive into states, by its wheels and the known stretches without driving.

    What is driven in stretches that the reference did not see, `unseen`, is not counted.
    """
    first, last = float(counters.time[0]), float(counters.time[-1])
    grid = np.append(instants(first, last, _GRID, counters.time, _REACH), last)
    left, right = counters.travel(robot, grid)
    silent = np.diff(grid) > 2 * _GRID
    left[silent], right[silent] = 0.0, 0.0  # what was gone in a silence is not gone at once
    way, turn = 0.5 * (left + right), (right - left) / robot.track
    rolled = 0.5 * (np.abs(left) + np.abs(right))
    moving = rolled > standing_below(rolled)
    if max(np.ptp(np.cumsum(each)) for each in (left, right)) <= rules.NO_DRIVING_TREMBLES:
        moving[:] = False  # a simulator's robot, which trembles where it stands
    state = np.where(moving, "drove", "stood").astype(object)
    for begin, end in itertools.pairwise(_changes(state)):
        if state[begin] == "stood" and (end - begin) * _GRID < rules.REST_LASTS:
            state[begin:end] = "drove"
    middle = 0.5 * (grid[1:] + grid[:-1])
    for index in np.flatnonzero(
        gaps_in(counters.time, counters.way(robot, 1.0, rules.QUARTER_TURN))
    ):
        begin, end = counters.time[index : index + 2]
        state[(middle > begin) & (middle < end)] = "silent"
    for part in by_hand(no_driving):
        what = {LOST: "lost", SLID: "slid"}.get(part.words, part.why)
        state[(middle >= part.begin) & (middle <= part.end)] = what
    spans = tuple(
        TimeSpan(float(grid[begin]), float(grid[end]), state[begin])
        for begin, end in itertools.pairwise(_changes(state))
    )
    drove = state == "drove"
    for since, until in unseen:
        drove &= (middle < since) | (middle > until)
    along = np.sign(way[drove & (np.abs(way) > 0.5 * rolled) & moving])
    return DrivenAmount(
        spans,
        float(np.abs(way[drove]).sum()),
        float(np.abs(turn[drove]).sum()),
        int(np.count_nonzero(np.diff(along))),
        _one_curve(np.where(drove, way, 0.0), np.where(drove, turn, 0.0)),
    )


def _one_curve(way: Floats, turn: Floats) -> bool:
    """Whether turn and way of each second are proportional, by the angle between them."""
    begin = np.arange(0, way.size, round(1.0 / _GRID))
    ways, turns = np.add.reduceat(way, begin), np.add.reduceat(turn, begin)
    return bool(abs(ways @ turns) > rules.ONE_CURVE * np.sqrt((ways @ ways) * (turns @ turns)))


def _changes(state: NDArray[Any]) -> list[int]:
    """Indices at which the state changes, including the first and the end."""
    return [0, *(np.flatnonzero(state[1:] != state[:-1]) + 1).tolist(), state.size]
