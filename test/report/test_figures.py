# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the figures show of the physics, read from the figures themselves."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import AMPLITUDE, PLAIN, eccentric_run

from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.comparison.compare import Comparison, compare
from werrimbi_odom.inference.comparison.dead_reckoning import covariance_along
from werrimbi_odom.inference.comparison.over_variable import once_a_turn, over_a_turn, wheel_errors
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.response_curve import before_after, parts_of, response
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.events.events import Events, Way
from werrimbi_odom.inference.manoeuvres.ideal_drives import pace_of
from werrimbi_odom.inference.manoeuvres.library import MANOEUVRES
from werrimbi_odom.model.effect import Sketch
from werrimbi_odom.model.effect_declarations import DRAWINGS
from werrimbi_odom.report import sketches
from werrimbi_odom.report.adding.document import error_falling_figure, steps_of
from werrimbi_odom.report.calibration.document import leg_figure
from werrimbi_odom.report.comparison.figures import legs_by_motion_figure, nees_figure
from werrimbi_odom.report.comparison.measured_path_figure import path_figure
from werrimbi_odom.report.comparison.over_variable import error_against_figure, variables_of
from werrimbi_odom.report.diagnosis.evidence_figures import (
    before_after_figure,
    best_by_name,
    best_cells,
    evidence_map_figure,
)
from werrimbi_odom.report.diagnosis.figures import manoeuvre_figure, ranking_figure
from werrimbi_odom.report.events import over_time
from werrimbi_odom.report.path_figure import PathDrawing
from werrimbi_odom.report.path_figure import path_figure as drawn_path
from werrimbi_odom.report.sketches import effect_sketch
from werrimbi_odom.report.style import FEWEST, MARKS, MOST, along_path

RELATIVE = 1e3 * AMPLITUDE / PLAIN.wheel_radius
"""How much more or less than its radius says an eccentric wheel rolls, at the most [mm/m]."""


def test_an_eccentric_wheel_shows_its_sine_over_its_turn_and_then_a_flat_line(
    diagnosis: Diagnosis,
) -> None:
    found = before_after(diagnosis)
    assert found is not None
    assert found.effect == "eccentric_left_wheel"
    assert found.cell.channel == "left"
    assert found.after is not None
    wave = np.sin(found.before.centre)
    before, after = (
        1e3 * np.sum(wave * each.value) / np.sum(wave**2) for each in (found.before, found.after)
    )
    assert before == pytest.approx(RELATIVE, rel=0.1)
    assert abs(after) < 0.1 * RELATIVE
    rest = 1e3 * found.before.value - before * wave
    assert np.std(rest) < 0.2 * RELATIVE
    assert len(before_after_figure(found).data) == 2


def test_parts_in_which_nothing_was_driven_are_left_out(diagnosis: Diagnosis) -> None:
    """A heading error in proportion to the turn: next to no turn says nothing of it."""
    runs, fit = diagnosis.runs, diagnosis.final
    drive = runs.drive(diagnosis.robot)
    rate = drive.yaw_rate.end
    edges = parts_of(rate, rate, turns=False)
    found = response(runs, fit.point, (), Amount("heading", "turn"), (rate, rate), edges)
    assert 2 < found.centre.size <= edges.size - 1
    assert found.std.max() <= 10.0 * np.median(found.std) * 1.5
    assert np.abs(found.value / found.std).max() < 5.0


def test_error_bars_of_a_flat_line_hold_zero_as_often_as_they_say(diagnosis: Diagnosis) -> None:
    found = before_after(diagnosis)
    assert found is not None
    assert found.after is not None
    outside = np.abs(found.after.value) > 3.0 * found.after.std
    assert outside.sum() <= 1


def test_a_figure_has_the_name_of_an_effect_whose_variable_it_shows(diagnosis: Diagnosis) -> None:
    """Headings over the travel since a reversal stood under the name of a lever arm."""
    first = replace(diagnosis, found=("reference_lever_arm", *diagnosis.found))
    found = before_after(first)
    assert found is not None
    assert found.effect == "eccentric_left_wheel"
    assert before_after(replace(diagnosis, found=("reference_lever_arm",))) is None


def test_the_comparison_sees_the_same_sine_in_each_drive(comparison: Comparison) -> None:
    """From the raw intervals of the reference, with no fit but a division."""
    for index in range(len(comparison.runs)):
        parts = over_a_turn(*wheel_errors(comparison, index, -1))
        centre, mean, _ = parts
        phase = 0.3 * (index + 1)
        wave = np.sin(np.radians(centre) + phase)
        assert np.sum(wave * mean) / np.sum(wave**2) == pytest.approx(RELATIVE, rel=0.2)
        amplitude, std, _ = once_a_turn(*parts)
        assert amplitude == pytest.approx(RELATIVE, abs=4.0 * std)
        other, std, _ = once_a_turn(*over_a_turn(*wheel_errors(comparison, index, 1)))
        assert other < 5.0 * std


