# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A candidate effect: one that the model may lack, and the directions away from its null value."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from werrimbi_odom.inference.fitting.free_parameters import STEP
from werrimbi_odom.model.effect import AppliedEffect, Effect
from werrimbi_odom.model.reference_view import View


@dataclass(frozen=True, slots=True)
class Candidate:
    """An effect at its null value, with values for its shape parameters."""

    effect: Effect
    shape: Mapping[str, float]
    """Values of parameters that have no effect while the others are null (a threshold, a
    length)."""
    shared: tuple[str, ...] = ()
    """Per-run parameters that are taken to be the same in all runs."""

    @property
    def name(self) -> str:
        """Name of the effect."""
        return self.effect.name

    @property
    def coordinates(self) -> tuple[Mapping[str, float], ...]:
        """Directions from null, as parameter values one step (`STEP`) away."""
        null = self.effect.nulls | dict(self.shape)
        if self.effect.quadrature is not None:
            amplitude, phase = self.effect.quadrature
            size = STEP * self.effect.parameters[amplitude].scale
            return tuple(null | {amplitude: size, phase: angle} for angle in (0.0, 0.5 * math.pi))
        if self.place is not None:  # as for its first harmonic, which dominates
            return self.round_the_wheel[:: max(len(self.round_the_wheel) // 4, 1)][:2]
        return tuple(
            null | {name: null[name] + STEP * item.scale}
            for name, item in self.effect.parameters.items()
            if not item.tries and not item.as_base
        )

    @property
    def reach(self) -> tuple[float, ...]:
        """Largest physical distance from null along each coordinate, in steps."""
        parameters = self.effect.parameters
        if self.effect.quadrature is not None:
            items = [parameters[self.effect.quadrature[0]]] * 2
        else:
            items = [item for item in parameters.values() if not item.tries and not item.as_base]
        return tuple(item.reach / (STEP * item.scale) for item in items)

    @property
    def place(self) -> str | None:
        """Name of a parameter that is an unknown angle round the wheel, possibly one per run."""
        items = self.effect.parameters
        if sum(not item.tries for item in items.values()) == 1:
            for name, item in items.items():
                if item.per_run and item.tries and name not in self.shape:
                    return name
        return None

    @property
    def round_the_wheel(self) -> tuple[Mapping[str, float], ...]:
        """Directions from null at each trial angle; empty for an effect without such an angle."""
        if self.place is None:
            return ()
        null = self.effect.nulls | dict(self.shape)
        (size,) = (name for name, item in self.effect.parameters.items() if not item.tries)
        step = STEP * self.effect.parameters[size].scale
        tries = self.effect.parameters[self.place].tries
        return tuple(null | {size: step, self.place: angle} for angle in tries)

    @property
    def per_run(self) -> bool:
        """Whether each run has values of its own."""
        return any(
            item.per_run and name not in self.shared
            for name, item in self.effect.parameters.items()
        )

    def with_value(self, coordinate: Mapping[str, float], factor: float) -> AppliedEffect:
        """Effect at `factor` times a coordinate from null."""
        null = self.effect.nulls | dict(self.shape)
        values = {}
        for name, item in self.effect.parameters.items():
            if name == self.place or name == (self.effect.quadrature or (None, None))[1]:
                values[name] = coordinate[name]
                continue
            value = null[name] + factor * (coordinate[name] - null[name])
            values[name] = min(max(value, item.bounds[0]), item.bounds[1])
        return AppliedEffect(self.effect, values)


def names_with(names: Sequence[str], candidate: Candidate) -> tuple[str, ...]:
    """Names of effects, with that of a candidate in place of what it extends."""
    return (*(each for each in names if each != candidate.effect.extends), candidate.name)


def usual_view(effect: Effect) -> View:
    """The view of a reference with an effect of it, of the usual size."""
    usual = {name: item.typical for name, item in effect.parameters.items()}
    view: View = effect.apply(View(), **usual)
    return view
