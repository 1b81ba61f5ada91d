# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A physical effect: a named, documented function on travel or motion, with declared parameters.

Physics acts at three places, so an effect has a stage: `wheels` (WheelTravel -> WheelTravel),
`body` (BodyMotion -> BodyMotion) and `reference` (View -> View: how the measurement looks at the
robot; it changes what is compared, never what the node publishes). Set-up mistakes change how the
counters are read (Wiring -> Wiring).

Laws that every effect keeps (`check_effect` holds them against it, a user's own too): at its null
values it is the exact identity; a step's result depends on that step's row alone; it changes none
of its arguments; it is finite at the bounds; splitting a step changes nothing; `turn` never depends
on the heading.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.motion import BodyMotion, WheelTravel

Stage = Literal["wiring", "wheels", "body", "reference"]


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
    """

    unit: str
    null: float
    typical: float
    bounds: tuple[float, float]
    says: str
    per_run: bool = False


class View(NamedTuple):
    """How the reference looks at the robot."""

    ahead: float = 0.0
    """The measured point lies this far ahead of the axle's midpoint [m]."""
    left: float = 0.0
    """... and this far to its left [m]."""
    yaw: float = 0.0
    """The reference's forward axis is turned by this against the robot's [rad]."""
    delay: float = 0.0
    """What the reference stamps t, it saw at t - delay [s]."""
    heading_delay: float = 0.0
    """Its heading is later than its position by this [s]."""
    mirrored: bool = False
    """Its frame is left-handed."""


class Wiring(NamedTuple):
    """Which counter belongs to which wheel, and which way it counts."""

    swapped: bool = False
    left_sign: float = 1.0
    right_sign: float = 1.0


Apply = Callable[..., Any]


@dataclass(frozen=True)
class Effect:
    """A physical effect of the library, or of a user's package."""

    name: str
    stage: Stage
    parameters: Mapping[str, Parameter]
    apply: Apply
    doc: str

    @property
    def summary(self) -> str:
        """First line of what it is."""
        return self.doc.strip().splitlines()[0]

    @property
    def nulls(self) -> dict[str, float]:
        """The values at which it is absent."""
        return {name: item.null for name, item in self.parameters.items()}

    def using(self, **values: float) -> AppliedEffect:
        """The effect with values; those not given are null.

        Raises
        ------
        ValueError
            For a parameter that it does not have, or a value that physics does not allow.
        """
        for name, value in values.items():
            if name not in self.parameters:
                known = ", ".join(self.parameters)
                raise ValueError(f"{self.name} has no parameter {name}; it has {known}")
            low, high = self.parameters[name].bounds
            if not low <= value <= high:
                raise ValueError(
                    f"{self.name}.{name} must lie between {low:g} and {high:g} "
                    f"{self.parameters[name].unit}, it is {value:g}"
                )
        return AppliedEffect(self, {**self.nulls, **values})


@dataclass(frozen=True)
class AppliedEffect:
    """An effect with values for all its parameters."""

    effect: Effect
    values: Mapping[str, float] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """Of the effect."""
        return self.effect.name


def wheel_effect(**parameters: Parameter) -> Callable[[Apply], Effect]:
    """Declare ``f(travel, drive, **parameters) -> WheelTravel`` as an effect on the wheels."""
    return _declared("wheels", parameters)


def body_effect(**parameters: Parameter) -> Callable[[Apply], Effect]:
    """Declare ``f(motion, drive, **parameters) -> BodyMotion`` as an effect on the body."""
    return _declared("body", parameters)


def reference_effect(**parameters: Parameter) -> Callable[[Apply], Effect]:
    """Declare ``f(view, **parameters) -> View`` as an effect of the measurement."""
    return _declared("reference", parameters)


def wiring_mistake(apply: Apply) -> Effect:
    """Declare ``f(wiring) -> Wiring`` as a set-up mistake: it is made, or it is not."""
    return _declared("wiring", {})(apply)


def _declared(stage: Stage, parameters: Mapping[str, Parameter]) -> Callable[[Apply], Effect]:
    def declare(apply: Apply) -> Effect:
        name = apply.__name__
        doc = inspect.getdoc(apply)
        if not doc:
            raise TypeError(f"effect {name} needs a docstring: people will read it")
        return Effect(name, stage, dict(parameters), apply, doc)

    return declare


def after_wheel_effects(
    effects: tuple[AppliedEffect, ...], travel: WheelTravel[Any], drive: Drive[Any]
) -> WheelTravel[Any]:
    """Travel of the wheels once the effects on them have acted, in order."""
    for applied in effects:
        if applied.effect.stage == "wheels":
            travel = applied.effect.apply(travel, drive, **applied.values)
    return travel


def after_body_effects(
    effects: tuple[AppliedEffect, ...], motion: BodyMotion[Any], drive: Drive[Any]
) -> BodyMotion[Any]:
    """Motion of the body once the effects on it have acted, in order."""
    for applied in effects:
        if applied.effect.stage == "body":
            motion = applied.effect.apply(motion, drive, **applied.values)
    return motion


def view_of(effects: tuple[AppliedEffect, ...]) -> View:
    """How the reference looks at the robot."""
    view = View()
    for applied in effects:
        if applied.effect.stage == "reference":
            view = applied.effect.apply(view, **applied.values)
    return view


def wiring_of(effects: tuple[AppliedEffect, ...]) -> Wiring:
    """How the counters are to be read."""
    wiring = Wiring()
    for applied in effects:
        if applied.effect.stage == "wiring":
            wiring = applied.effect.apply(wiring, **applied.values)
    return wiring
