# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Fits repeated without abrupt events: for a diagnosis, and for effects that are added.

Events in a few legs have inflated the noise of a fit: it is estimated without them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.holdout import Judge
from werrimbi_odom.inference.distributions import chi2_median
from werrimbi_odom.inference.events.events import Events, EventSide, events_among, without
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.noise import map_variances
from werrimbi_odom.inference.fitting.whitened_innovations import Costs, Point, unexpected

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
        if counted.sum() < rules.NOISE_NUMBERS:
            break
        usual = np.median(deviation[counted] / chi2_median(numbers[counted]))
        far = deviation > rules.NOISE_TRIMMED * usual
        if not (far & ~point.skip).any():
            break
        out = far | point.skip
        point = replace(point, excluded=tuple(out[first:last] for first, last in bounds))
        point = replace(point, variances=map_variances(Costs(runs, point), point.variances, held))
    return point.variances


Found = TypeVar("Found")


def refit_without_events(
    fit: Callable[[Sequence[Run], Sequence[Run], bool], tuple[Found, Events]],
    runs: Sequence[Run],
    holdout: Sequence[Run],
) -> tuple[Found, Events]:
    """Fit drives, and fit again without the events that are found beside the model.

    `fit`: from runs, held-out runs and whether it is the first time, to the result and the events
    beside it. `runs`, `holdout`: fitted and held-out drives. Result: the last result, and the
    events beside it.
    """
    found, happened = fit(runs, holdout, True)
    for _ in range(rules.EVENT_ROUNDS):
        if not happened.left_out:
            break
        both = [[without(run, happened) for run in some] for some in (runs, holdout)]
        if both == [list(runs), list(holdout)]:
            break
        runs, holdout = both
        again, happened = fit(runs, holdout, False)
        if not happened.many and not happened.systematic:
            found = again
    return found, happened


def events_beside(runs: Concatenated, fitted: Point, judge: Judge) -> Events:
    """Abrupt events beside a model, in the fitted and in the held-out drives."""
    noise = noise_of_most(runs, fitted)
    point = replace(fitted, variances=noise)
    home = replace(judge.fitted_per_run(point.model), variances=noise)
    fitted_on, kept = ([run.path for run in some] for some in (judge.fitted_on, judge.kept_back))
    return events_among(
        [
            EventSide(runs.runs, fitted_on, point, held_out=False),
            EventSide(judge.fine.runs, kept, home, held_out=True),
        ],
        point.options.reference_kind,
    )
