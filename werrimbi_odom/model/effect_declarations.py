# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Declarations of an effect besides its formula: parameters, twins, a sketch. Data only."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from werrimbi_odom.model.pose import wrap

A_TURN_AS_WRITTEN = 0.01
"""How far bounds written in a few digits (3.14 or 3.1416) may miss a full turn [rad]."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """Declaration of a parameter of an effect.

    Parameters
    ----------
    unit : str
        SI unit; "" if dimensionless.
    null : float
        Value at which the effect is absent.
    typical : float
        Typical size on real robots; also the scale for derivatives.
    bounds : (float, float)
        Physical limits; a fit that ends at one is reported.
    says : str
        Meaning of the parameter, in plain words.
    per_run : bool
        Nuisance parameter with a new value in each run (a phase, where counters start anywhere).
    tries : tuple of float
        Start values for a shape parameter (a threshold, a length). While the effect's other
        parameters are null, it has no influence and therefore no derivative there. A fit starts at
        each of these values.
    as_base : bool
        The parameter is `wheel_separation_multiplier` of the robot file under another name: a fit
        changes that one and reports and writes the result as this one.
    grain : float
        Relative width of the stretch in which the robot's own value lies, however well drives
        determine the law's: a law is a form, and is driven by speeds and accelerations of counters.
        Of a threshold the width of its smooth onset, since those are too coarsely quantised for a
        sharp edge. A fit states no value more precisely than this.
    refines : bool
        A shape parameter whose null is what a law with fewer numbers has. A fit frees it only where
        it pays its penalty; else it stays at null, and is neither reported nor written.
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
    refines: bool = False

    @property
    def scale(self) -> float:
        """Typical distance from null on real robots; for a shape parameter its typical size."""
        return abs(self.typical) if self.tries else abs(self.typical - self.null)

    @property
    def reach(self) -> float:
        """Largest distance from null that is physically possible."""
        return max(abs(bound - self.null) for bound in self.bounds)

    @property
    def is_direction(self) -> bool:
        """Whether it is an angle that may take any direction: its bounds are a full turn apart.

        Both bounds are then the same direction, and neither is a limit.
        """
        low, high = self.bounds
        return self.unit == "rad" and abs(high - low - 2.0 * math.pi) < A_TURN_AS_WRITTEN

    def is_unrefined(self, value: float) -> bool:
        """Whether it would refine its law, and has the value of the law without it."""
        return self.refines and value == self.null

    def combined(self, one: float, more: float) -> float:
        """Combine two successive values of the parameter: factors multiply, others add.

        A parameter with null value 1 is a factor. An angle that may take any direction is wrapped.
        """
        if self.null == 1.0:
            return one * more
        return wrap(one + more) if self.is_direction else one + more


@dataclass(frozen=True, slots=True)
class Twin:
    """Another effect that no drive can distinguish from this one, and what can.

    Parameters
    ----------
    name : str
        Name of the other effect.
    told_apart_by : str
        Reason why no drive can distinguish them, and what can; a clause, without a full stop.
    do : str
        What to do to distinguish them; likewise.
    manoeuvre : str
        Identifier of that manoeuvre, for programs.
    minutes : float
        Duration of the drive [min]; 0 if it is no drive.
    values : mapping of str to (str, float)
        For each parameter of the twin, the parameter of this effect and the factor that give it;
        empty where the two are not proportional.
    of_headings : bool
        They are twins only where the reference measures headings alone.
    inverse : bool
        The twin's values are proportional to the reciprocals of this effect's.
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
        """Values of the twin that are equivalent to `values` of this effect."""
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
"""Drawings of the reports, and the number of labels that each takes: a side, or two signals."""


@dataclass(frozen=True, slots=True)
class Sketch:
    """A drawing of the physics for reports, and its texts.

    Parameters
    ----------
    drawing : str
        One of `DRAWINGS`.
    says : str
        Text alternative of the drawing.
    caption : str
        Caption below it.
    labels : tuple of str
        Labels that the drawing takes: a side ("left", "right"), the names of two signals.

    Raises
    ------
    ValueError
        For an unknown drawing, or a wrong number of labels.
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
