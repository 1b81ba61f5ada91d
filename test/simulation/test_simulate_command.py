# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi simulate`: a session in a folder, all or nothing, the truth apart from the runs."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import werrimbi_odom.simulation
from test.cli.commands import called
from test.command_line import Complaint
from werrimbi_odom.cli import main as command
from werrimbi_odom.cli import simulate
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.simulation import (
    CATALOGUE,
    Nominal,
    TrueRobot,
    UnstableError,
    drives,
    moves,
    wished,
    write_robot_file,
)

call = partial(called, simulate)


@pytest.fixture
def short_day(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two little drives in place of eleven long ones."""
    day = {"train/hop": moves("hop", [(0.2, 0.0)]), "holdout/bend": moves("bend", [(0.2, 0.3)])}
    monkeypatch.setattr("werrimbi_odom.simulation.sessions.drives", lambda seed: day)


@pytest.mark.usefixtures("short_day")
def test_it_writes_robot_runs_and_truth(tmp_path: Path) -> None:
    out = tmp_path / "new" / "day"
    assert call("--out", str(out), "--hide", "track_width=1.02", "--seed", "5") == 0
    files = sorted(str(f.relative_to(out)) for f in out.rglob("*") if f.is_file())
    assert files == [
        "holdout/bend/reference.csv",
        "holdout/bend/ticks.csv",
        "robot.yaml",
        "train/hop/reference.csv",
        "train/hop/ticks.csv",
        "truth.json",
    ]
    truth = json.loads((out / "truth.json").read_text(encoding="utf-8"))
    assert truth["seed"] == 5
    assert truth["hidden"][0]["effect"] == "track_width"
    assert truth["hidden"][0]["parameters"] == {"multiplier": 1.02}
    says = YAML(typ="safe").load((out / "robot.yaml").read_text(encoding="utf-8"))
    assert says["odom_node"]["ros__parameters"]["wheel_separation"] == 0.35


@pytest.mark.usefixtures("short_day")
def test_the_same_seed_writes_the_same_files(tmp_path: Path) -> None:
    def contents(name: str, seed: str) -> dict[str, str]:
        out = tmp_path / name
        call("--out", str(out), "--hide", "random", "--seed", seed)
        return {
            str(f.relative_to(out)): f.read_text(encoding="utf-8")
            for f in out.rglob("*")
            if f.is_file()
        }

    first = contents("first", "1")
    assert first == contents("second", "1")
    assert first["train/hop/ticks.csv"] != contents("third", "2")["train/hop/ticks.csv"]


@pytest.mark.usefixtures("short_day")
def test_nothing_is_said_of_what_is_hidden(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    call("--out", str(tmp_path / "day"), "--hide", "track_width")
    printed = capsys.readouterr()
    assert "track" not in printed.out + printed.err


@pytest.mark.usefixtures("short_day")
def test_an_empty_folder_may_be_filled(tmp_path: Path) -> None:
    (tmp_path / "day").mkdir()
    assert call("--out", str(tmp_path / "day")) == 0
    truth = json.loads((tmp_path / "day" / "truth.json").read_text(encoding="utf-8"))
    assert truth["hidden"] == []


def test_a_folder_with_something_in_it_is_left_alone(tmp_path: Path, complaint: Complaint) -> None:
    (tmp_path / "thesis.tex").write_text("all of it", encoding="utf-8")
    assert "not empty" in complaint("simulate", "--out", tmp_path)
    assert [f.name for f in tmp_path.iterdir()] == ["thesis.tex"]


def test_a_file_is_left_alone(tmp_path: Path, complaint: Complaint) -> None:
    file = tmp_path / "day"
    file.write_text("mine", encoding="utf-8")
    assert "is a file" in complaint("simulate", "--out", file)
    assert file.read_text(encoding="utf-8") == "mine"


@pytest.mark.parametrize(
    ("wish", "answer"),
    [
        ("trackwidth", "did you mean track_width"),
        ("track_width=wide", "not a number"),
        ("track_width=nan", "cannot be nan"),
        ("track_width=0", "cannot be 0"),
        ("eccentric_left_wheel=inf", "cannot be inf"),
        ("eccentric_left_wheel=5", "eccentric_left_wheel cannot be 5 m: .* have 0 to 0.015 m"),
        ("lateral_slip=-0.02", "lateral_slip cannot be -0.02 s: a robot can have 0 to 0.2 s"),
        ("track_width=1e-9", "track_width cannot be 1e-09: a robot can have 0.0625 to 16"),
        ("wheels_swapped=7", "wheels_swapped cannot be 7: a robot can have 0 to 1"),
        ("skid_steer=0.5", "skid_steer cannot be 0.5: a robot can have 1 to 4"),
        ("random=0.01", "name the effect"),
        ("", "nothing called ''"),
    ],
)
def test_a_wish_that_cannot_be_met(tmp_path: Path, wish: str, answer: str) -> None:
    with pytest.raises(InputError, match=answer) as refusal:
        call("--out", str(tmp_path / "day"), "--hide", wish)
    assert "\n" not in str(refusal.value)
    assert not (tmp_path / "day").exists()


def test_an_effect_is_hidden_once(tmp_path: Path) -> None:
    twice = ("--hide", "track_width=1.02", "--hide", "track_width=0.98")
    with pytest.raises(InputError, match="track_width comes 2 times"):
        call("--out", str(tmp_path / "day"), *twice)
    assert list(tmp_path.iterdir()) == []
    one = wished(["random"], seed=3)[0].entry.name
    names = [each.entry.name for each in wished(["random", one, "random"], seed=3)]
    assert len(set(names)) == 3, "random draws none that is hidden already"


def test_all_that_is_realistic_is_possible() -> None:
    for entry in CATALOGUE:
        least, most = entry.possible
        assert least <= entry.null - entry.signed * entry.high < entry.null + entry.high <= most


@pytest.mark.usefixtures("short_day")
def test_a_robot_that_cannot_be_built(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def cannot(*_: object, **__: object) -> Iterator[None]:
        yield from ()
        raise UnstableError("the engine gave up")

    monkeypatch.setattr(werrimbi_odom.simulation, "session", cannot)
    with pytest.raises(InputError, match="no such robot can be built: the engine gave up"):
        call("--out", str(tmp_path / "day"))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("short_day")
def test_a_failure_half_way_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(recording: object, folder: Path) -> Path:
        folder.mkdir(parents=True)
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(werrimbi_odom.simulation, "write_run", full)
    with pytest.raises(InputError, match="No space left"):
        call("--out", str(tmp_path / "day"))
    assert list(tmp_path.iterdir()) == []


def test_out_is_asked_for() -> None:
    with pytest.raises(InputError, match="--out"):
        call()


def test_the_list_needs_no_folder(capsys: pytest.CaptureFixture[str]) -> None:
    assert call("--list") == 0
    listed = capsys.readouterr().out
    for entry in CATALOGUE:
        assert f"  {entry.name}  " in listed
    assert "1.3 to 2.5" in listed, "skid_steer: its null added to both ends"


def test_the_next_command_takes_its_own_bags(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A bag as of the field has two references, so the printed command names one."""
    there = moves("there", [(2.0, 0.0), (0.0, 1.6), (2.0, 1.0), (-2.0, 0.0), (0.0, -1.6)])
    monkeypatch.setattr(
        "werrimbi_odom.simulation.sessions.drives", lambda seed: {"train/there": there}
    )
    assert call("--out", str(tmp_path / "a day"), "--like", "field") == 0
    words = shlex.split(capsys.readouterr().out.partition("next: werrimbi ")[2])
    assert command.main([*words[:-1], str(tmp_path / "a day" / "train" / "there")]) == 0


def test_a_day_has_seven_drives_to_learn_from_and_four_to_test() -> None:
    names = list(drives(1))
    assert sum(name.startswith("train/") for name in names) == 7
    assert sum(name.startswith("holdout/") for name in names) == 4
    minutes = sum(drive.duration for drive in drives(1).values()) / 60
    assert 9.0 < minutes < 13.0


def test_a_robot_of_crooked_sizes_is_written_so_that_it_can_be_read(tmp_path: Path) -> None:
    """Numbers of many digits must not swallow the space before their comment."""
    robot = TrueRobot(
        nominal=Nominal(wheel_separation=1.0 / 3.0, wheel_radius=0.1 / 3.0),
        left_ticks_per_revolution=6178.123456,
        left_wheel_noise=0.001 / 3.0,
        right_wheel_noise=0.002 / 3.0,
    )
    read = read_robot_file(write_robot_file(robot, tmp_path / "robot.yaml")).robot
    assert read.wheel_separation == 1.0 / 3.0
    assert read.left_wheel_noise == 0.001 / 3.0
