# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which drives err far more than is usual: one rule for compare and diagnose."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.judged_legs import Legs


def typical_errors(legs: Legs, runs: int) -> Sequence[float]:
    """Median error of each drive's legs, of position [m], or of heading [rad] where that is all."""
    by_position = np.isfinite(legs.errors.distance).any()
    size = legs.errors.distance if by_position else np.abs(legs.errors.error[:, 2])
    medians = []
    for index in range(runs):
        own = size[(legs.run == index) & np.isfinite(size)]
        medians.append(float(np.median(own)) if own.size else float("nan"))
    return medians


def usual_error(errors: Sequence[float]) -> float:
    """Median over the drives; infinite where none is known, as headings alone have no position."""
    known = [error for error in errors if math.isfinite(error)]
    return float(np.median(known)) if known else math.inf


def far_beyond(errors: Sequence[float], usual_of: Sequence[float]) -> tuple[int, ...]:
    """Drives whose typical error is far beyond the usual one, that of `usual_of`."""
    usual = usual_error(usual_of)
    return tuple(index for index, error in enumerate(errors) if error > rules.GROSS * usual)
