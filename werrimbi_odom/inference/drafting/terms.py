# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Terms of a law of two variables: products, ratios and gated terms.

A term is a factor of the share. It has values at every step, for the regression, and a source text,
for the effect file. Both are means over the step (`effects.shapes`), so the rate at which counters
are read does not matter. Terms may be added, as each coefficient has its own unit. No term is
divided by a quantity that comes near zero.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from typing import Literal

import numpy as np

from werrimbi_odom.effects.shapes import mean_product, mean_ratio, mean_step, steady
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.drafting.law_forms import unit_of
from werrimbi_odom.inference.drafting.variable_source import Signal
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.pose import Floats

Kind = Literal["line", "product", "ratio", "gated law"]


@dataclass(frozen=True)
class Term:
    """A factor of the share, for the left and the right wheel."""

    kind: Kind
    formula: str
    """As written by hand: v * payload_kg."""
    signals: tuple[Signal, ...]
    source: tuple[str, str]
    """Python code for its mean over a step, for left and right wheel."""
    values: Callable[[int], Floats]
    """The same at every step, (n,), of the left wheel (0) or the right one (1); computed on demand,
    as the arrays of all terms are large."""
    unit: dict[str, int]
    """Exponents of its units."""
    gate: str = ""
    """Condition under which it acts, as in the formula; "" if always."""

    @property
    def variables(self) -> frozenset[str]:
        """Names of the variables in it."""
        return frozenset(signal.variable for signal in self.signals)

    @property
    def channels(self) -> tuple[str, ...]:
        """Extra channels that it reads."""
        return tuple(signal.channel for signal in self.signals if signal.channel is not None)


def terms_of(signals: Sequence[Signal]) -> list[Term]:
    """All terms of the signals of one kind of amount, the simplest first."""
    found = [_line(one) for one in signals]
    found += [
        _product(one, other)
        for one, other in combinations(signals, 2)
        if one.variable != other.variable
    ]
    found += [
        _ratio(one, other)
        for other in signals
        if _clear_of_zero(other)
        for one in signals
        if one.variable != other.variable
    ]
    (speed,) = (signal for signal in signals if signal.name == "v")
    for gate in _gates(speed):
        found.append(gate)
        found += [_gated(one, gate) for one in signals if one.variable != speed.variable]
    return found


def is_of_two(term: Term, amount: Amount) -> bool:
    """Whether no law of one variable says the same.

    Laws of one variable use the size of a speed alone. Per turn, the signed speed makes a product
    of speed and yaw rate.
    """
    return term.kind != "line" or (term.formula == "v" and amount.per == "turn")


def unit_of_coefficient(term: Term, amount: Amount) -> str:
    """Unit of the coefficient of a term: the share's unit over the term's."""
    above, _, below = unit_of(amount).partition("/")
    powers: dict[str, int] = {}
    for name, power in [(above, 1), (below, -1), *((name, -n) for name, n in term.unit.items())]:
        powers[name] = powers.get(name, 0) + power
    powers.pop("", None)
    up = [_power(name, power) for name, power in powers.items() if power > 0]
    down = [_power(name, -power) for name, power in powers.items() if power < 0]
    return "/".join(["*".join(up) or "1", *down]) if up or down else ""


def _power(name: str, power: int) -> str:
    return name if power == 1 else f"{name}^{power}"


def _line(one: Signal) -> Term:
    return Term("line", one.name, (one,), _sources(one), partial(_values, one), one.unit)


def _product(one: Signal, other: Signal) -> Term:
    formula = f"{one.name} * {other.name}"
    unit = _times(one.unit, other.unit, 1)
    if one.spans and other.spans:
        pairs = zip(one.source, other.source, strict=True)
        left, right = (f"mean_product({first}, {second})" for first, second in pairs)
    else:
        pairs = zip(_sources(one), _sources(other), strict=True)
        left, right = (f"{first} * {second}" for first, second in pairs)
    return Term(
        "product",
        formula,
        (one, other),
        (left, right),
        lambda side: mean_product(one.values[side], other.values[side]),
        unit,
    )


def _ratio(one: Signal, other: Signal) -> Term:
    above = one.source if one.spans else tuple(f"steady({source})" for source in one.source)
    pairs = zip(above, other.source, strict=True)
    left, right = (f"mean_ratio({first}, {second})" for first, second in pairs)
    return Term(
        "ratio",
        f"{one.name} / {other.name}",
        (one, other),
        (left, right),
        lambda side: mean_ratio(one.values[side], other.values[side]),
        _times(one.unit, other.unit, -1),
    )


def _gates(speed: Signal) -> Iterator[Term]:
    """Gates: rolling backwards, and above some speeds."""
    left, right = (f"({source} < {-rules.ROLLS_BACKWARDS})" for source in speed.source)
    yield Term(
        "gated law",
        "(v < 0)",
        (replace(speed, variable="direction"),),
        (left, right),
        lambda side: np.asarray(_values(speed, side) < -rules.ROLLS_BACKWARDS, dtype=np.float64),
        {},
        "(v < 0)",
    )
    sizes = np.abs(np.concatenate([_values(speed, side) for side in (0, 1)]))
    moving = sizes[sizes > rules.ROLLS_BACKWARDS]
    for share in rules.GATE_SPEEDS if moving.size else ():
        edge = float(f"{np.quantile(moving, share):.2g}")
        width = float(f"{rules.GATE_WIDTH * float(moving.max()):.1g}")
        left, right = (
            f"mean_step(steady(abs({source})), {edge:g}, {width:g})" for source in speed.source
        )
        yield Term(
            "gated law",
            f"(|v| > {edge:g})",
            (speed,),
            (left, right),
            partial(_above, speed, edge, width),
            {},
            f"(|v| > {edge:g})",
        )


def _above(speed: Signal, edge: float, width: float, side: int) -> Floats:
    return np.asarray(mean_step(steady(np.abs(_values(speed, side))), edge, width))


def _gated(one: Signal, gate: Term) -> Term:
    pairs = zip(_sources(one), gate.source, strict=True)
    left, right = (f"{source} * {opens}" for source, opens in pairs)
    return Term(
        "gated law",
        f"{one.name} * {gate.formula}",
        (one, *gate.signals),
        (left, right),
        lambda side: _values(one, side) * gate.values(side),
        one.unit,
        gate.gate,
    )


def _sources(one: Signal) -> tuple[str, str]:
    """Python code for its mean over a step."""
    left, right = (f"{source}.mean" if one.spans else source for source in one.source)
    return left, right


def _values(one: Signal, side: int) -> Floats:
    return np.asarray(one.values[side].mean)


def _clear_of_zero(other: Signal) -> bool:
    """Whether a signal stays clear of zero, so that it may be divided by."""
    spans: list[Span[Floats]] = list(other.values)
    ends = np.concatenate([end for span in spans for end in span])
    least = float(np.min(ends)) if np.all(ends > 0.0) else -float(np.max(ends))
    return other.spans and least > rules.CLEAR_OF_ZERO * float(np.max(np.abs(ends)))


def _times(one: dict[str, int], other: dict[str, int], power: int) -> dict[str, int]:
    names = dict.fromkeys((*one, *other))
    return {name: one.get(name, 0) + power * other.get(name, 0) for name in names}
