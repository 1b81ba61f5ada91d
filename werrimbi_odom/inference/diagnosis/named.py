# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The effects that a diagnosis speaks of, a user's own among them."""

from __future__ import annotations

from werrimbi_odom.effects import find
from werrimbi_odom.inference.diagnosis.verdict import Diagnosis
from werrimbi_odom.inference.set_up.findings import IN_DEGREES
from werrimbi_odom.model.effect import Effect


def effect_named(diagnosis: Diagnosis, name: str) -> Effect | None:
    """The effect of a name; None for a finding that is no effect."""
    if name == IN_DEGREES:
        return None
    for this in diagnosis.rounds:
        for score in this.scores:
            if score.candidate.name == name:
                return score.candidate.effect
    for applied in diagnosis.robot.effects:
        if applied.name == name:
            return applied.effect
    return find(name)
