# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From a bag that nobody has seen to a robot file and the command that comes next, which works."""

from __future__ import annotations

import json
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import PLAIN, ROBOT_FILE, write_controllers, write_run
from test.command_line import Werrimbi
from test.files.conftest import Messages
from test.files.unseen import DAY, JOINTS, gyro, joints, poses, stamp_of, urdf
from test.inference.driven import run_of
from test.inference.test_held_or_carried import held
from test.model.drives import ROBOT
from werrimbi_odom.cli.main import main
from werrimbi_odom.simulation.lidar import Lidar


def bag_of(
    folder: Path, *, described: bool = True, measured: bool = True, again: str = "/joint_states"
) -> tuple[Path, float]:
    """A bag as people have it: joints, gyro, own odometry, poses of a tracker; begin of a hold."""
    ros, late = Messages(), np.random.default_rng(4)
    run, begin, _ = held(run_of(ROBOT, 1, 40), 20.0, 26.0)
    sent = list(joints(ros, run))
    sent += [(again, at, what) for topic, at, what in sent if topic != again]
    sent += [("/odom", at, ros.odometry(at, 0.0, 0.0, 0.0)) for _, at, _ in sent]
    if measured:
        sent += gyro(ros, run)
        sent += [("/vrpn/robot/pose", at, pose) for _, at, pose in poses(ros, run)]
    if described:
        text = ros.make("std_msgs/msg/String", urdf())
        sent.append(("/robot_description", stamp_of(0.0), ("std_msgs/msg/String", text)))
    entries = [(topic, at + round(1e9 * late.exponential(0.02)), what) for topic, at, what in sent]
    entries.sort(key=lambda entry: entry[1])
    return ros.write(folder / "a bag", entries, "sqlite3"), begin


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, float]:
    return bag_of(tmp_path_factory.mktemp("info"))


