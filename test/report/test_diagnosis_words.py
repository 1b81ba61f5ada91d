# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Words of a diagnosis and of `add`: costs, what is not shown or not told apart, what to drive."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from test.inference.driven import run_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference.changes.between_drives import changes_between
from werrimbi_odom.inference.diagnosis import estimated_values
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import Value
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.what_is_left import (
    LeftOfLegs,
    NeighbourCorrelation,
    WhatIsLeft,
)
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.for_unexplained_errors import ProposedManoeuvre
from werrimbi_odom.inference.set_up.search import _late
from werrimbi_odom.report.adding.words import _headline
from werrimbi_odom.report.diagnosis import ambiguous, as_json, costs, phrases, tables, words
from werrimbi_odom.report.diagnosis.ambiguous import how_long
from werrimbi_odom.report.diagnosis.costs import by_sizes_alone, cost, whole
from werrimbi_odom.report.diagnosis.document import document_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.phrases import hang_together
from werrimbi_odom.report.diagnosis.reference_remarks import not_shown, or_upside_down
from werrimbi_odom.report.diagnosis.remarks import (
    alike,
    at_bounds_told,
    drowned,
    instead_of_held,
    like_noise,
    nearest,
)
from werrimbi_odom.report.diagnosis.unknown import unknown_words
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.number_format import change_words
from werrimbi_odom.report.terminal import as_text


def told_of(after: float) -> Any:
    """One thing that was found, and another, by a metre of driving."""
    sides = Sides(3.5300e-3, after)
    diagnosis = SimpleNamespace(
        found=("track_width", "reference_delay"),
        ranking=(SimpleNamespace(effect="track_width", holdout=sides),),
        holdout=sides,
    )
    return SimpleNamespace(diagnosis=diagnosis, held_out=(), leg=0.25)


@pytest.mark.parametrize(
    ("after", "one", "all_of_it"),
    [
        (3.5299e-3, "hardly anything on a part put aside for judging", "stays at 3.5 mm"),
        (1.2e-3, "falls from 3.5 mm to 1.2 mm when it is put in", "falls from 3.5 mm to 1.2 mm"),
    ],
)
def test_what_it_costs(after: float, one: str, all_of_it: str) -> None:
    told = told_of(after)
    assert one in " ".join(cost(told, "track_width"))
    assert all_of_it in " ".join(whole(told))


def test_of_spins_on_the_spot_the_fall_of_the_headings_is_told() -> None:
    """A base 5 % off moves no place there; it "cost nothing yet" beside 4 degrees a leg.

    Positions "as good without it" was false of a delay of 0.15 s found together with a lever arm:
    errors were 33 mm with both and 50 mm without the delay.
    """
    told = told_of(3.5301e-3)
    told.diagnosis.headings = (None, Sides(0.07, 0.0035, "rad"))
    (words,) = cost(told, "track_width")
    assert "the heading error falls from 4.01° to 0.20° with all that is found" in words
    assert "alone it does not lower the position error" in words


def test_where_poses_are_rare_the_legs_own_length_is_told() -> None:
    """Two poses a drive of 2.1 m: its error is not that of a metre."""
    told = told_of(1.2e-3)
    sides = Sides(0.124, 0.029, length=2.1)
    told.diagnosis.holdout = told.diagnosis.ranking[0].holdout = sides
    told.leg = 1.0
    (said,) = cost(told, "track_width")
    assert "on each leg of 2.1 m; on a part put aside for judging (legs of 2.1 m)" in said


@pytest.mark.parametrize(
    ("sides", "said"),
    [
        (Sides(0.36, 0.36, length=1.1), "33 % of the way"),
        (Sides(0.08, 0.08, length=1.1), ""),
        (Sides(0.36, 0.36, length=16.0), ""),
        (Sides(0.36, 0.36, "rad", length=1.1), ""),
    ],
)
def test_nothing_is_missing_beside_errors_of_a_third_of_the_way(sides: Sides, said: str) -> None:
    told: Any = SimpleNamespace(diagnosis=SimpleNamespace(holdout=sides), leg=1.0)
    words = " ".join(drowned(told))
    assert said in words if said else not words


