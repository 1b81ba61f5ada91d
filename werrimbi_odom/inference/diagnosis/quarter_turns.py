# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What an error per radian turned comes to over the turning of the drives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True, eq=False)
class Turning:
    """The turning of the drives, in which a robot that holds its course also turns to and fro."""

    turn: Floats
    """In each step, shape (n,) [rad]."""
    run: NDArray[np.intp]
    """Run of each step, shape (n,)."""
    stretches: tuple[tuple[int, int], ...]
    """First step of each unbroken stretch without gaps, and one past its last."""

    def quarters(self) -> tuple[tuple[int, int], ...]:
        """Steps, as of `stretches`, over which the heading came to change by a quarter turn.

        One begins where the last ends. Of drives without any, the stretches themselves.
        """
        found = []
        for begin, end in self.stretches:
            gone = 0.0
            for step, turned in enumerate(self.turn[begin:end].tolist(), begin + 1):
                gone += turned
                if abs(gone) >= rules.QUARTER_TURN:
                    found.append((begin, step))
                    begin, gone = step, 0.0
        return tuple(found) or self.stretches

    def moved(self, errors: Floats) -> Floats:
        """How far errors (n,) per radian move the robot in each of `quarters`, along one axis."""
        up_to = np.concatenate([[0.0], np.cumsum(errors * self.turn)])
        begin, end = np.array(self.quarters()).T
        return np.asarray(np.abs(up_to[end] - up_to[begin]))


def turning_of(runs: Concatenated, turn: Floats) -> Turning:
    """The turning by `turn`, that of each step (n,) [rad]."""
    driven = np.flatnonzero(~runs.gap)
    broken = (np.diff(driven) > 1) | (np.diff(runs.run_of_leg[driven]) > 0)
    parts = np.split(driven, np.flatnonzero(broken) + 1) if driven.size else []
    stretches = tuple((int(runs.begin[part[0]]), int(runs.end[part[-1]])) for part in parts)
    return Turning(turn, runs.run_of_step, stretches)
