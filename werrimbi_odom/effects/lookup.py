# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Find effects by name: in the library, in installed packages, in files.

A robot file has names of effects, never code. So it can only refer to effects that are installed or
that the user gave on the command line.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import entry_points
from pathlib import Path
from typing import NamedTuple

from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.effects.user_effects import guarded, load_file, words_of
from werrimbi_odom.errors import InputError, nearest
from werrimbi_odom.model.effect import Effect

GROUP = "werrimbi_odom.effects"
"""Entry point group for the effects of a package."""


class Collection(NamedTuple):
    """Available effects, and warnings about unusable ones."""

    effects: tuple[Effect, ...]
    warnings: tuple[str, ...] = ()
    """A line for each installed effect that is left out, with the reason."""

    def find(self, name: str) -> Effect:
        """The effect of this name.

        Raises
        ------
        InputError
            If the name is unknown; the message suggests the nearest known one.
        """
        for effect in self.effects:
            if effect.name == name:
                return effect
        for warning in self.warnings:
            if warning.startswith(f"effect {name} of "):
                raise InputError(f"unknown effect {name}: {warning}")
        names = [effect.name for effect in self.effects]
        raise InputError(
            f"unknown effect {name}{nearest(name, names)} (all: werrimbi explain; one of your own: "
            "give its file with --effects FILE, or pip install its package)"
        )


def all_effects(files: Sequence[Path] = ()) -> Collection:
    """The library, the effects of installed packages, and those of the given files.

    A broken package only gives a warning, so that it does not disable the tool. A broken file is an
    error, because the user named it. An effect of a file replaces one of the same name that is
    installed, which helps the authors of packages, or in a file before it. Whether a law keeps what
    an effect promises is not asked here (`contract.check`).

    Raises
    ------
    InputError
        If a file cannot be used, or has an effect with a name of the library.
    """
    effects = {effect.name: effect for effect in LIBRARY}
    ours = set(effects)
    warnings = []
    for point in sorted(entry_points(group=GROUP), key=lambda point: point.name):
        place = f"effect {point.name} of {_package(point)} ({point.value})"
        try:
            found = point.load()
        except KeyboardInterrupt:
            raise
        except BaseException as error:
            warnings.append(f"{place} is left out: {words_of(error)}")
            continue
        if not isinstance(found, Effect):
            warnings.append(
                f"{place} is left out: it is no effect but a {type(found).__name__}; "
                "is its decorator missing?"
            )
        elif found.name in effects:
            warnings.append(f"{place} is left out: the name {found.name} is taken")
        else:
            effects[found.name] = guarded(found, _package(point))
    source: dict[str, Path] = {}
    for file in files:
        for found in load_file(file):
            if found.name in ours:
                raise InputError(f"{file}: the name {found.name} is taken; give it another")
            if found.name in effects:
                other = (
                    f"that of {source[found.name]}" if found.name in source else "the installed one"
                )
                warnings.append(f"{file}: its {found.name} goes before {other}")
            effects[found.name], source[found.name] = guarded(found, str(file)), file
    return Collection(tuple(effects.values()), tuple(warnings))


def find(name: str) -> Effect:
    """The effect of this name, from the library or an installed package.

    Raises
    ------
    InputError
        If the name is unknown; the message suggests the nearest known one.
    """
    for effect in LIBRARY:
        if effect.name == name:
            return effect
    return all_effects().find(name)


def _package(point: object) -> str:
    distribution = getattr(point, "dist", None)
    return distribution.name if distribution is not None else "an unknown package"
