# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi diagnose --fleet`: one table, and the same results whoever works them out."""

from __future__ import annotations

import json
import sys
from contextlib import redirect_stdout
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import Any

import pytest

from test.command_line import Complaint
from test.fleet.conftest import BASES, broken
from werrimbi_odom.cli.main import main


@dataclass(frozen=True)
class Said:
    out: str
    text: str
    """Of the JSON."""

    @property
    def figures(self) -> dict[str, Any]:
        found: dict[str, Any] = json.loads(self.text)
        return found

    @property
    def words(self) -> str:
        return " ".join(self.out.split())


def say(home: Path, *words: str) -> Said:
    """The verb in the folder that holds `fleet`."""
    out, file = StringIO(), home / f"figures_{len(list(home.glob('figures_*')))}.json"
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(out):
        patch.chdir(home)
        patch.setenv("COLUMNS", "100")
        assert main(["diagnose", "--json", str(file), *words]) == 0
    return Said(out.getvalue(), file.read_text())


@pytest.fixture(scope="module")
def said(home: Path) -> Said:
    page = str(home / "page.html")
    return say(home, "--fleet", "fleet", "--jobs", "2", "--report", page)


def test_the_first_line_counts_and_the_next_ones_say_whose_matter_it_is(said: Said) -> None:
    assert said.words.startswith(
        "4 robots: 1 misses nothing, 2 miss track_width, 1 could not be diagnosed. track_width is "
        "missing in 2 of 3: what most robots of a fleet have is a matter of their design, or of "
        "the robot file, which is the same, byte for byte, for all of them"
    )
    assert "Fitted multiplier: 1.02" in said.words


def test_the_table_has_a_row_a_robot_in_natural_order(said: Said) -> None:
    rows = [line.split() for line in said.out.splitlines() if line.startswith(" robot_")]
    assert [row[:3] for row in rows] == [
        ["robot_2", "3", "named"],
        ["robot_9", "1", "error"],
        ["robot_10", "3", "named"],
        ["robot_11", "3", "none"],
    ]
    assert rows[0][3] == "track_width:"
    assert rows[0][-2:] == ["add", "track_width"]
    before, arrow, after = rows[0][4:7]
    assert arrow == "→"
    assert 0.0 < float(after) < float(before)
    values = [
        line.split() for line in said.out.splitlines() if "multiplier" in line and "±" in line
    ]
    assert [float(words[1]) for words in values] == pytest.approx([1.03, 1.025], abs=0.005)
    assert max(map(len, said.out.rsplit("written: ")[0].splitlines())) <= 100


def test_the_json_names_robots_by_what_they_miss(said: Said) -> None:
    figures = said.figures
    assert figures["missing"] == {"track_width": ["robot_2", "robot_10"]}
    assert figures["verdicts"] == {"error": 1, "named": 2, "none": 1}
    assert figures["left"] == []
    bad = figures["robots"][1]
    assert bad.keys() == {"robot", "error"}
    assert bad["error"].startswith("fleet/robot_9/runs/day/ticks.csv, line 1: ")


def test_a_robot_of_a_fleet_is_diagnosed_as_by_itself(home: Path, said: Said) -> None:
    folder = home / "fleet" / "robot_2"
    words = ["--robot", str(folder / "robot.yaml")]
    words += [str(folder / "train" / name) for name in ("free", "square")]
    words += ["--holdout", str(folder / "holdout" / "free")]
    alone = say(home, *words)
    (row,) = (row for row in said.figures["robots"] if row["robot"] == "robot_2")
    del row["robot"]
    assert row == alone.figures
    assert row["found"][0]["parameters"]["multiplier"]["value"] == pytest.approx(
        BASES["robot_2"], abs=0.005
    )


@pytest.mark.evidence
def test_one_process_says_the_same_as_two(home: Path, said: Said) -> None:
    assert say(home, "--fleet", "fleet", "--jobs", "1").text == said.text


