# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""General learners on the same drives: what they leave of the held-out error, beside what we leave.

    make peers
    python -m test.hidden.peers [--only WORD] [--workers N] [--seed SEED]

One engine set for each thing that can be hidden, 7 drives to learn from and 4 held out. All begin
with the same calibrated robot. The learners are given what `draft` and `diagnose` look at (speeds,
accelerations, headings, places, wheel angles, channels ...) and learn what is left of each short
leg, its three coordinates, from it; how freely, they choose by cross-validation over the drives. On
held-out drives what they foretell is put onto the calibrated robot's path. Errors are of position,
over the same legs of 1 m for all.

The learners are those of `test.hidden.learners`; ours is what `diagnose` finds and, where it says
unknown, what `draft` drafts.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from pathlib import Path

import numpy as np

from test.hidden.floors import LEG, Floor
from test.hidden.learners import CHOICES, Legs, learnt
from test.hidden.plan import CALIBRATION, EFFECTS, OUTSIDERS
from test.hidden.resumable_jobs import Line, done, kept, results_of
from test.hidden.sets import ROOT, HiddenSet, make, make_all, runs_of
from werrimbi_odom.api.draft import draft
from werrimbi_odom.effects import LIBRARY
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.inference.comparison.residuals import chained
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.diagnosis.variables import CONSTANT, variables_of
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.likelihood import errors_between
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.fitting.run_phases import model_in_runs
from werrimbi_odom.model.pose import Floats

PAGE = ROOT / "docs" / "peers.md"
BEGIN, END = "<!-- tables: written by make peers -->", "<!-- end of tables -->"
SEED = 96_001
"""None of these sets was seen before the table was made."""
FEW = 2
"""Drives to learn from, in the second table."""


def legs_of(runs: Concatenated, model: Model) -> Legs:
    """Of runs; legs that are none have what is not a number."""
    drive = runs.drive(model.laid_out(runs.steps))
    moves = [drive.speed.end, drive.left_speed.end, drive.right_speed.end, drive.yaw_rate.end]
    moves += [np.abs(drive.speed.end), np.abs(drive.yaw_rate.end)]
    columns = []
    for item in variables_of(runs, model):
        if item.form == "turns":
            columns += [np.cos(item.harmonic * item.left), np.sin(item.harmonic * item.left)]
        elif item.name != CONSTANT:
            columns += [item.left] if item.shared else [item.left, item.right]
    step = drive.duration
    seen = predict_all(model, runs)
    time = runs.per_leg(step)
    means = [runs.per_leg(column * step) / time for column in (*moves, *columns)]
    ones = np.ones_like(step)
    pairs = product(moves, (ones, *moves, *columns))
    products = [runs.per_leg(one * other * step) for one, other in pairs]
    left = errors_between(runs.start, runs.finish, seen)
    left[runs.gap] = np.nan
    plain = np.column_stack([*means, time, seen.along, seen.turn])
    return Legs(plain, np.column_stack(products), left, runs.run_of_leg)


def _chained(coarse: Concatenated, relative: Floats) -> Floats:
    """Ends of legs (m, 3), of the relative poses of the short legs in them."""
    found = []
    for first, last in zip(*coarse.parts(), strict=True):
        place, yaw = chained(relative[first:last])
        found.append((place[-1].real, place[-1].imag, yaw[-1]))
    return np.array(found)


def error_with(coarse: Concatenated, model: Model, relative: Floats) -> float:
    """Root mean square position error over the legs that are judged [m].

    Parameters
    ----------
    relative
        Of the short legs, in the place of what the model predicts.
    """
    prediction = replace(predict_all(model, coarse), relative=_chained(coarse, relative))
    off = errors_between(coarse.start, coarse.finish, prediction)[:, :2]
    told = ~coarse.gap & np.isfinite(off).all(axis=1)
    return float(np.sqrt(np.mean(np.sum(off[told] ** 2, axis=1))))


