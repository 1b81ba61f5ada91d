# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robust noise estimate: events in a few legs have inflated the noise of a fit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.inference.distributions import chi2_median
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.noise import map_variances
from werrimbi_odom.inference.fitting.whitened_innovations import Costs, Point, unexpected
from werrimbi_odom.inference.rules import NOISE_NUMBERS, NOISE_TRIMMED

_ROUNDS = 4


def noise_of_most(runs: Concatenated, point: Point) -> Variances:
    """Variances fitted again without outlying legs; the model stays."""
    held = point.options.sigmas_known
    bounds = list(zip(runs.legs[:-1].tolist(), runs.legs[1:].tolist(), strict=True))
    for _ in range(_ROUNDS):
        found = unexpected(runs, point)
        deviation = np.sum(found.whitened() ** 2, axis=-1)
        numbers = found.known.sum(axis=-1).astype(np.float64)
        counted = (numbers > 0) & (deviation > 0.0)
        if counted.sum() < NOISE_NUMBERS:
            break
        usual = np.median(deviation[counted] / chi2_median(numbers[counted]))
        far = deviation > NOISE_TRIMMED * usual
        if not (far & ~point.skip).any():
            break
        out = far | point.skip
        point = replace(point, excluded=tuple(out[first:last] for first, last in bounds))
        point = replace(point, variances=map_variances(Costs(runs, point), point.variances, held))
    return point.variances
