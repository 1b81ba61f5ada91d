# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is said of a covariance is true to the table that stands below it."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from scipy import stats

from test.evidence import in_evidence
from test.inference.driven import run_by
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.compare import Comparison, compare
from werrimbi_odom.inference.comparison.consistency import (
    AtLength,
    consistency,
    honest_bounds,
    judged_lengths,
    of_all,
)
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.comparison.reference_noise_source import ReferenceNoise
from werrimbi_odom.inference.comparison.systematic import NoiseFactor, Systematic
from werrimbi_odom.inference.comparison.verdict import Noise, Verdict, verdict_of
from werrimbi_odom.inference.diagnosis.outlying_drives import recorded_otherwise
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.report.adding.words import _rest
from werrimbi_odom.report.comparison.document import document_of
from werrimbi_odom.report.comparison.phrases import (
    covariance_words,
    reference_words,
    systematic_told,
)
from werrimbi_odom.report.comparison.words import words_of
from werrimbi_odom.report.diagnosis import remarks
from werrimbi_odom.report.number_format import from_start
from werrimbi_odom.report.phrases import left_out_words
from werrimbi_odom.report.terminal import printed

SYSTEMATIC = Systematic("line", "heading", "travel", 0.1, 0.01, 1e-9, 0.1, 0.1, True)
NUMBER = r"([\d.]+(?:e[+-]?\d+)?)"


def test_a_clock_that_shows_the_time_of_day_is_told_from_the_drives_start() -> None:
    assert from_start(1_767_225_600.0, 1_767_225_626.4, 1_767_225_630.6) == pytest.approx(
        (26.4, 30.6)
    )
    assert from_start(1000.0, 1026.4) == (1026.4,), "one that began with the robot is told as it is"


def table(random: np.random.Generator) -> tuple[AtLength, ...]:
    """NEES that stays, grows, falls, or goes up and down with the length of the legs."""
    count = int(random.integers(1, 8))
    shape = random.choice(["flat", "grows", "falls", "any"])
    values = np.exp(random.normal(0.0, 0.15 if shape == "flat" else 1.5, count))
    if shape == "grows":
        values = np.sort(values)
    if shape == "falls":
        values = np.sort(values)[::-1]
    legs = int(random.integers(5, 40_000)) // 2 ** np.arange(count)
    return tuple(
        AtLength(0.25 * 2.0**place, int(number), float(nees), 3 * int(number))
        for place, (number, nees) in enumerate(zip(legs, values, strict=True))
    )


def verdict(random: np.random.Generator, lengths: tuple[AtLength, ...]) -> Verdict:
    noise: Noise = random.choice(["honest", "too small", "too large", "grows", "comes and goes"])
    factor = NoiseFactor(*np.sort(np.exp(random.normal(0.0, 1.5, 3)))[[1, 0, 2]].tolist())
    mean = () if random.random() < 0.6 else (SYSTEMATIC,)
    judged_at = float(random.choice([item.leg for item in lengths]))
    off = ("line",) if random.random() < 0.2 else ()
    return Verdict(
        enough=True,
        systematic=mean,
        noise=noise,
        factor=factor,
        judged_at=judged_at,
        off=off,
        lengths=judged_lengths(lengths),
    )


def said_of(text: str, lengths: tuple[AtLength, ...], main: float) -> list[AtLength | float]:
    """Every NEES that a sentence holds, with the row of the table that it is of."""
    found: list[AtLength | float] = []
    by_leg = {f"{item.leg:g}": item for item in lengths}
    for number, leg in re.findall(rf"{NUMBER} over (?:legs of )?{NUMBER} m", text):
        row = by_leg[leg]
        assert float(number) == pytest.approx(row.nees, rel=0.01)
        found.append(row)
    for leg, number in re.findall(rf"over legs of {NUMBER} m \(NEES {NUMBER}", text):
        row = by_leg[leg]
        assert float(number) == pytest.approx(row.nees, rel=0.01)
        found.append(row)
    if not found:
        (number,) = re.findall(rf"NEES (?:is )?{NUMBER}", text)
        assert float(number) == pytest.approx(main, rel=0.01, abs=0.006)
        found.append(main)
    return found


