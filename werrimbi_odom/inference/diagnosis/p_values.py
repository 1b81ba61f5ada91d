# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""P-values of findings: by the noise, and by the disagreement between parts of the drives."""

from __future__ import annotations

import math

import numpy as np

from werrimbi_odom.inference.calibration_parametrisation import sizes_of
from werrimbi_odom.inference.diagnosis.evidence import p_value_of_score
from werrimbi_odom.inference.diagnosis.homogeneity import homogeneity_of_effect
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.distributions import bonferroni, fisher_survival
from werrimbi_odom.inference.fitting.clusters import few_parts, parts_of_innovations
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.inference.fitting.score_tests import Score
from werrimbi_odom.model.robot import Robot


def chance(fit: Fitted, before: Fitted, tried: int) -> float:
    """P-value of the cost reduction from `before` to `fit`, corrected for all candidates tried.

    A likelihood-ratio test; where few data determine the noise, by Fisher's F.
    """
    gain = before.cost + before.needless_gain - fit.cost - fit.needless_gain
    gain /= fit.scatter * fit.neighbours
    numbers = max(fit.paid - before.paid, 1)
    return bonferroni(max(tried, 1), fisher_survival(gain / numbers, numbers, fit.spare))


def chance_of_score(score: Score, before: Fitted, tried: int) -> float:
    """P-value of the score of an effect that was not fitted, corrected for all candidates tried."""
    p_value = p_value_of_score(score.gain, score.degrees, before.squares, before.spare)
    return bonferroni(max(tried, 1), p_value)


def p_value_by_parts(runs: Concatenated, fit: Fitted, name: str, tried: int) -> float:
    """P-value of an effect in the model, by the disagreement between the parts (homogeneity test).

    It is corrected for the number of candidates where the parts disagree beyond chance, and where
    they are too few to show it. Elsewhere the likelihood-ratio test, which has that correction, is
    valid by itself.
    """
    parts = parts_of_innovations(runs, fit.design.white.ravel())
    few = parts is not None and few_parts(runs, parts)
    tests = max(tried, 1) if few or disagreeing(fit, name) else 1
    return bonferroni(tests, homogeneity_of_effect(runs, fit, name))


def disagreeing(fit: Fitted, name: str) -> bool:
    """Whether the parts of the drives disagree beyond chance on an effect in the model."""
    mine = [number.name.rpartition(".")[0] == name for number, _ in fit.design.columns]
    return bool(np.any(fit.widening[mine] > 1.0))


def p_value_of_size(fit: Fitted, name: str, given: Robot, start: Robot) -> float:
    """P-value of a calibration effect: of its importance, and of its difference from the file.

    By Fisher's F. Where the parts disagree, with the degrees of freedom in which they tell their
    scatter, as few parts estimate it poorly; else with those of the noise, as `chance`. The
    importance is beside the sizes from which the fit started. Where a search of the set-up found
    these (a factor of 4.05), they are as rough as that search, and what differs from them need not
    differ from the file.
    """
    freedom = fit.freedom[name] if fit.doubts[name] > 1.0 else fit.spare
    p_value = fisher_survival(fit.importance.get(name, 0.0), 1, freedom)
    if all(getattr(start, size) == getattr(given, size) for size in MULTIPLIERS):
        return p_value
    away = deviations_from(given, fit, name)
    return max(p_value, fisher_survival(away**2, 1, freedom))


def deviations_from(given: Robot, fit: Fitted, name: str) -> float:
    """By how many standard deviations a size differs from that of the file."""
    size = sizes_of(fit.point.model.robot).over(sizes_of(given)).as_effects[name]
    return abs(math.log(size)) / max(fit.std_of_size(name), 1e-12)
