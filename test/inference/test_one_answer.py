# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One answer to one question: a robot's errors on some drives are the same by whatever verb."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.cli.commands import write_run
from test.command_line import Werrimbi
from test.evidence import in_evidence
from test.inference.driven import COMMON, parts, run_of, runs_of
from test.inference.test_gaps import silent, without_ticks
from test.model.drives import ROBOT
from werrimbi_odom.cli.main import main
from werrimbi_odom.effects.lookup import all_effects, find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.recordings import DriveOptions, Recordings
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.calibration import any_driving
from werrimbi_odom.inference.calibration.any_driving import calibrate
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.judged_legs import figures_of
from werrimbi_odom.inference.comparison.leg_errors import LegStatistics
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import values_of
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.workbench.loaded_input import opened

ANY_FILE = read_robot_file(
    Path(__file__).parents[2] / "werrimbi_odom" / "recordings" / "square" / "robot.yaml"
)
WRONG = replace(ROBOT, wheel_separation_multiplier=1.01)
ECCENTRIC = find("eccentric_left_wheel")
UNKNOWN_PHASE = replace(WRONG, effects=(ECCENTRIC.using(amplitude=0.002),))
"""The file says how far the axle is off, and each drive begins somewhere else in the turn."""


def jumping(run: Run) -> Run:
    """The tracker comes to believe another place, in the middle of the drive."""
    reference = run.reference
    assert reference is not None
    late = reference.time > 45.0
    return replace(run, reference=replace(reference, x=reference.x + np.where(late, 0.8, 0.0)))


def differing(run: Run) -> Run:
    """Every other drive with positions alone."""
    return parts(run, "positions") if int(run.name[-1]) % 2 else run


CASES: dict[str, tuple[Callable[[Run], Run], ReferenceKind, Robot]] = {
    "full poses": (lambda run: run, "absolute", WRONG),
    "a gap of the reference": (silent, "absolute", WRONG),
    "a gap of the ticks": (without_ticks, "absolute", WRONG),
    "jumps": (jumping, "absolute", WRONG),
    "positions alone": (lambda run: parts(run, "positions"), "absolute", WRONG),
    "positions with gaps": (lambda run: silent(parts(run, "positions")), "absolute", WRONG),
    "headings alone": (lambda run: parts(run, "yaw"), "absolute", WRONG),
    "increments": (lambda run: run, "incremental", WRONG),
    "increments with gaps": (silent, "incremental", WRONG),
    "on a map with gaps": (silent, "local_map", WRONG),
    "differing measures": (differing, "absolute", WRONG),
    "a phase that nobody knows": (silent, "absolute", UNKNOWN_PHASE),
}


def drives(seeds: Sequence[int], robot: Robot) -> list[Run]:
    """Of a robot like the file's but for its base; what the file does not say is chosen anew."""
    found = []
    for seed in seeds:
        effects = tuple(
            applied.effect.using(**{**applied.values, "phase": 1.1 * (seed - 51)})
            for applied in robot.effects
        )
        found.append(run_of(replace(ROBOT, effects=effects), seed, 60))
    return found


def figures(statistics: LegStatistics) -> list[float]:
    return [statistics.rmse_position_m, statistics.median_position_m, statistics.rmse_yaw_rad]


QUICK = ("headings alone", "increments with gaps")
"""Of each unit and each cause of what is left out one; all of them in `make evidence`."""


@pytest.mark.parametrize(
    "case",
    [pytest.param(case, marks=[pytest.mark.evidence] * (case not in QUICK)) for case in CASES],
)
def test_every_verb_gives_the_same_figures(case: str) -> None:
    change, kind, robot = CASES[case]
    train, held = ([change(run) for run in drives(seeds, robot)] for seeds in ((50, 51), (52,)))
    compared = [
        compare(runs, robot, EvaluationOptions(reference_kind=kind)) for runs in (train, held)
    ]
    of_compare = [figures(each.main.all.figures) for each in compared]
    added = add_effects(
        [find("track_width")], train, robot, EvaluationOptions(reference_kind=kind), holdout=held
    )
    diagnosis = diagnose(train, robot, (), EvaluationOptions(reference_kind=kind), holdout=held)
    given = Recordings(
        ANY_FILE, all_effects(), tuple(train), tuple(held), DriveOptions(reference_kind=kind), robot
    )
    look = opened(given).look(robot)
    for other in (
        [figures(side.figures("before")) for side in (added.train, added.holdout)],
        [figures(each.main.all.figures) for each in (look.train, look.holdout)],
        [
            figures(figures_of(prepare(runs, robot, EvaluationOptions(reference_kind=kind)), robot))
            for runs in (train, held)
        ],
    ):
        np.testing.assert_array_equal(other, of_compare)
    judged = 0 if diagnosis.train.unit == "m" else 2
    assert (judged == 2) == (case == "headings alone")
    np.testing.assert_array_equal(
        [diagnosis.train.before, diagnosis.holdout.before],
        [errors[judged] for errors in of_compare],
    )
    np.testing.assert_array_equal(
        [added.train.sides.before, added.holdout.sides.before],
        [errors[judged] for errors in of_compare],
    )
    np.testing.assert_array_equal(diagnosis.headings[1].before, of_compare[1][2])
    counted = [legs.main.all.figures.count for legs in compared]
    assert [added.train.figures("before").count, added.holdout.figures("before").count] == counted
    left_out = (*compared[0].left_out, *compared[1].left_out)
    assert added.left_out == diagnosis.left_out == left_out
    whys = {part.why for part in left_out}
    assert whys == ({"gap"} if "gap" in case or "phase" in case else set()) | (
        {"reference"} if "jumps" in case else set()
    )


