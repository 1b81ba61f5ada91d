# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Forms of law for a draft: for each form of a dependence its parameters and its lines of code.

A law has two factors: the share (or rate) as a function of the variable, and the quantity that the
error is proportional to. Both are written as Python code for the user to read.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from werrimbi_odom.inference.diagnosis.step_jacobians import Amount

INDENT = "    "
_SQUARED = {"s/m*s/m": "s^2/m^2", "1/m/m": "1/m^2", "1/s/s": "1/s^2", "s^2/m*s^2/m": "s^4/m^2"}


@dataclass(frozen=True, slots=True)
class Declared:
    """A parameter of a draft."""

    name: str
    unit: str
    null: float
    typical: float
    bounds: tuple[float, float]
    says: str
    per_run: bool = False
    tries: tuple[float, ...] = ()
    digits: int = 4
    """Significant digits that tell its values apart."""

    def source(self) -> str:
        """Its declaration as Python code."""
        digits = self.digits
        low, high = (
            f"{value:.{digits - 1}g}" if abs(value) != 3.1415927 else f"{value}"
            for value in self.bounds
        )
        words = [
            f'{INDENT * 2}"{self.unit}"',
            f"null={self.null:.{digits}g}",
            f"typical={self.typical:.{digits}g}",
            f"bounds=({low}, {high})",
        ]
        lines = [", ".join(words) + ",", f'{INDENT * 2}says="{self.says}",']
        if self.per_run:
            lines.append(f"{INDENT * 2}per_run=True,")
        if self.tries:
            tries = ", ".join(f"{value:.{digits}g}" for value in self.tries)
            lines.append(f"{INDENT * 2}tries=({tries},),")
        body = "\n".join(lines)
        return f"{INDENT}{self.name}=Parameter(\n{body}\n{INDENT}),"


@dataclass(frozen=True, slots=True)
class Seen:
    """A variable as an effect reads it in a step."""

    name: str
    unit: str
    span: Callable[[str], str]
    """Python code for its span, by side (left, right); the same for both if it is the robot's."""
    middle: float = 0.0
    """Usual value, at which a linear law is zero."""
    low: float = 0.0
    high: float = 1.0
    per_wheel: bool = False
    from_zero: bool = False
    """Whether zero is a natural origin (a speed, a time)."""
    harmonic: int = 1
    knots: tuple[float, ...] = ()
    waves: bool = False
    per_run: bool = False
    channels: tuple[str, ...] = ()
    """Extra channels that it reads."""
    smooth: str = ""
    """Python code for the span of a change per step (acceleration) in laws that are no line. Unlike
    the changes, their squares do not add up to the same however often counters are read."""
    digits: int = 4
    """Significant digits that tell its values apart."""

    def told(self, value: float) -> str:
        """A value of it in these digits."""
        return f"{value:.{self.digits}g}"


@dataclass(frozen=True, slots=True)
class Form:
    """The share as a function of the variable."""

    kind: str
    parameters: tuple[Declared, ...]
    expression: Callable[[str], str]
    """Python code for the share on a side."""
    formula: str
    numbers: int
    """Number of free parameters."""
    constants: tuple[str, ...] = ()
    quadrature: tuple[str, str] | None = None
    span: str = ""
    """Python code for the span of the variable, where it is not as in `Seen`."""
    needs_span: bool = False
    harmonic: int = 0
    """Harmonic of a wave with a phase of each run; 0 for any other form."""


def unit_per(base: str, per: str) -> str:
    """Unit of a coefficient: that of the share, per unit of the variable."""
    if not per:
        return base
    inverse = {
        "m/s": "s/m",
        "m": "1/m",
        "s": "1/s",
        "rad": "1/rad",
        "rad/s": "s/rad",
        "m/s^2": "s^2/m",
    }.get(per)
    if inverse is None:
        return base
    return inverse if not base else f"{base}*{inverse}".replace("*1/", "/")


def unit_of(amount: Amount) -> str:
    """Unit of the share itself."""
    over = {"travel": "m", "path": "m", "turn": "rad", "duration": "s"}[amount.per]
    own = "rad" if amount.channel == "heading" else "m"
    return "" if own == over else f"{own}/{over}"


def forms_of(seen: Seen, amount: Amount, size: float) -> tuple[Form, ...]:
    """Forms of law in a variable, the simplest first.

    `seen`: the variable. `amount`: error channel, and what the error is proportional to. `size`:
    size of the share, by the evidence.
    """
    if seen.waves:
        return (_wave(seen, amount, size),)
    forms = [_line(seen, amount, size)]
    if seen.from_zero or seen.smooth:
        forms.append(_square(seen, amount, size))
    if seen.smooth or (seen.name == "direction" and not seen.channels):
        return tuple(forms)
    forms.append(_step(seen, amount, size))
    if len(seen.knots) > 2:
        forms.append(_curve(seen, amount, size))
    return tuple(forms)


def wide(typical: float) -> tuple[float, float]:
    """Bounds far beyond what was observed."""
    return (-100.0 * abs(typical), 100.0 * abs(typical))


