# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Fits repeated without abrupt events: for a diagnosis, and for effects that are added.

Events in a few legs have inflated the noise of a fit: it is estimated without them. And what a
model lacks has inflated the noise of its wheels, which may then stand for that of the reference:
between poses that follow closely both look alike.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np

from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.judged_legs import in_runs, paths
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.comparison.unlike_noise import noise_of_the_noisiest
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


def with_noise_of_reference(
    variances: Variances, point: Point, prepared: PreparedRuns
) -> Variances:
    """Variances in which a reference has no less noise than its small differences show.

    Those know no wheel noise. So wheels that stand for a missing law, and err by as much between
    two poses as the reference does, leave it its own noise; else each of its larger errors is a
    jump. Noise that is known, and that of a reference whose errors are correlated, stays.
    """
    options = point.options
    if options.reference_kind != "absolute":
        return variances
    residuals = paths(prepared, in_runs(prepared, point.model))
    shown = noise_of_the_noisiest(prepared.robot, residuals, options.reference_kind)
    least = [
        0.0 if known or sigma is None else sigma**2
        for sigma, known in zip(shown, options.sigmas_known, strict=True)
    ]
    return replace(
        variances, xy=np.maximum(variances.xy, least[0]), yaw=np.maximum(variances.yaw, least[1])
    )


Found = TypeVar("Found")


def refit_without_events(
    fit: Callable[[Sequence[Run], Sequence[Run], bool], tuple[Found, Events]],
    runs: Sequence[Run],
    holdout: Sequence[Run],
) -> tuple[Found, Events]:
    """Fit drives, and fit again without the events that are found beside the model.

    `fit`: from runs, held-out runs and whether it is the first time, to the result and the events
    beside it. `runs`, `holdout`: fitted and held-out drives. Result: the last result, and the
    events beside it. Where these turn out to be no accidents, none is left out: the first result.
    """
    first, happened = fit(runs, holdout, True)
    found = first
    for _ in range(rules.EVENT_ROUNDS):
        if not happened.left_out:
            break
        both = [[without(run, happened) for run in some] for some in (runs, holdout)]
        if both == [list(runs), list(holdout)]:
            break
        runs, holdout = both
        again, happened = fit(runs, holdout, False)
        found = first if happened.many or happened.systematic else again
    return found, happened


def events_beside(runs: Concatenated, fitted: Point, judge: Judge) -> Events:
    """Abrupt events beside a model, in the fitted and in the held-out drives."""
    most, home = noise_of_most(runs, fitted), judge.fitted_per_run(fitted.model)
    point, home = (
        replace(each, variances=with_noise_of_reference(most, each, prepared))
        for each, prepared in ((fitted, judge.train), (home, judge.holdout))
    )
    fitted_on, kept = ([run.path for run in some] for some in (judge.fitted_on, judge.kept_back))
    return events_among(
        [
            EventSide(runs.runs, fitted_on, point, held_out=False),
            EventSide(judge.fine.runs, kept, home, held_out=True),
        ],
        point.options.reference_kind,
    )
