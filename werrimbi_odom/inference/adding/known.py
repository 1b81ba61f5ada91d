# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How well the numbers of a model with more effects are known: its noise, and every deviation."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace

import numpy as np

from werrimbi_odom.inference.adding.start import Drives
from werrimbi_odom.inference.calibration_sizes import with_sizes_in_multipliers
from werrimbi_odom.inference.diagnosis.selection import Fitted, grain_of
from werrimbi_odom.inference.diagnosis.sizes import Sizes, spread_over_sizes
from werrimbi_odom.inference.fitting.costs import Costs
from werrimbi_odom.inference.fitting.knobs import CALIBRATION, START_YAW, Model, own_of, shared_of
from werrimbi_odom.inference.fitting.noise import NoiseEstimate, likeliest, noise_estimates
from werrimbi_odom.inference.fitting.precision import Precision
from werrimbi_odom.model.robot import Robot


def noises_of(drives: Drives, fit: Fitted) -> dict[str, NoiseEstimate]:
    """Noise of a model as its file has it (`as_written`)."""
    costs = Costs(drives.laid, fit.point, drives.kind)
    information = _precision(drives, fit).information
    return noise_estimates(costs, fit.point.variances, _held(drives), information)


def as_written(drives: Drives, fit: Fitted, given: Robot) -> Fitted:
    """The fit with its sizes as multipliers, and the noise that suits them.

    A size that a search put in as an effect turns the robot, and leaves the covariance to the
    file's: the wheels' noise with a base in millimetres is another one than with that base mended.
    """
    model = fit.point.model
    robot = with_sizes_in_multipliers(model.robot, given)
    if robot is model.robot:
        return fit
    point = replace(fit.point, model=Model(robot, model.own))
    variances = likeliest(Costs(drives.laid, point, drives.kind), point.variances, _held(drives))
    return replace(fit, point=replace(point, variances=variances))


def _held(drives: Drives) -> tuple[bool, bool]:
    return drives.sigma[0] is not None, drives.sigma[1] is not None


def with_spread(
    drives: Drives,
    fit: Fitted,
    given: Robot,
    wanted: Collection[str],
    sizes: Sizes,
    noises: Mapping[str, NoiseEstimate],
) -> Fitted:
    """The fit with covariances of what is told that count all that was chosen by the same drives.

    Which sizes differ from the file's (`spread_over_sizes`), and the noise (`Precision.widening`);
    and the edge of a threshold is no finer than its law (`grain_of`).
    """
    columns = [knob.name for knob, run in fit.design.columns]
    spread = spread_over_sizes(fit, given, wanted, sizes)
    told = [
        index
        for index, (_, run) in enumerate(fit.design.columns)
        if run < 0 and fit.moves[index].any()
    ]
    precision = _precision(drives, as_written(drives, fit, given))
    wide = np.ones(len(columns))
    wide[told] = precision.widening(noises, [columns[index] for index in told])
    covariance = fit.covariance.copy()
    spread = spread * np.outer(wide, wide) + np.diag(grain_of(fit.design, fit.point.model.robot))
    covariance[np.ix_(told, told)] = spread[np.ix_(told, told)]
    return replace(fit, covariance=covariance)


def _precision(drives: Drives, fit: Fitted) -> Precision:
    knobs = (*fit.knobs, *fit.point.model.nuisance_knobs)
    local = [
        knob
        for knob in (*CALIBRATION, *own_of(knobs), *shared_of(fit.knobs))
        if knob.name != START_YAW
    ]
    return Precision.of(drives.laid, fit.point, drives.kind, local, fit.moves)
