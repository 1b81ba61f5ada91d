# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Bias of a gyro, estimated while the wheels stand."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from werrimbi_odom.files.run import Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.motion_states import TimeSpan
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot


class AtRest(NamedTuple):
    """How a gyro's heading turns while the wheels stand."""

    rate: float
    """[rad/s]"""
    unsure: float
    """Its standard deviation, as of a random walk: the larger one."""
    taken_off: float = 0.0
    """What was taken off the headings, of which nothing is in `rate` [rad/s]."""

    def limited(self, drift: float) -> float:
        """The nearest drift [rad/s] that a gyro of such a rest may have while the robot drives."""
        room = rules.LAID_DRIFT + rules.BIAS_SURE * self.unsure
        return float(np.clip(drift, self.rate - room, self.rate + room))


def without_bias(
    reference: Reference, spans: Sequence[TimeSpan], counters: Counters, robot: Robot
) -> tuple[Reference, AtRest | None]:
    """Remove the bias estimated at rest from the headings of a gyro, if it is significant.

    Also returned is how the headings turn at rest from then on. The robot model takes no part, so
    all parts of a drive get the same bias. Its change while the robot drives is left to the fits,
    where the drift of each run is free. `reference`: headings alone. `spans`: what the robot did
    when, in order. `counters`, `robot`: a rest in which the wheels crept is none, as in a slow spin
    amid a fast drive.
    """
    rests = [span for span in spans if span.what == "stood" and not _crept(span, counters, robot)]
    told = _turning_at_rest(reference, rests)
    if told is None or abs(told.rate) < rules.BIAS_SURE * told.unsure:
        return reference, told
    lapsed = reference.time - reference.time[0]
    seen = replace(reference, yaw=reference.yaw - told.rate * lapsed)
    return seen, AtRest(0.0, told.unsure, told.rate)


def drifts_known(rests: Sequence[tuple[float, float, float] | None]) -> Floats:
    """What rests tell of each gyro's drift while the robot drives, and its standard deviation.

    `rests`: `Run.at_rest` of each run. A drive without a rest has the bias of the others, as they
    were recorded; without any, the deviation is infinite. Shape (2, runs) [rad/s].
    """
    seen = [AtRest(*rest) for rest in rests if rest is not None]
    recorded = np.array([rest.rate + rest.taken_off for rest in seen])
    other = (0.0, np.inf)
    if seen:
        other = (float(recorded.mean()), float(np.hypot(rules.BIAS_OF_A_DRIVE, recorded.std())))
    each = [
        other if rest is None else (rest[0], float(np.hypot(rest[1], rules.LAID_DRIFT)))
        for rest in rests
    ]
    return np.array(each).T


def _crept(span: TimeSpan, counters: Counters, robot: Robot) -> bool:
    """Whether a wheel went on by more than it trembles or than one count."""
    ends = np.array([span.begin + rules.BIAS_EDGE, span.end - rules.BIAS_EDGE])
    ticks = np.array([robot.left_tick, robot.right_tick])
    moved = np.abs(np.diff(counters.at(ends), axis=0)[0]) * ticks
    return bool(np.any(moved > np.maximum(rules.NO_DRIVING_TREMBLES, ticks)))


def _turning_at_rest(reference: Reference, rests: Sequence[TimeSpan]) -> AtRest | None:
    """The turning of headings while the wheels stand; None if they never do so for long enough."""
    seen = reference.has_yaw
    time, turned = reference.time[seen], wrap_all(np.diff(reference.yaw[seen]))
    duration = np.diff(time)
    edge = rules.BIAS_EDGE
    ends = np.array([(-np.inf, -np.inf), *((rest.begin + edge, rest.end - edge) for rest in rests)])
    which = np.searchsorted(ends[:, 0], time, side="right") - 1
    inside = time <= ends[which, 1]
    within, which = inside[:-1] & inside[1:] & (which[:-1] == which[1:]), which[:-1]
    lasted = np.bincount(which[within], duration[within], len(ends))
    rest = within & (lasted >= rules.BIAS_REST)[which]  # in a pause it may still come to rest
    seconds = float(duration[rest].sum())
    if not rest.any():
        return None
    rate = float(turned[rest].sum()) / seconds
    scatter = turned[rest] - rate * duration[rest]
    return AtRest(rate, float(np.sqrt(scatter @ scatter)) / seconds)
