# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A column of a recording is drafted whatever it is called, and whatever its values are."""

from __future__ import annotations

import numpy as np
import pytest

from werrimbi_odom.effects.contract.sample_drive import Rehearsal
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.diagnosis.variables import Variable
from werrimbi_odom.inference.drafting.candidate_law import keeps_laws, loaded
from werrimbi_odom.inference.drafting.formula import factor_of
from werrimbi_odom.inference.drafting.law_forms import forms_of
from werrimbi_odom.inference.drafting.source import name_of, source_of
from werrimbi_odom.inference.drafting.terms import terms_of
from werrimbi_odom.inference.drafting.variable_source import seen_as, signals_of
from werrimbi_odom.model.drive import Span

COLUMNS = {
    "pressure_pa": lambda random: 101_325.0 + 3.0 * random.normal(size=1000),
    "ros_time": lambda random: 1.7e9 + np.linspace(0.0, 600.0, 1000),
    "bumper": lambda random: (np.arange(1000) % 100 == 0).astype(float),
    "steered": lambda random: np.where(np.arange(1000) % 100 < 50, 1.0, -1.0),
    "Température (°C)": lambda random: 20.0 + 2.0 * random.normal(size=1000),
    'a "load" \\ kg': lambda random: 3.0 + random.normal(size=1000),
}


@pytest.mark.parametrize("name", COLUMNS)
def test_any_column_can_be_drafted_whatever_its_name_and_its_offset(name: str) -> None:
    """Knots and edges beside a large offset were one number, and divided by zero."""
    values = COLUMNS[name](np.random.default_rng(6))
    seen = seen_as(Variable(name, "", values, values, looks_at=(name,)))
    assert seen is not None
    rehearsal, amount = Rehearsal.of((name,)), Amount("left", "travel")
    column = np.resize(values, rehearsal.left.size + 1)
    drive = rehearsal.drive.but(channels={name: Span(column[:-1], column[1:])})
    kinds = []
    for form in forms_of(seen, amount, 0.01):
        effect = loaded(source_of(name_of(amount, name), amount, seen, form, 7, "p = 1e-9"))
        assert effect.channels == (name,)
        assert form.kind != "step" or keeps_laws(effect)
        usual = {key: item.typical for key, item in effect.parameters.items()}
        share = effect.apply(rehearsal.travel, drive, **usual).left / rehearsal.left - 1.0
        assert 5e-3 < np.nanmax(np.abs(share)) < 0.2, form.kind
        assert np.nanmax(share) - np.nanmin(share) > 5e-3, form.kind
        kinds.append(form.kind)
    assert kinds[:2] == ["line", "step"]


@pytest.mark.parametrize("name", ["speed", "time", "direction", "v"])
def test_a_column_with_a_name_of_ours_is_the_column(name: str) -> None:
    values = 5.0 + np.random.default_rng(7).normal(size=1000)
    seen = seen_as(Variable(name, "", values, values, looks_at=(name,)))
    assert seen is not None
    assert seen.channels == (name,)
    assert seen.span("left") == f'drive.channels["{name}"]'
    assert factor_of(Amount("along", "travel"), seen) == f"({name} - {seen.told(seen.middle)})"
    assert {form.kind for form in forms_of(seen, Amount("along", "travel"), 0.01)} == {
        *("line", "step", "curve")
    }
    signals = {each.name: each for each in signals_of(Rehearsal.of((name,)).drive, of_wheels=True)}
    column = signals[f"column_{name}"]
    assert column.channel == name
    assert {"v", "time", "distance"} <= signals.keys()
    assert any(column in term.signals for term in terms_of([*signals.values()]))


@pytest.mark.parametrize(
    ("variable", "named"),
    [
        ("payload_kg", "left_by_payload_kg"),
        ("speed and yaw_rate", "left_by_speed_and_yaw_rate"),
        ("Température (°C)", "left_by_temperature_c"),
        ("m²", "left_by_m2"),
        ("温度", "left_by_column"),
    ],
)
def test_a_draft_has_a_name_that_effects_and_packages_may_have(variable: str, named: str) -> None:
    assert name_of(Amount("left", "travel"), variable) == named
