# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi draft`: a law that the library lacks is written, tried, added; else one clear line."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import PLAIN, RECORDING, called, written, written_by
from test.command_line import Complaint, Printed
from test.soft_tyres import soft_tyres
from werrimbi_odom.api.drives import recordings_of
from werrimbi_odom.cli import draft
from werrimbi_odom.cli.main import main
from werrimbi_odom.effects import find, load_file
from werrimbi_odom.effects.contract import check_effect


@pytest.fixture(scope="module")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    truth = replace(PLAIN, effects=(soft_tyres.using(softness=4e-3),))
    random = np.random.default_rng(5)
    loads = [{"load_kg": np.repeat(random.uniform(0, 10, 20), 100)[:1201]} for _ in range(4)]
    return written(tmp_path_factory.mktemp("loaded"), [truth] * 4, loads)


def runs(folder: Path) -> list[str]:
    found = sorted(str(path) for path in folder.glob("run_*"))
    return ["--robot", str(folder / "robot.yaml"), *found[:3], "--holdout", found[3]]


@pytest.mark.usefixtures("few_effects")
def test_the_law_is_found_written_and_added(
    loaded: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, figures = tmp_path / "package", tmp_path / "f.json"
    found = written_by(figures, "draft", *runs(loaded), "--out", out)
    said = capsys.readouterr().out
    assert found["draft"]["variable"] == "load_kg"
    assert found["draft"]["form"] == "line"
    assert found["holdout"]["after"] < 0.5 * found["holdout"]["before"]
    slope = found["parameters"]["slope"]
    (told,) = re.findall(r"Fitted: slope = (\S+) ± ([-+.e\d]*\d)", " ".join(said.split()))
    assert [float(each) for each in told] == pytest.approx(
        [slope["value"], slope["std"]], rel=0.05, abs=0.1 * slope["std"]
    )
    file = out / "along_by_load_kg.py"
    assert f"--effects {file}" in said
    (effect,) = load_file(file)
    check_effect(effect)
    assert "werrimbi_odom.effects" in (out / "pyproject.toml").read_text()
    assert (
        "the node refuses it: it has counters alone, no load_kg" in (out / "README.md").read_text()
    )

    new = tmp_path / "new.yaml"
    words = ["add", effect.name, *runs(loaded), "--effects", str(file), "--out", str(new)]
    assert main(words) == 0
    assert "along_by_load_kg" in new.read_text()


def test_a_package_is_not_written_over(loaded: Path, tmp_path: Path, complaint: Complaint) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    assert "is not empty" in complaint("draft", *runs(loaded), "--out", tmp_path)


@pytest.mark.usefixtures("few_effects")
def test_where_nothing_is_missing_nothing_is_drafted(tmp_path: Path, complaint: Complaint) -> None:
    folder = written(tmp_path, [PLAIN] * 4)
    told = complaint("draft", *runs(folder), "--out", tmp_path / "package")
    assert "the verdict is" in told
    assert not (tmp_path / "package").exists()


@pytest.mark.evidence
@pytest.mark.usefixtures("few_effects")
def test_no_draft_is_promised_of_what_an_effect_of_the_library_explains(
    tmp_path: Path, complaint: Complaint
) -> None:
    """`--force drafts the strongest dependence all the same` ended with: there is none."""
    slips = replace(PLAIN, effects=(find("lateral_slip").using(creep=0.02),))
    folder = written(tmp_path, [slips] * 4)
    words = ["draft", *runs(folder), "--out", tmp_path / "package"]
    told = complaint(*words)
    assert "lateral_slip, which the library holds" in told
    assert "--force drafts" not in told
    assert "with lateral_slip put in, the errors go with no" in complaint(*words, "--force")


@pytest.mark.parametrize(
    ("out", "place"), [("e", "./e"), ("a/e", "a/e"), ("/tmp/e", "/tmp/e"), ("../e", "../e")]
)
def test_pip_is_given_a_folder_and_no_name_of_a_package(out: str, place: str) -> None:
    assert draft._place(Path(out)) == place


def test_what_is_printed_takes_a_reference_that_wanders_as_it_was_taken(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, printed: Printed
) -> None:
    given = recordings_of(wo.read_robot(RECORDING / "robot.yaml"), RECORDING)
    found = SimpleNamespace(name="by_load", diagnosis=SimpleNamespace(wander="some"))
    result: Any = SimpleNamespace(
        found=found, write_package=lambda out: [], summary=lambda: "", write_report=None
    )
    monkeypatch.setattr(draft, "on_recordings", lambda *_: (given, result))
    words = (RECORDING, "--robot", RECORDING / "robot.yaml", "--out", tmp_path / "package")
    assert called(draft, *words) == 0
    assert "werrimbi add by_load" in (said := printed())
    assert "--reference-kind local_map" in said


def test_a_law_is_tried_with_the_file_from_before_what_stood_in_for_it(tmp_path: Path) -> None:
    """Four effects were added for one law; beside the law none of them was ever taken out."""
    text = (RECORDING / "robot.yaml").read_text()
    (tmp_path / "robot.yaml").write_text(text)
    better = tmp_path / "robot_better.yaml"
    held = "    effects: [load_transfer]\n    load_transfer: {lateral: 0.03, longitudinal: 0.0}\n"
    better.write_text(text.rstrip("\n") + "\n" + held)

    def said() -> str:
        given = recordings_of(wo.read_robot(better), RECORDING)
        return " ".join(draft._next(Path("mine"), given, "by_load").split())

    told = said()
    before = f"werrimbi diagnose --robot {tmp_path / 'robot.yaml'} --effects mine/by_load.py"
    assert "the robot file from before load_transfer, which may have stood in for it" in told
    assert told.index(before) < told.index(f"werrimbi add by_load --robot {better}")
    (tmp_path / "robot.yaml").write_text(
        text.replace("wheel_separation: 0.35 ", "wheel_separation: 0.4 ")
    )
    told = said()  # another robot's file
    assert before not in told
    assert "diagnose the file from before, with --effects as here" in told
