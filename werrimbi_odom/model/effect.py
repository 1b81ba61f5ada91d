# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A physical effect: a named, documented function of travel or motion, with declared parameters.

Physics acts at three places, so an effect has a stage: `wheels` (WheelTravel -> WheelTravel),
`body` (BodyMotion -> BodyMotion) or `reference` (View -> View: how the reference observes the
robot; it changes what is compared, never what the node publishes). Set-up mistakes change how the
counters are read (Wiring -> Wiring).

Every effect, also a user's own, must have these properties (see `check_effect`): at its null
values it is exactly the identity; a step's result depends on that step's row alone; it does not
modify its arguments; it is finite at the bounds; splitting a step changes nothing; a turn that
depends on the heading does so smoothly and weakly; live, recorded and predicted drives give equal
results. The quantities that it reads need not be declared: they are recorded while it runs
(`werrimbi_odom.model.effects_over_run`).
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, TypeVar

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect_declarations import Parameter, Sketch, Twin
from werrimbi_odom.model.motion import BodyMotion, WheelTravel
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.wiring import Wiring

__all__ = [
    "AppliedEffect",
    "Effect",
    "Parameter",
    "Sketch",
    "Stage",
    "Twin",
    "after_stage",
    "always_twins",
    "applied_of",
    "body_effect",
    "extended_by",
    "reference_effect",
    "twin_of",
    "view_of",
    "wheel_effect",
    "wiring_mistake",
    "wiring_of",
]

Stage = Literal["wiring", "wheels", "body", "reference"]


Apply = Callable[..., Any]
ActedOn = TypeVar("ActedOn", Wiring, WheelTravel[Any], BodyMotion[Any], View)


