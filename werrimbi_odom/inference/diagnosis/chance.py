# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How often chance would make what is found: by the noise, and by how parts of drives disagree."""

from __future__ import annotations

import math

import numpy as np

from werrimbi_odom.inference.chances import fisher_above, in_any_of
from werrimbi_odom.inference.diagnosis.homogeneity import lasting_effect
from werrimbi_odom.inference.diagnosis.selection import Fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.rules import LASTING_PARTS


def chance(fit: Fitted, before: Fitted, tried: int) -> float:
    """How often chance would lower the cost as much, all that was tried counted.

    By a likelihood ratio; where the noise is what few data scatter by themselves, by Fisher's F.
    """
    gain = (before.cost + before.needless - fit.cost - fit.needless) / fit.scatter
    numbers = max(round((fit.price - before.price) / fit.price_of_one), 1)
    return in_any_of(max(tried, 1), fisher_above(gain / numbers, numbers, fit.spare))


def chance_by_parts(runs: Concatenated, fit: Fitted, name: str, tried: int) -> float:
    """How often chance would make an effect of a model, by the disagreement of the parts.

    All that was tried counts where parts disagree beyond chance: the likelihood ratio, which counts
    it, means nothing there.
    """
    mine = [number.name.rpartition(".")[0] == name for number, _ in fit.design.columns]
    apart = bool(np.any(fit.widening[mine] > 1.0))
    return in_any_of(max(tried, 1) if apart else 1, lasting_effect(runs, fit, name))


def chance_of_size(fit: Fitted, name: str) -> float:
    """How often chance would make a calibration effect as important; by the parts where they part.

    As many parts tell their scatter no better than they are many (Fisher's F).
    """
    parts = LASTING_PARTS - 1 if fit.doubts[name] > 1.0 else math.inf
    return fisher_above(fit.importance.get(name, 0.0), 1, parts)
