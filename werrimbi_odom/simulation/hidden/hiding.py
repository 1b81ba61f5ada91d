# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Draws what is hidden in a robot: an effect by its name, or any, and its strength."""

from __future__ import annotations

import math
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from .catalogue import CATALOGUE, Entry
from .hidden_effect import Peculiarity, Rng


class UnknownEffectError(ValueError):
    """The catalogue has no effect of this name."""


class StrengthError(ValueError):
    """The strength is outside an effect's range."""


@dataclass(frozen=True)
class Hidden:
    """One hidden effect for truth.json: its entry, strength, and true parameters."""

    entry: Entry
    strength: float
    peculiarity: Peculiarity


def find(name: str) -> Entry:
    """The entry called `name`; otherwise an UnknownEffectError that names the nearest one."""
    names = [entry.name for entry in CATALOGUE]
    if name in names:
        return CATALOGUE[names.index(name)]
    near = get_close_matches(name, names, 1)
    hint = f"; did you mean {near[0]}?" if near else ""
    raise UnknownEffectError(f"nothing called {name!r} can be hidden{hint}")


def hide(name: str, strength: float | None = None, *, seed: int, number: int = 0) -> Hidden:
    """Draw a hidden effect.

    Parameters
    ----------
    name : str
        Name of an entry, or "random" for any effect of the library.
    strength : float, optional
        In the entry's unit; by default drawn from the realistic range.
    seed, number : int
        Seed of the robot, and number of the effect among its hidden effects.
    """
    rng = np.random.default_rng([seed, number, *name.encode()])
    if name == "random":
        name = _any_effect(rng, seed, number)
    entry = find(name)
    drawn = entry.draw(rng)
    strength = drawn if strength is None else strength
    if not math.isfinite(strength) or (entry.null > 0 and strength <= 0):
        raise StrengthError(f"the strength of {entry.name} cannot be {strength:g}")
    return Hidden(entry, strength, entry.make(strength, rng))


FIRST = 21
"""Number of effects when seeds were first recorded."""


def _any_effect(rng: Rng, seed: int, number: int) -> str:
    """A random effect of the library, all with equal probability.

    Each effect added later takes its share of the seeds (reservoir sampling, Vitter 1985); all
    other seeds keep their effects.
    """
    names = [entry.name for entry in CATALOGUE if entry.kind == "effect"]
    chosen = str(rng.choice(names[:FIRST]))
    for place, name in enumerate(names[FIRST:], start=FIRST):
        own = np.random.default_rng([seed, number, *b"random", *name.encode()])
        if own.uniform() < 1.0 / (place + 1):
            chosen = name
    return chosen


def wished(wish: str, *, seed: int, number: int = 0) -> Hidden:
    """Parse EFFECT or EFFECT=STRENGTH and draw the hidden effect as in `hide`.

    Raises
    ------
    UnknownEffectError, StrengthError
        If the name is unknown, or the strength is no number or out of range.
    """
    name, _, strength = wish.partition("=")
    try:
        value = float(strength) if strength else None
    except ValueError:
        raise StrengthError(f"the strength {strength!r} is not a number") from None
    return hide(name, value, seed=seed, number=number)
