# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Per-run phases of effects, estimated from a measured heading during the drive.

The counter of an eccentric wheel starts anywhere. So the robot file knows the amplitude, but cannot
know the phase. The error of the turn is linear in amplitude * cos(phase) and amplitude * sin(phase)
(`Effect.to_fit`). Both are fitted by least squares, row by row:

    reference turn - predicted turn = sum of (cos, sin) * derivative of the turn in each
                                      + bias * time + share * turn + noise

Nuisance parameters are a bias of the reference's rate (of a gyro) and a share of the turn (a
wheelbase that is slightly wrong). The noise is estimated from the residuals.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.driven_motion import features
from werrimbi_odom.model.effect import AppliedEffect, wiring_of
from werrimbi_odom.model.effects_over_run import after_effects
from werrimbi_odom.model.encoder_online import Counts, EncoderLimits
from werrimbi_odom.model.encoder_recorded import wheel_steps
from werrimbi_odom.model.motion import Number, WheelTravel
from werrimbi_odom.model.pose import Floats, wrap
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import channel_spans

KNOWN_WELL_ENOUGH = 0.3
"""Standard deviation of a phase [rad] below which the effect removes most of its error."""

STRIDE = 0.5
"""Rotation of a wheel per row [rad]; finer rows hold more noise, but no more signal."""
LONGEST = 10.0
"""Longer intervals of the reference [s] are skipped."""
FEWEST = 12
"""Degrees of freedom from which the residuals determine the noise."""
ABSURD = 0.5
"""A larger error of the turn over one row [rad] is a jump of the reference."""
NUISANCE_BIAS, NUISANCE_SHARE = 0.1, 0.1
"""Standard deviations of the priors: a gyro's bias [rad/s], and a relative error of the base."""


class Phase(NamedTuple):
    """Estimate of an effect's phase."""

    effect: str
    parameter: str
    value: float
    """[rad]"""
    std: float
    """[rad]"""
    amplitude: float
    """Estimated amplitude, independent of the robot file's; in its own unit."""


def learnable(robot: Robot) -> tuple[AppliedEffect, ...]:
    """Effects of which only the phase of a quadrature is unknown."""
    return tuple(
        applied
        for applied in robot.effects
        if applied.effect.quadrature is not None
        and applied.effect.stage in ("wheels", "body")
        and applied.unknown == (applied.effect.quadrature[1],)
        and abs(applied.values[applied.effect.quadrature[0]]) > 0.0
    )


class Turning:
    """Turn of steps without the effects to be estimated, and its derivatives in their coordinates.

    `effects`: `learnable` effects of the robot.
    """

    def __init__(self, robot: Robot, effects: tuple[AppliedEffect, ...]) -> None:
        self._robot = robot
        self._with: list[tuple[Robot, float]] = []
        for applied in effects:
            assert applied.effect.quadrature is not None
            amplitude, phase = applied.effect.quadrature
            size = applied.effect.parameters[amplitude].typical
            for angle in (0.0, 0.5 * math.pi):
                known = applied.learnt(**{amplitude: size, phase: angle})
                others = tuple(known if e.name == known.name else e for e in robot.effects)
                self._with.append((replace(robot, effects=others), size))

    def of(self, raw: WheelTravel[Number], drive: Drive[Number]) -> list[Number]:
        """Turn [rad], then its derivatives in each effect's cos and sin [rad / unit]."""
        turn = after_effects(self._robot, raw, drive)[1].turn
        turns = [turn]
        for robot, amplitude in self._with:
            turns.append((after_effects(robot, raw, drive)[1].turn - turn) / amplitude)
        return turns


@dataclass
class _LeastSquares:
    """Sums over rows: recursive least squares in information form."""

    priors: Floats
    """Prior standard deviation of each unknown."""
    matrix: Floats = field(init=False)
    vector: Floats = field(init=False)
    squares: float = 0.0
    rows: int = 0

    def __post_init__(self) -> None:
        self.matrix = np.zeros((self.priors.size, self.priors.size))
        self.vector = np.zeros(self.priors.size)

    def add(self, row: Floats, error: float) -> None:
        self.matrix += np.outer(row, row)
        self.vector += row * error
        self.squares += error * error
        self.rows += 1

    def solved(self) -> tuple[Floats, Floats] | None:
        """Estimates and their covariance, noise from the residuals; None while rows are few."""
        spare = self.rows - self.priors.size
        if spare < FEWEST:
            return None
        variance = self.squares / self.rows
        if variance <= 0.0:
            return None
        for _ in range(3):  # the noise sets the weight of the priors, which matters little
            precision = self.matrix / variance + np.diag(self.priors**-2.0)
            scale = np.sqrt(np.diag(precision))
            covariance = np.linalg.inv(precision / np.outer(scale, scale))
            covariance = covariance / np.outer(scale, scale)
            found = covariance @ (self.vector / variance)
            left = self.squares - 2.0 * found @ self.vector + found @ self.matrix @ found
            variance = max(float(left), 1e-12 * self.squares) / spare
        return found, covariance