def test_the_strongest_field_of_the_evidence_map_is_the_left_wheels_angle(
    diagnosis: Diagnosis,
) -> None:
    heat = evidence_map_figure(diagnosis.depends_on, opens="cell").data[0]
    row, column = np.unravel_index(np.nanargmax(heat.z), np.shape(heat.z))
    assert heat.y[row] == "left"
    assert tuple(heat.customdata[row][column]) == ("left", "left_wheel_angle", "cell", 0)


def test_the_workbench_chooses_the_dependence_that_the_page_chooses(diagnosis: Diagnosis) -> None:
    """However small the chances of two forms are: of two that are 0, the stronger one."""
    cell = diagnosis.depends_on[0]
    simple = replace(cell, p_value=0.0, gain=3000.0, degrees=2)
    strong = replace(cell, p_value=0.0, gain=5000.0, degrees=4)
    (of_page,) = best_cells([simple, strong]).values()
    (of_tab,) = best_by_name([simple, strong]).values()
    assert of_tab is of_page
    assert of_page is strong


def test_the_ranking_shows_what_the_diagnosis_says(diagnosis: Diagnosis) -> None:
    fit, held_out = ranking_figure(diagnosis).data
    first = diagnosis.ranking[0]
    assert first.holdout is not None
    gain = 100.0 * (1.0 - first.holdout.after / first.holdout.before)
    assert held_out.x[0] == pytest.approx(gain)
    assert held_out.customdata[0] == "eccentric_left_wheel"
    assert len(fit.x) == len(held_out.x)


def test_the_error_falls_to_the_floor(added: Added) -> None:
    steps = steps_of(added)
    assert [step.name for step in steps] == ["as given", "calibrated", "+ eccentric_left_wheel"]
    assert steps[-1].holdout < 0.7 * steps[0].holdout
    assert steps[-1].holdout == pytest.approx(added.noise_alone(added.holdout), rel=0.25)
    fit, held_out = error_falling_figure(steps, added.noise_alone(added.holdout)).data[:2]
    assert [*held_out.y] == pytest.approx([1e3 * step.holdout for step in steps])
    assert [*fit.y] == pytest.approx([1e3 * step.train for step in steps])


def test_an_ellipse_grows_along_the_way_and_begins_with_the_references_noise(
    comparison: Comparison,
) -> None:
    covariance = covariance_along(comparison, 0)
    size = np.sqrt(np.linalg.eigvalsh(covariance)[:, -1])
    noise = comparison.prepared.noises[0][1]
    assert covariance.shape == (comparison.paths[0].measured.size, 2, 2)
    assert size[0] == pytest.approx(noise.sigma_xy, rel=0.05)
    assert size[-1] > 5.0 * size[0]


def points_and_marks(figure: Any) -> tuple[int, int]:
    """Corners of lines, and marks, each of which is an element of the page."""
    points = marks = 0
    for trace in figure.data:
        if trace.x is None or trace.type != "scatter":
            continue
        points += len(trace.x)
        marks += len(trace.x) if "markers" in trace.mode else 0
    return points, marks


@pytest.mark.evidence
def test_every_leg_is_counted_and_few_are_drawn() -> None:
    """A quarter of an hour: more legs than a mark each is worth, all in the means."""
    found = compare([eccentric_run("long", 5, 15.0)], PLAIN, EvaluationOptions(leg=0.05))
    assert found.legs.run.size > 5 * MARKS
    for figure in (
        path_figure(found),
        legs_by_motion_figure(found),
        nees_figure(found),
        *(error_against_figure(found, name) for name in variables_of(found)),
    ):
        points, marks = points_and_marks(figure)
        assert points < 3 * MOST
        assert marks < 2 * MARKS
    _, means, *_ = error_against_figure(found, "speed [m/s]").data
    assert sum(means.customdata) == int((~found.legs.outlier).sum())


def test_a_calibrations_median_is_of_all_legs_though_few_are_drawn() -> None:
    errors = np.random.default_rng(3).normal(0.0, 0.01, (20 * MARKS, 2))
    figure = leg_figure(errors, 0.5 * errors)
    assert points_and_marks(figure)[1] <= MARKS
    median = 1e3 * np.median(np.hypot(*errors.T))
    assert figure.data[0].name == f"before: median {median:.1f} mm"
    largest = 1e3 * np.abs(errors[:, 0]).max()
    assert np.abs(figure.data[0].x).max() == pytest.approx(largest), "the worst are never left out"


@pytest.mark.parametrize("most", [FEWEST, MOST])
def test_a_long_path_keeps_its_ends_and_few_points(most: int) -> None:
    """Standing still for half of the time, too."""
    way = np.concatenate([np.linspace(0.0, 9.0, 50_000), np.full(50_000, 9.0)])
    places = np.exp(1j * way)
    kept = along_path(places, most)
    assert 0.9 * most <= kept.size <= most + 2
    assert {0, places.size - 1} <= set(kept.tolist())
    assert np.abs(np.diff(places[kept])).max() < 2.0 * 9.0 / most


