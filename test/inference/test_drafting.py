# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every form of a draft is an effect: it loads, keeps the laws, and says what it cannot know."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from werrimbi_odom.effects import find
from werrimbi_odom.effects.effect_docstring import page_of
from werrimbi_odom.effects.shapes import mean_curve, mean_square, mean_step
from werrimbi_odom.inference.diagnosis.evidence import Dependence, place_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.result import Diagnosis
from werrimbi_odom.inference.diagnosis.step_jacobians import AMOUNTS, Amount
from werrimbi_odom.inference.diagnosis.variables import Variable, floor_cells
from werrimbi_odom.inference.drafting.candidate_law import (
    Claim,
    LawForm,
    Option,
    keeps_laws,
    loaded,
    planned,
    with_values,
    worth_fitting,
)
from werrimbi_odom.inference.drafting.draft import worth_drafting
from werrimbi_odom.inference.drafting.formula import factor_of
from werrimbi_odom.inference.drafting.law_forms import Seen, forms_of
from werrimbi_odom.inference.drafting.source import source_of
from werrimbi_odom.inference.drafting.spot import spot_form
from werrimbi_odom.inference.drafting.variable_source import seen_as
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.report.diagnosis.dependence import dependence_words

SPEED = Seen(
    "speed",
    "m/s",
    lambda side: "steady(abs(drive.speed.end))",
    high=0.7,
    from_zero=True,
    knots=(0.05, 0.2, 0.4, 0.6),
)
HEADING = Seen("heading", "rad", lambda side: "drive.heading", waves=True)
ANGLE = Seen(
    "left_wheel_angle_twice",
    "rad",
    lambda side: "drive.left_angle",
    waves=True,
    per_run=True,
    harmonic=2,
)
TIME = Seen(
    "time", "s", lambda side: "drive.time", high=15.0, from_zero=True, knots=(1.0, 5.0, 9.0)
)


PAYLOAD = Seen(
    "payload_kg",
    "",
    lambda side: 'drive.channels["payload_kg"]',
    middle=3.0,
    low=1.5,
    high=4.5,
    knots=(1.5, 3.0, 4.5),
    channels=("payload_kg",),
)

ACCELERATION = Seen(
    "acceleration",
    "m/s^2",
    lambda side: "steady(drive.speed.change / drive.duration)",
    middle=0.001,
    low=-0.8,
    high=0.9,
    smooth="steady(0.5 * (drive.left_acceleration + drive.right_acceleration))",
)

SENSES = np.array([-1.0, 1.0, 1.0])
DIRECTION = seen_as(Variable("direction", "", SENSES, SENSES, looks_at=("speed", "direction")))
assert DIRECTION is not None


@pytest.mark.parametrize(
    ("seen", "amount"),
    [
        pytest.param(seen, amount, marks=[pytest.mark.evidence] * ((row + column) % 6 > 0))
        for row, seen in enumerate((SPEED, HEADING, TIME, PAYLOAD, ACCELERATION, DIRECTION))
        for column, amount in enumerate(AMOUNTS)
    ],
    ids=lambda item: item.name if isinstance(item, Seen) else f"{item.channel}-{item.per}",
)
def test_every_form_keeps_the_laws(seen: Seen, amount: Amount) -> None:
    """Each variable and each amount; each with each in `make evidence`."""
    for form in forms_of(seen, amount, 0.01):
        effect = loaded(source_of("drafted", amount, seen, form, 7, "p = 1e-9"))
        assert keeps_laws(effect), form.kind
        assert "cannot say" in " ".join(page_of(effect).physics)


def test_a_wave_has_a_phase_of_each_drive() -> None:
    (form,) = forms_of(ANGLE, Amount("left", "travel"), 0.01)
    effect = loaded(source_of("drafted", Amount("left", "travel"), ANGLE, form, 7, "p = 1e-9"))
    assert keeps_laws(effect)
    assert effect.quadrature == ("amplitude", "phase")
    assert effect.parameters["phase"].per_run


def test_a_spot_of_the_floor_keeps_the_laws() -> None:
    form = spot_form([(1.0, 0.5)], (0.4,), -0.1, 0.175)
    seen = Seen("position", "m", lambda side: "")
    effect = loaded(source_of("drafted", Amount("along", "travel"), seen, form, 7, "p = 1e-9"))
    assert keeps_laws(effect)


