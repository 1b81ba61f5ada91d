# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Runs whose references measure the same quantities: poses, positions or headings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.reference_jumps import (
    jumped_legs,
    jumps_of,
    pieces_between,
)
from werrimbi_odom.inference.comparison.reference_noise_source import OwnNoise, noise_of
from werrimbi_odom.inference.comparison.residuals import Measure, Residual, residuals_of
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.legs.cutting import every_pose
from werrimbi_odom.inference.legs.matched_run import AlignedRun
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True, eq=False)
class ReferenceGroup:
    """Runs whose references measure the same quantities."""

    index: tuple[int, ...]
    measure: Measure
    every: Concatenated
    whole: tuple[bool, ...]
    """Whether `every` has all rows of a run's reference."""
    jumps: tuple[Floats, ...]
    own: OwnNoise
    """Noise of the references."""
    plain: tuple[Residual, ...]
    """Paths by the robot whose travel cuts the legs."""

    @property
    def pieces(self) -> tuple[NDArray[np.intp], ...]:
        """Piece between jumps that each pose of each run is of (`pieces_between`)."""
        return tuple(map(pieces_between, self.jumps))

    def ways(self, robot: Robot, leg: float) -> list[Floats]:
        """Cumulative travel at each pose of each run, in legs."""
        records = (run.record for run in self.every.runs)
        return [
            np.interp(
                record.measured.time,
                record.counters.time,
                record.counters.way(robot, leg, rules.QUARTER_TURN),
            )
            for record in records
        ]


def group_of(
    robot: Robot,
    measure: Measure,
    members: list[tuple[int, AlignedRun, bool]],
    options: EvaluationOptions,
) -> ReferenceGroup:
    """Estimate the noise and find the jumps of runs whose references measure the same.

    `members`: index, record, and whether the record has all rows of the run's reference.
    """
    every = concatenated([every_pose(record) for _, record, _ in members])
    plain = Model(robot, tuple({} for _ in members))
    residuals, _ = residuals_of(plain, every, measure)
    own = noise_of(robot, every, residuals, measure, options)
    every = _with_shares(every, own.shares)
    jumps = tuple(
        jumps_of(residual, run.gap, robot)
        for residual, run in zip(residuals, every.runs, strict=True)
    )
    if measure == "position" and any(jump.any() for jump in jumps):
        pieces = tuple(map(pieces_between, jumps))
        residuals, _ = residuals_of(plain, every, measure, pieces)
    return ReferenceGroup(
        tuple(index for index, _, _ in members),
        measure,
        every,
        tuple(whole for _, _, whole in members),
        jumps,
        own,
        residuals,
    )


def _with_shares(every: Concatenated, shares: Sequence[tuple[float, float]]) -> Concatenated:
    """The runs, each with the share of the reference's noise that it has."""
    if all(run.record.noise_shares == of for run, of in zip(every.runs, shares, strict=True)):
        return every
    return concatenated(
        [
            replace(run, record=replace(run.record, noise_shares=of))
            for run, of in zip(every.runs, shares, strict=True)
        ]
    )


def jumped_in(group: ReferenceGroup, runs: Concatenated, kind: ReferenceKind) -> NDArray[np.bool_]:
    """Legs that a jump of the reference invalidates, shape (m,)."""

    def of_each() -> NDArray[np.bool_]:
        both = zip(group.jumps, runs.runs, strict=True)
        return np.concatenate([jumped_legs(jumps, run.rows, kind) for jumps, run in both])

    return runs.cache.known(("jumped", kind), of_each)
