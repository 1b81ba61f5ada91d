# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What to drive if no effect explains the errors: vary what they depend on, keep the rest."""

from __future__ import annotations

from dataclasses import dataclass

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.variables import CONSTANT
from werrimbi_odom.inference.manoeuvres.library import MANOEUVRES


@dataclass(frozen=True, slots=True)
class ProposedManoeuvre:
    """The next thing to do, to know more."""

    name: str
    """A manoeuvre of `library`; or a work by hand, as the twins declare it (`Twin.manoeuvre`), or
    `push_by_hand`."""
    why: str
    """One plain sentence."""
    do: str
    """What to drive, or to do."""
    minutes: float
    """Duration in minutes; 0 if it is no drive."""
    chance: float | None = None
    """Share of cases in which so long a drive tells the rivals apart."""


_VARYING = {
    "speed": ("out_and_back", "speed"),
    "wheel_speed": ("out_and_back", "speed"),
    "acceleration": ("start_stop", "acceleration"),
    "yaw_rate": ("arcs", "rate of turning"),
    "yaw_rate_size": ("arcs", "rate of turning"),
    "direction": ("out_and_back", "sense of driving"),
    "travel_since_reversal": ("start_stop", "travel since the last reversal"),
    "heading": ("square", "heading"),
    "left_wheel_angle": ("out_and_back", "angle of the left wheel"),
    "right_wheel_angle": ("out_and_back", "angle of the right wheel"),
    "left_wheel_angle_twice": ("out_and_back", "angle of the left wheel"),
    "right_wheel_angle_twice": ("out_and_back", "angle of the right wheel"),
    "turn": ("spins", "turning"),
    "travel": ("out_and_back", "travel"),
    "path": ("out_and_back", "travel"),
}
"""Manoeuvre that varies a variable by itself as far as possible, and the variable in words."""


def for_the_unknown(diagnosis: Diagnosis) -> ProposedManoeuvre | None:
    """Vary what the error depends on, and keep all else constant."""
    if diagnosis.by_events:
        ideal = next(item for item in MANOEUVRES if item.name == "start_stop")
        return ProposedManoeuvre(
            ideal.name,
            "many starts of either sense by themselves show to which side the error goes, and "
            "whether it grows with how hard they are",
            f"drive {ideal.words}",
            rules.MINUTES_OF_A_LAW,
        )
    found = strongest(diagnosis)
    if found is None:
        return None
    name = found.name
    if name in _VARYING:
        manoeuvre, words = _VARYING[name]
        ideal = next(item for item in MANOEUVRES if item.name == manoeuvre)
        why = f"it varies the {words} and holds as much else as can be held, so that the law shows"
        return ProposedManoeuvre(manoeuvre, why, f"drive {ideal.words}", rules.MINUTES_OF_A_LAW)
    if name == "position":
        return ProposedManoeuvre(
            "square",
            "the same drive on different places of the floor shows where the error is and how wide",
            "drive the same small square, in both senses, on and off the places where the error is "
            "largest",
            rules.MINUTES_OF_PLACES,
        )
    if name in ("time", "duration", "distance"):
        return ProposedManoeuvre(
            "out_and_back",
            "the same line, repeated, shows how the error grows with time, and whether it comes "
            "back after a rest",
            "drive one and the same line forwards and backwards for ten minutes; then after a rest "
            "again",
            rules.MINUTES_OF_TIME,
        )
    return ProposedManoeuvre(
        "out_and_back",
        f"the same short drive at different values of {name}, all else held, shows how the error "
        "follows it",
        f"drive one and the same line forwards and backwards, with {name} as low and as high as "
        "it gets, and in between",
        rules.MINUTES_OF_PLACES,
    )


def strongest(diagnosis: Diagnosis) -> Dependence | None:
    """The dependence that explains most; one on a variable is preferred to a bare amount if close.

    What depends on the speed also depends slightly on the distance; the reverse is rare.
    """
    sure = [cell for cell in diagnosis.depends_on if cell.p_value < rules.SURE]
    if not sure:
        return None
    top = max(_explains(cell) for cell in sure)
    near = [cell for cell in sure if _explains(cell) >= rules.NEARLY_AS_MUCH * top]
    return max(near, key=lambda cell: (cell.variable.name != CONSTANT, _explains(cell)))


def _explains(cell: Dependence) -> float:
    """Gain of a dependence above that of as many null parameters."""
    return cell.gain - rules.USELESS_NUMBER * cell.degrees
