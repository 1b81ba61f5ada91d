# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A castor trails the robot as a trailer does."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from werrimbi_odom.model.castor import PIVOT, PLAY, TRAIL, castor_swings, swing, trailed
from werrimbi_odom.model.compiled import compiled

BASE = 0.35


@settings(max_examples=60, deadline=None)
@given(
    angle=st.floats(-4.0, 4.0),
    along=st.floats(-0.3, 0.3),
    turn=st.floats(-1.5, 1.5),
)
def test_a_step_is_the_solution_of_the_trailers_equation(
    angle: float, along: float, turn: float
) -> None:
    """The contact follows its fork without sliding sideways: the equation, solved by scipy."""

    def rate(_: float, state: np.ndarray) -> list[float]:
        sideways = PIVOT * BASE * turn * math.cos(state[0]) - along * math.sin(state[0])
        return [sideways / (TRAIL * BASE) - turn + PLAY * abs(along) / (TRAIL * BASE)]

    solved = solve_ivp(rate, (0.0, 1.0), [angle], rtol=1e-10, atol=1e-12).y[0, -1]
    assert swing(angle, along, turn, BASE) == pytest.approx(solved - angle, abs=1e-6)


@given(angle=st.floats(-4.0, 4.0), along=st.floats(-0.3, 0.3), turn=st.floats(-1.5, 1.5))
def test_two_halves_of_a_step_are_the_step(angle: float, along: float, turn: float) -> None:
    half = swing(angle, along / 2, turn / 2, BASE)
    both = half + swing(angle + half, along / 2, turn / 2, BASE)
    assert both == pytest.approx(swing(angle, along, turn, BASE), abs=1e-9)


def test_it_trails_in_a_line_and_lies_across_in_a_spin() -> None:
    """Forwards at 0, in a spin near a quarter turn; after a reversal half a turn away."""
    line, spin = np.full(100, 0.01), np.zeros(100)
    along = np.concatenate([line, spin, line, -line])
    turn = np.concatenate([spin, np.full(100, 0.03), spin, spin])
    angles = np.cumsum(castor_swings(along, turn, BASE))
    assert angles[99] == pytest.approx(0.0, abs=1e-3)
    assert angles[199] == pytest.approx(-math.acos(-TRAIL / -PIVOT), abs=1e-2)
    assert angles[299] == pytest.approx(0.0, abs=1e-3)
    assert abs(angles[399]) == pytest.approx(math.pi, abs=1e-3)


def test_it_swings_to_the_side_to_which_the_last_curve_has_left_it() -> None:
    def after(sense: float) -> float:
        along = np.concatenate([np.full(50, 0.01), np.full(100, -0.01)])
        turn = np.concatenate([np.full(50, 0.01 * sense), np.zeros(100)])
        return float(castor_swings(along, turn, BASE).sum())

    assert after(1.0) == pytest.approx(-math.pi, abs=1e-2)
    assert after(-1.0) == pytest.approx(math.pi, abs=1e-2)


def test_compiled_code_gives_the_same_angles() -> None:
    random = np.random.default_rng(3)
    along, turn = random.normal(0.0, 0.01, 2000), random.normal(0.0, 0.02, 2000)
    machine = compiled(trailed)
    if machine is None:
        pytest.skip("numba is not installed, or its cache is not writable")
    swings = [np.empty(2000), np.empty(2000)]
    machine(along, turn, BASE, swings[0])
    trailed(along.tolist(), turn.tolist(), BASE, swings[1])
    np.testing.assert_allclose(*np.cumsum(swings, axis=1), atol=1e-9)
