# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""All that can be hidden: names, units, realistic strengths."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Literal

import numpy as np

from .geometry import TrackWidth, UnequalWheelRadii, WheelRadiusScale
from .peculiarity import Peculiarity

Rng = np.random.Generator
Kind = Literal["effect", "mistake", "outside"]


class UnknownEffectError(ValueError):
    """There is no such effect to hide."""


@dataclass(frozen=True)
class Entry:
    """One thing that can be hidden.

    Parameters
    ----------
    name : str
    make : callable of (strength, rng)
        Gives the peculiarity; what else it needs, a direction for example, is drawn from `rng`.
    unit : str
        Of the strength.
    low, high : float
        Realistic range of its distance from `null`, drawn evenly in its logarithm.
    says : str
        What it is, in a line.
    null : float
        Strength at which there is no effect.
    signed : bool
        Whether both signs of that distance occur.
    kind : "effect", "mistake" or "outside"
        In the library's vocabulary, a mistake of set-up, or nothing that the library knows.
    """

    name: str
    make: Callable[[float, Rng], Peculiarity]
    unit: str
    low: float
    high: float
    says: str
    null: float = 0.0
    signed: bool = True
    kind: Kind = "effect"

    def draw(self, rng: Rng) -> float:
        """A realistic strength."""
        size = math.exp(rng.uniform(math.log(self.low), math.log(self.high)))
        sign = rng.choice([-1.0, 1.0]) if self.signed else 1.0
        return float(self.null + sign * size)

    @property
    def range_in_words(self) -> str:
        """The realistic strengths, for people."""
        null = f"{self.null:g} " if self.null else ""
        sign = "+/- " if self.signed else ""
        return f"{null}{sign}{self.low:g} to {self.high:g} {self.unit}"


@dataclass(frozen=True)
class Hidden:
    """One effect that was hidden, for truth.json: what, how strong, and its true parameters."""

    entry: Entry
    strength: float
    peculiarity: Peculiarity


CATALOGUE: tuple[Entry, ...] = (
    Entry(
        "track_width",
        lambda strength, rng: TrackWidth(strength),
        "1",
        0.003,
        0.04,
        "true base over believed base",
        null=1.0,
    ),
    Entry(
        "unequal_wheel_radii",
        lambda strength, rng: UnequalWheelRadii(strength),
        "1",
        0.001,
        0.02,
        "right radius over left radius",
        null=1.0,
    ),
    Entry(
        "wheel_radius_scale",
        lambda strength, rng: WheelRadiusScale(strength),
        "1",
        0.002,
        0.03,
        "true radii over believed radius",
        null=1.0,
    ),
)


def find(name: str) -> Entry:
    """The entry called `name`, or an UnknownEffectError that names the nearest one."""
    names = [entry.name for entry in CATALOGUE]
    if name in names:
        return CATALOGUE[names.index(name)]
    near = get_close_matches(name, names, 1)
    hint = f"; did you mean {near[0]}?" if near else ""
    raise UnknownEffectError(f"nothing called {name!r} can be hidden{hint}")


def hide(name: str, strength: float | None = None, *, seed: int, number: int = 0) -> Hidden:
    """Choose the peculiarity of a robot.

    Parameters
    ----------
    name : str
        Of an entry, or "random" for any effect of the library's vocabulary.
    strength : float, optional
        In the entry's unit; drawn from the realistic range if not given.
    seed, number : int
        Of all that is drawn: of the robot, and which of its hidden effects this is.
    """
    rng = np.random.default_rng([seed, number, *name.encode()])
    if name == "random":
        name = str(rng.choice([entry.name for entry in CATALOGUE if entry.kind == "effect"]))
    entry = find(name)
    drawn = entry.draw(rng)
    strength = drawn if strength is None else strength
    return Hidden(entry, strength, entry.make(strength, rng))