def test_means_over_a_step_are_integrals() -> None:
    start, end = 0.3, 2.1
    fine = np.linspace(start, end, 200_001)
    middle = 0.5 * (fine[1:] + fine[:-1])
    knots, heights = (0.5, 1.0, 2.0), (1.0, -2.0, 0.5)
    span = Span(start, end)
    for mean, values in (
        (mean_square(span), middle**2),
        (mean_curve(span, knots, heights), np.interp(middle, knots, heights)),
        (mean_step(span, 1.2, 0.2), np.clip((middle - 1.1) / 0.2, 0.0, 1.0)),
    ):
        assert mean == pytest.approx(float(np.mean(values)), abs=1e-9)


def test_a_place_is_told_finer_than_the_floors_cells() -> None:
    random = np.random.default_rng(3)
    x, y = random.uniform(-1.5, 1.5, (2, 20_000))
    lost = np.where(np.hypot(x - 0.45, y - 0.15) < 0.4, -0.1, 0.0)
    cells = floor_cells(x, y)
    coefficients = cells.T @ lost / cells.sum(axis=0)
    variable = Variable("position", "m", x, y, "place", ("x", "y"))
    cell = Dependence(Amount("along", "travel"), variable, "place", coefficients, 1.0, 1, 0.0)
    at_x, at_y = place_of(cell)
    assert np.hypot(at_x - 0.45, at_y - 0.15) < 0.12
    assert f"about x {at_x:.1f} m, y {at_y:.1f} m" in dependence_words(cell)


def test_an_error_per_turn_is_where_the_robot_turned() -> None:
    """Where it drove straight the error per radian is anything: that was told as its place."""
    random = np.random.default_rng(4)
    x, y = random.uniform(-1.5, 1.5, (2, 20_000))
    turned = np.where((x > 0.0) & (y > 0.0), 1e-6, 0.05)
    cells = floor_cells(x, y)
    known = cells.T @ turned**2
    lost = cells.T @ np.where(np.hypot(x + 0.75, y + 0.75) < 0.3, -0.1, 0.0) / cells.sum(axis=0)
    coefficients = lost + np.sqrt(1e-6 / known) * random.standard_normal(known.size)
    variable = Variable("position", "m", x, y, "place", ("x", "y"))
    amount = Amount("along", "turn")
    cell = Dependence(amount, variable, "place", coefficients, 1.0, 1, 0.0, shares=(turned, turned))
    at_x, at_y = place_of(cell)
    assert np.hypot(at_x + 0.75, at_y + 0.75) < 0.25


def test_what_no_law_can_be_written_of_is_no_draft() -> None:
    """A heading that goes with the place on the floor was proposed, and hid what can be drafted."""
    random = np.random.default_rng(5)
    x, y = random.uniform(-1.5, 1.5, (2, 2000))
    place = Variable("position", "m", x, y, "place", ("x", "y"))
    speed = Variable("speed", "m/s", np.abs(x), np.abs(x), looks_at=("speed",))
    cells = [
        Dependence(Amount(channel, per), seen, seen.form, np.ones(8), gain, 8, 1e-9)
        for channel, per, seen, gain in (
            ("heading", "turn", place, 300.0),
            ("sideways", "turn", speed, 90.0),
        )
    ]

    def drafted(*left: Dependence) -> list[Dependence]:
        return worth_drafting(cast(Diagnosis, SimpleNamespace(remaining=left)))

    assert drafted(*cells) == cells[1:]
    assert not drafted(cells[0])


def test_a_square_of_turns_to_one_side_is_of_a_usual_size() -> None:
    """The largest yaw rate of a robot that only turned right is zero, and was divided by."""
    rates = -np.abs(np.random.default_rng(8).normal(size=1000))
    seen = seen_as(
        Variable("yaw_rate", "rad/s", rates, rates, looks_at=("yaw_rate", "castor_angle"))
    )
    assert seen is not None
    forms = {form.kind: form for form in forms_of(seen, Amount("heading", "turn"), 0.01)}
    (growth,) = forms["square"].parameters
    assert 1e-3 < growth.typical < 0.1


def test_what_reports_show_of_a_law_has_its_constants() -> None:
    for form in forms_of(PAYLOAD, Amount("left", "travel"), 0.01):
        source = source_of("drafted", Amount("left", "travel"), PAYLOAD, form, 7, "p = 1e-9")
        law = source.partition("\n\n\n")[2]
        assert law.startswith(
            {"line": "USUAL = 3", "step": "WIDTH = 0.15"}.get(form.kind, "KNOTS = ")
        )
        assert "\n\n\n@wheel_effect(" in law