@pytest.mark.parametrize("seed", [1, in_evidence(2)])
def test_a_base_by_headings_alone_is_as_sure_by_add_as_by_diagnose(seed: int) -> None:
    """Half a wider base and half smaller wheels were an estimate of both: ± ten times as much.

    What is written is fitted on the whole drive, of which a diagnosis has three quarters.
    """
    runs = [parts(run, "yaw") for run in drives((seed,), WRONG)]
    base = find("track_width")
    (told,) = values_of(diagnose(runs, WRONG, COMMON), base.name).values()
    (added,) = add_effects([base], runs, WRONG).fitted[base.name].values()
    assert added.value == pytest.approx(told.value, abs=told.std)
    assert added.std is not None
    assert 0.95 * math.sqrt(0.75) * told.std <= added.std < 2.5 * told.std


def test_diagnose_states_what_add_will_write() -> None:
    """Value and ± of an effect and of the base."""
    hidden = find("lateral_slip").using(creep=0.02)
    *train, held = runs_of(replace(ROBOT, effects=(hidden,)), (50, 51, 52), 60)
    found = diagnose(train, WRONG, COMMON, holdout=[held])
    assert found.verdict == "named"
    assert set(found.found) == {hidden.name, "track_width"}
    added = add_effects([found.effect_named(name) for name in found.found], train, WRONG,
                        holdout=[held])  # fmt: skip
    for name in found.found:
        for parameter, told in values_of(found, name).items():
            if told.reported:
                written = added.fitted[name][parameter]
                assert written.value == pytest.approx(told.value, abs=0.02 * told.std)
                assert written.std == pytest.approx(told.std, rel=0.02)


def test_a_phase_is_learnt_by_compare_as_well() -> None:
    """The file's own effect, judged with a phase that fits the drive, not without the effect."""
    true = replace(UNKNOWN_PHASE, wheel_separation_multiplier=ROBOT.wheel_separation_multiplier)
    runs = drives((50, 51), true)
    learnt, without = (
        compare(runs, robot).main.all.figures.rmse_yaw_rad for robot in (true, ROBOT)
    )
    assert learnt < 0.9 * without


def _written_robot(path: Path, base: float = 1.0, effect: Effect | None = None) -> Path:
    held = (
        f"    effects: [{effect.name}]\n    {effect.name}:\n      amplitude: 0.002\n"
        if effect
        else ""
    )
    path.write_text(
        "odom_node:\n  ros__parameters:\n"
        f"    wheel_separation: {ROBOT.wheel_separation}\n"
        f"    wheel_separation_multiplier: {base}\n"
        f"    wheel_radius: {ROBOT.wheel_radius}\n"
        f"    left_ticks_per_revolution: {ROBOT.left_ticks_per_revolution}\n"
        f"    right_ticks_per_revolution: {ROBOT.right_ticks_per_revolution}\n"
        f"    left_wheel_noise: {ROBOT.left_wheel_noise}\n"
        f"    right_wheel_noise: {ROBOT.right_wheel_noise}\n" + held
    )
    return path


