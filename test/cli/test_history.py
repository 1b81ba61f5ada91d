# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi history` on run folders: dates, a change, what is kept, what cannot be used."""

from __future__ import annotations

import os
import shlex
import shutil
from dataclasses import replace
from pathlib import Path

import pytest

import werrimbi_odom as wo
from test.cli.commands import PLAIN, ROBOT_FILE, write_run, written_by
from test.command_line import Complaint, Printed, Werrimbi
from test.files.conftest import Messages
from test.files.unseen import JOINTS, joints, poses
from test.inference.driven import run_of
from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.changes.dated_drives import Unusable
from werrimbi_odom.report.history_words import words_of

BEGAN = 1_700_000_000.0
DAY = 86400.0
DRIVES, FIRST_NEW = 7, 4


@pytest.fixture(scope="module")
def months(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Drives with dates, in folders whose names are in no order; the right tyre is replaced."""
    folder = tmp_path_factory.mktemp("months")
    (folder / "robot.yaml").write_text(ROBOT_FILE)
    sound = ROBOT_FILE + "    right_wheel_radius_multiplier: 1.006\n"
    (folder / "sound.yaml").write_text(sound)
    for number in range(DRIVES):
        factor = 1.006 if number >= FIRST_NEW else 1.0
        truth = replace(PLAIN, right_wheel_radius_multiplier=factor)
        run, late = run_of(truth, 20 + number, 25), BEGAN + 9.0 * DAY * number
        assert run.reference is not None
        moved = replace(run.reference, time=run.reference.time + late)
        ticks = replace(run.ticks, time=run.ticks.time + late)
        # Seconds since 1970 need more digits than `write_run` gives: these start at whole ones.
        write_run(folder / f"drive_{(number * 3) % DRIVES}", run)
        for name, table in (("ticks", ticks.time), ("reference", moved.time)):
            file = folder / f"drive_{(number * 3) % DRIVES}" / f"{name}.csv"
            head, *rows = file.read_text().splitlines()
            rows = [
                f"{time:.3f},{row.partition(',')[2]}"
                for time, row in zip(table.tolist(), rows, strict=True)
            ]
            file.write_text("\n".join([head, *rows]) + "\n")
    (folder / "drive_broken").mkdir()
    (folder / "drive_broken" / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n")
    return folder


def told(folder: Path, *more: str, out: Path) -> dict[str, object]:
    robot, drives = folder / "robot.yaml", sorted(folder.glob("drive_*"))
    return written_by(out, "history", "--robot", robot, *drives, *more, "--jobs", "1")


def test_drives_are_told_by_their_dates_and_kept_by_their_content(
    months: Path, tmp_path: Path, printed: Printed
) -> None:
    cache, out, page = tmp_path / "kept", tmp_path / "h.json", tmp_path / "h.html"
    more = ("--cache", str(cache), "--report", str(page), "--like", str(months / "sound.yaml"))
    found = told(months, *more, out=out)
    dates = [drive["date"] for drive in found["drives"]]
    assert dates == sorted(dates)
    assert {drive["date_from"] for drive in found["drives"]} == {"stamp"}
    assert [Path(drive["run"]).name for drive in found["drives"]] == [
        f"drive_{(number * 3) % DRIVES}" for number in range(DRIVES)
    ]
    (change,) = found["changes"]
    assert change["what"] == "right_wheel_radius_multiplier"
    assert Path(change["from_run"]).name == f"drive_{(FIRST_NEW * 3) % DRIVES}"
    assert (change["before"], change["after"]) == pytest.approx((1.0, 1.006), abs=4e-4)
    assert change["date"].startswith("2023-12-20")
    assert [alarm["what"] for alarm in found["alarms"]] == ["right_wheel", "calibration"]
    assert not any(each["differs"] for each in found["like"])
    (unusable,) = found["unusable"]
    assert "drive_broken" in unusable["run"]
    words = printed()
    assert "look at the right wheel" in words
    assert "calibrate again" in words
    assert "nothing is new" in words
    assert "right radius" in page.read_text()

    kept = sorted(cache.iterdir())
    assert len(kept) == DRIVES
    before = [file.stat().st_mtime_ns for file in kept]
    again = told(months, *more, out=out)
    assert again == found
    assert [file.stat().st_mtime_ns for file in sorted(cache.iterdir())] == before
    words = printed()
    assert f"{DRIVES} of them known from before" in words
    kept[0].write_text("{")
    assert told(months, *more, out=out) == found


def test_without_stamps_the_files_own_dates_count_unless_they_were_copied(
    tmp_path: Path, printed: Printed
) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT_FILE)
    for number in range(2):
        write_run(tmp_path / f"drive_{number}", run_of(PLAIN, number, 25))
    more = ("--cache", str(tmp_path / "kept"))
    found = told(tmp_path, *more, out=tmp_path / "h.json")
    assert [drive["date"] for drive in found["drives"]] == [None, None]
    assert "in the order given" in printed()
    for file in (tmp_path / "drive_1").iterdir():
        os.utime(file, (BEGAN, BEGAN))
    found = told(tmp_path, *more, out=tmp_path / "h.json")
    assert [Path(drive["run"]).name for drive in found["drives"]] == ["drive_1", "drive_0"]
    assert found["drives"][0]["date"].startswith("2023-11-14")
    assert "when their files were written" in printed()
    assert found["changes"] == []


@pytest.mark.usefixtures("few_effects")
def test_diagnose_tells_the_same_change_before_its_verdict(
    months: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drives, robot = sorted(months.glob("drive_[0-9]")), months / "robot.yaml"
    found = written_by(tmp_path / "d.json", "diagnose", "--robot", robot, *drives)
    (change,) = found["changes"]
    assert change["what"] == "right_wheel_radius_multiplier"
    assert change["from_run"] == f"drive_{(FIRST_NEW * 3) % DRIVES}"
    assert change["after"] - change["before"] == pytest.approx(0.006, abs=6e-4)
    assert change["p_value"] < 1e-3
    printed = capsys.readouterr().out
    assert printed.startswith("The robot was not the same in all of these drives.")
    # In the order of their dates, which is not that of their names.
    since = [f"drive_{(number * 3) % DRIVES}" for number in range(FIRST_NEW, DRIVES)]
    assert f"ask again with the drives from {since[0]} on alone:" in " ".join(printed.split())
    command = printed[printed.index("    werrimbi diagnose") :].partition("\n")[2].split("\n")[0]
    assert sorted(Path(word).name for word in command.split()) == sorted(since)


@pytest.mark.usefixtures("few_effects")
def test_drives_of_one_name_are_told_apart_by_their_folders(
    months: Path, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """One shape on each day: "between square and square", and a command with all of them."""
    drives = [tmp_path / f"day_{number}" / "square" for number in range(DRIVES)]
    for number, drive in enumerate(drives):
        shutil.copytree(months / f"drive_{(number * 3) % DRIVES}", drive)
    said = werrimbi("diagnose", "--robot", months / "robot.yaml", *drives).words
    assert f"Between day_{FIRST_NEW - 1}/square and day_{FIRST_NEW}/square the right wheel" in said
    again = said.partition(f"with the drives from day_{FIRST_NEW}/square on alone:")[2]
    command = shlex.split(again.partition(" Nothing is missing")[0].replace("\\ ", ""))
    assert command[4:] == list(map(str, drives[FIRST_NEW:]))


def test_from_python_it_takes_drives_that_were_read_and_keeps_nothing(months: Path) -> None:
    robot = wo.read_robot(months / "robot.yaml")
    drives = [wo.read_run(months / f"drive_{number}", robot) for number in (0, 3, 6)]
    result = wo.history(robot, drives)
    assert result.to_dict()["changes"] == []
    assert [drive.run.name for drive in result.found.drives] == ["drive_0", "drive_3", "drive_6"]
    assert "Nothing changed" in repr(result)
    assert list(result.figures()) == ["history"]


def test_a_robot_file_that_was_edited_is_read_anew(months: Path, tmp_path: Path) -> None:
    file, drive = tmp_path / "robot.yaml", months / "drive_0"
    bases = []
    for base in ("0.35", "0.37"):
        file.write_text(ROBOT_FILE.replace("wheel_separation: 0.35", f"wheel_separation: {base}"))
        robot = wo.read_robot(file)
        told = wo.history(robot, drive, cache=tmp_path / "kept").to_dict()["numbers"]
        bases.append(robot.robot.wheel_separation * told["wheel_separation_multiplier"]["now"])
    assert bases[1] == pytest.approx(bases[0], rel=0.005), "the robot is the same"


STRETCHED = """\
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel

@wheel_effect(gain=Parameter("", 0.0, 0.01, (-0.5, 0.5), "share of the travel"))
def stretched(travel, drive, gain):
    \"""Wheels go farther than they turn.

    Formula    travel *= 1 + gain      [m]
    Signature  distances are wrong
    Ruler      tape
    \"""
    return WheelTravel(travel.left * (1.0 + gain), travel.right * (1.0 + gain))
"""


def test_an_effect_of_one_s_own_that_was_edited_is_read_anew(months: Path, tmp_path: Path) -> None:
    file, law = tmp_path / "robot.yaml", tmp_path / "stretched.py"
    file.write_text(ROBOT_FILE + "    effects: [stretched]\n    stretched: {gain: 0.02}\n")
    gains = []
    for text in (STRETCHED, STRETCHED.replace("+ gain)", "+ 3.0 * gain)")):
        law.write_text(text)
        told = wo.history(wo.read_robot(file, [law]), months / "drive_0", effects=[law]).to_dict()
        gains.append(told["numbers"]["stretched.gain"]["now"])
    assert gains[1] != pytest.approx(gains[0], rel=0.01)


def test_what_a_bag_is_read_by_is_no_other_robot_s(tmp_path: Path) -> None:
    """Names of the joints that are exchanged in the file make another robot of the same bag."""
    ros, run = Messages(), run_of(PLAIN, 3, 25)
    assert run.reference is not None
    sent = [*joints(ros, run), *poses(ros, run)]
    bag = ros.write(tmp_path / "bag", sorted(sent, key=lambda each: each[1]), "sqlite3")
    file = tmp_path / "robot.yaml"

    def history_by(left: str, right: str) -> None:
        names = f"    left_wheel_names: [{left}]\n    right_wheel_names: [{right}]\n"
        file.write_text(ROBOT_FILE + names)
        wo.history(wo.read_robot(file), bag, cache=tmp_path / "kept")

    history_by(*JOINTS)
    with pytest.raises(InputError, match="counters are exchanged"):
        history_by(*JOINTS[::-1])


def test_a_drive_that_was_read_and_cannot_be_used_leaves_the_others(months: Path) -> None:
    """As one that is given by its path: the history of the others is told."""
    robot = wo.read_robot(months / "robot.yaml")
    drives = [wo.read_run(months / f"drive_{number}", robot) for number in (0, 3)]
    blind = replace(drives[1], reference=None, path=Path("blind"))
    found = wo.history(robot, [drives[0], blind]).found
    assert [drive.run.name for drive in found.drives] == ["drive_0"]
    assert [each.run for each in found.unusable] == [Path("blind")]
    with pytest.raises(InputError, match=r"no drive can be used; blind: .*no reference"):
        wo.history(robot, blind)


@pytest.mark.parametrize("wrong", ["millimetres", "exchanged"])
def test_a_drive_that_is_set_up_wrongly_tells_no_sizes(months: Path, wrong: str) -> None:
    """By millimetres the base was 1e-48 of the file's, and "calibrate again" was said of it."""
    robot = wo.read_robot(months / "robot.yaml")
    sound, drive = (wo.read_run(months / f"drive_{number}", robot) for number in (0, 3))
    seen, ticks = drive.reference, drive.ticks
    assert seen is not None
    if wrong == "millimetres":
        seen = replace(seen, x=1e3 * seen.x, y=1e3 * seen.y)
    else:
        ticks = replace(ticks, left=ticks.right, right=ticks.left)
    found = wo.history(robot, [sound, replace(drive, reference=seen, ticks=ticks)]).found
    assert [each.run.name for each in found.drives] == ["drive_0"]
    assert [each.run.name for each in found.unusable] == ["drive_3"]
    assert wrong in found.unusable[0].why


def test_a_drive_that_was_read_counts_once(months: Path) -> None:
    robot = wo.read_robot(months / "robot.yaml")
    drive = wo.read_run(months / "drive_0", robot)
    with pytest.raises(InputError, match="is given twice"):
        wo.history(robot, [drive, drive])


def test_of_one_more_unusable_drive_it_is_told_as_of_one(months: Path) -> None:
    robot = wo.read_robot(months / "robot.yaml")
    found = wo.history(robot, months / "drive_0").found
    broken = [Unusable(Path(f"drive_{number}"), "it is empty") for number in range(6)]
    said = [part.text for part in words_of(replace(found, unusable=tuple(broken)))]
    assert said[-1] == "So is 1 more drive."


def test_drives_none_of_which_can_be_used_are_an_error(
    tmp_path: Path, complaint: Complaint
) -> None:
    (tmp_path / "robot.yaml").write_text(ROBOT_FILE)
    (tmp_path / "empty").mkdir()
    given = ("--robot", tmp_path / "robot.yaml", tmp_path / "empty", "--cache", tmp_path / "kept")
    assert "no drive can be used" in complaint("history", *given)


@pytest.mark.parametrize("jobs", [-2, 0])
def test_processes_are_one_or_more(months: Path, complaint: Complaint, jobs: int) -> None:
    given = ("--robot", months / "robot.yaml", *sorted(months.glob("drive_*")), "--jobs", jobs)
    assert "not a whole number greater than zero" in complaint("history", *given)


def test_what_only_the_other_file_holds_is_told(tmp_path: Path) -> None:
    """These drives were not asked about it: silence would mean that it is alike on both."""
    (tmp_path / "robot.yaml").write_text(ROBOT_FILE)
    more = "    effects: [lateral_slip]\n    lateral_slip:\n      creep: 0.01\n"
    (tmp_path / "other.yaml").write_text(ROBOT_FILE + more)
    own, other = (wo.read_robot(tmp_path / f"{name}.yaml") for name in ("robot", "other"))
    run = run_of(PLAIN, 1, 25)
    said = " ".join(str(part) for part in words_of(wo.history(own, [run], like=other).found))
    assert "It holds lateral_slip, which this file does not: not compared." in said
    alike = " ".join(str(part) for part in words_of(wo.history(other, [run], like=other).found))
    assert "not compared" not in alike
