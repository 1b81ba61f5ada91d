# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Inputs of the effects over the steps of several runs, laid end to end."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.legs.matched_run import MatchedRun
from werrimbi_odom.model.drive_of_run import QUANTITIES, DriveOfRun
from werrimbi_odom.model.driven_motion import features
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.wiring import Wiring


class StepMessages(NamedTuple):
    """Messages of a run that have a part in its steps."""

    of_step: NDArray[np.intp]
    """Which of them each step is a part of."""
    rates: Floats | None
    """Counts per second in each (2, k), where the counts alone are too coarse to tell them."""


def messages_of(runs: Sequence[MatchedRun]) -> list[StepMessages]:
    """Messages of each run; they do not depend on the robot."""
    found = []
    for run in runs:
        middles = 0.5 * (run.time[1:] + run.time[:-1])
        numbers, of_step = np.unique(run.counters.message_at(middles), return_inverse=True)
        rates = run.counters.rates
        found.append(StepMessages(of_step, None if rates is None else rates[:, numbers]))
    return found


def drive_of_runs(
    runs: Sequence[MatchedRun], messages: Sequence[StepMessages], robot: Robot, wiring: Wiring
) -> DriveOfRun:
    """Inputs of the effects in the steps of all runs, for a robot with that wiring."""
    parts = [_drive_of(*each, robot, wiring) for each in zip(runs, messages, strict=True)]
    if len(parts) == 1:
        return parts[0]

    def joined(name: str) -> Any:
        return _joined([part.found(name) for part in parts])

    return DriveOfRun.by({name: partial(joined, name) for name in QUANTITIES})


def counts_of(runs: Sequence[MatchedRun]) -> WheelTravel[Floats]:
    """Counts of both wheels in all steps."""
    counts: WheelTravel[Floats] = _joined([WheelTravel(run.left, run.right) for run in runs])
    return counts


def _drive_of(run: MatchedRun, messages: StepMessages, robot: Robot, wiring: Wiring) -> DriveOfRun:
    left, right = wiring.wheels(run.left, run.right)
    first_counts = wiring.wheels(run.counters.first_left, run.counters.first_right)
    raw = WheelTravel(left * robot.left_tick, right * robot.right_tick)
    rims = None
    if messages.rates is not None:
        left, right = wiring.wheels(*messages.rates)
        rims = WheelTravel(left * robot.left_tick, right * robot.right_tick)
    duration, message = np.diff(run.time), messages.of_step
    return features(robot, duration, raw, first_counts, run.channels, message, rims)


def _joined(parts: Sequence[Any]) -> Any:
    """Concatenate arrays, tuples or mappings of arrays."""
    first = parts[0]
    if len(parts) == 1:
        return first
    if isinstance(first, np.ndarray):
        return np.concatenate(parts)
    if isinstance(first, tuple):
        return type(first)(*(_joined(list(column)) for column in zip(*parts, strict=True)))
    common = [name for name in first if all(name in part for part in parts)]
    return {name: _joined([part[name] for part in parts]) for name in common}
