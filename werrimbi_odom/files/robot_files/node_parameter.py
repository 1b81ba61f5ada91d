# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One parameter of a node or of the robot file: its type, unit and range."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from werrimbi_odom.errors import InputError

Kind = Literal["float", "integer", "boolean", "string", "strings"]
Value = float | int | bool | str | tuple[str, ...]
_KINDS: Mapping[type, Kind] = {
    float: "float",
    type(None): "float",
    int: "integer",
    bool: "boolean",
    str: "string",
    tuple: "strings",
}


@dataclass(frozen=True, slots=True)
class NodeParameter:
    """One parameter: type, unit, range, and the effect of a wrong value."""

    name: str
    default: Value | None
    """Also defines the type; None: a number that the file must give."""
    says: str
    unit: str = ""
    minimum: float | None = None
    above: float | None = None
    """Exclusive lower bound."""
    maximum: float | None = None
    choices: tuple[str, ...] = ()

    @property
    def kind(self) -> Kind:
        """Type of its values."""
        return _KINDS[type(self.default)]

    def checked(self, value: object) -> Value:
        """Convert a value to this parameter's type.

        InputError if type or range is wrong; the message names the parameter and the remedy.
        """
        if self.kind in ("float", "integer"):
            return self._checked_number(value)
        if self.kind == "boolean":
            if not isinstance(value, bool):
                raise self._wrong(value, "true or false")
            return value
        if self.kind == "string":
            if not isinstance(value, str) or not (value or self.default == ""):
                raise self._wrong(value, "a text")
            if self.choices and value not in self.choices:
                raise self._wrong(value, "one of " + ", ".join(self.choices))
            return value
        if isinstance(value, str) or not isinstance(value, Sequence) or not value:
            raise self._wrong(value, "a list of names")
        if not all(isinstance(item, str) and item for item in value):
            raise self._wrong(value, "a list of names")
        return tuple(value)

    def _checked_number(self, value: object) -> float | int:
        number = "a whole number" if self.kind == "integer" else "a number"
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self._wrong(value, number)
        if isinstance(value, int) and abs(value) > 2**63:
            raise self._wrong(value, number)
        if not math.isfinite(value) or (self.kind == "integer" and value != int(value)):
            raise self._wrong(value, number)
        if self.above is not None and value <= self.above:
            raise self._wrong(value, f"{number} greater than {self.above:g}")
        if self.minimum is not None and value < self.minimum:
            raise self._wrong(value, f"{number} of at least {self.minimum:g}")
        if self.maximum is not None and value > self.maximum:
            raise self._wrong(value, f"{number} of at most {self.maximum:g}")
        if self.choices and str(int(value)) not in self.choices:
            raise self._wrong(value, "one of " + ", ".join(self.choices))
        return int(value) if self.kind == "integer" else float(value)

    def _wrong(self, value: object, wanted: str) -> InputError:
        unit = f" ({self.unit})" if self.unit else ""
        return InputError(f"{self.name} must be {wanted}{unit}, not {value!r}")
