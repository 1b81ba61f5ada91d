# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sentences about what is left beside everything that was found."""

from __future__ import annotations

from werrimbi_odom.inference.diagnosis.estimated_values import widest
from werrimbi_odom.inference.manoeuvres.advice import Told, beyond_chance
from werrimbi_odom.report.diagnosis.dependence import dependence_words
from werrimbi_odom.report.numbers import chance_words, listed


def law(told: Told) -> list[str]:
    """What is left once everything found is put in, or of a law that the robot file holds."""
    misfit = told.diagnosis.misfit
    if misfit is None:
        return []
    cell = f"{dependence_words(misfit.cell)} ({chance_words(misfit.cell.p_value)})"
    if misfit.only_in is not None:
        return [
            f"But: drive {misfit.only_in} alone shows something more: in it {cell}. The others "
            "hold as much driving that would show it, and do not. So no law of the robot is seen "
            "in it: "
            "something happened on that drive, its reference erred, or it was recorded otherwise"
            f"{_or_a_held_law(told)}."
        ]
    if misfit.effect is None:
        return [f"But: something is left. With everything found put in, {cell}."]
    share = "" if misfit.share is None else f", {100.0 * misfit.share:.2g} % of what it explains,"
    return [
        f"But: the law of {misfit.effect} does not fit fully. What it leaves{share} is in what it "
        f"looks at: {cell}. That is a matter of the law's form, and no other effect."
    ]


def scatter(told: Told) -> list[str]:
    """That values scatter from part to part of the drives, and their deviations with them."""
    diagnosis = told.diagnosis
    widened = widest(diagnosis)
    if widened <= 1.0:
        return []
    left = next(iter(beyond_chance(diagnosis.remaining)), None)
    most = f" What is left goes most with this: {dependence_words(left)}." if left else ""
    return [
        f"But: the parts of the drives do not agree on these values; each ± is as wide as they "
        f"scatter, up to {widened:.2g} times what the noise would make. So they are no more than "
        "the mean of something that is still missing: a law that the library lacks, a reference "
        f"that wanders, or a robot that was changed.{most}"
    ]


def _or_a_held_law(told: Told) -> str:
    """The laws that the model holds, which may be a bit other than nature's."""
    applied = told.diagnosis.robot.effects
    laws = [each.name for each in applied if not each.effect.is_mistake]
    return f", or the law of {listed(laws, 'or')} does not quite fit there" if laws else ""