def test_a_usual_value_below_zero_is_added_in_a_formula() -> None:
    cold = replace(PAYLOAD, name="outside", middle=-5.2)
    assert factor_of(Amount("left", "travel"), cold) == "(outside + 5.2)"


def test_one_drive_shows_and_several_show() -> None:
    (form, *_) = forms_of(SPEED, Amount("left", "travel"), 0.01)
    for drives, said in ((1, "one drive shows"), (2, "2 drives show")):
        source = source_of("drafted", Amount("left", "travel"), SPEED, form, drives, "p = 1e-9")
        assert f"That is what {said} (p = 1e-9)" in source


def test_a_spot_is_where_it_is_on_a_map_too() -> None:
    """Places were written in four digits, which is a metre beyond a kilometre."""
    form = spot_form([(501_234.567, -47.25)], (0.4,), -0.1, 0.175)
    seen = Seen("position", "m", lambda side: "")
    effect = loaded(source_of("drafted", Amount("along", "travel"), seen, form, 7, "p = 1e-9"))
    assert keeps_laws(effect)
    assert effect.parameters["x"].tries == (501_234.567,)
    assert effect.parameters["y"].tries == (-47.25,)
    low, high = effect.parameters["x"].bounds
    assert low < 0.0 < 501_234.567 < high


def a_law(name: str, excess: float, lawful: bool = True) -> LawForm:
    (form, *_) = forms_of(SPEED, Amount("left", "travel"), 0.01)
    claim = Claim(Amount("left", "travel"), name, 1e-9)
    return LawForm(claim, SPEED, form, find("tyre_squash"), "", lambda: lawful, excess=excess)


def test_a_form_that_is_no_effect_does_not_push_out_those_that_are() -> None:
    no_effect, best, near = a_law("a", 900.0, lawful=False), a_law("b", 100.0), a_law("c", 90.0)
    assert worth_fitting([no_effect, best, near, a_law("d", 10.0)]) == [no_effect, best, near]
    assert worth_fitting([no_effect]) == []


def test_a_draft_beside_an_earlier_one_has_a_name_of_its_own() -> None:
    (form, *_) = forms_of(SPEED, Amount("left", "travel"), 0.01)

    def named(*held: str) -> str:
        robot = SimpleNamespace(effects=[SimpleNamespace(name=name) for name in held])
        point = SimpleNamespace(model=SimpleNamespace(robot=robot))
        diagnosis = SimpleNamespace(
            final=SimpleNamespace(point=point), runs=SimpleNamespace(runs=[None])
        )
        claim = Claim(Amount("left", "travel"), "speed", 1e-9)
        return planned(cast(Diagnosis, diagnosis), claim, SPEED, form).effect.name

    assert named() == "left_by_speed"
    assert named("left_by_speed") == "left_by_speed_2"
    assert named("left_by_speed", "left_by_speed_2") == "left_by_speed_3"


def test_a_spot_too_slippery_for_the_contract_keeps_its_fitted_place() -> None:
    """Else whoever adds it fits each trial place anew: ten times as long as the draft."""
    form = spot_form([(1.0, 0.5), (1.2, 0.5)], (0.2, 0.4), -0.1, 0.175)
    nothing = SimpleNamespace(point=SimpleNamespace(model=_robot_with()))
    diagnosis = cast(Diagnosis, SimpleNamespace(final=nothing, runs=SimpleNamespace(runs=[None])))
    seen = Seen("position", "m", lambda side: "")
    plan = planned(diagnosis, Claim(Amount("along", "travel"), "position", 1e-9), seen, form)
    applied = plan.effect.using(share=-0.25, x=0.9, y=0.6, radius=0.45)
    fit = SimpleNamespace(point=SimpleNamespace(model=_robot_with(applied)))
    found = with_values(diagnosis, Option(plan, cast(Fitted, fit))).effect.parameters
    assert [found[name].tries for name in ("x", "y", "radius")] == [(0.9,), (0.6,), (0.45,)]
    assert found["share"].typical == -0.1


def _robot_with(*effects: AppliedEffect) -> SimpleNamespace:
    return SimpleNamespace(robot=SimpleNamespace(effects=effects))
