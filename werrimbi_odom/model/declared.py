# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What an effect declares beside its law: parameters, twins, a sketch. Data; nothing here acts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from werrimbi_odom.model.pose import wrap


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of an effect, declared once.

    Parameters
    ----------
    unit : str
        SI unit, "" for a pure number.
    null : float
        The value at which the effect is absent.
    typical : float
        A size that real robots show; the scale on which derivatives are taken.
    bounds : (float, float)
        What physics allows; a fit that ends there is a finding of its own.
    says : str
        What the number is, in plain words.
    per_run : bool
        A nuisance that each run has anew (a phase where counters start anywhere).
    tries : tuple of float
        Given for a shape (a threshold, a length): it does nothing while the effect's other
        parameters are null, so no derivative there finds it. A fit begins at each of these values.
    as_base : bool
        It is the robot file's `wheel_separation_multiplier` by another name: a fit turns that, and
        what it finds is told and written as this.
    grain : float
        Given for a threshold: the share of its value over which the law lets it set in, because
        speeds and the like are not counted finely enough for an edge. A fit knows no more of it.
    """

    unit: str
    null: float
    typical: float
    bounds: tuple[float, float]
    says: str
    per_run: bool = False
    tries: tuple[float, ...] = ()
    as_base: bool = False
    grain: float = 0.0

    @property
    def scale(self) -> float:
        """Distance from null that real robots show; of a shape, its typical size."""
        return abs(self.typical) if self.tries else abs(self.typical - self.null)

    def combined(self, one: float, more: float) -> float:
        """What two of its values come to, one after the other: factors multiply, others add.

        A parameter is a factor where it is absent at 1. An angle that goes all the way round stays
        within half a turn.
        """
        if self.null == 1.0:
            return one * more
        all_round = self.unit == "rad" and self.bounds[1] - self.bounds[0] > 2.0 * math.pi - 1e-6
        return wrap(one + more) if all_round else one + more


@dataclass(frozen=True, slots=True)
class Twin:
    """Another effect that no drive can tell from this one, and what can.

    Parameters
    ----------
    name : str
        Of the other effect.
    told_apart_by : str
        Why no drive can tell them, and what can; a clause, without a full stop.
    do : str
        What to do for that; likewise.
    manoeuvre : str
        A name for it, for programs.
    minutes : float
        How long it takes to drive; 0 where it is no drive.
    values : mapping of str to (str, float)
        For each parameter of the twin, the parameter of this effect and the factor that make it;
        empty where they are not in proportion.
    of_headings : bool
        They are one only where the reference measures headings alone.
    inverse : bool
        Values are in proportion to the reciprocals of this effect's.
    """

    name: str
    told_apart_by: str = ""
    do: str = ""
    manoeuvre: str = "by_hand"
    minutes: float = 0.0
    values: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    of_headings: bool = False
    inverse: bool = False

    def same_as(self, values: Mapping[str, float]) -> dict[str, float]:
        """The twin's values that do the same as `values` of this effect."""
        power = -1.0 if self.inverse else 1.0
        return {name: factor * values[own] ** power for name, (own, factor) in self.values.items()}


DRAWINGS: Mapping[str, int] = {
    "backlash": 1,
    "by_channel": 0,
    "carpet": 0,
    "castor": 0,
    "eccentric": 1,
    "late": 2,
    "lever_arm": 0,
    "load": 0,
    "lost_counts": 1,
    "mirrored": 0,
    "oval": 1,
    "radius": 0,
    "scale": 0,
    "shrinking": 0,
    "sideways": 0,
    "skid": 0,
    "slip_above": 0,
    "slip_ahead": 0,
    "slip_outwards": 0,
    "slope": 0,
    "squash": 0,
    "swapped": 0,
    "track": 0,
    "tread_bump": 1,
    "two_bases": 0,
    "unequal": 0,
    "wrong_sign": 1,
    "wandering_bias": 0,
    "yaw_offset": 0,
}
"""Drawings that the reports have, and how many labels each asks for: a side, or two signals."""


@dataclass(frozen=True, slots=True)
class Sketch:
    """A drawing of the physics, for reports: which one, and its words.

    Parameters
    ----------
    drawing : str
        One of `DRAWINGS`.
    says : str
        What it shows, for those who do not see it.
    caption : str
        Below it.
    labels : tuple of str
        What the drawing asks for: a side ("left", "right"), the names of two signals.

    Raises
    ------
    ValueError
        For a drawing that there is not, or labels that it does not ask for.
    """

    drawing: str
    says: str
    caption: str
    labels: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.drawing not in DRAWINGS:
            raise ValueError(f"there is no drawing {self.drawing}; there are {', '.join(DRAWINGS)}")
        if len(self.labels) != DRAWINGS[self.drawing]:
            raise ValueError(
                f"the drawing {self.drawing} asks for {DRAWINGS[self.drawing]} labels, not for "
                f"{len(self.labels)}"
            )