def test_three_commands_from_a_bag_to_the_verdict(
    recording: tuple[Path, float],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bag, _ = recording
    monkeypatch.chdir(tmp_path)
    assert main(["info", str(bag)]) == 0
    words = " ".join(capsys.readouterr().out.split())
    assert "Wheels: /joint_states, angles of the wheels at 20 Hz" in words
    assert "Reference /vrpn/robot/pose: poses at 5 Hz" in words
    assert "No reference: /odom" in words
    assert "believe the headers" in words
    assert "was held for" in words
    assert "the wheels turned and the robot did not: held, or against a wall. Left out." in words
    commands = [words.rpartition("Next: a first robot file. ")[2]]
    for verb in ("info", "compare"):
        said = shlex.split(commands[-1])
        assert said[:2] == ["werrimbi", verb]
        assert main([*said[1:], "--json", f"{verb}.json"]) == 0, commands[-1]
        printed = capsys.readouterr().out
        commands.append(next((line for line in printed.splitlines() if "    werri" in line), ""))
    robot = wo.read_robot(tmp_path / "robot.yaml")
    assert robot.robot.wheel_separation == pytest.approx(ROBOT.wheel_separation, abs=1e-5)
    assert robot.robot.wheel_radius == pytest.approx(ROBOT.wheel_radius, abs=1e-6)
    assert robot.robot.left_ticks_per_revolution == ROBOT.left_ticks_per_revolution
    found = json.loads(Path("info.json").read_text())
    compared = json.loads(Path("compare.json").read_text())
    (run,) = found["runs"]
    assert run["left_out"] == compared["left_out"]
    assert [each["topic"] for each in run["references"] if each["taken"]] == ["/vrpn/robot/pose"]
    assert run["stamps"]["/joint_states"]["rate"] == pytest.approx(20.0, rel=0.01)
    assert run["stamps"]["/joint_states"]["jitter"] < 1e-4
    spans = dict.fromkeys(("stood", "drove", "held"), 0.0)
    for span in run["spans"]:
        spans[span["what"]] += span["to_s"] - span["from_s"]
    assert spans["held"] == pytest.approx(5.0, abs=1.5)
    assert compared["legs"]["count"] > 20


def test_from_python_it_is_the_same(recording: tuple[Path, float], tmp_path: Path) -> None:
    bag, begin = recording
    result = wo.info(bag, out=tmp_path / "robot.yaml")
    found = result.to_dict()
    (stretch,) = found["runs"][0]["left_out"]
    assert stretch["why"] == "held"
    assert stretch["from_s"] - DAY == pytest.approx(begin, abs=0.5)
    assert found["robot"] == str(tmp_path / "robot.yaml")
    assert found["next"].startswith("werrimbi compare --robot")
    assert "The" not in repr(result)
    assert str(bag) in result.summary()


@pytest.mark.evidence
def test_the_commands_keep_the_wheels_that_were_asked_for(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    bag, _ = bag_of(tmp_path, again="/motors")
    taken = wo.info(bag).to_dict()["runs"][0]["wheels"]
    (other,) = (
        each["topic"] for each in taken if each["gives"] == "positions" and not each["taken"]
    )
    words = ["info", str(bag), "--ticks-topic", other]
    for then in ("info", "compare"):
        printed = werrimbi(*words).out.splitlines()
        words = shlex.split(next(line for line in printed if line.startswith("    werrimbi")))[1:]
        words = [str(tmp_path / word) if word == "robot.yaml" else word for word in words]
        assert words[0] == then
        assert words[words.index("--ticks-topic") + 1] == other


@pytest.mark.evidence
def test_without_sizes_it_says_what_to_measure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag, _ = bag_of(tmp_path, described=False)
    assert main(["info", str(bag)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "measure the wheels' radius and the distance between them" in printed
    assert " m and turned" not in printed
    assert main(["info", str(bag), "--out", str(tmp_path / "new.yaml")]) == 2
    told = capsys.readouterr()
    assert "/robot_description" in told.err
    assert " ".join(told.out.split()) == printed  # what it holds is told all the same
    parameters = tmp_path / "controllers.yaml"
    parameters.write_text(
        "controller_manager:\n  ros__parameters:\n    update_rate: 50\n"
        "diff_drive_controller:\n  ros__parameters:\n"
        f"    left_wheel_names: [{JOINTS[0]}]\n    right_wheel_names: [{JOINTS[1]}]\n"
        f"    wheel_separation: {ROBOT.wheel_separation}\n    wheel_radius: {ROBOT.wheel_radius}\n"
        "    left_wheel_radius_multiplier: 1.01\n    linear.x.max_velocity: 1.0\n"
    )
    capsys.readouterr()
    assert main(["info", str(bag), "--robot", str(parameters)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert f"--robot {parameters} --out robot.yaml" in printed, "else it has no sizes to write"
    out = tmp_path / "new.yaml"
    words = ["info", str(bag), "--robot", str(parameters), "--out", str(out)]
    assert main(words) == 0
    robot = wo.read_robot(out).robot
    assert robot.left_wheel_radius_multiplier == 1.01
    assert robot.left_ticks_per_revolution == ROBOT.left_ticks_per_revolution
    assert main(words) == 2  # it is not overwritten


def test_counts_of_a_turn_that_nothing_tells_are_a_placeholder_and_no_distance_is_told(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    write_run(tmp_path / "drive", held(run_of(ROBOT, 1, 40), 20.0, 26.0)[0])
    sizes = tmp_path / "controllers.yaml"
    write_controllers(sizes, ROBOT)
    out = tmp_path / "robot.yaml"
    printed = werrimbi("info", tmp_path / "drive", "--robot", sizes, "--out", out).words
    assert f"4096 in {out} is a placeholder. Enter left_ticks_per_revolution" in printed
    assert "it went" not in printed, "by 4096 counts a turn any distance is nonsense"
    written = out.read_text()
    assert written.count("ticks_per_revolution: 4096.0  # a placeholder: enter the counts") == 2
    out.write_text(written.replace("4096.0  # a placeholder: enter the", "2000.0  # "))
    assert "it went" in werrimbi("info", tmp_path / "drive", "--robot", out).words


@pytest.mark.parametrize("bits", [12, 16])
def test_counters_that_wrap_are_told_and_the_first_robot_file_says_at_how_many_bits(
    tmp_path: Path, werrimbi: Werrimbi, bits: int
) -> None:
    run, period = run_of(ROBOT, 1, 40), 1 << bits
    left, right = ((counts - 500) % period for counts in (run.ticks.left, run.ticks.right))
    assert np.abs(np.diff(left)).max() > period / 2, "it wraps"
    write_run(tmp_path / "drive", replace(run, ticks=replace(run.ticks, left=left, right=right)))
    sizes = tmp_path / "controllers.yaml"
    write_controllers(sizes, ROBOT)
    out = tmp_path / "robot.yaml"
    printed = werrimbi("info", tmp_path / "drive", "--robot", sizes, "--out", out)
    assert f"begin anew at {bits} bits: the robot file needs encoder_bits: {bits}" in printed.words
    out.write_text(out.read_text().replace("4096.0", "2000.0"))
    assert wo.read_robot(out).robot.encoder_bits == bits
    command = next(line for line in printed.out.splitlines() if "werrimbi compare" in line)
    werrimbi(*shlex.split(command)[1:])


def test_a_robot_file_with_a_mistake_is_not_taken_for_a_controllers(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    bag, _ = bag_of(tmp_path)
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(
        "odom_node:\n  ros__parameters:\n    wheel_separation: 0.4\n    wheel_radius: 0.1\n"
        "    ticks_per_revolution: 1000.0\n"
    )
    told = werrimbi("info", bag, "--robot", wrong, code=2).err
    assert "unknown parameter ticks_per_revolution" in told


def test_without_a_reference_it_says_so(tmp_path: Path, werrimbi: Werrimbi) -> None:
    bag, _ = bag_of(tmp_path, measured=False)
    printed = werrimbi("info", bag).words
    assert "Nothing that is read in the bag measures the robot but its own wheels" in printed
    assert "If another recording measured these drives" in printed
    assert "record again with something that measures the robot" in printed


@pytest.mark.parametrize("kind", ["bag", "table"])
def test_a_reference_in_another_recording_is_looked_at_and_kept_in_the_command(
    kind: str, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """Motion capture of another computer: its bag, which holds another body too, or a table."""
    bag, _ = bag_of(tmp_path, measured=False)
    ros, other = Messages(), tmp_path / "mocap"
    seen = [(at, pose) for _, at, pose in poses(ros, held(run_of(ROBOT, 1, 40), 20.0, 26.0)[0])]
    if kind == "bag":
        ros.write(other, [(f"/vrpn/{name}/pose", *each) for each in seen for name in ("a", "b")])
        told = f"Reference /vrpn/a/pose in {other}: poses (poses in map, of a sensor"
    else:
        other.mkdir()
        rows = (
            f"{1e-9 * at},{p.pose.position.x},{p.pose.position.y},"
            f"{2.0 * np.arctan2(p.pose.orientation.z, p.pose.orientation.w)}"
            for at, (_, p) in seen
        )
        (other / "reference.csv").write_text("\n".join(["t_s,x_m,y_m,yaw_rad", *rows]) + "\n")
        told = f"Reference: {other / 'reference.csv'}, poses."
    robot, judged = tmp_path / "robot.yaml", tmp_path / "compare.json"
    for words in (("--reference", other), ("--reference", other, "--out", robot)):
        said = werrimbi("info", bag, *words, "--json", judged)
        assert told in said.words
        assert "Nothing that is read in the bag measures" not in said.words
        assert "the wheels turned and the robot did not" in said.words
        taken = [
            each
            for each in json.loads(judged.read_text())["runs"][0]["references"]
            if each["taken"]
        ]
        assert [each["run"] for each in taken] == [str(other)]
        command = next(line for line in said.out.splitlines() if "    werri" in line)
        assert f"--reference {other}" in command
    assert werrimbi(*shlex.split(command)[1:], "--json", judged)
    assert json.loads(judged.read_text())["legs"]["count"] > 20


def one_drive(*spaces: str, wheels_late: int = 0) -> list[tuple[str, int, object]]:
    """Poses and wheels that roll ahead for 30 s, of as many robots as there are namespaces."""
    ros = Messages()
    entries: list[tuple[str, int, object]] = []
    for number in range(300):
        at = DAY * 10**9 + number * 10**8
        for space in spaces:
            wheels = ros.joints(at + wheels_late * 10**9, JOINTS, [0.1 * number] * 2)
            entries.append((f"{space}/joint_states", at, wheels))
            entries.append((f"{space}/pose", at, ros.pose(at, 0.005 * number, 0.0, 0.0)))
    return entries


def test_of_two_robots_each_is_judged_by_its_own_reference(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    bag = Messages().write(tmp_path / "two", one_drive("/one", "/two"))
    for mine, other in (("one", "two"), ("two", "one")):
        printed = werrimbi("info", bag, "--ticks-topic", f"/{mine}/joint_states").words
        assert f"Wheels: /{mine}/joint_states" in printed
        assert f"not looked at, but may tell of wheels: /{other}/joint_states" in printed.lower()
        assert f"Reference /{mine}/pose: poses at 10 Hz" in printed
        assert printed.count("It is taken") == 1
        assert printed.index(f"/{mine}/pose: poses") < printed.index("It is taken")


def test_clocks_apart_are_told_with_both_spans_and_put_on_the_recorders(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """The robot's computer began at another date; one recorder received it all by one clock."""
    bag = Messages().write(tmp_path / "apart", one_drive("", wheels_late=5 - DAY))
    printed = werrimbi("info", bag).words
    assert "the reference's stamps are 1.7e+09 s later than those of the wheels" in printed
    assert f"and reference ({DAY} to {DAY + 29.9:.14g}) are of two clocks" in printed
    assert "In 29.9 s the robot drove for 29.9 s" in printed
    assert "cannot be used" not in printed


def test_poses_that_repeat_are_left_out_as_where_drives_are_judged(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """A tracker's last pose, sent on for 2 s at a time, is not a robot that somebody holds."""
    entries = one_drive("")
    poses = [each for each in entries if each[0] == "/pose"]
    ros = Messages()
    for number, (topic, at, _) in enumerate(poses):
        seen = 20 * (number // 20) if 100 <= number < 200 else number
        entries[entries.index(poses[number])] = (topic, at, ros.pose(at, 0.005 * seen, 0.0, 0.0))
    bag = ros.write(tmp_path / "sticks", entries)
    printed = werrimbi("info", bag).words
    assert "reference poses repeat the one before to the last digit" in printed
    assert "held, or against a wall" not in printed


def test_an_array_of_floats_is_told_with_how_it_is_read(tmp_path: Path, werrimbi: Werrimbi) -> None:
    ros = Messages()
    entries = [("/wheel_ticks", n * 10**8, ros.floats(10.0 * n, 10.0 * n)) for n in range(1, 100)]
    bag = ros.write(tmp_path / "floats", entries)
    printed = werrimbi("info", bag).words
    assert (
        "if two of its values count the wheels, --ticks-topic /wheel_ticks:0:1 reads the first two"
        in printed
    )
    then = werrimbi("info", bag, "--ticks-topic", "/wheel_ticks:0:1").out
    assert "Wheels: /wheel_ticks:0:1, counters at 10 Hz" in then


@pytest.mark.evidence
def test_legs_are_told_as_long_as_the_poses_let_them_be(tmp_path: Path, werrimbi: Werrimbi) -> None:
    """Of drives measured at their ends `info` said that they show all, `compare` that 1 m err."""
    robot = tmp_path / "robot.yaml"
    robot.write_text(ROBOT_FILE)
    run = run_of(PLAIN, 1, 60)
    assert run.reference is not None
    for name, every in (("ends", 300), ("seldom", 25)):
        rows = np.arange(run.reference.time.size) % every == 0
        write_run(tmp_path / name, replace(run, reference=run.reference.chosen(rows)))
    said = werrimbi("info", tmp_path / "ends", "--robot", robot).words
    assert "no leg is shorter than from pose to pose, which is 1 leg at most" in said
    assert "Too seldom" not in werrimbi("info", tmp_path / "seldom", "--robot", robot).words
    out = werrimbi("compare", tmp_path / "seldom", "--robot", robot, "--leg", "0.25").out
    table = out.partition("Errors by length of leg")[2].splitlines()[2].split()
    assert float(table[0]) == pytest.approx(1.0, abs=0.3)


def test_a_run_folder_is_looked_at_too(werrimbi: Werrimbi) -> None:
    square = Path(wo.__file__).parent / "recordings" / "square"
    printed = werrimbi("info", square, "--robot", square / "robot.yaml").words
    assert "Reference: reference.csv, poses." in printed
    assert "werrimbi compare --robot" in printed


@pytest.mark.parametrize("both_ways", [False, True])
def test_one_circle_does_not_tell_the_base_from_the_ratio_of_the_radii(
    tmp_path: Path, werrimbi: Werrimbi, both_ways: bool
) -> None:
    time, turns = 0.1 * np.arange(600), np.full(600, 20.0)
    if both_ways:
        turns[300:] = -20.0
    left, right = (np.round(np.cumsum(100.0 + side * turns)) for side in (-1.0, 1.0))
    robot = tmp_path / "robot.yaml"
    robot.write_text(ROBOT_FILE)
    path = wo.odometry(wo.read_robot(robot), time, left, right)
    run = tmp_path / "run"
    poses = np.column_stack((time, path.x, path.y, path.yaw))
    poses[:, 1:] += np.random.default_rng(1).normal(0.0, 0.003, (600, 3))
    wo.write_run(run, time, left, right, poses)
    said = werrimbi("info", run, "--robot", robot).words
    assert ("It can show the base, the ratio of the radii" in said) == both_ways
    assert ("the base apart from the ratio of the radii: it drove one curve" in said) != both_ways


def test_a_heading_that_was_measured_once_is_no_bias(tmp_path: Path, werrimbi: Werrimbi) -> None:
    time, counts = 0.1 * np.arange(100), np.arange(100) * 100
    seen = np.column_stack((time, 0.0157 * np.arange(100), 0.0 * time, np.full(100, np.nan)))
    seen[:, 1:3] += np.random.default_rng(1).normal(0.0, 0.003, (100, 2))
    seen[0, 3] = 0.0
    run = wo.write_run(tmp_path / "run", time, counts, counts, seen)
    robot = Path(wo.__file__).parent / "recordings" / "square" / "robot.yaml"
    printed = werrimbi("info", run, "--robot", robot).words
    assert "Reference: reference.csv" in printed
    assert "bias" not in printed


def test_the_bias_of_a_gyro_is_told(tmp_path: Path, werrimbi: Werrimbi) -> None:
    counts = [100.0 * max(0.0, 0.1 * n - 3.0) for n in range(90)]
    rows = [f"{0.1 * n},{each:.0f},{each:.0f}" for n, each in enumerate(counts)]
    (tmp_path / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n" + "\n".join(rows))
    turned = [f"{0.1 * n},,,{-0.002 * n}" for n in range(90)]
    (tmp_path / "reference.csv").write_text("t_s,x_m,y_m,yaw_rad\n" + "\n".join(turned))
    robot = Path(wo.__file__).parent / "recordings" / "square" / "robot.yaml"
    printed = werrimbi("info", tmp_path, "--robot", robot).words
    assert "Its headings turn by -1.1°/s while the wheels stand: a gyro's bias" in printed


@pytest.mark.parametrize("with_joints", [False, True])
def test_that_a_driver_s_heading_may_be_the_gyro_s_is_told(
    tmp_path: Path, werrimbi: Werrimbi, with_joints: bool
) -> None:
    """Of wheels that are the driver's odometry alone; joint angles are the wheels' own."""
    ros, run = Messages(), run_of(ROBOT, 1, 40)
    seen = run.reference
    assert seen is not None
    sent = [*gyro(ros, run), *(joints(ros, run) if with_joints else [])]
    for time, x, y, yaw in zip(seen.time, seen.x, seen.y, seen.yaw, strict=True):
        sent.append(("/odom", stamp_of(time), ros.odometry(stamp_of(time), x, y, yaw)))
    bag = ros.write(tmp_path / "bag", sorted(sent, key=lambda entry: entry[1]))
    printed = werrimbi("info", bag).words
    assert ("put the gyro's heading into /odom" in printed) is not with_joints


def test_silences_between_tests_in_one_file_are_no_driving(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """Two tests of 6 s, and the robot set back by hand, or driven, for a minute in between."""
    time = np.concatenate([0.05 * np.arange(120), 66.0 + 0.05 * np.arange(120)])
    counts = np.concatenate([40.0 * np.arange(120), 3000.0 + 40.0 * np.arange(120)])
    rows = [f"{at:.2f},{each:.0f},{each:.0f}" for at, each in zip(time, counts, strict=True)]
    (tmp_path / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n" + "\n".join(rows))
    robot = Path(wo.__file__).parent / "recordings" / "square" / "robot.yaml"
    printed = werrimbi("info", tmp_path, "--robot", robot).words
    assert "In 72.0 s the robot drove for 12.0 s and moved unrecorded for 60.0 s." in printed


def test_how_far_a_robot_drove_in_a_gap_is_told_by_sizes_that_were_given(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """Without them it was told by placeholders: 0.3 m, and by the robot file 0.5 m."""
    run = run_of(PLAIN, 1, 60)
    assert run.reference is not None
    time = run.reference.time
    heard = run.reference.chosen(np.flatnonzero((time < 30.0) | (time > 33.0)))
    write_run(tmp_path / "drive", replace(run, reference=heard))
    robot = tmp_path / "robot.yaml"
    robot.write_text(ROBOT_FILE)
    printed = werrimbi("info", tmp_path / "drive").words
    assert "the reference is silent while the robot moved: left out." in printed
    printed = werrimbi("info", tmp_path / "drive", "--robot", robot).words
    assert "the reference is silent while the robot moved" not in printed
    assert "the reference is silent while the robot" in printed


def test_without_sizes_nothing_is_claimed_of_base_and_radii(tmp_path: Path) -> None:
    """A drive without a turn; by a size that nobody gave it would be any number of turns."""
    ros = Messages()
    entries = []
    for n in range(600):
        stamp = (DAY * 10 + n) * 10**8
        entries.append(("/joint_states", stamp, ros.joints(stamp, JOINTS, [0.2 * n, -0.2 * n])))
        entries.append(("/pose", stamp, ros.pose(stamp, 0.01 * n, 0.0, 0.0)))
    said = " ".join(wo.info(ros.write(tmp_path / "bag", entries)).summary().split())
    assert "show the base" not in said
    assert "show the ratio" not in said
    assert "Whether it can show base and radii is said once --robot gives their sizes." in said


DRIVER = "c:\n  ros__parameters:\n    wheel_separation: 0.4\n    wheel_radius: 0.1\n"


def test_too_little_driving_is_told_before_compare_tells_it(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    ros, entries = Messages(), []
    noise = np.random.default_rng(1).normal(0.0, 3e-3, (200, 3))
    for n in range(200):
        stamp, roll = n * 10**8, 0.04 * min(n, 150)
        entries.append(("/joint_states", stamp, ros.joints(stamp, JOINTS, [roll, roll])))
        seen = noise[n] + [0.1 * roll, 0.0, 0.0]
        entries.append(("/pose", stamp, ros.pose(stamp, *seen)))
    bag, robot = ros.write(tmp_path / "bag", entries), tmp_path / "robot.yaml"
    sides = zip(("left", "right"), JOINTS, strict=True)
    lines = "".join(
        f"    {side}_ticks_per_revolution: 1000.0\n    {side}_wheel_names: [{joint}]\n"
        for side, joint in sides
    )
    robot.write_text(DRIVER + lines)
    said = werrimbi("info", bag, "--robot", robot).words
    assert "it makes 2 legs of 0.25 m or a quarter turn at most, 10 are the least" in said


def in_a_hall(folder: Path, *scans: str, turning: bool = True) -> Path:
    """A bag with a gyro, or none, and lidars that see nothing."""
    ros, lidar, run = Messages(), Lidar(), run_of(ROBOT, 1, 40)
    turned = list(gyro(ros, run))
    nothing = np.full(lidar.beams, np.inf)
    seen = [(scan, at, ros.scan(at, lidar, nothing)) for _, at, _ in turned for scan in scans]
    entries = [*joints(ros, run), *(turned if turning else []), *seen]
    return ros.write(folder, sorted(entries, key=lambda entry: entry[1]))


def test_where_the_scans_are_of_no_use_the_gyro_is_the_next(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """In the middle of a hall a lidar sees nothing; the command that is printed works."""
    bag = in_a_hall(tmp_path / "hall", "/scan", "/stable_scan")
    printed = werrimbi("info", bag, "--reference-topic", "/scan").out
    assert "By /scan nothing can be judged" in " ".join(printed.split())
    said = werrimbi(*shlex.split(printed.splitlines()[-1].strip())[1:]).words
    assert "its yaw rate is integrated). It is taken." in said
    assert "It can show what happens at reversals" in said


def test_the_commands_of_another_reference_keep_its_topic_and_the_robot(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """With the driver's parameters; they led back to the scans, and asked for the sizes again."""
    bag = in_a_hall(tmp_path / "hall", "/scan")
    driver = tmp_path / "diff_drive.yaml"
    driver.write_text(DRIVER)
    out = tmp_path / "robot.yaml"
    words = ["info", str(bag), "--robot", str(driver), "--reference-topic", "/scan"]
    for then in ("info", "info", "compare"):
        printed = werrimbi(*words).out
        command = next(row for row in printed.splitlines()[::-1] if row.startswith("    werrimbi"))
        words = shlex.split(command)[1:]
        assert words[0] == then
        assert words[words.index("--reference-topic") + 1] == "/imu"
        words = [str(out) if word == "robot.yaml" else word for word in words]
    assert words[words.index("--robot") + 1] == str(out)


def test_what_cannot_be_judged_either_does_not_lead_back(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """The folder is called as a ROS 1 bag's file is: `ros2 bag record -o hall.bag`."""
    bag = in_a_hall(tmp_path / "hall.bag", "/scan", "/stable_scan", turning=False)
    printed = werrimbi("info", bag).out
    assert printed.splitlines()[-1] == "Nothing of it can be judged as it is."
    assert "No reference: /stable_scan, made of /scan by its name" in " ".join(printed.split())


def test_a_cloud_of_points_is_told_with_what_makes_a_reference_of_it(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    ros, kind = Messages(), "sensor_msgs/msg/PointCloud2"
    none = np.zeros(0, dtype=np.uint8)
    cloud = (kind, ros.make(kind, ros.header(1), 1, 0, [], False, 16, 0, none, True))
    wheels = [("/joint_states", n, ros.joints(n, JOINTS, [0.1 * n] * 2)) for n in (1, 2, 3)]
    bag = ros.write(tmp_path / "cloud", [*wheels, ("/velodyne_points", 4, cloud)])
    told = werrimbi("info", bag).words
    assert "No reference as it is: /velodyne_points, clouds of points" in told
    assert "pointcloud_to_laserscan makes them of it" in told


def test_satellites_and_a_gyro_are_taken_together(tmp_path: Path, werrimbi: Werrimbi) -> None:
    """As they were read to tell it, so the command that it prints reads them."""
    pytest.importorskip("pyproj")
    ros, run = Messages(), run_of(ROBOT, 1, 40)
    seen, random = run.reference, np.random.default_rng(5)
    assert seen is not None
    sent = [*gyro(ros, run), *joints(ros, run)]
    for time, x, y in list(zip(seen.time, seen.x, seen.y, strict=True))[::4]:
        east, north = np.array([x, y]) + 0.01 * random.standard_normal(2)
        degrees = float(50.0 + north / 111229.0), float(10.0 + east / 71696.0)
        sent.append(("/gps/fix", stamp_of(time), ros.fix(stamp_of(time), degrees)))
    bag = ros.write(tmp_path / "bag", sorted(sent, key=lambda entry: entry[1]))
    robot = tmp_path / "robot.yaml"
    robot.write_text(
        ROBOT_FILE + f"    left_wheel_names: [{JOINTS[0]}]\n    right_wheel_names: [{JOINTS[1]}]\n"
    )
    printed = werrimbi("info", bag, "--robot", robot).words
    assert "satellites). Its positions are taken." in printed
    assert "Its headings are taken. " in printed
    command = shlex.split(printed.split("Next:")[1].replace("\\\n", ""))
    topics = [command[n + 1] for n, word in enumerate(command) if word == "--reference-topic"]
    assert topics == ["/gps/fix", "/imu"]
