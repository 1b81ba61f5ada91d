# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi diagnose` on the command line: words, tables, JSON, and one line for a mistake."""

from __future__ import annotations

from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

from test.cli.commands import RECORDING, ROBOT, written_by
from test.command_line import Complaint

TEXT = ROBOT.read_text()
FILES = {
    "right": TEXT,
    "base": TEXT.replace("wheel_separation: 0.35 ", "wheel_separation: 0.36 "),
    "half base": TEXT.replace("wheel_separation: 0.35 ", "wheel_separation: 0.175 "),
}


@dataclass(frozen=True)
class Said:
    figures: dict[str, Any]
    out: str
    err: str

    @property
    def words(self) -> str:
        return " ".join(self.out.split())


@pytest.fixture(scope="module")
def said(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Said]:
    """Each robot file diagnosed once."""
    found = {}
    for name, text in FILES.items():
        assert (name == "right") == (text == TEXT)
        folder = tmp_path_factory.mktemp("robot")
        (folder / "robot.yaml").write_text(text)
        file, out, err = folder / "figures.json", StringIO(), StringIO()
        words = ["--robot", folder / "robot.yaml", RECORDING, "--leg", "0.5"]
        with redirect_stdout(out), redirect_stderr(err):
            figures = written_by(file, "diagnose", *words)
        found[name] = Said(figures, out.getvalue(), err.getvalue())
    return found


@pytest.mark.parametrize("name", FILES)
def test_the_json_is_the_contracts(name: str, said: dict[str, Said]) -> None:
    found = said[name].figures
    assert found["verdict"] in {"none", "named", "ambiguous", "unknown"}
    assert (found["effect"] is None) == (found["verdict"] in {"none", "unknown"})
    for entry in found["ranking"]:
        assert entry.keys() == {"effect", "p_value", "train", "holdout"}
        assert entry["train"].keys() == entry["holdout"].keys() == {"before", "after"}
        mistake = entry["effect"] in [item["effect"] for item in found["set_up"]]
        assert (entry["p_value"] is None) == mistake  # seen without a test
        assert mistake or 0.0 <= entry["p_value"] <= 1.0
    cells = [(cell["channel"], cell["variable"]) for cell in found["depends_on"]]
    assert len(cells) == len(set(cells))
    assert all(cell["p_value"] < 1e-3 for cell in found["depends_on"])
    assert found["next_manoeuvre"] is None or found["next_manoeuvre"].keys() >= {"name", "why"}
    assert {"found", "set_up", "remaining", "train", "holdout"} <= found.keys()


@pytest.mark.parametrize("name", FILES)
def test_words_and_tables_fit_the_terminal(name: str, said: dict[str, Said]) -> None:
    assert said[name].err == ""
    lines = [line for line in said[name].out.splitlines() if not line.startswith(("    ", "writ"))]
    assert max(map(len, lines)) <= 80
    assert "nan" not in said[name].out.lower().split()


def test_a_right_model_misses_nothing_and_it_is_told_how_well_that_is_known(
    said: dict[str, Said],
) -> None:
    right = said["right"]
    assert right.figures["verdict"] == "none"
    assert right.words.startswith("Nothing is missing that these drives could show")
    assert "werrimbi add" not in right.out
    seen = {sight["effect"]: sight for sight in right.figures["could_have_been_seen"]}
    assert seen["track_width"]["seen_from"] < 0.02
    # Squares of one sense are never driven backwards, so no castor swings round.
    assert seen["castor_kick"]["hidden"]
    assert seen["castor_kick"]["shown_by"] is not None
    assert "castor_kick" in right.words.split("Effects, best first")[0]


def test_a_wrong_base_is_named_with_its_size_its_ruler_and_the_command_that_mends_it(
    said: dict[str, Said],
) -> None:
    base = said["base"]
    assert (base.figures["verdict"], base.figures["effect"]) == ("named", "track_width")
    (found,) = base.figures["found"]
    multiplier = found["parameters"]["multiplier"]
    assert multiplier["value"] == pytest.approx(0.35 / 0.36, abs=4.0 * multiplier["std"])
    assert 0.0 < multiplier["std"] < 0.003
    ranked = base.figures["ranking"][0]
    assert ranked["effect"] == "track_width"
    assert ranked["p_value"] < 1e-6
    assert base.words.startswith("One thing is missing: track_width.")
    assert "Check it: spin ten turns" in base.words
    assert "werrimbi add track_width --robot" in base.out
    assert "--leg 0.5" in base.out
    assert str(RECORDING) in base.out


def test_half_a_base_is_called_a_mistake_of_set_up_before_anything_else(
    said: dict[str, Said],
) -> None:
    half = said["half base"]
    assert half.figures["verdict"] == "named"
    assert half.figures["set_up"][0]["effect"] == "track_width"
    assert half.figures["set_up"][0]["factor"] == "2"
    assert half.words.startswith("Something is set up wrongly:")
    (value,) = half.figures["found"][0]["parameters"].values()
    assert value["value"] == pytest.approx(2.0, abs=0.01)


def test_mistakes_are_told_in_one_line(complaint: Complaint) -> None:
    robot = ("--robot", ROBOT)
    told = complaint("diagnose", *robot, RECORDING, "--holdout", RECORDING)
    assert "given twice" in told
    assert "required: --robot" in complaint("diagnose", RECORDING)


def test_headings_in_degrees_are_told_with_the_mend(tmp_path: Path, complaint: Complaint) -> None:
    (tmp_path / "ticks.csv").write_text((RECORDING / "ticks.csv").read_text())
    header, *rows = (RECORDING / "reference.csv").read_text().splitlines()
    turned = [row.rsplit(",", 1) for row in rows]
    lines = [f"{rest},{float(yaw) * 180.0 / 3.141592653589793:.4f}" for rest, yaw in turned]
    (tmp_path / "reference.csv").write_text("\n".join([header, *lines]) + "\n")
    told = complaint("diagnose", "--robot", ROBOT, tmp_path)
    assert str(tmp_path) in told
    assert "degrees" in told
    assert "pi/180" in told
