# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Evidence of changes: innovations of all drives, and their slopes in all that may change."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.inference.changes.change_points import GroupChange
from werrimbi_odom.inference.changes.information_of_drives import DriveNumbers
from werrimbi_odom.inference.changes.parameter_groups import DELAY, MOUNT, numbers_of, value_at
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import STEP, FreeParameter
from werrimbi_odom.inference.fitting.score_tests import signatures
from werrimbi_odom.inference.linear import nuisance
from werrimbi_odom.model.effect import extended_by
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Evidence:
    """Linearised innovations of all runs with their Jacobian; each row is an innovation."""

    numbers: tuple[FreeParameter, ...]
    """The parameters that may change, the first of the columns."""
    names: tuple[str, ...]
    """Names of all s columns."""
    values: Floats
    """Values of the columns, (s,)."""
    white: Floats
    """Whitened innovations, (n,)."""
    shared: Floats
    """Derivatives in the shared parameters, (n, s)."""
    own: Floats
    """Derivatives in the per-run parameters, (n, k)."""
    run: NDArray[np.intp]
    """Drive of each row."""

    def drives(self, time: Floats) -> DriveNumbers:
        """The same as information by drive; `time` (R,): times of the drives.

        The per-run parameters are projected out.
        """
        size = len(self.names)
        information = np.zeros((time.size, size, size))
        weighted = np.zeros((time.size, size))
        for index in range(time.size):
            here = self.run == index
            own = self.own[here]
            beside = nuisance(own[:, own.any(axis=0)])
            slopes, rest = beside.residual(self.shared[here]), beside.residual(self.white[here])
            information[index] = slopes.T @ slopes
            weighted[index] = information[index] @ self.values - slopes.T @ rest
        return DriveNumbers(self.names, information, weighted, time)

    def columns(self, step: GroupChange, place: NDArray[np.intp]) -> Floats:
        """Derivative of the innovations in a change, (n, d); `place`: rank of each drive."""
        size = step.shape.over(np.arange(place.size, dtype=np.float64))[place]
        return np.asarray(size[self.run, None] * (self.shared @ step.group.directions))


def held_or_equivalent(robot: Robot) -> set[str]:
    """Names of a robot's effects, of their twins, and of what they extend."""
    held = {name for item in robot.effects for name in (item.name, *item.effect.twins)}
    return held | extended_by(robot.effects)


def evidence_of(runs: Concatenated, fit: Fitted) -> Evidence:
    """Innovations at a fit, and their derivatives in all parameters."""
    point, design, robot = fit.point, fit.design, fit.point.model.robot
    held = held_or_equivalent(robot)
    white, flat = design.flat()
    columns = {number.name: flat[:, n] for n, (number, run) in enumerate(design.columns) if run < 0}
    own = flat[:, [n for n, (_, run) in enumerate(design.columns) if run >= 0]]
    of_reference = [find(name) for name in (*MOUNT, DELAY) if name not in held]
    nulls = {}
    seen = []
    if of_reference:
        _, each = signatures(runs, point, (), [Candidate(effect, {}) for effect in of_reference])
        for signature in each:
            effect = signature.candidate.effect
            if not signature.flat.any():
                continue
            seen.append(effect)
            sizes = zip(effect.parameters.items(), signature.flat.T, strict=True)
            for (key, item), column in sizes:
                columns[f"{effect.name}.{key}"] = column / (STEP * item.scale)
                nulls[f"{effect.name}.{key}"] = item.null
    numbers = tuple(number for number in numbers_of(robot, seen) if number.name in columns)
    named = [number.name for number in numbers]
    names = (*named, *(name for name in columns if name not in named))
    size = np.sqrt(fit.scatter)
    return Evidence(
        numbers,
        names,
        np.array([value_at(robot, name, nulls) for name in names]),
        white / size,
        np.stack([columns[name] for name in names], axis=-1) / size,
        own / size,
        np.repeat(runs.run_of_leg, 3),
    )
