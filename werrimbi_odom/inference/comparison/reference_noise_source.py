# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Noise of the references: as given, else as stated in the records, else estimated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.local_map_errors import wandering_of
from werrimbi_odom.inference.comparison.reference_noise import reference_noise, stamp_noise
from werrimbi_odom.inference.comparison.residuals import Measure, Residual
from werrimbi_odom.inference.comparison.unlike_noise import noise_of_each
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class ReferenceNoise:
    """Standard deviations of the reference, and how they are known."""

    sigma_xy: float
    """[m]"""
    sigma_yaw: float
    """[rad]"""
    xy_told: str
    """Origin: given (an option), stated (in the record), estimated, or assumed (too few poses)."""
    yaw_told: str
    sigma_stamp: float = 0.0
    """Noise of the stamps of a gyro, or of scans [s]."""
    walk_xy: float = 0.0
    """Random walk of the error on a local map [m/s^0.5]."""
    walk_yaw: float = 0.0
    """Random walk of its heading error [rad/s^0.5]."""
    reversion: float = 0.0
    """Rate at which that error reverts to zero [1/s]."""
    of_runs: tuple[tuple[float, float], tuple[float, float]] | None = None
    """Noise of positions [m] and of headings [rad], the least and the most of a run, where runs
    are not alike."""

    @property
    def wander(self) -> tuple[float, float]:
        """Stationary standard deviation of that error [m, rad]."""
        share = np.sqrt(2.0 * self.reversion) if self.reversion > 0.0 else 1.0
        return self.walk_xy / share, self.walk_yaw / share


@dataclass(frozen=True, slots=True, eq=False)
class OwnNoise:
    """Noise of the references, in summary and for each run."""

    noise: ReferenceNoise
    sigma_xy: Floats
    """For each run [m]."""
    sigma_yaw: Floats
    """For each run [rad]."""
    wandering: Variances | None
    """Noise of a reference on a local map."""
    freedom: tuple[float, float]
    """Degrees of freedom of the variances of positions and of headings: infinite where they are
    given or stated, none where they are assumed."""

    @property
    def shares(self) -> list[tuple[float, float]]:
        """Noise of each run's positions and headings, in shares of the noisiest run's."""
        both = (each / each.max() for each in (self.sigma_xy, self.sigma_yaw))
        place, heading = (each.tolist() for each in both)
        return list(zip(place, heading, strict=True))


def noise_of(
    robot: Robot,
    every: Concatenated,
    residuals: Sequence[Residual],
    measure: Measure,
    options: EvaluationOptions,
) -> OwnNoise:
    """Noise of references that measure the same quantities.

    `every`: runs with a leg from each reference pose to the next. `residuals`: measured and
    predicted paths of these. `measure`: what the references measure. `options`: what is known of
    the reference.
    """
    estimated: tuple[float | None, float | None]
    stated = [[getattr(run, name) for run in every.runs] for name in ("sigma_xy", "sigma_yaw")]
    usual = rules.TAPE_XY, rules.TAPE_YAW
    wandering, walk = None, (0.0, 0.0, 0.0)
    if options.reference_kind == "local_map":
        found = wandering_of([run.record for run in every.runs], robot, options)
        wandering, usual = found.variances, rules.TYPICAL_MATCH
        sigma = {name: float(np.sqrt(part[0])) for name, part in asdict(wandering).items()}
        estimated = (sigma["xy"], sigma["yaw"]) if found.estimated else (None, None)
        walk = sigma["walk_xy"], sigma["walk_yaw"], sigma["reversion"]
        # A localiser states its absolute error, most of which is the random walk.
        stated = [[None] * len(every.runs)] * 2
    else:
        estimated = reference_noise(robot, residuals, options.reference_kind)
    each = noise_of_each(robot, residuals, options.reference_kind, estimated)
    sources = zip(
        (options.sigma_xy, options.sigma_yaw), stated, estimated, each, usual, strict=True
    )
    (position, of_position, told), (heading, of_heading, yaw_told) = (_known(*of) for of in sources)
    stamp = stamp_noise(robot, every, residuals)
    ends = [(float(each.min()), float(each.max())) for each in (of_position, of_heading)]
    unlike = (ends[0], ends[1]) if any(least < most for least, most in ends) else None
    noise = ReferenceNoise(position, heading, told, yaw_told, stamp, *walk, unlike)
    counts = map(sum, zip(*(item.coordinates for item in residuals), strict=True))
    freedom = tuple(
        {"estimated": rules.FREEDOM_OF_A_DIFFERENCE * count, "assumed": 0.0}.get(how, math.inf)
        for how, count in zip((told, yaw_told), counts, strict=True)
    )
    return OwnNoise(noise, of_position, of_heading, wandering, (freedom[0], freedom[1]))


def _known(
    given: float | None,
    stated: list[float | None],
    estimated: float | None,
    unlike: Floats | None,
    usual: float,
) -> tuple[float, Floats, str]:
    """Summary sigma, sigma of each run, and their origin."""
    count = len(stated)
    if given is not None:
        return given, np.full(count, given), "given"
    fallback, told = (usual, "assumed") if estimated is None else (estimated, "estimated")
    others = [fallback] * count if unlike is None else unlike.tolist()
    pairs = zip(stated, others, strict=True)
    values = np.array([other if value is None else value for value, other in pairs])
    if all(value is not None for value in stated):
        told = "stated"
    return float(np.sqrt(np.mean(values**2))), values, told