@pytest.mark.parametrize(
    ("correlation", "reference", "said"),
    [(0.32, 0.001, True), (0.32, 0.01, False), (-0.32, 0.001, False)],
)
def test_what_skids_is_not_said_to_be_noise(
    correlation: float, reference: float, said: bool
) -> None:
    """A skid steer's headings: 0.9 degrees on a leg were "explained to their noise"."""
    sides = LeftOfLegs(0.016, reference)
    heading = NeighbourCorrelation(correlation, 2e-11)
    left = WhatIsLeft(sides, sides, "rad", {"heading": heading})
    told = alike(SimpleNamespace(left=left))  # type: ignore[arg-type]
    assert bool(told) is said
    assert not said or "correlation +0.32), by 16 times what" in told[0]


def test_what_was_put_aside_and_errs_far_more_is_not_noise_alone() -> None:
    """A half turn by a gyro whose stamps jitter: 4.12° put aside, 0.88° fitted."""
    fitted, aside = (Sides(math.radians(each), math.radians(each), "rad") for each in (0.88, 4.12))
    odd: Any = SimpleNamespace(train=fitted, holdout=aside)
    words = "; on what was fitted they are 0.88°, so they are not noise alone."
    assert [like_noise(odd, noise=noise) for noise in (True, False)] == [words, words]
    odd.holdout = Sides(1.5 * fitted.before, 1.5 * fitted.after, "rad")
    assert like_noise(odd, noise=True) == ", and they look like noise."
    assert like_noise(odd, noise=False) == "."