@pytest.mark.parametrize("gains", [(40.0, 15.0), (-60.0, -300.0)])
def test_no_text_of_the_ranking_lies_on_the_effects_names(
    diagnosis: Diagnosis, gains: tuple[float, float]
) -> None:
    """A bar to the left has its text to the right of zero."""
    ranked = tuple(
        replace(item, holdout=Sides(1.0, 1.0 - gain / 100.0), train=None)
        for item, gain in zip(diagnosis.ranking, gains, strict=False)
    )
    figure = ranking_figure(replace(diagnosis, ranking=ranked))
    low, high = figure.layout.xaxis.range
    assert low <= 0.0 < high
    beyond = [text for text in figure.data[1].text if text]
    assert len(beyond) == sum(gain > 0.0 for gain in gains)
    assert all(note.x == 0.0 and note.xanchor == "left" for note in figure.layout.annotations)
    assert len(figure.layout.annotations) == sum(gain < 0.0 for gain in gains)


def test_the_path_of_a_fast_reference_keeps_its_end_and_few_points() -> None:
    """Motion capture sends as many poses in an hour as would make a page too large to open."""
    way = np.linspace(0.0, 1.0, 200_000)
    still = np.zeros((2, 2, 2))
    figure: Any = drawn_path(PathDrawing(np.array([0.0, 1.0]), np.zeros(2), still, way, 0.0 * way))
    shown = {trace.name: trace for trace in figure.data}
    assert shown["measured"].x.size <= MOST + 2
    assert shown["measured"].x[-1] == shown["measured end"].x[0] == 1.0


def test_a_gyro_has_no_measured_path() -> None:
    ends, nothing = np.array([0.0, 1.0]), np.full(9, np.nan)
    drawing = PathDrawing(ends, ends, np.zeros((2, 2, 2)), nothing, nothing)
    figure: Any = drawn_path(drawing)
    assert not [trace.name for trace in figure.data if "measured" in trace.name]


def test_all_figures_are_json_without_surprises(comparison: Comparison) -> None:
    for figure in (path_figure(comparison), nees_figure(comparison)):
        assert "NaN" not in json.dumps(json.loads(figure.to_json()), allow_nan=False)


@pytest.mark.parametrize("effect", LIBRARY, ids=lambda effect: effect.name)
def test_every_effect_of_the_library_has_a_sketch(effect) -> None:  # type: ignore[no-untyped-def]
    from xml.etree import ElementTree

    sketch = effect_sketch(effect)
    assert sketch is not None
    root = ElementTree.fromstring(sketch)
    assert root.get("aria-label", "").startswith(effect.name)
    assert len(root) > 3


def test_an_effect_that_declares_no_sketch_has_none() -> None:
    assert effect_sketch(replace(LIBRARY[0], sketch=None)) is None


def test_every_drawing_can_be_asked_for_with_its_labels() -> None:
    assert DRAWINGS.keys() == sketches.DRAWINGS.keys()
    for name, count in DRAWINGS.items():
        sketch = Sketch(name, "what it shows", "a caption", ("left", "right")[:count])
        drawn = effect_sketch(replace(LIBRARY[0], sketch=sketch))
        assert drawn is not None
        assert ">a caption</text>" in drawn


def test_a_sketch_that_cannot_be_drawn_is_refused_where_it_is_declared() -> None:
    with pytest.raises(ValueError, match="there is no drawing wheel; there are backlash"):
        Sketch("wheel", "a wheel", "round")
    with pytest.raises(ValueError, match="eccentric asks for 1 labels"):
        Sketch("eccentric", "a wheel", "round")


@pytest.mark.parametrize("ideal", MANOEUVRES, ids=lambda ideal: ideal.name)
def test_a_manoeuvre_is_drawn_to_scale(ideal, diagnosis: Diagnosis) -> None:  # type: ignore[no-untyped-def]
    figure = manoeuvre_figure(ideal, PLAIN, pace_of(diagnosis.runs, PLAIN))
    left, right = figure.data[:2]
    apart = np.hypot(np.asarray(left.x) - right.x, np.asarray(left.y) - right.y)
    assert apart == pytest.approx(PLAIN.track, rel=1e-3)
    assert figure.layout.yaxis.scaleanchor == "x"


def test_events_of_drives_of_one_name_stand_on_lines_of_their_own() -> None:
    """day1/square and day2/square were one line, with the events of both."""
    time, nothing = np.array([0.0, 10.0]), np.full(2, np.nan)
    ways = [
        Way(Path(f"{day}/square"), held, time, nothing, nothing)
        for day, held in (("day1", False), ("day2", False), ("day3", True))
    ]
    drawn: Any = over_time(Events(ways=tuple(ways)), 0.35)
    assert [line.y[0] for line in drawn.data] == [
        "day1/square",
        "day2/square",
        "square (held out)",
    ]