@dataclass(frozen=True)
class Effect:
    """A physical effect of the library or of a user's package.

    Parameters
    ----------
    stage : "wiring", "wheels", "body" or "reference"
        Where it acts.
    parameters : mapping of str to Parameter
        Empty for a set-up mistake, which is present or not.
    apply : callable
        The function itself.
    doc : str
        Its page: a description, then Formula, Signature, Ruler, Twins.
    indistinguishable_from : tuple of Twin
        Effects that no drive can distinguish from it, by algebra, and what can.
    quadrature : (str, str), optional
        Names of an amplitude and a phase [rad]. The amplitude has no derivative at null, because
        that depends on the phase; amplitude * cos(phase) and amplitude * sin(phase) have one. See
        `to_fit`.
    channels : tuple of str
        Extra measured channels that it reads; it cannot be applied without them.
    sketch : Sketch, optional
        A drawing for reports.
    one_of_channels : tuple of str
        It needs a measured channel with one of these words in its name.
    extends : str
        Name of a nested effect: the same at the null values of the parameters that it lacks.
    """

    name: str
    stage: Stage
    parameters: Mapping[str, Parameter]
    apply: Apply
    doc: str
    indistinguishable_from: tuple[Twin, ...] = ()
    quadrature: tuple[str, str] | None = None
    channels: tuple[str, ...] = ()
    sketch: Sketch | None = None
    one_of_channels: tuple[str, ...] = ()
    extends: str = ""

    def lacks(self, measured: Iterable[str]) -> tuple[str, ...]:
        """Channels that it reads and that were not measured, in words; empty if it can act."""
        there = tuple(measured)
        missing = tuple(name for name in self.channels if name not in there)
        wanted = self.one_of_channels
        if wanted and not any(word in name.lower() for word in wanted for name in there):
            missing += (f"whose name has one of {', '.join(wanted)} in it",)
        return missing

    @property
    def twins(self) -> tuple[str, ...]:
        """Effects that no drive can distinguish from it, whatever the reference measures."""
        return tuple(twin.name for twin in self.indistinguishable_from if not twin.of_headings)

    @property
    def summary(self) -> str:
        """First line of its page."""
        return self.doc.strip().splitlines()[0]

    @property
    def nulls(self) -> dict[str, float]:
        """Values at which it is absent."""
        return {name: item.null for name, item in self.parameters.items()}

    def has_null(self, name: str) -> bool:
        """Whether a parameter has a value at which it does nothing: not a shape, not a phase."""
        return not self.parameters[name].tries and name not in (self.quadrature or ())[1:]

    @property
    def is_mistake(self) -> bool:
        """Whether it is a set-up mistake: present or absent, nothing in between."""
        return not self.parameters

    def allows(self, values: Mapping[str, float]) -> bool:
        """Whether these values lie within the physical bounds."""
        bounds = {name: self.parameters[name].bounds for name in values}
        return all(low <= values[name] <= high for name, (low, high) in bounds.items())

    def to_fit(self, values: Mapping[str, float]) -> dict[str, float]:
        """Transform values to coordinates that have a derivative at null, for a fit.

        They are the parameters themselves, except for a `quadrature`: amplitude and phase become
        ``AMPLITUDE_cos`` and ``AMPLITUDE_sin``.
        """
        if self.quadrature is None:
            return dict(values)
        amplitude, phase = self.quadrature
        size, angle = values[amplitude], values[phase]
        parts = {
            f"{amplitude}_cos": size * math.cos(angle),
            f"{amplitude}_sin": size * math.sin(angle),
        }
        return parts | {
            name: value for name, value in values.items() if name not in (amplitude, phase)
        }

    def from_fit(self, coordinates: Mapping[str, float]) -> dict[str, float]:
        """Inverse of `to_fit`; the amplitude is not negative."""
        if self.quadrature is None:
            return dict(coordinates)
        amplitude, phase = self.quadrature
        found = dict(coordinates)
        cos, sin = found.pop(f"{amplitude}_cos"), found.pop(f"{amplitude}_sin")
        found[amplitude], found[phase] = math.hypot(cos, sin), math.atan2(sin, cos)
        return {name: found[name] for name in self.parameters}

    def using(self, **values: float) -> AppliedEffect:
        """Apply the effect with these values; those not given are null.

        A per-run parameter that is not given stays `unknown` until it is estimated by a fit or the
        node.

        Raises
        ------
        ValueError
            For an unknown parameter, or a value outside its physical bounds.
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
        unknown = tuple(
            name for name, item in self.parameters.items() if item.per_run and name not in values
        )
        return AppliedEffect(self, {**self.nulls, **values}, unknown)


@dataclass(frozen=True)
class AppliedEffect:
    """An effect with values for all its parameters."""

    effect: Effect
    values: Mapping[str, float] = field(default_factory=dict)
    unknown: tuple[str, ...] = ()
    """Per-run parameters that are not yet estimated; their values are null."""

    @property
    def name(self) -> str:
        """Name of the effect."""
        return self.effect.name

    @property
    def ready(self) -> bool:
        """Whether it can act. With an unknown phase it might double the error instead."""
        return not self.unknown

    def learnt(self, **values: float) -> AppliedEffect:
        """Return a copy with estimated values."""
        left = tuple(name for name in self.unknown if name not in values)
        return AppliedEffect(self.effect, {**self.values, **values}, left)


def wheel_effect(
    *,
    twins: Sequence[Twin | str] = (),
    quadrature: tuple[str, str] | None = None,
    channels: tuple[str, ...] = (),
    one_of_channels: tuple[str, ...] = (),
    sketch: Sketch | None = None,
    pose: bool = False,  # obsolete: what an effect reads is now recorded while it runs
    **parameters: Parameter,
) -> Callable[[Apply], Effect]:
    """Declare ``f(travel, drive, **parameters) -> WheelTravel`` as an effect on the wheels."""
    more = {"sketch": sketch, "channels": channels, "one_of_channels": one_of_channels}
    return _declared("wheels", parameters, twins, quadrature, **more)


def body_effect(
    *,
    twins: Sequence[Twin | str] = (),
    quadrature: tuple[str, str] | None = None,
    channels: tuple[str, ...] = (),
    sketch: Sketch | None = None,
    pose: bool = False,
    **parameters: Parameter,
) -> Callable[[Apply], Effect]:
    """Declare ``f(motion, drive, **parameters) -> BodyMotion`` as an effect on the body."""
    return _declared("body", parameters, twins, quadrature, sketch=sketch, channels=channels)


def reference_effect(
    *,
    twins: Sequence[Twin | str] = (),
    sketch: Sketch | None = None,
    extends: str = "",
    **parameters: Parameter,
) -> Callable[[Apply], Effect]:
    """Declare ``f(view, **parameters) -> View`` as an effect on the measurement."""
    return _declared("reference", parameters, twins, sketch=sketch, extends=extends)


def wiring_mistake(
    *, twins: Sequence[Twin | str] = (), sketch: Sketch | None = None
) -> Callable[[Apply], Effect]:
    """Declare ``f(wiring) -> Wiring`` as a set-up mistake: present or not."""
    return _declared("wiring", {}, twins, sketch=sketch)


def _declared(
    stage: Stage,
    parameters: Mapping[str, Parameter],
    twins: Sequence[Twin | str],
    quadrature: tuple[str, str] | None = None,
    **more: Any,
) -> Callable[[Apply], Effect]:
    """`more`: of `Effect`, as they are."""
    looked_at = 2 if stage in ("wheels", "body") else 1

    def declare(apply: Apply) -> Effect:
        name = apply.__name__
        doc = inspect.getdoc(apply)
        if not doc:
            raise TypeError(f"effect {name} needs a docstring: people will read it")
        taken = list(inspect.signature(apply).parameters)
        if taken[looked_at:] != list(parameters) or len(taken) < looked_at:
            raise TypeError(
                f"effect {name} declares the parameters ({', '.join(parameters)}), but its "
                f"function takes ({', '.join(taken[looked_at:])}) after the first {looked_at}; "
                "both must be the same, in the same order"
            )
        if quadrature is not None and not set(quadrature) <= set(parameters):
            raise TypeError(
                f"effect {name}: its quadrature names {quadrature}, no parameters of it"
            )
        others = tuple(Twin(each) if isinstance(each, str) else each for each in twins)
        return Effect(name, stage, dict(parameters), apply, doc, others, quadrature, **more)

    return declare


def twin_of(one: Effect, other: Effect) -> Twin | None:
    """Declaration of twinship, by either of the two effects; None if they are no twins."""
    found = [twin for twin in one.indistinguishable_from if twin.name == other.name]
    found += [twin for twin in other.indistinguishable_from if twin.name == one.name]
    return max(found, key=lambda twin: bool(twin.do), default=None)


def always_twins(one: Effect, other: Effect) -> bool:
    """Whether no drive can distinguish them, whatever the reference measures."""
    return other.name in one.twins or one.name in other.twins


def after_stage(
    stage: Stage, effects: tuple[AppliedEffect, ...], acted_on: ActedOn, *drive: Drive[Any]
) -> ActedOn:
    """Apply the effects of a stage in order: on travel or motion, which `drive` belongs to."""
    for applied in effects:
        if applied.effect.stage == stage and applied.ready:
            acted_on = applied.effect.apply(acted_on, *drive, **applied.values)
    return acted_on


def applied_of(effects: tuple[AppliedEffect, ...], name: str) -> AppliedEffect:
    """The effect of that name, which must be one of them."""
    return next(applied for applied in effects if applied.name == name)


def extended_by(effects: tuple[AppliedEffect, ...]) -> frozenset[str]:
    """Names of the effects that some of these extend."""
    return frozenset(applied.effect.extends for applied in effects if applied.effect.extends)


def view_of(effects: tuple[AppliedEffect, ...]) -> View:
    """How the reference observes the robot."""
    return after_stage("reference", effects, View())


def wiring_of(effects: tuple[AppliedEffect, ...]) -> Wiring:
    """How the counters must be read."""
    return after_stage("wiring", effects, Wiring())
