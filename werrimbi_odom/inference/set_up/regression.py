# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Both wheels, base, mounting angle and lever arm in closed form, for any size and sign.

After Censi, Franchi, Marchionni, Oriolo, "Simultaneous calibration of odometry and sensor
parameters for mobile robots", IEEE T-RO 2013. The turn of a cut is linear in the travel of both
wheels. Given that, its displacement is linear in the base, rotated by the mounting angle, and in
the lever arm.

    turn = right * R - left * L
    move = (B / 2) exp(-i yaw) S + exp(-i yaw) p (exp(i turn) - 1),
    S = sum over steps of (left L + right R) exp(i heading)
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.set_up.records import Complexes, Cuts
from werrimbi_odom.model.motion import sinc
from werrimbi_odom.model.pose import Floats, wrap_all

_LARGE = 4.685
"""Tukey's biweight constant: 95 % efficiency for normal errors."""


@dataclass(frozen=True, slots=True)
class HeadingRegression:
    """Regression of the measured turn on the wheels."""

    left: float
    """Turn per travel of the file's left wheel [rad/m], positive if it turns the robot right."""
    right: float
    """Turn per travel of the file's right wheel [rad/m], positive if it turns the robot left."""
    left_std: float
    right_std: float
    scatter: float
    """Robust residual dispersion of a cut [rad]."""


@dataclass(frozen=True, slots=True)
class Moving:
    """Regression of the measured displacement on the wheels."""

    half_base: complex
    """(B / 2) exp(-i yaw) [m]."""
    arm: complex
    """exp(-i yaw) (ahead + i left) [m]; 0 where none is fitted beside the base."""
    half_base_std: float
    scatter: float
    """Robust residual dispersion of a cut [m]."""


def turning(
    cuts: Cuts, *, with_bias: bool = False, squares: bool = False
) -> HeadingRegression | None:
    """Regress measured turns on the travel of both wheels; None where not determined.

    `cuts`: cuts of all runs. `with_bias`: also fit a constant rate, such as a gyro's bias.
    `squares`: use plain least squares. If a robot drives straight nearly all the time, its few
    turns look like outliers, yet only they tell the wheels apart.
    """
    columns = [cuts.summed(cuts.right), -cuts.summed(cuts.left)]
    if with_bias:
        columns.append(cuts.duration)
    fit = (least_squares if squares else robust)(np.stack(columns, axis=-1), cuts.turn)
    if fit is None:
        return None
    value, std, scatter = fit
    return HeadingRegression(
        float(value[1].real), float(value[0].real), float(std[1]), float(std[0]), scatter
    )


def moving(cuts: Cuts, left: float, right: float) -> Moving | None:
    """Regress measured displacements on the wheels' motion, given their turn per travel."""
    gone, turn = swept(cuts, left, right)
    swing = np.exp(1j * turn) - 1.0
    both = robust(np.stack([gone, swing], axis=-1), cuts.move)
    alone = robust(gone[:, None], cuts.move)
    if alone is None:
        return None
    if both is not None:
        value, std, scatter = both
        base_sure, arm_sure = np.abs(value) > rules.SURE_SIZE * std
        # On circles only, base and lever arm are confounded. Without the arm, the circle on which a
        # marker goes round a robot that spins is a base several times too large.
        if std[0] < rules.ARM_TOLD * abs(value[0]) or arm_sure or not base_sure:
            return Moving(complex(value[0]), complex(value[1]), float(std[0]), scatter)
    value, std, scatter = alone
    return Moving(complex(value[0]), 0j, float(std[0]), scatter)


def path_swept(cuts: Cuts, left: float, right: float) -> tuple[Complexes, Floats]:
    """Path in units of half the base, and heading, at each node, for the given turn per travel."""
    along, turn = left * cuts.left + right * cuts.right, right * cuts.right - left * cuts.left
    heading = np.concatenate([[0.0], np.cumsum(turn)])
    chord = along * sinc(0.5 * turn) * np.exp(1j * (heading[:-1] + 0.5 * turn))
    return np.concatenate([[0j], np.cumsum(chord)]), heading


def swept(cuts: Cuts, left: float, right: float) -> tuple[Complexes, Floats]:
    """S of the module's formula for each cut, and its turn, for the given turn per travel."""
    path, heading = path_swept(cuts, left, right)
    gone = (path[cuts.end] - path[cuts.begin]) * np.exp(-1j * heading[cuts.begin])
    return gone, heading[cuts.end] - heading[cuts.begin]


def errors(cuts: Cuts, left: float, right: float, half_base: complex, arm: complex) -> Complexes:
    """Measured less predicted displacement and turn, shape (2, k); the turn is real."""
    gone, turn = swept(cuts, left, right)
    move = cuts.move - half_base * gone - arm * (np.exp(1j * turn) - 1.0)
    return np.stack([move, wrap_all(cuts.turn - turn).astype(complex)])


def least_squares(columns: Floats, values: Floats) -> tuple[Floats, Floats, float] | None:
    """Ordinary least squares; returns the same as `robust`."""
    known = np.isfinite(values) & np.isfinite(columns).all(axis=-1)
    rows, aims = columns[known], values[known]
    count, width = rows.shape
    if count <= width + 1 or np.linalg.matrix_rank(rows) < width:
        return None
    value: Floats = np.linalg.lstsq(rows, aims, rcond=None)[0].astype(np.float64)
    scatter = float(np.sqrt(np.sum((aims - rows @ value) ** 2) / (count - width)))
    std = scatter * np.sqrt(np.diag(np.linalg.inv(rows.T @ rows)))
    return value, std, scatter


def robust(
    columns: Complexes | Floats, values: Complexes | Floats
) -> tuple[Complexes | Floats, Floats, float] | None:
    """Linear regression by least absolute deviations, then Tukey's biweight.

    None where the columns are rank deficient.
    """
    known = np.isfinite(values) & np.isfinite(columns).all(axis=-1)
    rows, aims = columns[known], values[known]
    count, width = rows.shape
    size = np.sqrt(np.mean(np.abs(rows) ** 2, axis=0)) if count else np.zeros(width)
    if count <= width + 1 or not (size > 0.0).all():
        return None
    rows = rows / size
    weight = np.ones(count)
    floor = 1e-9 * float(np.max(np.abs(aims), initial=0.0)) + 1e-300
    for turn in range(40):
        normal = (rows.conj().T * weight) @ rows
        if np.linalg.cond(normal) > 1e12:
            return None
        value = np.linalg.solve(normal, (rows.conj().T * weight) @ aims)
        off = np.abs(aims - rows @ value)
        scatter = MEDIAN_TO_SIGMA * float(np.median(off)) + floor
        before = weight
        if turn < 15:
            weight = 1.0 / np.maximum(off, 0.05 * scatter + floor)
            weight = weight / weight.max()
        else:
            weight = np.clip(1.0 - (off / (_LARGE * scatter)) ** 2, 0.0, None) ** 2
            if turn > 16 and np.abs(weight - before).max() < 1e-4:
                break
    if np.linalg.matrix_rank((rows.conj().T * weight) @ rows) < width:
        return None
    spread = np.linalg.inv((rows.conj().T * weight) @ rows).diagonal().real
    return np.asarray(value / size), np.asarray(np.sqrt(spread) * scatter / size), scatter
