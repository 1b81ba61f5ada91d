# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where nothing was found: whether what is left is of the robot all the same, and no noise."""

from __future__ import annotations

from dataclasses import replace

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.one_sided_noise import one_sided_noise
from werrimbi_odom.inference.diagnosis.result import Diagnosis
from werrimbi_odom.inference.events.events import Events


def with_what_is_no_noise(found: Diagnosis, happened: Events) -> Diagnosis:
    """The diagnosis with the events; *unknown* where what is left is no noise, and no law."""
    found = replace(found, happened=happened)
    # What one drive alone shows may be of an error that each of them has in its own way.
    no_law = found.misfit is None or found.misfit.only_in is not None
    nothing = found.verdict == "none" and no_law
    if nothing and any(cell.p_value < rules.VERY_SURE for cell in found.depends_on):
        one_sided = one_sided_noise(found.runs, found.final)
        if one_sided is not None:
            return replace(found, verdict="unknown", one_sided=one_sided)
    # A law that the model holds leaves such errors where its form or its size is not quite right.
    if found.verdict == "none" and found.left_by is None and _come_with_driving(happened):
        return replace(found, verdict="unknown", by_events=True)
    return found


def _come_with_driving(happened: Events) -> bool:
    """Whether events of the robot come with its reversals, or with its starts and stops.

    A localiser corrects itself when the robot sets off, and a match may fail then: their steps are
    no proof. A place on the floor is no law that a robot file could hold.
    """
    common = happened.alike
    if common is None or common.what not in ("reversal", "start or stop"):
        return False
    jumps = sum(event.channel == "reference" for event in happened.events)
    return happened.kind == "absolute" and 2 * jumps < len(happened.events)
