# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verdict *ambiguous* in words: the rivals, what is found beside them, and what to drive."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import mistakes
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.for_unexplained_errors import ProposedManoeuvre
from werrimbi_odom.model.effect import always_twins
from werrimbi_odom.report.diagnosis import costs, phrases, reference_remarks, remarks
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.number_format import listed


def ambiguous_words(advised: AdvisedDiagnosis, steps: NextSteps) -> list[str]:
    """What cannot be told apart, how to tell it apart, and everything that was found beside it."""
    diagnosis = advised.diagnosis
    rivals = diagnosis.rivals
    first = diagnosis.effect_named(rivals[0])
    lines = phrases.set_up_lines(diagnosis)
    which = listed(rivals, "or")
    lines.append(
        f"These drives cannot tell which it is, {which}."
        if rivals[0] in mistakes(diagnosis)
        else f"Something is missing, but these drives cannot tell which: {which}."
    )
    if diagnosis.torn:
        lines.append(
            f"All drives together speak for {rivals[0]}; halves of them, taken by themselves, for "
            f"{listed(diagnosis.torn, 'or')}. A verdict that half of the data would change is none."
        )
    others = [diagnosis.effect_named(name) for name in rivals[1:]]
    twins = [each.name for each in others if each and first and always_twins(first, each)]
    if twins:
        lines.append(
            f"To the reference {listed([rivals[0], *twins])} are one and the same, on any drive."
        )
    for name in rivals:
        effect = diagnosis.effect_named(name)
        if effect is not None:
            size = phrases.sizes(diagnosis, name, believed=True)
            lines.append(f"- {name}: {effect.summary}{f' Fitted: {size}.' if size else ''}")
    lines += reference_remarks.or_upside_down(diagnosis)
    lines += reference_remarks.or_the_reference_s_scale(diagnosis)
    lines += reference_remarks.moved_by_its_odometry(diagnosis)
    lines += reference_remarks.transform_to_mend(diagnosis)
    lines += costs.cost(advised, rivals[0])
    if (move := advised.manoeuvre) is not None:
        lines.append(f"Why: {move.why}.")
        lines.append(" ".join((f"Next: {move.do} ({move.name}).", *how_long(move, steps.diagnose))))
    else:
        lines += reference_remarks.by_ruler(diagnosis)
    rest = [other for other in diagnosis.found if other not in rivals]
    command = steps.add([_to_try(diagnosis, [rivals[0], *twins]), *rest])
    lines += ["Or, if you know which it is, add it, for example:", f"    {command}"]
    for name in rivals[:3]:
        lines += phrases.ruler(diagnosis, diagnosis.effect_named(name), f"Check {name}")
    for other in diagnosis.found[1:]:
        if other not in rivals and other not in mistakes(diagnosis):
            lines += phrases.also(advised, other)
    if sizes := costs.sizes_found(diagnosis):
        lines.append(f"On the robot, if it is {rivals[0]}: {sizes}.")
    return [*lines, *costs.whole(advised), *remarks.remainder(advised)]


def _to_try(diagnosis: Diagnosis, twins: Sequence[str]) -> str:
    """The one of twins that leaves what the node publishes as it is; the first if none does."""
    effects = map(diagnosis.effect_named, twins)
    kept = [each.name for each in effects if each is not None and each.stage == "reference"]
    return next(iter(kept), twins[0])


def how_long(move: ProposedManoeuvre, diagnose: str) -> Iterator[str]:
    """Duration and power of a drive that separates rivals, and what to do with it."""
    if not move.minutes:
        return
    enough = "are enough"
    if move.chance is not None and move.chance < rules.POWER:
        enough = f"tell them apart in {100.0 * move.chance:.0f} % of cases"
    yield f"About {move.minutes:.0f} min of it {enough}."
    yield f"Then give that drive to `{diagnose}` together with these."