@pytest.mark.parametrize("seed", range(400))
def test_sentences_are_true_to_their_table(seed: int) -> None:
    random = np.random.default_rng(seed)
    lengths = table(random)
    judged = verdict(random, lengths)
    main = lengths[min(2, len(lengths) - 1)].nees
    (text,) = covariance_words(judged, main)
    rows = said_of(text, lengths, main)
    enough = [item for item in lengths if item.count >= rules.FEWEST_LEGS]
    says = {item.says for item in enough}
    if "honest" in text and "in straight driving" not in text:
        assert says == {"honest"}
    if "covariance is too small" in text or "times too small" in text:
        assert "too small" in says
        assert any(isinstance(row, AtLength) and row.says == "too small" for row in rows)
    if "too large" in text:
        assert says & {"too large"}
        assert not says & {"too small"}
    values = [item.nees for item in enough]
    if "the more so the longer the leg" in text:
        rises = [after > before for before, after in pairwise(values)]
        assert all(rises) if "too small" in text else not any(rises)
    if "the more so the shorter the leg" in text:
        rises = [after > before for before, after in pairwise(values)]
        assert not any(rises) if "too small" in text else all(rises)
    for leg in re.findall(rf"most over legs of {NUMBER} m", text):
        worst = (max if "too small" in text else min)(enough, key=lambda item: item.nees)
        assert leg == f"{worst.leg:g}"
    for nees, times in re.findall(rf"NEES {NUMBER}, 1 is right: errors are {NUMBER} times", text):
        assert float(times) == pytest.approx(math.sqrt(float(nees)), rel=0.06)
    for times in re.findall(rf"noise k were {NUMBER} times", text):
        assert float(times) == pytest.approx(math.sqrt(judged.factor.value), rel=0.06)


def test_one_rule_for_few_legs_and_many() -> None:
    """Chance rules while legs are few, what matters to a user when they are many."""
    for freedom in (15, 60, 300, 3000, 300_000):
        low, high = honest_bounds(freedom)
        tail = 0.5 * (1.0 - rules.HONEST_CHANCE)
        exact = stats.chi2.ppf([tail, 1.0 - tail], freedom) / freedom
        assert low == pytest.approx(min(exact[0], 1.0 / rules.HONEST_WITHIN), rel=0.09)
        assert high == pytest.approx(max(exact[1], rules.HONEST_WITHIN), rel=0.02)
        assert consistency(1.0, freedom) == "honest"
        assert consistency(1.01 * high, freedom) == "too small"
        assert consistency(0.99 * low, freedom) == "too large"
    assert consistency(math.nan, 100) == consistency(2.0, 0) == "unknown"


def test_a_covariance_is_honest_only_where_it_is_so_at_every_length() -> None:
    good = [AtLength(1.0, 1000, 1.02, 3000), AtLength(4.0, 500, 1.41, 1500)]
    assert of_all(good) == "honest"
    assert of_all([*good, AtLength(16.0, 100, 28.8, 300)]) == "too small"
    assert of_all([*good, AtLength(16.0, rules.FEWEST_LEGS - 1, 28.8, 27)]) == "honest"
    assert of_all([]) == "unknown"


def test_what_is_still_missing_is_told_in_words_and_not_by_a_variables_name() -> None:
    cell = SimpleNamespace(
        amount=SimpleNamespace(channel="along", per="travel"),
        variable=SimpleNamespace(name="yaw_rate_size"),
        p_value=4e-16,
    )
    figures = SimpleNamespace(nees=10.96)
    added = SimpleNamespace(
        verdict=None,
        compared=SimpleNamespace(main=SimpleNamespace(all=SimpleNamespace(figures=figures))),
        misfit=SimpleNamespace(cell=cell, only_in=None, effect=None, share=None),
    )
    assert _rest(added) == (  # type: ignore[arg-type]
        "Something is still missing: how far both wheels roll goes with the size of the rate of "
        "turning (p = 4e-16; NEES 10.96, honest is 1)."
    )
    added.misfit.share = 0.012
    assert _rest(added).startswith("Something is left: how far both wheels roll goes with")  # type: ignore[arg-type]
    assert "That is 1.2 % of the squared errors" in _rest(added)  # type: ignore[arg-type]


