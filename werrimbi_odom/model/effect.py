# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A physical effect: a named, documented function on travel or motion, with declared parameters.

Physics acts at three places, so an effect has a stage: `wheels` (WheelTravel -> WheelTravel),
`body` (BodyMotion -> BodyMotion) and `reference` (View -> View: how the measurement looks at the
robot; it changes what is compared, never what the node publishes). Set-up mistakes change how the
counters are read (Wiring -> Wiring).

Laws that every effect keeps (`check_effect` holds them against it, a user's own too): at its null
values it is the exact identity; a step's result depends on that step's row alone; it changes none
of its arguments; it is finite at the bounds; splitting a step changes nothing; a turn that depends
on the heading does so gently.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.motion import BodyMotion, WheelTravel
from werrimbi_odom.model.view import View
from werrimbi_odom.model.wiring import Wiring

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
    tries : tuple of float
        Given for a shape (a threshold, a length): it does nothing while the effect's other
        parameters are null, so no derivative there finds it. A fit begins at each of these values.
    """

    unit: str
    null: float
    typical: float
    bounds: tuple[float, float]
    says: str
    per_run: bool = False
    tries: tuple[float, ...] = ()

    @property
    def scale(self) -> float:
        """Distance from null that real robots show; of a shape, its typical size."""
        return abs(self.typical) if self.tries else abs(self.typical - self.null)


Apply = Callable[..., Any]


@dataclass(frozen=True)
class Effect:
    """A physical effect of the library, or of a user's package.

    Parameters
    ----------
    name : str
    stage : "wiring", "wheels", "body" or "reference"
        Where it acts.
    parameters : mapping of str to Parameter
        None: a set-up mistake, which is made or not.
    apply : callable
        The law.
    doc : str
        Its page: what it is, then Formula, Signature, Ruler, Twins.
    twins : tuple of str
        Effects that no drive can tell from it, by algebra.
    quadrature : (str, str), optional
        Names of an amplitude and a phase [rad]. The amplitude alone has no derivative at null (it
        depends on the phase); amplitude * cos(phase) and amplitude * sin(phase) have. See
        `to_fit`.
    channels : tuple of str
        Extra measured channels that it looks at; without them it cannot be applied.
    pose : bool
        It looks at where the robot stands (`Drive.x`, `Drive.y`), or acts on the wheels and looks
        at the heading.
    """

    name: str
    stage: Stage
    parameters: Mapping[str, Parameter]
    apply: Apply
    doc: str
    twins: tuple[str, ...] = ()
    quadrature: tuple[str, str] | None = None
    channels: tuple[str, ...] = ()
    pose: bool = False

    @property
    def summary(self) -> str:
        """First line of what it is."""
        return self.doc.strip().splitlines()[0]

    @property
    def nulls(self) -> dict[str, float]:
        """The values at which it is absent."""
        return {name: item.null for name, item in self.parameters.items()}

    @property
    def is_mistake(self) -> bool:
        """Whether it is a set-up mistake: made or not, nothing in between."""
        return not self.parameters

    def to_fit(self, values: Mapping[str, float]) -> dict[str, float]:
        """Values in coordinates that have a derivative at null, for a fit to move.

        They are the parameters themselves, but for a `quadrature`: its amplitude and phase become
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
        """What `to_fit` undoes: parameters from coordinates; the amplitude is not negative."""
        if self.quadrature is None:
            return dict(coordinates)
        amplitude, phase = self.quadrature
        found = dict(coordinates)
        cos, sin = found.pop(f"{amplitude}_cos"), found.pop(f"{amplitude}_sin")
        found[amplitude], found[phase] = math.hypot(cos, sin), math.atan2(sin, cos)
        return {name: found[name] for name in self.parameters}

    def using(self, **values: float) -> AppliedEffect:
        """The effect with values; those not given are null.

        A parameter that each run has anew and that is not given stays `unknown` until somebody
        (a fit, the node) has learnt it.

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
    """Parameters that this run has anew and nobody has learnt yet; their values are the null's."""

    @property
    def name(self) -> str:
        """Of the effect."""
        return self.effect.name

    @property
    def ready(self) -> bool:
        """Whether it can act: with an unknown phase it might double the error that it is for."""
        return not self.unknown

    def learnt(self, **values: float) -> AppliedEffect:
        """The same with values that are now known."""
        left = tuple(name for name in self.unknown if name not in values)
        return AppliedEffect(self.effect, {**self.values, **values}, left)


def wheel_effect(
    *,
    twins: tuple[str, ...] = (),
    quadrature: tuple[str, str] | None = None,
    channels: tuple[str, ...] = (),
    pose: bool = False,
    **parameters: Parameter,
) -> Callable[[Apply], Effect]:
    """Declare ``f(travel, drive, **parameters) -> WheelTravel`` as an effect on the wheels."""
    return _declared("wheels", parameters, 2, twins, quadrature, channels, pose)


def body_effect(
    *,
    twins: tuple[str, ...] = (),
    quadrature: tuple[str, str] | None = None,
    channels: tuple[str, ...] = (),
    pose: bool = False,
    **parameters: Parameter,
) -> Callable[[Apply], Effect]:
    """Declare ``f(motion, drive, **parameters) -> BodyMotion`` as an effect on the body."""
    return _declared("body", parameters, 2, twins, quadrature, channels, pose)


def reference_effect(
    *, twins: tuple[str, ...] = (), **parameters: Parameter
) -> Callable[[Apply], Effect]:
    """Declare ``f(view, **parameters) -> View`` as an effect of the measurement."""
    return _declared("reference", parameters, 1, twins)


def wiring_mistake(*, twins: tuple[str, ...] = ()) -> Callable[[Apply], Effect]:
    """Declare ``f(wiring) -> Wiring`` as a set-up mistake: it is made, or it is not."""
    return _declared("wiring", {}, 1, twins)


def _declared(
    stage: Stage,
    parameters: Mapping[str, Parameter],
    looked_at: int,
    twins: tuple[str, ...],
    quadrature: tuple[str, str] | None = None,
    channels: tuple[str, ...] = (),
    pose: bool = False,
) -> Callable[[Apply], Effect]:
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
        return Effect(name, stage, dict(parameters), apply, doc, twins, quadrature, channels, pose)

    return declare


def after_wheel_effects(
    effects: tuple[AppliedEffect, ...], travel: WheelTravel[Any], drive: Drive[Any]
) -> WheelTravel[Any]:
    """Travel of the wheels once the effects on them have acted, in order."""
    for applied in effects:
        if applied.effect.stage == "wheels" and applied.ready:
            travel = applied.effect.apply(travel, drive, **applied.values)
    return travel


def after_body_effects(
    effects: tuple[AppliedEffect, ...], motion: BodyMotion[Any], drive: Drive[Any]
) -> BodyMotion[Any]:
    """Motion of the body once the effects on it have acted, in order."""
    for applied in effects:
        if applied.effect.stage == "body" and applied.ready:
            motion = applied.effect.apply(motion, drive, **applied.values)
    return motion


def view_of(effects: tuple[AppliedEffect, ...]) -> View:
    """How the reference looks at the robot."""
    view = View()
    for applied in effects:
        if applied.effect.stage == "reference" and applied.ready:
            view = applied.effect.apply(view, **applied.values)
    return view


def wiring_of(effects: tuple[AppliedEffect, ...]) -> Wiring:
    """How the counters are to be read."""
    wiring = Wiring()
    for applied in effects:
        if applied.effect.stage == "wiring":
            wiring = applied.effect.apply(wiring, **applied.values)
    return wiring
