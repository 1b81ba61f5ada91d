# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects named in a robot file, and the values of their parameters.

In the robot file, a parameter of an effect is a line in a block; in ROS its name has a dot,
``eccentric_left_wheel.amplitude``. Both arrive here in the form with the dot.
"""

from __future__ import annotations

import difflib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from werrimbi_odom.effects import lookup
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.errors import InputError, nearest
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter
from werrimbi_odom.files.robot_files.parameters import PARAMETERS
from werrimbi_odom.model.effect import AppliedEffect, Effect

EFFECTS = "effects"
"""Key of the list of effect names."""

Find = Callable[[str], Effect]
"""Find an effect by its name; InputError if unknown."""


@dataclass
class Named:
    """Effects while their values are read."""

    effects: tuple[Effect, ...]
    _values: dict[str, dict[str, float]] = field(init=False)

    def __post_init__(self) -> None:
        self._values = {effect.name: {} for effect in self.effects}

    def take(self, key: str, value: object) -> None:
        """Add the value of ``effect.parameter``.

        InputError if there is no such parameter, or the value is invalid for it.
        """
        name, _, parameter = key.partition(".")
        effect = self.listed(name)
        found = next((item for item in parameters_of(effect) if item.name == key), None)
        if found is None:
            raise InputError(f"{name} has no parameter {parameter}; {_has(effect)}")
        if parameter in self._values[name]:
            raise InputError(f"{key} is given twice")
        self._values[name][parameter] = float(found.checked(value))  # type: ignore[arg-type]

    def listed(self, name: str) -> Effect:
        """The effect of a block.

        InputError if the list of effects does not contain it; the message says what to do.
        """
        for effect in self.effects:
            if effect.name == name:
                return effect
        names = [effect.name for effect in (*self.effects, *LIBRARY)]
        near = nearest(name, names)
        if near and name not in names:
            raise InputError(f"unknown effect {name}{near}")
        raise InputError(
            f"this is a block of parameters for {name}, but effects does not list {name}; "
            "add it to the list, or take the block out"
        )

    def refuse_value(self, name: str, value: object) -> InputError:
        """Error for a value in the place of an effect's block."""
        effect = self.listed(name)
        given = "nothing" if value is None else repr(value)
        if effect.is_mistake:
            return InputError(f"{name} has no parameters; take this line out")
        return InputError(
            f"{name} must be a block of its parameters ({', '.join(effect.parameters)}), "
            f"not {given}"
        )

    def applied(self) -> tuple[AppliedEffect, ...]:
        """The effects in order, with their values; values not given are null or unknown."""
        return tuple(effect.using(**self._values[effect.name]) for effect in self.effects)


def named_effects(names: object, find: Find | None = None) -> Named:
    """Read a list of effect names.

    `names`: value of ``effects:``; None if it is empty. `find`: default: the library and installed
    packages. InputError if it is not a list of names, or a name is unknown or repeated.
    """
    if names is None:
        return Named(())
    if isinstance(names, str) or not isinstance(names, Iterable) or isinstance(names, Mapping):
        raise InputError(f"effects must be a list of names, [] for none, not {names!r}")
    found: dict[str, Effect] = {}
    for name in names:
        if not isinstance(name, str) or not name:
            raise InputError(f"effects must be a list of names, [] for none, not {list(names)!r}")
        if name in found:
            raise InputError(f"effects lists {name} twice; an effect acts once")
        effect = (find or lookup.find)(name)
        if any(item.name == name for item in PARAMETERS):
            raise InputError(f"effect {name} bears the name of another parameter; rename it")
        found[name] = effect
    return Named(tuple(found.values()))


def parameters_of(effect: Effect) -> tuple[NodeParameter, ...]:
    """Parameters of an effect as in a robot file, with dotted names."""
    return tuple(
        NodeParameter(
            f"{effect.name}.{name}",
            float(item.null),
            f"{item.says[:1].upper()}{item.says[1:]}.",
            unit=item.unit,
            minimum=item.bounds[0],
            maximum=item.bounds[1],
        )
        for name, item in effect.parameters.items()
    )


def is_effect_or_near(name: str) -> bool:
    """Whether an unknown key probably means an effect's block."""
    parameters = [item.name for item in PARAMETERS]
    effects = [effect.name for effect in LIBRARY]
    near = difflib.get_close_matches(name, [*parameters, *effects], n=1)
    return bool(near) and near[0] in effects


def _has(effect: Effect) -> str:
    if effect.is_mistake:
        return "it is a set-up mistake, made or not; listing it is enough"
    return f"it has {', '.join(effect.parameters)}"