def measured_at_the_ends(number: int) -> Run:
    """Two metres, and the pose where they begin and where they end."""
    run = run_by(ROBOT, np.full(100, 0.4), np.zeros(100), seed=number, name=f"run_{number}")
    assert run.reference is not None
    columns = (getattr(run.reference, name)[[0, -1]] for name in ("time", "x", "y", "yaw"))
    return replace(run, reference=Reference(*columns))


def test_where_two_poses_are_all_no_shorter_leg_is_advised() -> None:
    """Four drives with a pose at either end: "4 legs of 1 m ... try a shorter --leg"."""
    found = compare([measured_at_the_ends(number) for number in range(4)], ROBOT)
    words = " ".join(printed(document_of(found)).split())
    assert "4 legs of 2 m, 10 are the least. Drive more (6 more drives like these), or" in words
    assert "measure the robot more often" in words
    assert "Errors of legs of 2 m (rms)" in words
    assert "shorter --leg" not in words


def test_a_thousandfold_way_is_told_without_an_exponent() -> None:
    """Of a reference in millimetres the robot went "1e+03 times as far"."""
    part = Systematic("line", "along", "travel", 998.6, 0.3, 0.0, 500.0, 0.003, common=True)
    assert systematic_told(part) == "the robot goes 1000 times as far as the model says"


def test_what_lasts_no_time_was_at_a_time() -> None:
    run = Path("run")
    leap = LeftOut(run, 0.001, 0.02, "counter", "the right counter leapt by 13.5 m")
    held = LeftOut(run, 9.7, 11.2, "carried", "the robot was carried")
    at_once, lasting = left_out_words([leap, held])
    assert at_once == "At 0.0 s of run the right counter leapt by 13.5 m: left out."
    assert lasting == "From 9.7 s to 11.2 s of run the robot was carried: left out."
    *of_one_drive, _ = left_out_words([leap, held], named=False)
    assert of_one_drive == ["At 0.0 s the right counter leapt by 13.5 m: left out."]


def test_stretches_are_told_drive_by_drive_and_of_which_drive_each_is() -> None:
    """Of three drives one was held: the one sentence did not say which."""
    late, early = (LeftOut(Path(name), 10.0, 12.0, "gap", "silent") for name in ("b", "a"))
    assert left_out_words([late]) == ["From 10.0 s to 12.0 s of b silent: left out."]
    parts = [replace(late, begin=20.0, end=22.0), early, late]
    assert [line[:22] for line in left_out_words(parts)] == [
        "From 10.0 s to 12.0 s ",
        "From 20.0 s to 22.0 s ",
        "From 10.0 s to 12.0 s ",
    ]
    assert [line[22:26] for line in left_out_words(parts)] == ["of b", "of b", "of a"]


def test_drives_of_one_name_are_told_by_the_folder_above_too() -> None:
    held = LeftOut(Path("bags/train/free"), 10.0, 12.0, "held", "the robot was held", 0.0)
    parts = [held, replace(held, run=Path("bags/holdout/free"))]
    assert [line.partition(" of ")[2].partition(" the")[0] for line in left_out_words(parts)] == [
        "train/free",
        "holdout/free",
    ]


def test_the_longest_stretches_are_told_in_their_order() -> None:
    """Of sixty silences, those of half a second stood in the way of the half hour that mattered."""
    run = Path("run")
    short = [LeftOut(run, 10.0 * n, 10.0 * n + 0.5, "gap", "silent") for n in range(1, 8)]
    long = LeftOut(run, 100.0, 843.0, "carried", "the heading is not known")
    *told, rest = left_out_words([*short, long])
    assert told[-1] == "From 100.0 s to 843.0 s of run the heading is not known: left out."
    assert told[0].startswith("From 10.0 s")
    assert rest == "So are 3 more such stretches, 1.5 s in all."


