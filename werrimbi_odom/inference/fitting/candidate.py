# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An effect that a model might be missing, and the directions in which it would leave null."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from werrimbi_odom.inference.fitting.free_parameters import STEP
from werrimbi_odom.model.effect import AppliedEffect, Effect


@dataclass(frozen=True, slots=True)
class Candidate:
    """An effect at null, with values for its shape."""

    effect: Effect
    shape: Mapping[str, float]
    """Values of parameters that do nothing while the others are null (a threshold, a length)."""
    shared: tuple[str, ...] = ()
    """Parameters that each run could have anew, taken to be the same in all of them."""

    @property
    def name(self) -> str:
        """Of the effect."""
        return self.effect.name

    @property
    def coordinates(self) -> tuple[Mapping[str, float], ...]:
        """Directions from null, as values of the effect's parameters one usual size away."""
        null = self.effect.nulls | dict(self.shape)
        if self.effect.quadrature is not None:
            amplitude, phase = self.effect.quadrature
            size = STEP * self.effect.parameters[amplitude].scale
            return tuple(null | {amplitude: size, phase: angle} for angle in (0.0, 0.5 * math.pi))
        if self.place is not None:  # as of its first harmonic, which is most of it
            return self.round_the_wheel[:: len(self.round_the_wheel) // 4][:2]
        return tuple(
            null | {name: null[name] + STEP * item.scale}
            for name, item in self.effect.parameters.items()
            if not item.tries and not item.as_base
        )

    @property
    def place(self) -> str | None:
        """Parameter that is a place round the wheel, not known yet: each run may have its own."""
        items = self.effect.parameters
        if sum(not item.tries for item in items.values()) == 1:
            for name, item in items.items():
                if item.per_run and item.tries and name not in self.shape:
                    return name
        return None

    @property
    def round_the_wheel(self) -> tuple[Mapping[str, float], ...]:
        """Directions from null at each place that is tried; empty for an effect that has none."""
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
        """The effect `factor` times along a coordinate."""
        null = self.effect.nulls | dict(self.shape)
        values = {}
        for name, item in self.effect.parameters.items():
            if name == self.place or name == (self.effect.quadrature or (None, None))[1]:
                values[name] = coordinate[name]
                continue
            value = null[name] + factor * (coordinate[name] - null[name])
            values[name] = min(max(value, item.bounds[0]), item.bounds[1])
        return AppliedEffect(self.effect, values)