def _line(seen: Seen, amount: Amount, size: float) -> Form:
    spread = max(seen.high - seen.low, 1e-9)
    slope = 2.0 * size / spread
    unit = unit_per(unit_of(amount), seen.unit)
    constants: tuple[str, ...] = ()
    away = "{}.mean"
    if seen.middle and not seen.from_zero:
        usual = seen.told(seen.middle)
        constants = (f"USUAL = {usual}  # {seen.name} at which the calibration holds",)
        away = "({}.mean - USUAL)"
    says = f"change of the share per {seen.unit or 'unit'} of {seen.name}"
    return Form(
        "line",
        (Declared("slope", unit, 0.0, slope, wide(slope), says),),
        lambda side: f"slope * {away.format(seen.span(side))}",
        f"share = slope * {f'({seen.name} - USUAL)' if constants else seen.name}",
        1,
        constants,
        needs_span=True,
    )


def _square(seen: Seen, amount: Amount, size: float) -> Form:
    growth = 2.0 * size / max(abs(seen.low), abs(seen.high), 1e-9) ** 2
    unit = unit_per(unit_per(unit_of(amount), seen.unit), seen.unit)
    unit = _SQUARED.get(unit, unit)
    says = f"the share where {seen.name} is 1 {seen.unit}"
    return Form(
        "square",
        (Declared("growth", unit, 0.0, growth, wide(growth), says),),
        lambda side: f"growth * mean_square({seen.smooth or seen.span(side)})",
        f"share = growth * {seen.name}^2",
        1,
        span=seen.smooth,
        needs_span=True,
    )


def _step(seen: Seen, amount: Amount, size: float) -> Form:
    low, high = seen.low, seen.high
    tries = tuple(low + part * (high - low) for part in (0.2, 0.35, 0.5, 0.65, 0.8))
    width = 0.05 * (high - low)
    middle = 0.5 * (low + high)
    typical = middle if abs(middle) > width else width
    return Form(
        "step",
        (
            Declared(
                "height",
                unit_of(amount),
                0.0,
                2.0 * size,
                wide(2.0 * size),
                "share above the edge, more than below it",
            ),
            Declared(
                "edge",
                seen.unit,
                typical,
                typical,
                (low - 0.1 * (high - low), high + 0.1 * (high - low)),
                f"{seen.name} at which it sets in",
                tries=tries,
                digits=seen.digits,
            ),
        ),
        lambda side: f"height * mean_step({seen.span(side)}, edge, WIDTH)",
        f"share = height, where {seen.name} > edge",
        2,
        (f"WIDTH = {width:.2g}  # of {seen.name}, over which it sets in",),
        needs_span=True,
    )


def _curve(seen: Seen, amount: Amount, size: float) -> Form:
    knots = seen.knots
    nearest = min(range(len(knots)), key=lambda index: abs(knots[index] - seen.middle))
    names = [f"at_{index + 1}" for index in range(len(knots))]
    free = [index for index in range(len(knots)) if index != nearest]
    heights = ", ".join("0.0" if index == nearest else names[index] for index in range(len(knots)))
    listed = ", ".join(map(seen.told, knots))
    return Form(
        "curve",
        tuple(
            Declared(
                names[index],
                unit_of(amount),
                0.0,
                2.0 * size,
                wide(2.0 * size),
                f"share where {seen.name} is {seen.told(knots[index])}",
            )
            for index in free
        ),
        lambda side: f"mean_curve({seen.span(side)}, KNOTS, ({heights}))",
        f"share = curve through ({heights}) at KNOTS of {seen.name}",
        len(free),
        (f"KNOTS = ({listed})",),
        needs_span=True,
    )


def _wave(seen: Seen, amount: Amount, size: float) -> Form:
    times = f"{seen.harmonic} * " if seen.harmonic > 1 else ""
    unit = unit_of(amount)
    if not seen.per_run:
        parts = [
            Declared(name, unit, 0.0, size, wide(size), f"share times the {name} of {seen.name}")
            for name in ("cosine", "sine")
        ]
        return Form(
            "sine",
            tuple(parts),
            lambda side: (
                f"cosine * mean_cos({seen.span(side)}) + sine * mean_sin({seen.span(side)})"
            ),
            f"share = cosine * cos({seen.name}) + sine * sin({seen.name})",
            2,
            needs_span=True,
        )
    return Form(
        "sine",
        (
            Declared(
                "amplitude", unit, 0.0, size, (0.0, 100.0 * size), "largest share, to and fro"
            ),
            Declared(
                "phase",
                "rad",
                0.0,
                1.0,
                (-3.1415927, 3.1415927),
                "where the wave begins; another one in each drive",
                per_run=True,
            ),
        ),
        lambda side: "amplitude * mean_cos(wave)",
        f"share = amplitude * cos({times}{seen.name} + phase)",
        2,
        quadrature=("amplitude", "phase"),
        needs_span=True,
        harmonic=seen.harmonic,
    )
