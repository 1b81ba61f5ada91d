# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How far the steps of coarse counters move what is fitted of the reference's clock.

Another delay puts the ends of all legs between other counts, and what is rounded off there is drawn
anew. So the likelihood has many minima, each sharper than the whole: between counts a wheel seems
to stand, and as one comes to leap. The curvature of one says nothing of how far the next one is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter
from werrimbi_odom.inference.fitting.whitened_innovations import Point, stacked
from werrimbi_odom.inference.legs.matched_run import MatchedRun, delayed
from werrimbi_odom.inference.linear import solved
from werrimbi_odom.model.pose import Floats

_OF_THE_CLOCK = ("reference_delay", "reference_clock_drift")


def variances_between_counts(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter], moves: Floats
) -> dict[str, float]:
    """Variances of the numbers of the reference's clock, by name; none where counts are fine.

    They are squares of how far it is to the values between the counts: one step of Gauss and Newton
    with the wheels going evenly from the middle of a step of their counter to that of the next.
    `numbers`: those of the columns of a design. `moves`: directions of its columns that were free.
    """
    late = [item.name for item in numbers if item.name.rpartition(".")[0] in _OF_THE_CLOCK]
    if not late or not runs.has_coarse_counters:
        return {}
    even = concatenated([_between_counts(run) for run in runs.runs])
    design = stacked(even, point, list(dict.fromkeys(numbers)))
    step = moves @ solved(design.flat()[1] @ moves, design.white.ravel())
    return {
        number.name: float(step[index]) ** 2
        for index, (number, run) in enumerate(design.columns)
        if number.name in late and run < 0
    }


def _between_counts(run: MatchedRun) -> MatchedRun:
    """The same legs, with counters that go evenly from count to count."""
    record = replace(run.record, counters=run.counters.between_counts())
    return delayed(replace(run, record=record, delay=np.nan), run.delay, run.clock_drift)