@pytest.mark.evidence
@pytest.mark.parametrize(
    ("name", "size"),
    [in_evidence("floor_slope", 0.005), ("lateral_slip", 0.004)],
)
def test_no_motion_is_as_promised_that_errs_more_at_any_length(
    name: str, size: float, tmp_path: Path
) -> None:
    simulation = pytest.importorskip("werrimbi_odom.simulation")
    odd = [simulation.hide(name, size, seed=21).peculiarity]
    robot = simulation.TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
    file = read_robot_file(simulation.write_robot_file(robot, tmp_path / "robot.yaml"))
    chosen = ("train/free_brisk", "train/arcs", "train/square_cw")
    drives = [
        read_run(simulation.write_run(recording, tmp_path / label), file)
        for label, recording in simulation.session(robot, 21, hidden=odd, only=chosen)
    ]
    found = compare(drives, file.robot)
    assert not verdict_of(found).good
    words = [part.text for part in words_of(found)]
    for kind, what in (("line", "Straight driving"), ("arc", "Curves")):
        lengths = judged_lengths([item.consistency_of(kind) for item in found.lengths])
        worst = max(lengths, key=lambda item: item.nees)
        line = next((part for part in words if f"{what}: " in part), "")
        assert kind == "line" or (line and worst.says == "too small")
        if line and worst.says == "too small":
            assert "times what is promised" in line or " ± " in line
        elif line:
            assert line.endswith(", as promised.")


def test_of_headings_alone_the_option_that_states_their_noise_is_told() -> None:
    """It was `--reference-sigma-xy`, which says nothing of a gyro."""
    noise = ReferenceNoise(2e-3, 5e-3, "assumed", "assumed")
    prepared = SimpleNamespace(
        options=EvaluationOptions(reference_kind="incremental"), noises=[("heading", noise)]
    )
    figures = SimpleNamespace(all=SimpleNamespace(outliers=0))
    comparison: Any = SimpleNamespace(prepared=prepared, main=figures, remarks=(), left_out=())
    (words,) = reference_words(comparison)
    assert "0.29° each interval, is assumed" in words
    assert "--reference-sigma-yaw says it" in words


def test_the_drive_that_errs_grossly_is_the_one_that_diagnose_names() -> None:
    """Of four drives one with exchanged counters: all of the model was "grossly wrong"."""
    random, options = np.random.default_rng(3), EvaluationOptions()
    runs = []
    for number in range(4):
        turning = np.repeat(random.uniform(-0.8, 0.8, 12), 100)
        runs.append(run_by(ROBOT, np.full(1200, 0.4), turning, number, f"drive_{number}"))
    ticks = runs[2].ticks
    runs[2] = replace(runs[2], ticks=replace(ticks, left=ticks.right, right=ticks.left))
    compared = compare(runs, ROBOT, options)
    verdict = verdict_of(compared)
    assert (verdict.gross, verdict.runs) == (True, (2,))
    assert "The model is grossly wrong in drive drive_2 alone" in said(compared)
    fitted = prepare(runs, ROBOT, options)
    (odd,) = recorded_otherwise(fitted, prepare(runs[:1], ROBOT, options), ROBOT, options)
    assert odd.run == "drive_2"
    every = [replace(run, ticks=replace(run.ticks, left=run.ticks.right, right=run.ticks.left))
             for run in runs]  # fmt: skip
    assert "alone" not in said(compare([*every[:2], runs[2], every[3]], ROBOT, options))


def test_one_drive_by_the_size_of_its_errors_another_by_what_they_go_with(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Compare named one drive and diagnose another, as if both had been asked the same."""
    monkeypatch.setattr(remarks, "dependence_words", lambda _: "the error goes with the speed")
    misfit = SimpleNamespace(cell=SimpleNamespace(p_value=1e-9), only_in="arcs")
    (told,) = remarks.law(
        SimpleNamespace(diagnosis=SimpleNamespace(misfit=misfit, robot=ROBOT))  # type: ignore[arg-type]
    )
    assert "It stands out by what its errors go with. By their size" in told


def test_what_is_alike_for_seconds_may_be_the_law_that_the_file_holds() -> None:
    """Motion capture of white noise "wandered"; it was the form of a backlash that did not fit."""
    backlash = find("left_backlash").using(travel=0.002)
    assert "the law of left_backlash" in remarks.wanders_words(replace(ROBOT, effects=(backlash,)))
    assert "law" not in remarks.wanders_words(ROBOT)


def said(compared: Comparison) -> str:
    return " ".join(paragraph.text for paragraph in words_of(compared))
