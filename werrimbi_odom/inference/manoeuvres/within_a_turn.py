# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Legs short enough to show what an error does within one turn of a wheel."""

from __future__ import annotations

from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.effect_support import support_of
from werrimbi_odom.inference.rules import LEGS_A_TURN

WHEELS_ANGLE = frozenset({"left_angle", "right_angle"})
"""Inputs of effects that repeat with each turn of a wheel."""


def shorter_leg(diagnosis: Diagnosis, leg: float) -> float | None:
    """Length of legs that may tell the rivals apart [m]; None where the legs are not the reason.

    Over whole turns of a wheel a bump on its tread is a larger radius, and an axle off the centre
    is nothing: what tells them apart is seen within a turn alone.

    Parameters
    ----------
    leg
        Length of the legs of this diagnosis [m].
    """
    if diagnosis.verdict != "ambiguous" or not _repeats_each_turn(diagnosis):
        return None
    robot = diagnosis.robot
    turns = (
        robot.left_tick * robot.left_ticks_per_revolution,
        robot.right_tick * robot.right_ticks_per_revolution,
    )
    shorter = float(f"{min(turns) / LEGS_A_TURN:.2g}")
    return shorter if shorter < 0.5 * leg else None


def settles(shorter: Diagnosis, longer: Diagnosis) -> bool:
    """Whether the diagnosis with shorter legs names one of the rivals of the one with longer."""
    known = {*longer.rivals, *longer.found}
    return (
        shorter.verdict == "named"
        and shorter.effect in longer.rivals
        and known.issuperset(shorter.found)
    )


def _repeats_each_turn(diagnosis: Diagnosis) -> bool:
    """Whether one of the rivals is an effect of the angle of a wheel."""
    runs, model = diagnosis.runs, diagnosis.model
    drive = runs.drive(model.laid_out(runs.steps))
    return any(
        WHEELS_ANGLE & support_of(score.candidate, drive).inputs
        for score in diagnosis.rounds[0].scores
        if score.candidate.name in diagnosis.rivals
    )
