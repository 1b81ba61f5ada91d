# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Draws what is hidden in a robot: an effect by its name, or any, and its strength."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from .catalogue import CATALOGUE, Entry
from .hidden_effect import Peculiarity, Rng


class WishError(ValueError):
    """What is to be hidden cannot be."""


class UnknownEffectError(WishError):
    """The catalogue has no effect of this name."""


class StrengthError(WishError):
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
    """Draw a hidden effect, of the library if `name` is "random".

    The strength is in the entry's unit, by default drawn from the realistic range. `seed` is that
    of the robot, and `number` that of the effect among its hidden effects.
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


_LIBRARY = sum(entry.kind == "effect" for entry in CATALOGUE)

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


def wished(wishes: Sequence[str], *, seed: int) -> list[Hidden]:
    """Parse each EFFECT or EFFECT=STRENGTH and draw the hidden effects as in `hide`.

    `random` draws none that is hidden already. WishError if a name is unknown or comes twice, or a
    strength is none that a robot can have.
    """
    parted = [wish.partition("=") for wish in wishes]
    names = [name for name, _, _ in parted if name != "random"]
    for name in names:
        if names.count(name) > 1:
            raise WishError(
                f"{name} comes {names.count(name)} times; a robot has it once, with one strength"
            )
    hidden: list[Hidden] = []
    for number, (name, _, strength) in enumerate(parted):
        found = hide(name, _strength(name, strength), seed=seed, number=number)
        while name == "random" and found.entry.name in names:
            if len(names) >= _LIBRARY:
                raise WishError("random finds no further effect: all of the library are hidden")
            number += len(wishes)
            found = hide(name, _strength(name, strength), seed=seed, number=number)
        if name == "random":
            names.append(found.entry.name)
        hidden.append(found)
    return hidden


def _strength(name: str, told: str) -> float | None:
    """Strength that was asked for; None if it is to be drawn."""
    if told and name == "random":
        raise StrengthError("random draws its strength itself; name the effect to give one")
    if not told:
        return None
    entry = find(name)
    try:
        strength = float(told)
    except ValueError:
        raise StrengthError(f"the strength {told!r} of {name} is not a number") from None
    (least, most), unit = entry.possible, entry.unit_in_words
    if not least <= strength <= most:
        raise StrengthError(
            f"the strength of {name} cannot be {strength:g}{unit}: "
            f"a robot can have {least:.3g} to {most:.3g}{unit}"
        )
    return strength
