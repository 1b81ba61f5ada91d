# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that the robot file holds: their rivals, and values that the drives contradict.

A user who was told several rivals adds one of them, and then nothing is missing. That does not
prove it: the same drives still cannot tell it from the others, and the report must keep saying so.

Every fit frees the effects that the file holds, so a wrong value of one is no missing effect, and
no search looks for it. The errors of the robot as given are as wrong for it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import base_name
from werrimbi_odom.inference.diagnosis.forward_selection import best_of_each
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted, fitted, refined
from werrimbi_odom.inference.distributions import bonferroni, chi2_survival
from werrimbi_odom.inference.fitting.candidate_starts import started_with
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.score_tests import candidates, parameters_with, scores
from werrimbi_odom.model.effect import AppliedEffect, Effect, extended_by
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def rivals_of_held(
    runs: Concatenated, fit: Fitted, effects: Sequence[Effect], given: Robot
) -> dict[str, tuple[str, ...]]:
    """Effects that explain the drives as well as an effect that the file holds, by its name."""
    found = {}
    extended = extended_by(fit.point.model.robot.effects)
    for applied in fit.point.model.robot.effects:
        if applied.effect.is_mistake or applied.name in CALIBRATED or base_name(applied.effect):
            continue  # sizes are in every fit
        if applied.name in extended:
            continue  # the other holds all of it
        rivals = _rivals(runs, fit, effects, given, applied.effect)
        if rivals:
            found[applied.name] = rivals
    return found


def needless_of_held(
    runs: Concatenated, fit: Fitted, names: Iterable[str], given: Robot
) -> tuple[str, ...]:
    """Those of the effects that the file holds without which the drives are explained as well."""
    found = []
    for name in names:
        bare, free = fit.without(name)
        without = refined(runs, fitted(runs, bare, (), free, given), given)
        if without.total < fit.total + rules.RIVAL * fit.scatter:
            found.append(name)
    return tuple(found)


def _rivals(
    runs: Concatenated, fit: Fitted, effects: Sequence[Effect], given: Robot, held: Effect
) -> tuple[str, ...]:
    """Score all effects without the held one; fit the best few in its place."""
    point, numbers = fit.without(held.name)
    others = point.model.robot.effects
    # What extends the held effect holds it.
    own = {effect.name for effect in effects if held.name in (effect.name, effect.extends)}
    library = [held, *(effect for effect in effects if effect.name not in own)]
    tried = candidates(library, {item.name for item in others}, runs.channels, len(runs.runs))
    ordered = best_of_each(scores(runs, point, (*CALIBRATION, *numbers), tried))
    gains = {score.candidate.name: score.gain for score in ordered}
    least = rules.WORTH_A_FIT * gains.get(held.name, max(gains.values(), default=0.0))
    near = [each for each in ordered if each.candidate.name != held.name and each.gain > least]
    found = {}
    for score in near[: rules.INSTEAD_FITTED]:
        start = started_with(runs, point, score)
        free = parameters_with(numbers, score.candidate)
        other = refined(runs, fitted(runs, start, (score.candidate.name,), free, given), given)
        if (
            other.determined
            and not other.at_bound
            and other.total < fit.total + rules.RIVAL * fit.scatter
        ):
            found[score.candidate.name] = other.total
    return tuple(sorted(found, key=lambda name: found[name]))


def outdated(fit: Fitted, given: Robot) -> tuple[str, ...]:
    """Names of the effects of the given robot whose values are not those of its drives.

    As certain as a missing effect, and worth as much as a size that is reported. Legs of a better
    model are shorter, so that a fit beside it knows more than the one that was written: where the
    held-out error does not fall, such a value is not told (`Sides.fell_much`).
    """
    held = [item for item in given.effects if not base_name(item.effect)]
    found = []
    for item in held:
        columns, away = _away(item, fit)
        if not columns:
            continue
        spread = fit.covariance[np.ix_(columns, columns)]
        gain = float(away @ np.linalg.pinv(spread, hermitian=True) @ away)
        sure = bonferroni(len(held), chi2_survival(gain, len(columns))) < rules.SURE
        if sure and gain > rules.CALIBRATION_WORTH * fit.penalty_of_one * len(columns):
            found.append(item.name)
    return tuple(found)


def _away(item: AppliedEffect, fit: Fitted) -> tuple[list[int], Floats]:
    """Columns of the effect's determined values common to all drives, and their differences."""
    columns, away = [], []
    for index, (number, run) in enumerate(fit.design.columns):
        name, _, parameter = number.name.rpartition(".")
        if name != item.name or run >= 0 or number.name in fit.held:
            continue
        columns.append(index)
        away.append(fit.point.model.value(number, 0) - float(item.values[parameter]))
    return columns, np.array(away)