@pytest.mark.evidence
def test_a_cluster_without_our_disk_says_the_same(home: Path, said: Said, cluster: Any) -> None:
    there = say(home, "--fleet", "fleet", "--scheduler", cluster.scheduler_address)
    assert there.text == said.text
    assert there.out.rsplit("written: ")[0] == said.out.rsplit("written: ")[0]


def test_the_page_shows_each_robot_and_draws_itself(home: Path, said: Said) -> None:
    assert f"written: {home}" in said.out
    page = (home / "page.html").read_text(encoding="utf-8")
    for name in (*BASES, "robot_9"):
        assert f'<th scope="row">{name}</th>' in page
    assert "fleet/robot_9/runs/day/ticks.csv, line 1: " in page
    assert 'data-figure="errors"' in page


@pytest.fixture
def refused(complaint: Complaint) -> Complaint:
    """What `werrimbi diagnose` says of a mistake."""
    return lambda *words: complaint("diagnose", *words)


def test_wrong_use_is_one_line_with_the_mend(
    home: Path, tmp_path: Path, refused: Complaint
) -> None:
    fleet = home / "fleet"
    run = fleet / "robot_2" / "train" / "free"
    robot = fleet / "robot_2" / "robot.yaml"
    both = refused("--fleet", fleet, "--jobs", "2", "--scheduler", "tcp://a:1")
    assert "leave out one" in both
    assert "leave out --robot" in refused("--fleet", fleet, "--robot", robot)
    assert "leave out --reference" in refused("--fleet", fleet, "--reference", robot)
    assert "leave out RUN" in refused("--fleet", fleet, "--", run)
    assert "leave out --holdout" in refused("--fleet", fleet, "--holdout", run)
    assert "give --fleet FOLDER" in refused("--robot", robot, run, "--jobs", "2")
    alone = refused("--robot", robot, run, "--scheduler", "tcp://a:1")
    assert "give --fleet FOLDER" in alone
    assert "greater than zero" in refused("--fleet", fleet, "--jobs", "0")
    assert "write tcp://HOST:PORT" in refused("--fleet", fleet, "--scheduler", "a:1")
    assert "required: RUN, --robot" in refused()
    assert "required: RUN " in refused("--robot", robot)
    taken = refused("--fleet", fleet, "--json", run / "ticks.csv")
    assert "would overwrite" in taken
    late = refused("--fleet", fleet, "--json", tmp_path / "new" / "figures.json")
    assert "there is no folder" in late
    assert "ends in .html" in refused("--fleet", fleet, "--report", tmp_path / "a.txt")


def test_a_folder_without_a_fleet_is_told(home: Path, tmp_path: Path, refused: Complaint) -> None:
    assert "no such folder" in refused("--fleet", tmp_path / "nowhere")
    assert "no robot is in it; each robot is" in refused("--fleet", tmp_path)
    one = refused("--fleet", home / "fleet" / "robot_2")
    assert "is one robot" in one
    robot = broken(tmp_path / "robot_1")
    (robot / "runs" / "day" / "ticks.csv").unlink()
    (robot / "runs" / "day").rmdir()
    assert "holds no runs; put them in" in refused("--fleet", tmp_path)


def test_effects_that_cannot_be_used_are_no_robots_fault(
    home: Path, tmp_path: Path, refused: Complaint
) -> None:
    (tmp_path / "mine.py").write_text("1 / 0\n")
    told = refused("--fleet", home / "fleet", "--effects", tmp_path / "mine.py")
    assert "mine.py:1: ZeroDivisionError" in told


def test_what_is_not_installed_is_told_before_anything_is_begun(
    home: Path, monkeypatch: pytest.MonkeyPatch, refused: Complaint
) -> None:
    monkeypatch.setitem(sys.modules, "threadpoolctl", None)
    told = refused("--fleet", home / "fleet")
    assert "pip install 'werrimbi_odom[tools]'" in told