def judged(task: tuple[HiddenSet, int]) -> Line:
    """Held-out errors of a set [m], by learner; `ours` with what was found."""
    what, drives = task
    folder = make(what)
    file = read_robot_file(folder / "robot.yaml")
    paths = runs_of(folder, "train")[:drives], runs_of(folder, "holdout")
    train, holdout = ([read_run(path, file) for path in some] for some in paths)
    floor = Floor(train, holdout, file.robot, limits=file.limits)
    (coarse,) = floor.judge.holdout.cuts[LEG]
    fine = floor.judge.fine
    fit = fit_calibration(floor.laid, file.robot, floor.options)
    model = model_in_runs(fit.point.model, fine, "absolute")
    held = legs_of(fine, model)
    predicted = predict_all(model, fine).relative
    seen = legs_of(floor.laid, fit.point.model)
    line: Line = {"calibrated": error_with(coarse, model, predicted)}
    by_judge = floor.judge.of(fit.point.model).holdout
    if not np.isclose(line["calibrated"], by_judge, rtol=1e-3):
        raise AssertionError(f"other legs than ours: {line['calibrated']} m, {by_judge} m")
    for peer in CHOICES:
        line[peer] = error_with(coarse, model, predicted + learnt(peer, seen)(held))
    line["ours"], line["found"] = _ours(file, paths[0], floor)
    line["right law"] = floor.of(what.names)
    return line


def _ours(file: RobotFile, learn_from: Sequence[Path], floor: Floor) -> tuple[float, str]:
    judge = floor.judge
    robot = file.robot
    found = diagnose(judge.fitted_on, robot, LIBRARY, floor.options, holdout=judge.kept_back)
    if found.verdict == "unknown":
        try:
            drafted = draft(file, learn_from, force=True)  # parts of these choose its law
            told = drafted.to_dict()["draft"]["law"] or "curve"
            return floor.of_law(drafted.found.effect), f"draft: {told}"
        except InputError:
            pass
    names = found.final.names
    return judge.of(found.final.point.model).holdout, ", ".join(names) or found.verdict


def table(lines: dict[str, Line], drives: int) -> str:
    """Of those with so many drives, in millimetres, with their means."""
    heads = ("calibrated", *CHOICES, "ours", "right law")
    rows = [(key, line) for key, line in lines.items() if key.endswith(f" {drives}")]
    said = ["| hidden | " + " | ".join(heads) + " | found |", "| --- " * (len(heads) + 2) + "|"]
    for key, line in rows:
        figures = " | ".join(f"{1e3 * line[head]:.2f}" for head in heads)
        found = line["found"].replace("|", r"\|")
        said.append(f"| `{key.split()[0]}` | {figures} | {found} |")
    means = " | ".join(f"{1e3 * np.mean([line[head] for _, line in rows]):.2f}" for head in heads)
    return "\n".join([*said, f"| mean of {len(rows)} | {means} | |"])


def main() -> None:
    """See above."""
    parser = argparse.ArgumentParser(
        prog="python -m test.hidden.peers",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--only", default="", help="what holds this word")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--seed", type=int, default=SEED)
    given = parser.parse_args()
    names = [name for name in (*EFFECTS, *OUTSIDERS) if name not in CALIBRATION]
    sets = [HiddenSet("effect", (name,), given.seed) for name in names if given.only in name]
    for each in make_all(sets, given.workers):
        print(f"made {each.name}", flush=True)
    os.environ.setdefault("OMP_NUM_THREADS", "1")  # trees of few rows are slower with several
    tasks = {
        f"{each.names[0]} {given.seed} {drives}": (each, drives)
        for drives in (7, FEW)
        for each in sets
        if each.path.exists()
    }
    for key, line in done(results_of("peers"), tasks, judged, given.workers):
        print(key, line, flush=True)
    lines = kept(results_of("peers"))
    mine = {key: lines[key] for key in tasks if key in lines}
    text = "\n\n".join(
        f"{count} drives to learn from:\n\n{table(mine, count)}" for count in (7, FEW)
    )
    print(f"\n{text}")
    if not given.only:
        first, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
        PAGE.write_text(
            f"{first}{BEGIN}\n\n{text}\n\n{END}{rest.partition(END)[2]}", encoding="utf-8"
        )


if __name__ == "__main__":
    main()
