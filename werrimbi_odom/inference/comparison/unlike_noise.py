# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives whose references have unlike noise: satellites with and without corrections, two trackers.

One noise for all makes errors out of what the worse drives scatter, and hides those of the better.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.reference_noise import reference_noise
from werrimbi_odom.inference.comparison.residuals import Residual
from werrimbi_odom.inference.distributions import fisher_survival
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def noise_of_each(
    robot: Robot,
    residuals: Sequence[Residual],
    kind: ReferenceKind,
    estimated: tuple[float | None, float | None],
) -> tuple[Floats | None, Floats | None]:
    """Noise of each run's positions [m] and headings [rad], shape (runs,), where they are unlike.

    None where one noise is right for all: where no two runs differ by `UNLIKE_NOISE` beyond chance
    (Fisher's F, with a Bonferroni correction for the pairs). Runs of too few poses have that of all
    (`estimated`).
    """
    if kind != "absolute" or len(residuals) < 2 or estimated == (None, None):
        return None, None
    each = [reference_noise(robot, [item], kind) for item in residuals]
    counts = [item.coordinates for item in residuals]
    sigmas, numbers = (np.array(table, dtype=np.float64) for table in (each, counts))
    return (
        _if_unlike(sigmas[:, 0], numbers[:, 0], estimated[0], rules.MOTION_CAPTURE_XY),
        _if_unlike(sigmas[:, 1], numbers[:, 1], estimated[1], rules.MOTION_CAPTURE_YAW),
    )


def noise_of_the_noisiest(
    robot: Robot, residuals: Sequence[Residual], kind: ReferenceKind
) -> tuple[float | None, float | None]:
    """`reference_noise` of all runs, or of the run that has most where they are unlike."""
    of_all = reference_noise(robot, residuals, kind)
    each = noise_of_each(robot, residuals, kind, of_all)
    place, heading = (
        usual if unlike is None else float(unlike.max())
        for usual, unlike in zip(of_all, each, strict=True)
    )
    return place, heading


def _if_unlike(sigma: Floats, count: Floats, of_all: float | None, floor: float) -> Floats | None:
    known = np.flatnonzero(np.isfinite(sigma))
    if of_all is None or known.size < 2:
        return None
    most, least = known[np.argmax(sigma[known])], known[np.argmin(sigma[known])]
    ratio = max(sigma[most], floor) / max(sigma[least], floor)
    freedom = rules.FREEDOM_OF_A_DIFFERENCE * count
    chance = fisher_survival(ratio**2, freedom[most], freedom[least])
    chance *= known.size * (known.size - 1)
    if ratio < rules.UNLIKE_NOISE or chance > rules.SURE:
        return None
    return np.where(np.isfinite(sigma), sigma, of_all)
