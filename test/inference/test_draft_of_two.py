# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A law of two variables is drafted where drives held out want the second, and nowhere else.

What is hidden is made by the engine, or by laws that are written here by hand.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from test.evidence import in_evidence
from test.hidden.sets import HiddenSet, make, runs_of
from test.inference.driven import run_of
from test.model.drives import ROBOT
from test.soft_tyres import soft_tyres
from werrimbi_odom.effects import LIBRARY
from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.effects.contract.sample_drive import Rehearsal
from werrimbi_odom.effects.functions import limited
from werrimbi_odom.effects.shapes import mean_product, mean_ratio
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.step_jacobians import AMOUNTS, Amount
from werrimbi_odom.inference.drafting.candidate_law import keeps_laws, loaded
from werrimbi_odom.inference.drafting.draft import Draft
from werrimbi_odom.inference.drafting.regression import selections
from werrimbi_odom.inference.drafting.source import source_of
from werrimbi_odom.inference.drafting.terms import terms_of, unit_of_coefficient
from werrimbi_odom.inference.drafting.two_variable_law import LawOfTwo
from werrimbi_odom.inference.drafting.two_variables import best_draft, draft_of_two
from werrimbi_odom.inference.drafting.variable_source import signals_of
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.effect import AppliedEffect, Effect, Parameter, body_effect
from werrimbi_odom.model.robot import Robot

SECONDS, RATE = 60, 20


@body_effect(
    channels=("load_kg",),
    drag=Parameter("rad/m", 0.0, 1e-3, (-0.1, 0.1), "turn per way backwards and kilogram"),
)
def dug_in(motion: Any, drive: Any, drag: float) -> Any:
    """A castor under a load digs in when it is pushed, and pulls the robot round.

    Formula    turn += drag * load * way backwards      [rad]
    Signature  bends backwards, the more the heavier it is loaded
    Ruler      push it back along a line, empty and loaded
    """
    back = limited(motion.along, -np.inf, 0.0)
    return motion._replace(turn=motion.turn + drag * drive.channels["load_kg"].mean * back)


def drives_of(applied: Sequence[AppliedEffect], seeds: Sequence[int]) -> list[Run]:
    """Drives of a robot with an effect; a load and a temperature are measured."""
    truth = replace(ROBOT, effects=tuple(applied))
    return [run_of(truth, seed, SECONDS, _measured(seed)) for seed in seeds]


def _measured(seed: int) -> Mapping[str, np.ndarray]:
    random = np.random.default_rng([seed, 5])
    times = np.arange(SECONDS * RATE + 1) / RATE
    load, warmth = (
        np.interp(times, 6.0 * np.arange(11), random.uniform(*ends, 11))
        for ends in ((0.0, 8.0), (15.0, 40.0))
    )
    return {"load_kg": load, "motor_c": warmth}


def drafted(
    runs: Sequence[Run], held: Sequence[Run], robot: Robot, library: Sequence[Effect]
) -> tuple[Draft, Added]:
    """As `werrimbi draft --force` does."""
    diagnosis = diagnose(runs, robot, library, holdout=held)

    def tried_out(found: Draft) -> Added:
        return add_effects((found.effect,), runs, diagnosis.robot, given=robot, holdout=held)

    return best_draft(diagnosis, tried_out)


def values_of(found: Draft) -> Mapping[str, float]:
    """Of the effect that was drafted."""
    return found.fit.point.model.robot.effects[-1].values