@pytest.mark.evidence
def test_the_files_say_the_same_by_every_verb(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Through the command line: drives with gaps, a robot file whose phase is not known."""
    monkeypatch.setattr("werrimbi_odom.effects.lookup.LIBRARY", (*COMMON, ECCENTRIC))
    robot = _written_robot(tmp_path / "robot.yaml", 1.01, ECCENTRIC)
    folders = []
    for run in drives((50, 51, 52), UNKNOWN_PHASE):
        folders.append(str(tmp_path / run.name))
        write_run(tmp_path / run.name, silent(run))
    train, held = folders[:2], folders[2:]

    def told(verb: list[str], runs: list[str], *more: str) -> Any:
        out = tmp_path / "figures.json"
        assert main([*verb, "--robot", str(robot), *runs, *more, "--json", str(out)]) == 0
        return json.loads(out.read_text())

    judged = ["--holdout", *held]
    new, fitted = (["--out", str(tmp_path / f"{name}.yaml"), "--force"] for name in ("new", "fit"))
    diagnosis = told(["diagnose"], train, *judged)
    every = [
        diagnosis,
        told(["add", "track_width"], train, *judged, *new),
        told(["calibrate", "fit"], train, *judged, *fitted),
    ]
    words = capsys.readouterr().out
    for side, runs in (("train", train), ("holdout", held)):
        compared = told(["compare"], runs)
        expected = compared["legs"]["rmse_position_m"]
        assert [figures[side]["before"] for figures in every] == [expected] * len(every)
        gaps = [part for part in compared["left_out"] if part["why"] == "gap"]
        assert len(gaps) == 2 * len(runs)
        for figures in every[:2]:
            assert [part for part in figures["left_out"] if part["run"] in runs] == gaps
    assert [part["why"] for part in every[2]["left_out"]] == ["gap"] * 4
    first = diagnosis["left_out"][0]
    assert set(first) >= {"run", "from_s", "to_s", "why"}
    assert " ".join(words.split()).count("the reference is silent while the robot") >= 3
    assert "the reference is silent while the robot" in " ".join(capsys.readouterr().out.split())


def reeling(run: Run) -> Run:
    """After a spin on the spot the robot stands a little askew, now to one side, now the other."""
    reference, random = run.reference, np.random.default_rng(5)
    assert reference is not None
    place = reference.x + 1j * reference.y
    gone, turned = np.diff(place) * np.exp(-1j * reference.yaw[:-1]), np.diff(reference.yaw)
    spins = (np.abs(gone) < 0.02) & (np.abs(turned) > 0.05)
    ends = spins & ~np.append(spins[1:], False)
    turned = turned + np.where(ends, random.normal(0.0, 0.005, turned.size), 0.0)
    yaw = reference.yaw[0] + np.concatenate([[0.0], np.cumsum(turned)])
    place = place[0] + np.concatenate([[0.0], np.cumsum(gone * np.exp(1j * yaw[:-1]))])
    return replace(run, reference=replace(reference, x=place.real, y=place.imag, yaw=yaw))


@pytest.mark.evidence
def test_add_says_of_what_remains_what_compare_says_of_the_written_file(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """Nothing more is seen in the fitted drives, and those held out err more than is promised."""
    slip = find("lateral_slip").using(creep=0.02)
    given = _written_robot(tmp_path / "robot.yaml")
    folders = []
    for seed in range(50, 56):
        run = run_of(replace(ROBOT, effects=(slip,)), seed, 60)
        folders.append(str(tmp_path / run.name))
        write_run(tmp_path / run.name, reeling(run) if seed > 52 else run)
    out, json_of_both = tmp_path / "new.yaml", [tmp_path / "add.json", tmp_path / "compare.json"]
    words = ["add", "lateral_slip", "--robot", str(given), *folders[:3], "--holdout", *folders[3:]]
    said = werrimbi(*words, "--out", out, "--json", json_of_both[0]).words
    words = ["compare", "--robot", str(out), *folders[3:], "--json", str(json_of_both[1])]
    of_compare = werrimbi(*words).words
    added, compared = (json.loads(path.read_text()) for path in json_of_both)
    headline = of_compare.partition(" - ")[0]
    assert "the errors are larger than the model promises" in headline
    assert added["explains"] is compared["verdict"]["good"] is False
    assert added["covariance"] == compared["verdict"]["covariance"] == "too small"
    assert "What remains is noise" not in said
    assert f"of the new file says of the held-out drives: {headline}" in said


@pytest.mark.parametrize("share", [5.0, 0.2])
def test_a_calibration_and_a_diagnosis_take_the_same_for_chance(
    monkeypatch: pytest.MonkeyPatch, share: float
) -> None:
    """After *none*, the `calibrate fit` that it prints said that something else is missing."""
    own = any_driving.dependences

    def as_likely(*of: Any) -> list[Dependence]:
        return [replace(cell, p_value=share * rules.VERY_SURE) for cell in own(*of)]

    monkeypatch.setattr(any_driving, "dependences", as_likely)
    found = calibrate(match_for_fit([run_of(ROBOT, 1, 20)], ROBOT, 1.0), ROBOT)
    assert bool(found.misfit) == (share < 1.0)


def test_calibrate_fit_fits_what_each_drive_has_of_its_own() -> None:
    """It left such an effect out, and sent to `diagnose`, which found nothing missing."""
    truth = replace(UNKNOWN_PHASE, effects=(ECCENTRIC.using(amplitude=0.004, phase=0.7),))
    runs = [run_of(truth, seed) for seed in (1, 2)]
    given = replace(ROBOT, effects=(ECCENTRIC.using(amplitude=0.004),))
    found = calibrate(match_for_fit(runs, given, 1.0), given)
    assert found.misfit == ()
    base = found.multipliers["wheel_separation_multiplier"]
    assert base.std is not None
    assert abs(base.value - 1.01) < 3.0 * base.std
    without = calibrate(match_for_fit(runs, given, 1.0), replace(given, effects=()))
    assert without.misfit != (), "it shows in these drives"