def test_what_base_and_radii_do_is_no_credit_of_the_effect_that_is_nearest(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Radii 13 % too large, and something unknown besides (a car with rear encoders)."""
    sizes = "both wheels 12.7 % smaller"
    factor, unsure = 0.873, 0.01
    monkeypatch.setattr(costs, "sizes_found", lambda _: sizes)
    monkeypatch.setattr(costs, "best_sizes", lambda _: {"left": (factor, unsure)})
    ranking = [
        SimpleNamespace(effect=name, holdout=Sides(0.103, after))
        for name, after in (("wheel_radius_scale", 0.030), ("reference_heading_delay", 0.024))
    ]
    diagnosis: Any = SimpleNamespace(
        holdout=Sides(0.103, 0.030),
        ranking=ranking,
        explained_by=lambda _: False,
        given=SimpleNamespace(left=1.0),
    )
    told: Any = SimpleNamespace(diagnosis=diagnosis, held_out=(), leg=1.0)
    (said,) = by_sizes_alone(told)
    assert sizes in said
    assert "falls from 103 mm to 30.0 mm" in said
    (said,) = nearest(diagnosis, law_told=True)
    assert "reference_heading_delay: errors are 24.0 mm with it, and 30.0 mm without" in said
    assert "The above explains far more" in said
    (said,) = nearest(diagnosis, law_told=False)  # nothing stands above
    assert said.endswith("without. That is too little to name it.")
    ranking[1].holdout = Sides(0.103, 0.02999)
    assert not nearest(diagnosis, law_told=True)
    factor = 2.1  # wheels exchanged, perhaps, and too few poses to tell
    assert not by_sizes_alone(told)
    factor, unsure = 1.098, 0.089  # a spin of a few legs, by a gyro
    assert not by_sizes_alone(told)
    factor, unsure, diagnosis.holdout = 0.873, 0.01, Sides(0.103, 0.103)
    assert not by_sizes_alone(told)


@pytest.mark.parametrize("headings_alone", [True, False])
def test_a_gyro_sees_no_mark_passed(monkeypatch: pytest.MonkeyPatch, headings_alone: bool) -> None:
    monkeypatch.setattr(phrases, "values_of", lambda *_: {"delay": value(0.1, 0.001)})
    runs = SimpleNamespace(headings_alone=headings_alone)
    told: Any = SimpleNamespace(runs=runs, robot=ROBOT)
    (words,) = phrases.ruler(told, find("reference_delay"), "Check it")
    assert ("spin left, then right" in words) == headings_alone
    assert ("the mark passed" in words) != headings_alone
    assert "expect" in words


def test_a_delay_that_was_looked_for_in_steps_is_told_as_fitted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two Neatos with lossy radios: "0.3 s too late", and a line later 0.84 ± 0.14 s."""
    monkeypatch.setattr(phrases, "values_of", lambda *_: {"delay": value(0.84, 0.14)})
    said = phrases.set_up_words(SimpleNamespace(), _late(0.3, 100.0))  # type: ignore[arg-type]
    assert "the reference's stamps are 0.84 s too late against" in said
    monkeypatch.setattr(phrases, "values_of", lambda *_: {})
    said = phrases.set_up_words(SimpleNamespace(), _late(0.3, 100.0))  # type: ignore[arg-type]
    assert "the reference's stamps are 0.3 s too late against" in said
    assert "by a driver, a network, or two computers' clocks" in said  # a Neato has one computer


def test_what_was_named_is_not_among_what_the_drives_cannot_show() -> None:
    """A base that is 9 % off is seen where one of the usual 2 % would not be."""
    sights = tuple(
        SimpleNamespace(effect=name, hidden=True, shown_by="arcs", needs_more=False)
        for name in ("track_width", "tyre_squash")
    )
    diagnosis = SimpleNamespace(found=("track_width",), runs=SimpleNamespace(tells_noise=True))
    told: Any = SimpleNamespace(diagnosis=diagnosis, sights=sights)
    (said,) = not_shown(told)
    assert "tyre_squash (arcs would show it)" in said
    assert "track_width" not in said


@pytest.mark.parametrize(
    ("kind", "interval", "words"),
    [
        ("absolute", 0.05, "errs by 1.0 mm and 0.11° would: the poses of this one"),
        ("absolute", 0.5, "measures more finely, and more often, does (motion capture)"),
        ("local_map", 0.05, "measures more finely, and more often, does (motion capture)"),
    ],
)
def test_motion_capture_is_not_advised_to_who_has_it(
    kind: str, interval: float, words: str
) -> None:
    time = np.arange(100.0)
    measured, counters = (SimpleNamespace(time=step * time) for step in (interval, 0.05))
    run = SimpleNamespace(counters=counters, measured=measured, intervals=np.ones(99))
    runs = SimpleNamespace(runs=[run], own_axes=False, start=np.zeros((1, 3)))
    noise = SimpleNamespace(xy=np.array([8e-4**2]), yaw=np.array([6e-3**2]))
    point = SimpleNamespace(variances=noise, options=EvaluationOptions(reference_kind=kind))  # type: ignore[arg-type]
    diagnosis = SimpleNamespace(found=(), runs=runs, final=SimpleNamespace(point=point))
    sight = SimpleNamespace(effect="lateral_slip", hidden=True, shown_by=None, needs_more=True)
    (said,) = not_shown(SimpleNamespace(diagnosis=diagnosis, sights=(sight,)))  # type: ignore[arg-type]
    assert words in said


def value(size: float, std: float, *, determined: bool = True) -> Value:
    return Value(size, std, "rad", "an angle", 0.0, determined=determined)


def test_two_that_may_each_be_none_hang_together() -> None:
    assert "hang together" in hang_together([value(0.040, 0.044), value(-0.075, 0.071)])


def test_one_that_is_known_says_it_all() -> None:
    assert hang_together([value(0.040, 0.004), value(-0.075, 0.071)]) == ""
    assert hang_together([value(0.040, 0.044)]) == ""
    assert hang_together([value(0.04, 0.044), value(0.1, 0.2, determined=False)]) == ""


@pytest.mark.parametrize(
    ("own_axes", "verdict", "or_the_floor"),
    [(True, "none", True), (True, "unknown", False), (False, "none", False)],
)
def test_by_scans_a_change_may_be_the_floor_s(
    monkeypatch: pytest.MonkeyPatch, own_axes: bool, verdict: str, or_the_floor: bool
) -> None:
    """A floor's grain was told as a lidar mounted otherwise, and the floor not named at all."""
    monkeypatch.setattr(words, "changes_words", lambda *_: ["In arcs alone it was otherwise."])
    clock = SimpleNamespace(time=(0.0,))
    drives = tuple(SimpleNamespace(name=name, counters=clock) for name in ("arcs", "lines"))
    runs = SimpleNamespace(runs=drives, own_axes=own_axes)
    set_up = SimpleNamespace(findings=(), wrong=())
    diagnosis = SimpleNamespace(
        runs=runs, robot=ROBOT, verdict=verdict, set_up=set_up, of_another_drive=False
    )
    change = SimpleNamespace(surely_from="arcs", from_run="arcs", group="mount", kind="alone")
    told: Any = SimpleNamespace(diagnosis=diagnosis, changes=(change,))
    differ: Any = AdvisedDiagnosis.drives_differ
    told.drives_differ = differ.fget(told)
    steps = NextSteps(again=lambda names: f"werrimbi diagnose {'_'.join(names)}")
    said = " ".join(words._changes(told, steps))
    assert "For what it is now, ask again without arcs:     werrimbi diagnose lines" in said
    assert ("Or the floor is why. What lies on the floor" in said) == or_the_floor
    # Of the mean of two robots a law was drafted, of a place on the floor where one of them drove.
    assert ("so what else is missing is not asked" in said) == (verdict == "unknown")
    if verdict == "unknown":
        assert unknown_words(told, steps) == []


@pytest.mark.parametrize(
    ("minutes", "chance", "says"),
    [
        (3.0, 0.97, "About 3 min of it are enough."),
        (30.0, 0.704, "About 30 min of it tell them apart in 70 % of cases."),
    ],
)
def test_of_a_drive_it_is_said_how_long_and_how_surely_it_tells(
    minutes: float, chance: float, says: str
) -> None:
    move = ProposedManoeuvre("spins", "they differ", "spin", minutes, chance)
    first, then = how_long(move, "werrimbi diagnose")
    assert first == says
    assert then == "Then give that drive to `werrimbi diagnose` together with these."


def test_of_what_is_no_drive_no_minutes_are_said() -> None:
    assert not list(
        how_long(ProposedManoeuvre("push", "one and the same", "push it", 0.0), "werrimbi")
    )


def test_drives_that_no_mount_fits_are_not_said_to_be_lost() -> None:
    """A mower's compass beside its UWB: the reference "is lost, it slides, or sits far away"."""
    runs = []
    for number, angle in enumerate((1.57, 1.57, -1.57, -1.57)):
        run = run_of(ROBOT, number, 30)
        assert run.reference is not None
        turned = replace(run.reference, yaw=run.reference.yaw + angle)
        runs.append(replace(run, reference=turned))
    effects = [find(name) for name in ("track_width", "reference_yaw_offset", "reference_delay")]
    found = diagnose(runs, ROBOT, effects)
    told = AdvisedDiagnosis(found, None, (), changes=changes_between(found, effects))
    words = " ".join(as_text(words_of(told, NextSteps())).split())
    assert "Between run_1 and run_2 the reference came to be mounted otherwise" in words
    assert "No mount of the reference fits all of these drives" in words
    assert "It is lost" not in words
    assert told.drives_differ
    assert document_of(told).title == "Not the same in all of these drives"
    assert not replace(told, changes=()).drives_differ


def test_of_what_could_not_be_judged_no_number_is_told() -> None:
    """A spin that was held again and again, and added by force: nan mm, and nan % higher."""
    added: Any = SimpleNamespace(
        holdout=SimpleNamespace(sides=Sides(math.nan, math.nan), after=SimpleNamespace(leg=1.0)),
        effects=[SimpleNamespace(name="reference_lever_arm")],
        also=(),
        objection="reference_lever_arm cannot be judged",
        set_aside=(),
    )
    said = _headline(added)
    assert "nan" not in said
    assert said.startswith("What reference_lever_arm does to the error of the held-out drives")
    added.holdout.sides = Sides(0.1, 0.05)
    assert "50.00 mm where it was 100 mm (50 % lower" in _headline(added)
    added.set_aside = ("a drive of which a quarter was held out",)
    assert "the error of the held-out part is" in _headline(added)


def test_no_size_is_told_that_the_drives_do_not_determine(monkeypatch: pytest.MonkeyPatch) -> None:
    """One drive of 7 m by positions: a base of 0.373 of the file's, beside the verdict none."""
    sizes = {"base": (0.373, 0.3), "left": (1.002, 0.001), "right": (1.0, 0.0)}
    monkeypatch.setattr(as_json, "best_sizes", lambda _: sizes)
    sound: Any = SimpleNamespace(of_another_drive=None)
    assert as_json._calibration(sound) == {
        "base": {"value": None, "std": None},
        "left": {"value": 1.002, "std": 0.001},
        "right": {"value": 1.0, "std": None},
    }


def test_no_better_reference_is_promised_to_tell_twins_apart() -> None:
    held = {"reference_yaw_offset": ("sideways_drift", "reference_delay")}
    told: Any = SimpleNamespace(
        rivals_of_held=held,
        needless_of_held=("reference_yaw_offset",),
        effect_named=find,
        runs=SimpleNamespace(headings_alone=False),
    )
    twins, others = instead_of_held(told)
    assert "turned by 90 degrees" in twins
    assert "sideways_drift" not in others
    assert "reference_delay or nothing in its place would explain them as well" in others
    assert "measures more often tells them apart" in others


@pytest.mark.parametrize(
    ("value", "other", "told"),
    [
        (0.0996, -0.1003, ("0.0996 ± 0.0010 or -0.1003 ± 0.0010", "m")),
        (0.1003, -0.0996, ("0.1003 ± 0.0010 or -0.0996 ± 0.0010", "m")),
        (0.05, -0.06, ("50.0 ± 1.0 or -60.0 ± 1.0", "mm")),
        (0.05, None, ("50.0 ± 1.0", "mm")),
    ],
)
def test_a_row_of_the_table_has_one_unit(
    value: float, other: float | None, told: tuple[str, str]
) -> None:
    or_else = None if other is None else (other, 1e-3)
    assert tables._told(Value(value, 1e-3, "m", "ahead", 0.0, or_else=or_else)) == told


def test_what_helped_at_its_bound_before_the_arm_was_found_is_no_objection_to_the_arm(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A creep of -0.1 s stood in for a marker beside the axle; beside the arm it was not asked."""
    monkeypatch.setattr(estimated_values, "chance", lambda *_: 0.0)
    creep = find("lateral_slip").using(creep=-0.1)
    wild: Any = SimpleNamespace(
        names=("lateral_slip",),
        total=1.0,
        at_bound=("lateral_slip.creep",),
        point=SimpleNamespace(model=SimpleNamespace(robot=replace(ROBOT, effects=(creep,)))),
    )
    first = SimpleNamespace(tried=(wild,), before=SimpleNamespace(total=2.0), number=1)
    last = SimpleNamespace(tried=(), before=SimpleNamespace(total=0.5), number=1)
    found: Any = SimpleNamespace(found=("reference_lever_arm",), rounds=(first, last))
    assert at_bounds_told(found) == []
    found.rounds = (last, first)
    [told] = at_bounds_told(found)
    assert "creep = -0.1 s" in told


def test_of_twins_the_example_leaves_what_the_node_publishes() -> None:
    """A marker askew and a robot that crabs are one to the reference."""
    told: Any = SimpleNamespace(effect_named=find)
    twins = ["sideways_drift", "reference_yaw_offset"]
    assert ambiguous._to_try(told, twins) == "reference_yaw_offset"
    assert ambiguous._to_try(told, twins[::-1]) == "reference_yaw_offset"
    assert ambiguous._to_try(told, ["track_width"]) == "track_width"


def test_what_errors_go_with_is_told_as_beside_base_and_radii() -> None:
    """Of a wheel 0.2 % larger it was "before anything is put in: nothing", which veers."""
    (said,) = tables._map(SimpleNamespace(depends_on=()))  # type: ignore[arg-type]
    assert as_text([said]).startswith("What the errors go with, base and radii alone put in: ")


def test_by_scans_that_are_mirrored_one_looks_whether_the_lidar_hangs_upside_down() -> None:
    """They were to be told by a yaw that grows, which no scan shows."""
    twins = "wheels_swapped", "reference_mirrored"

    def said(rivals: tuple[str, ...], own_axes: bool) -> list[str]:
        diagnosis: Any = SimpleNamespace(rivals=rivals, runs=SimpleNamespace(own_axes=own_axes))
        return or_upside_down(diagnosis)

    (told,) = said(twins, True)
    assert "should then turn it over, by a roll of 180°" in told
    assert not said(twins, False)
    assert not said(("sideways_drift", "reference_yaw_offset"), True)


@pytest.mark.parametrize(
    ("before", "after", "unit", "words"),
    [
        (4.41e-3, 4.38e-3, "m", "stays at 4.4 mm"),  # three bags: "goes from 4.4 mm to 4.4 mm"
        (4.4e-3, 2.2e-3, "m", "falls from 4.4 mm to 2.2 mm"),
        (0.0035, 0.0047, "rad", "goes from 0.20° to 0.27°"),
    ],
)
def test_what_looks_the_same_stays(before: float, after: float, unit: str, words: str) -> None:
    assert change_words(before, after, unit) == words