@pytest.mark.parametrize(
    ("hidden", "law", "gain"),
    [
        in_evidence(
            "slide_by_tilt_and_payload=0.04", "sideways = {} * |v| * payload_kg * tilt_rad", -0.04
        ),
        in_evidence(
            "one_tyre_by_load_over_pressure=0.3", "{} * v * payload_kg / {}_tyre_kpa", -0.3
        ),
    ],
)
def test_what_the_engine_hides_in_two_variables_is_drafted(
    hidden: str,
    law: str,
    gain: float,
    tmp_path_factory: pytest.TempPathFactory,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pytest.importorskip("mujoco", reason="hidden sets need the physics engine")
    monkeypatch.setenv("WERRIMBI_HIDDEN", str(tmp_path_factory.mktemp("hidden")))
    folder = make(HiddenSet("outsider", (hidden,), 21, "short"))
    file = read_robot_file(folder / "robot.yaml")
    runs, held = (
        [read_run(path, file) for path in runs_of(folder, part)] for part in ("train", "holdout")
    )
    found, tried = drafted(runs, held, file.robot, LIBRARY)
    assert found.of_two is not None
    assert found.of_two.one is not None, "one variable explains some of it"
    words = law.replace("{}", "").split()
    assert [word for word in words if word not in found.law and word != "_tyre_kpa"] == []
    assert values_of(found) == {"gain": pytest.approx(gain, rel=0.1)}
    check_effect(found.effect)
    sides = found.of_two.held_out
    assert sides is not None
    assert tried.holdout.sides.after == pytest.approx(sides.before)
    assert sides.before < 0.9 * sides.after, "the held-out error is lower than with one variable"


@pytest.mark.evidence
def test_what_acts_backwards_alone_is_drafted_with_its_gate() -> None:
    effect = (dug_in.using(drag=0.01),)
    found, _ = drafted(drives_of(effect, [1, 2, 3]), drives_of(effect, [5]), ROBOT, LIBRARY)
    assert found.of_two is not None
    assert found.of_two.variables == ("load_kg", "direction")
    assert found.form == "gated law"
    # Way backwards is negative travel, or path with the other sign: one law, written in two ways.
    sign = 1.0 if found.claim.amount.per == "travel" else -1.0
    assert values_of(found) == {"gain": pytest.approx(sign * 0.01, rel=0.05)}


@pytest.mark.evidence
def test_lateral_slip_reads_as_a_product_where_no_library_has_it() -> None:
    """Of the yaw rate, in proportion to the way: one variable says it all."""
    (slip,) = (effect for effect in LIBRARY if effect.name == "lateral_slip")
    library = [effect for effect in LIBRARY if effect is not slip]
    truth = (slip.using(creep=0.03),)
    found, _ = drafted(drives_of(truth, [1, 2, 3]), drives_of(truth, [5]), ROBOT, library)
    assert found.of_two is None
    assert found.law == "sideways = -0.03 * v * w"


@pytest.mark.evidence
def test_a_law_of_one_variable_remains_one() -> None:
    effect = (soft_tyres.using(softness=4e-3),)
    found, _ = drafted(drives_of(effect, [1, 2, 3]), drives_of(effect, [5]), ROBOT, [])
    assert found.of_two is None
    assert (found.claim.variable, found.form) == ("load_kg", "line")
    assert found.law.startswith("along = -0.0041 * v * (load_kg - ")


@pytest.mark.parametrize("seed", [20, *(in_evidence(seed) for seed in (10, 30))])
def test_where_nothing_is_hidden_no_law_of_two_is_found(seed: int) -> None:
    runs = drives_of((), [seed, seed + 1, seed + 2])
    diagnosis = diagnose(runs, ROBOT, LIBRARY, holdout=drives_of((), [seed + 3]))
    assert draft_of_two(diagnosis, None) is None


CHANNELS = ("load_kg", "motor_c")


@pytest.mark.parametrize(
    "number",
    [each if each % 3 == 0 else in_evidence(each) for each in range(len(AMOUNTS))],
)
def test_every_term_keeps_the_laws_of_effects(number: int) -> None:
    """Of each amount some of the terms, three at once; of all amounts all terms."""
    amount = AMOUNTS[number]
    terms = terms_of(signals_of(Rehearsal.of(CHANNELS).drive, of_wheels=amount.of_wheels))
    assert {term.kind for term in terms} == {"line", "product", "ratio", "gated law"}
    some = terms[number :: len(AMOUNTS)]
    for begin in range(0, len(some), 3):
        own = tuple(some[begin : begin + 3])
        law = LawOfTwo(amount, own, (1e-3,) * len(own), 1.0)
        source = source_of("drafted", amount, law.seen, law.form, 7, "p = 1e-9")
        assert keeps_laws(loaded(source)), source


def test_a_search_and_an_effect_file_mean_the_same() -> None:
    """Values of the terms are what the file's law makes of a step."""
    amount = Amount("sideways", "duration")
    rehearsal = Rehearsal.of(CHANNELS)
    drive, motion = rehearsal.drive, rehearsal.motion
    for term in terms_of(signals_of(drive, of_wheels=False)):
        law = LawOfTwo(amount, (term,), (1e-3,), 1.0)
        effect = loaded(source_of("drafted", amount, law.seen, law.form, 7, "p = 1e-9"))
        moved = effect.apply(motion, drive, gain=0.01)
        expected = 0.01 * term.values(0) * drive.duration
        assert moved.sideways - motion.sideways == pytest.approx(expected, abs=1e-12), term.formula


def test_units_of_what_is_before_a_term() -> None:
    drive = Rehearsal.of(CHANNELS).drive
    terms = {term.formula: term for term in terms_of(signals_of(drive, of_wheels=False))}
    for formula, amount, unit in (
        ("v", Amount("sideways", "turn"), "s/rad"),
        ("v * w", Amount("heading", "duration"), "s/m"),
        ("w * time", Amount("along", "travel"), "1/rad"),
        ("v * load_kg", Amount("sideways", "travel"), "s/m"),
        ("load_kg * (v < 0)", Amount("heading", "path"), "rad/m"),
        ("load_kg / motor_c", Amount("along", "path"), ""),
    ):
        assert unit_of_coefficient(terms[formula], amount) == unit, formula


def test_means_over_a_step_of_products_and_ratios_are_integrals() -> None:
    part = (np.arange(200_000) + 0.5) / 200_000
    for ends in ((1.0, 3.0, 2.0, 2.001), (1.0, -3.0, 2.0, 9.0), (0.5, 0.7, 90.0, 90.0)):
        one, other = Span(*ends[:2]), Span(*ends[2:])
        first, second = (span.start + span.change * part for span in (one, other))
        assert mean_product(one, other) == pytest.approx(np.mean(first * second), abs=1e-9)
        assert mean_ratio(one, other) == pytest.approx(np.mean(first / second), abs=1e-9)
        arrays = [Span(*(np.array([end]) for end in span)) for span in (one, other)]
        assert mean_ratio(*arrays)[0] == pytest.approx(mean_ratio(one, other), abs=1e-15)


def test_few_of_many_terms_are_selected_and_none_of_noise() -> None:
    random = np.random.default_rng(4)
    columns = random.normal(size=(2000, 60))
    columns[:, 1] += 2.0 * columns[:, 0]  # of two that are alike, the right one
    columns /= np.sqrt(np.sum(columns**2, axis=0))
    noise = random.normal(size=2000)
    target = 20.0 * columns[:, 1] - 15.0 * columns[:, 7] + noise
    square, penalty = columns.T @ columns, 8.0 + 2.0 * np.log(60)
    best = selections(square, columns.T @ target, penalty)[0]
    assert best.terms == (1, 7)
    assert -best.coefficients == pytest.approx([20.0, -15.0], abs=4.0)
    nothing = selections(square, columns.T @ noise, penalty)
    assert max(each.worth(penalty) for each in nothing) < 0.0
    apart = selections(
        square, columns.T @ target, penalty, lambda chosen, one: not {1, 7} <= {*chosen, one}
    )
    assert not {1, 7} <= set(apart[0].terms)
