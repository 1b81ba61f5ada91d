# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a declaration of an effect says, and what it refuses."""

from __future__ import annotations

import math
from typing import Any

import pytest

from werrimbi_odom.effects import find
from werrimbi_odom.model.effect import Parameter, wheel_effect

AMOUNT = Parameter("m", 0.0, 0.01, (0.0, 0.1), "how much")


def test_function_and_declaration_must_name_the_same_parameters() -> None:
    def creep(travel: Any, drive: Any, much: float) -> Any:
        """Creep."""
        return travel

    with pytest.raises(TypeError, match=r"declares the parameters \(amount\).*takes \(much\)"):
        wheel_effect(amount=AMOUNT)(creep)


def test_it_needs_a_docstring() -> None:
    with pytest.raises(TypeError, match="docstring"):
        wheel_effect()(lambda travel, drive: travel)


def test_a_quadrature_is_of_its_own_parameters() -> None:
    def creep(travel: Any, drive: Any, amount: float) -> Any:
        """Creep."""
        return travel

    with pytest.raises(TypeError, match="quadrature"):
        wheel_effect(quadrature=("amount", "phase"), amount=AMOUNT)(creep)


def test_values_are_checked_and_the_rest_is_null() -> None:
    slip = find("floor_slope")
    assert slip.using(y=0.01).values == {"x": 0.0, "y": 0.01, "x_rate": 0.0, "y_rate": 0.0}
    with pytest.raises(ValueError, match="no parameter z; it has x, y"):
        slip.using(z=1.0)
    for impossible in (1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="must lie between"):
            slip.using(x=impossible)


def test_a_phase_that_each_run_has_anew_stays_unknown_until_given() -> None:
    wheel = find("eccentric_left_wheel")
    assert wheel.using(amplitude=1e-3).unknown == ("phase",)
    assert wheel.using(amplitude=1e-3, phase=0.4).unknown == ()


@pytest.mark.parametrize("phase", [0.3, -2.5, math.pi])
def test_amplitude_and_phase_are_fitted_as_two_parts(phase: float) -> None:
    wheel = find("eccentric_left_wheel")
    parts = wheel.to_fit({"amplitude": 2e-3, "phase": phase})
    assert parts == pytest.approx(
        {"amplitude_cos": 2e-3 * math.cos(phase), "amplitude_sin": 2e-3 * math.sin(phase)}
    )
    assert wheel.from_fit(parts) == pytest.approx({"amplitude": 2e-3, "phase": phase})


def test_without_a_quadrature_the_parameters_are_fitted_themselves() -> None:
    kick = find("castor_kick")
    values = {"angle": 0.1, "alternating": -0.2, "length": 0.05}
    assert kick.from_fit(kick.to_fit(values)) == values