@dataclass
class Sample:
    """Heading of the reference at an instant, and all sums up to then."""

    chain: int
    """Only headings of one chain are comparable."""
    time: float
    yaw: float
    sums: Floats
    """Cumulative turn and derivatives, then the angles of both wheels."""


class HeadingRows:
    """Rows for the least squares, one for each `STRIDE` of a wheel's rotation."""

    def __init__(self, effects: tuple[AppliedEffect, ...]) -> None:
        self.effects = effects
        sizes = [e.values[e.effect.quadrature[0]] for e in effects if e.effect.quadrature]
        priors = [*(2.0 * abs(size) for size in sizes for _ in (0, 1))]
        self.least_squares = _LeastSquares(np.array([*priors, NUISANCE_BIAS, NUISANCE_SHARE]))
        self._anchor: Sample | None = None

    def take(self, sample: Sample) -> None:
        """Add the next sample in time."""
        anchor = self._anchor
        if anchor is None or sample.chain != anchor.chain or sample.time - anchor.time > LONGEST:
            self._anchor = sample
            return
        change = sample.sums - anchor.sums
        if sample.time <= anchor.time or np.abs(change[-2:]).max() < STRIDE:
            return
        self._anchor = sample
        error = wrap(sample.yaw - anchor.yaw - change[0])
        if abs(error) < ABSURD:
            row = np.array([*change[1:-2], sample.time - anchor.time, change[0]])
            self.least_squares.add(row, error)

    def phases(self) -> tuple[Phase, ...]:
        """Estimate of each phase so far; an unknown one has an infinite standard deviation."""
        solved = self.least_squares.solved()
        return tuple(_phase(applied, i, solved) for i, applied in enumerate(self.effects))


def _phase(applied: AppliedEffect, index: int, solved: tuple[Floats, Floats] | None) -> Phase:
    assert applied.effect.quadrature is not None
    amplitude, name = applied.effect.quadrature
    if solved is None:
        return Phase(applied.name, name, 0.0, math.inf, 0.0)
    part = slice(2 * index, 2 * index + 2)
    cos, sin = solved[0][part].tolist()
    seen = math.hypot(cos, sin)
    if seen == 0.0:  # its wheel stood still
        return Phase(applied.name, name, 0.0, math.inf, 0.0)
    # Error perpendicular to the estimated vector. An estimated amplitude below the known one
    # increases the standard deviation in proportion.
    across = np.array([-sin, cos]) / seen
    lever = min(seen, abs(applied.values[amplitude]))
    spread = math.sqrt(float(across @ solved[1][part, part] @ across))
    std = spread / lever if lever > 0.0 else math.inf
    return Phase(applied.name, name, math.atan2(sin, cos), std, seen)


def phases_of_run(
    robot: Robot,
    time: Floats,
    left: Counts,
    right: Counts,
    reference_time: Floats,
    reference_yaw: Floats,
    *,
    limits: EncoderLimits | None = None,
    channels: Mapping[str, Floats] | None = None,
) -> tuple[Phase, ...]:
    """Estimate the phases of a recorded run.

    `time`, `left`, `right`: as for `trajectory`. `reference_time`, `reference_yaw` (m,): measured
    heading [rad], NaN where it was not measured.
    """
    effects = learnable(robot)
    left, right = wiring_of(robot.effects).wheels(left, right)
    steps = wheel_steps(robot, time, left, right, limits)
    rows = HeadingRows(effects)
    if steps.first_row < 0 or steps.time.size == 0:
        return rows.phases()
    taken = np.concatenate([[steps.first_row], steps.row])
    raw = WheelTravel(steps.left, steps.right)
    first = float(left[steps.first_row]), float(right[steps.first_row])
    spans = channel_spans(steps, channels or {})
    drive = features(robot, steps.duration, raw, first, spans)
    parts = [*Turning(robot, effects).of(raw, drive), drive.left_angle.change]
    sums = [np.concatenate([[0.0], np.cumsum(p)]) for p in (*parts, drive.right_angle.change)]
    stamps = time[taken]
    if not (np.diff(stamps) > 0.0).all():  # clock set back: stamps do not give the order
        return rows.phases()
    known = np.isfinite(reference_yaw)
    known &= (reference_time >= stamps[0]) & (reference_time <= stamps[-1])
    at = reference_time[known]
    there = np.stack([np.interp(at, stamps, part) for part in sums], axis=-1)
    for when, yaw, row in zip(at.tolist(), reference_yaw[known].tolist(), there, strict=True):
        rows.take(Sample(0, when, yaw, row))
    return rows.phases()
