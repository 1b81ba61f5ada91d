# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Laws of two variables: terms of one amount, as the form of an effect file and as a formula."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.drafting.formula import in_a_line, symbols_of
from werrimbi_odom.inference.drafting.law_forms import INDENT, Declared, Form, Seen, wide
from werrimbi_odom.inference.drafting.terms import Term, unit_of_coefficient
from werrimbi_odom.inference.drafting.variable_source import rounded

_NAMES = ("gain", "second_gain", "third_gain")
_MEASURED = {"travel": "speed", "path": "speed", "turn": "yaw_rate"}


class LawOfTwo(NamedTuple):
    """Terms that add up to a share of one amount."""

    amount: Amount
    terms: tuple[Term, ...]
    coefficients: tuple[float, ...]
    gain: float
    """Fall of the whitened squared innovations."""

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of both; with one signal the second is what the error is proportional to."""
        names = dict.fromkeys(self._of_share)
        if len(names) < 2 and self.amount.per in _MEASURED:
            names[_MEASURED[self.amount.per]] = None
        return tuple(names)

    @property
    def name(self) -> str:
        """Name made of its variables; "direction" if it acts only backwards."""
        alone = set(self._of_share) == {"direction"}
        return "direction" if alone else " and ".join(self.variables)

    @property
    def _of_share(self) -> list[str]:
        return [signal.variable for term in self.terms for signal in term.signals]

    @property
    def kind(self) -> str:
        """Kind of the form."""
        return self.terms[0].kind if len(self.terms) == 1 else f"sum of {len(self.terms)} terms"

    def line(self, values: Sequence[float]) -> str:
        """The law as a formula with numbers: sideways = -0.011 * v * w."""
        return in_a_line(self.amount, values, [term.formula.split(" * ") for term in self.terms])

    @property
    def seen(self) -> Seen:
        """Its variables, as seen by a draft."""
        channels = dict.fromkeys(name for term in self.terms for name in term.channels)
        return Seen(
            self.name,
            "",
            lambda side: "",
            per_wheel=any(term.source[0] != term.source[1] for term in self.terms),
            channels=tuple(channels),
        )

    @property
    def form(self) -> Form:
        """Its form for an effect file, with the coefficients of the regression."""
        names = _NAMES[: len(self.terms)]
        declared = []
        for name, term, value in zip(names, self.terms, self.coefficients, strict=True):
            typical = rounded(value) or 1e-6
            declared.append(
                Declared(
                    name,
                    unit_of_coefficient(term, self.amount),
                    0.0,
                    typical,
                    wide(typical),
                    _says(term),
                )
            )
        sums = [f"{name} * {term.formula}" for name, term in zip(names, self.terms, strict=True)]
        symbols = symbols_of(self.amount, " ".join(sums))

        def expression(side: str) -> str:
            number = ("left", "right").index(side)
            parts = [
                f"{name} * {term.source[number]}"
                for name, term in zip(names, self.terms, strict=True)
            ]
            if len(parts) == 1:
                return parts[0]
            lines = f"\n{INDENT * 2}+ ".join(parts)
            return f"(\n{INDENT * 2}{lines}\n{INDENT})"

        return Form(
            self.kind,
            tuple(declared),
            expression,
            f"share = {' + '.join(sums)}{f'  ({symbols})' if symbols else ''}",
            len(self.terms),
        )


def _says(term: Term) -> str:
    """Description of the coefficient of a term."""
    of = term.formula.removesuffix(term.gate).removesuffix(" * ")
    each = f" for each unit of {of}" if of else ""
    return f"share{each}{f' where {term.gate[1:-1]}' if term.gate else ''}"
