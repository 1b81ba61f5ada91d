# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks from bags: every kind of input that the node takes, and what is said when they are not."""

from __future__ import annotations

import math
import re
import shutil
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag_writing import BagWriter
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.model.trajectory import trajectory

MS = 10**6
WHEELS = ["left_wheel_joint", "right_wheel_joint"]
RECORDINGS = Path(__file__).parents[2] / "werrimbi_odom" / "recordings"


def joint_drive(ros: Any, names: list[str] | None = None) -> list[Any]:
    """Angles: the left wheel makes 0.1 rad a message, the right one 0.2."""
    return [
        ("/joint_states", n * 10 * MS + 3 * MS, ros.joints(n * 10 * MS, names or WHEELS, positions))
        for n, positions in enumerate(([0.0, 0.0], [0.1, 0.2], [0.2, 0.4]), start=1)
    ]


@pytest.mark.parametrize("plugin", ["mcap", "sqlite3"])
def test_joint_angles_become_counts(tmp_path: Path, ros: Any, robot: Any, plugin: str) -> None:
    bag = ros.write(tmp_path / "bag", joint_drive(ros), plugin)
    run = read_run(bag, robot())
    assert run.name == "bag"
    assert run.reference is None
    assert run.ticks.time.tolist() == [0.01, 0.02, 0.03], "stamps, not times of receipt"
    per_radian = 0.5 / math.pi
    np.testing.assert_allclose(run.ticks.left, np.array([0, 0.1, 0.2]) * 1000 * per_radian)
    np.testing.assert_allclose(run.ticks.right, np.array([0, 0.2, 0.4]) * 2000 * per_radian)


def test_a_single_file_and_a_folder_without_metadata(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "bag", joint_drive(ros))
    assert read_run(next(bag.glob("*.mcap")), robot()).ticks.rows == 3
    (bag / "metadata.yaml").unlink()
    assert read_run(bag, robot()).ticks.rows == 3
    bag = ros.write(tmp_path / "bag3", joint_drive(ros), "sqlite3")
    assert read_run(next(bag.glob("*.db3")), robot()).ticks.rows == 3


def test_joints_in_any_order_among_others_and_averaged(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    file = robot("left_wheel_names: [fl, rl]", "right_wheel_names: [fr]", "position_unit: ticks")
    entries = [
        ("/joint_states", 1, ros.joints(1 * MS, ["fr", "arm", "rl", "fl"], [7, 9, 2, 4])),
        ("/joint_states", 2, ros.joints(2 * MS, ["arm"], [9])),
        ("/joint_states", 3, ros.joints(3 * MS, ["fl", "fr", "rl"], [5, 8, 3])),
        ("/joint_states", 4, ros.joints(4 * MS, ["fl", "fr", "rl"], [5, 8])),
        ("/joint_states", 5, ros.joints(5 * MS, ["fl", "fr", "rl"], [6, math.nan, 4])),
    ]
    run = read_run(ros.write(tmp_path / "bag", entries), file)
    np.testing.assert_array_equal(run.ticks.left, [3, 4, 5])
    assert run.ticks.left.dtype == np.int64
    np.testing.assert_array_equal(run.ticks.right, [7, 8, np.nan])
    assert run.ticks.time.tolist() == [0.001, 0.003, 0.005]
    assert "left out: 1 messages without our joints" in run.notes
    assert "left out: 1 messages without a position for each joint" in run.notes


def test_wheels_of_a_side_wrap_and_restart_on_their_own(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    file = robot(
        "left_wheel_names: [fl, rl]",
        "right_wheel_names: [fr]",
        "position_unit: ticks",
        "encoder_bits: 16",
    )
    positions = [
        [32000, 5000, 0],
        [32700, 5700, 0],
        [-32136, 6400, 0],  # the front wheel wraps
        [-31436, 100, 0],  # the driver of the rear wheel restarts
        [-30736, 800, 0],
    ]
    entries = [
        ("/joint_states", n, ros.joints(n * MS, ["fl", "rl", "fr"], row))
        for n, row in enumerate(positions, start=1)
    ]
    run = read_run(ros.write(tmp_path / "bag", entries), file)
    assert np.diff(run.ticks.left).tolist() == [700, 700, 700, 700]


def test_no_stamp_is_when_it_was_received(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = [("/joint_states", n * MS, ros.joints(0, WHEELS, [n, n])) for n in (5, 7)]
    assert read_run(ros.write(tmp_path / "bag", entries), robot()).ticks.time.tolist() == [
        0.005,
        0.007,
    ]


@pytest.mark.parametrize("bits", [32, 64])
def test_two_topics_are_paired_as_the_node_pairs_them(
    tmp_path: Path, ros: Any, robot: Any, bits: int
) -> None:
    file = robot(f"input_type: int{bits}_pair", "pairing_window: 0.005")
    arrivals = [
        ("left", 10, 1),
        ("right", 12, 2),  # a pair
        ("right", 20, 3),
        ("right", 30, 4),  # overtakes the last one
        ("left", 34, 5),  # a pair
        ("left", 50, 6),
        ("right", 60, 7),  # too late for it
        ("left", 64, 8),  # a pair
    ]
    entries = [(f"/wheel/{side}_ticks", t * MS, ros.count(n, bits)) for side, t, n in arrivals]
    run = read_run(ros.write(tmp_path / "bag", entries), file)
    assert run.ticks.time.tolist() == [0.012, 0.034, 0.064]
    assert run.ticks.left.tolist() == [1, 5, 8]
    assert run.ticks.right.tolist() == [2, 4, 7]
    assert run.ticks.left.dtype == np.int64
    assert "left out: 2 messages without a partner in time" in run.notes


def test_a_pairing_that_began_one_message_off_mends_itself(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """At 50 Hz, the right count 4 ms after the left one; the first left count is lost."""
    entries = []
    for n in range(100):
        if n:
            entries.append(("/left_ticks", 20 * n * MS, ros.count(10 * n)))
        entries.append(("/right_ticks", (20 * n + 4) * MS, ros.count(10 * n)))
    run = read_run(ros.write(tmp_path / "bag", entries), robot("input_type: int32_pair"))
    apart = run.ticks.left - run.ticks.right
    assert apart[1:].tolist() == [0] * 99, "of the first alone the partner was lost"


def test_the_window_that_is_told_takes_counts_that_jitter(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Half were farther apart than 1.2 times their median; one partner of these is missing."""
    entries = []
    for n in range(100):
        apart = 10 + 17 * n % 31
        if n != 50:
            entries.append(("/left_ticks", 200 * n * MS, ros.count(n)))
        entries.append(("/right_ticks", (200 * n + apart) * MS, ros.count(n)))
    bag = ros.write(tmp_path / "bag", entries)
    with pytest.raises(InputError, match=r"are 0\.025 s apart as a rule") as caught:
        read_run(bag, robot("input_type: int32_pair", "pairing_window: 0.005"))
    told = re.search("pairing_window: [0-9.]+", str(caught.value))
    assert told
    run = read_run(bag, robot("input_type: int32_pair", told.group()))
    assert run.ticks.rows == 99


def test_an_int32_wraps_at_32_bits_whatever_the_file_says(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    counts = [2**31 - 100, -(2**31) + 100, -(2**31) + 300]
    entries = []
    for n, count in enumerate(counts, start=1):
        entries.append(("/left", n * 100 * MS, ros.count(count)))
        entries.append(("/right", n * 100 * MS + 1, ros.count(n)))
    run = read_run(ros.write(tmp_path / "bag", entries), robot("input_type: int32_pair"))
    assert np.diff(run.ticks.left).tolist() == [200, 200]


def test_two_topics_whose_names_do_not_tell(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = [("/a", 1, ros.count(1)), ("/b", 2, ros.count(2))]
    bag = ros.write(tmp_path / "bag", entries)
    with pytest.raises(InputError, match=r"--ticks-topic LEFT,RIGHT where their names do not say"):
        read_run(bag, robot())
    with pytest.raises(InputError, match=r"a is one wheel; --ticks-topic LEFT,RIGHT names both"):
        read_run(bag, robot(), ticks_topic="a")
    run = read_run(bag, robot(), ticks_topic="b,/a")
    assert (run.ticks.left.tolist(), run.ticks.right.tolist()) == ([2], [1])


def test_both_counters_in_an_array_are_exact(tmp_path: Path, ros: Any, robot: Any) -> None:
    huge = 2**62 + 1
    entries = [
        ("/ticks", 1 * MS, ros.counts(huge, -huge)),
        ("/ticks", 2 * MS, ros.counts(1, 2, 3)),
        ("/ticks", 3 * MS, ros.counts(huge + 1, -huge - 1)),
    ]
    run = read_run(ros.write(tmp_path / "bag", entries), robot("input_type: int64_multi_array"))
    assert run.ticks.left.tolist() == [huge, huge + 1]
    assert run.ticks.right.tolist() == [-huge, -huge - 1]
    assert "left out: 1 messages not of two values, left and right" in run.notes


@pytest.mark.parametrize("bits", [16, 32])
def test_narrower_arrays_wrap_at_their_width(
    tmp_path: Path, ros: Any, robot: Any, bits: int
) -> None:
    top = 2 ** (bits - 1)
    counts = [(top - 100, 1), (100 - top, 2), (300 - top, 3)]
    entries = [
        ("/ticks", n * MS, ros.counts(*pair, bits=bits)) for n, pair in enumerate(counts, start=1)
    ]
    entries.append(("/sonars", 1 * MS, ros.counts(1, 2, 3, bits=bits)))
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert np.diff(run.ticks.left).tolist() == [200, 200]
    assert run.ticks.right.tolist() == [1, 2, 3]


def test_counters_as_floats_are_read_where_they_are_asked_for(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Most arrays of two floats are commands, so nobody takes them unasked."""
    entries = [("/ticks", n * MS, ros.floats(100.0 * n, -3.0 * n)) for n in (1, 2, 3)]
    bag = ros.write(tmp_path / "bag", entries)
    with pytest.raises(InputError, match=r"no topic holds ticks .* it has /ticks \(std_msgs/msg/F"):
        read_run(bag, robot())
    run = read_run(bag, robot(), ticks_topic="/ticks")
    assert run.ticks.left.tolist() == [100, 200, 300]
    assert run.ticks.right.tolist() == [-3, -6, -9]
    entries.append(("/ticks", 4 * MS, ros.floats(1e300, -12.0)))  # memory that nothing was put into
    run = read_run(ros.write(tmp_path / "spoilt", entries), robot(), ticks_topic="/ticks")
    assert run.ticks.left.tolist() == [100, 200, 300]
    assert any("with a value that is no number" in note for note in run.notes)


@pytest.mark.parametrize("bits", [16, 32])
def test_unsigned_counters_run_on_below_zero(
    tmp_path: Path, ros: Any, robot: Any, bits: int
) -> None:
    """Backwards from zero: the counter of a board that drives away astern."""
    rows = [(-round(200 * math.sin(0.05 * n)), round(150 * math.sin(0.04 * n))) for n in range(90)]
    wrapped = [tuple(count % 2**bits for count in row) for row in rows]
    single = [
        (f"/{side}_ticks", n * MS, ros.count(row[place], bits, "UInt"))
        for n, row in enumerate(wrapped, start=1)
        for place, side in enumerate(("left", "right"))
    ]
    array = [
        ("/board", n * MS, ros.counts(*row, bits=bits, of="UInt"))
        for n, row in enumerate(wrapped, start=1)
    ]
    for entries, topic in ((single, None), (array, "/board")):
        name = "array" if topic else "single"
        run = read_run(ros.write(tmp_path / name, entries), robot(), ticks_topic=topic)
        assert run.ticks.left.tolist() == [left for left, _ in rows]
        assert run.ticks.right.tolist() == [right for _, right in rows]


def test_what_may_be_a_power_is_read_where_it_is_asked_for(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    for of, bits in (("UInt", 16), ("Float", 32)):
        entries = [
            (f"/{side}_motor", n * MS, ros.count(times * n, bits, of))
            for n in (1, 2, 3)
            for times, side in ((100, "left"), (90, "right"))
        ]
        bag = ros.write(tmp_path / of, entries)
        with pytest.raises(InputError, match="no topic holds ticks"):
            read_run(bag, robot())
        run = read_run(bag, robot(), ticks_topic="/left_motor,/right_motor")
        assert run.ticks.right.tolist() == [90, 180, 270]
    entries = [(f"/{side}", 1, ros.count(0.5, 64, "Float")) for side in ("a", "b")]
    bag = ros.write(tmp_path / "speeds", entries)
    with pytest.raises(InputError, match=r"/a,/b: 0\.5 is no whole number, and so no counter"):
        read_run(bag, robot(), ticks_topic="/a,/b")


def board(n: int) -> tuple[float, ...]:
    """What a board sends at once: ms, two commands, two counters, a battery."""
    speed = 20.0 * math.sin(0.1 * n)
    left = 200.0 * (1.0 - math.cos(0.1 * n))
    return 20.0 * n, round(speed), round(-speed), round(left), round(-1.5 * left), 11.93


@pytest.mark.parametrize("kind", ["floats", "counts"])
def test_counters_in_an_array_are_told_from_what_else_it_holds(
    tmp_path: Path, ros: Any, robot: Any, kind: str
) -> None:
    rows = [board(n)[: 6 if kind == "floats" else 5] for n in range(400)]
    entries = [("/board", 20 * n * MS, getattr(ros, kind)(*row)) for n, row in enumerate(rows)]
    bag = ros.write(tmp_path / "bag", entries)
    found = read_run(bag, robot())
    assert found.ticks.left.tolist() == [row[3] for row in rows]
    assert found.ticks.right.tolist() == [row[4] for row in rows]
    said = " ".join(wo.info(bag).summary().split())
    assert "Wheels: /board:3:4, counters at 50 Hz: of its values, counted from 0, number 3" in said
    other = read_run(bag, robot(), ticks_topic="/board:4:3")
    assert other.ticks.left.tolist() == [row[4] for row in rows]
    with pytest.raises(InputError, match="no message has values 3 and 8, counted from 0"):
        read_run(bag, robot(), ticks_topic="/board:3:8")
    with pytest.raises(InputError, match="takes two places of its values, counted from 0"):
        read_run(bag, robot(), ticks_topic="/board:3")
    with pytest.raises(InputError, match=r"TOPIC:LEFT:RIGHT says which two of more"):
        read_run(bag, robot(), ticks_topic="/board")


def test_whole_counts_are_no_angles(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Of 210 a turn, taken for radians: a robot that turned by 99° in a tenth of a second."""
    names = ["left_wheel_joint", "right_wheel_joint"]
    entries = [
        ("/joint_states", n * MS, ros.joints(n * MS, names, [3.0 * n, 4.0 * n])) for n in range(60)
    ]
    bag = ros.write(tmp_path / "bag", entries)
    with pytest.raises(InputError, match="are whole numbers, and so counts, no angles; they are"):
        read_run(bag, robot())
    run = read_run(bag, robot("position_unit: ticks"))
    assert run.ticks.right[-1] == 236


def test_floats_that_are_no_counters_are_refused(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "bag", [("/speeds", 1 * MS, ros.floats(0.25, 1.5))])
    with pytest.raises(InputError, match=r"/speeds: 0.25 and 1.5 are no whole numbers, and so no"):
        read_run(bag, robot(), ticks_topic="/speeds")


def test_a_topic_with_messages_of_two_types_is_told_with_both(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    entries = [*joint_drive(ros), ("/joint_states", 50 * MS, ros.counts(1, 2))]
    told = r"it has /joint_states \(sensor_msgs/msg/JointState and std_msgs/msg/Int64MultiArray\)"
    with pytest.raises(InputError, match=told):
        read_run(ros.write(tmp_path / "bag", entries), robot())


def test_encoders_of_a_duckiebot_are_paired_by_their_stamps(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """The network delivers the right one's messages 200 ms late."""
    entries = []
    for n in range(1, 50):
        stamp = 50 * n * MS
        entries.append(("/bot/left_wheel_encoder_node/tick", stamp, ros.encoder(stamp, 3 * n)))
        late, right = stamp + 200 * MS, ros.encoder(stamp + 2 * MS, 2 * n)
        entries.append(("/bot/right_wheel_encoder_node/tick", late, right))
    entries.sort(key=lambda entry: entry[1])
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert run.ticks.left.tolist() == [3 * n for n in range(1, 50)]
    assert run.ticks.right.tolist() == [2 * n for n in range(1, 50)]


def test_the_robot_file_chooses_and_else_the_only_one(tmp_path: Path, ros: Any, robot: Any) -> None:
    both = [*joint_drive(ros), ("/ticks", 40 * MS, ros.counts(1, 2))]
    bag = ros.write(tmp_path / "bag", both)
    assert read_run(bag, robot()).ticks.rows == 3
    assert read_run(bag, robot("input_type: int64_multi_array")).ticks.rows == 1
    assert read_run(bag, robot(), ticks_topic="ticks").ticks.rows == 1
    with pytest.raises(InputError) as caught:
        read_run(bag, robot("input_type: int32_pair"))
    assert str(caught.value) == (
        f"{bag}: choose with --ticks-topic; candidates are /joint_states "
        "(sensor_msgs/msg/JointState); /ticks (std_msgs/msg/Int64MultiArray)"
    )
    alone = ros.write(tmp_path / "alone", both[-1:])
    assert read_run(alone, robot()).ticks.rows == 1


@pytest.mark.parametrize(
    ("wish", "said"),
    [
        ("/nothing", "there are no ticks in /nothing; candidates are /joint_states (sensor_msgs"),
        ("/pose", "there are no ticks in /pose; candidates are /joint_states"),
        ("/joint_states,/joint_states", "there are no ticks in /joint_states,/joint_states"),
        ("", "there are no ticks in ; candidates are"),
    ],
)
def test_a_wish_that_cannot_be_met(
    tmp_path: Path, ros: Any, robot: Any, wish: str, said: str
) -> None:
    entries = [*joint_drive(ros), ("/pose", 50 * MS, ros.pose(50 * MS, 0.0, 0.0, 0.0))]
    with pytest.raises(InputError, match=re.escape(said)):
        read_run(ros.write(tmp_path / "bag", entries), robot(), ticks_topic=wish)


def test_joints_that_are_not_there(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "bag", joint_drive(ros, ["wheel_left_joint", "wheel_right_joint"]))
    with pytest.raises(InputError) as caught:
        read_run(bag, robot())
    assert str(caught.value) == (
        f"{bag}: /joint_states: no joint left_wheel_joint, the nearest is wheel_left_joint; it has "
        "wheel_left_joint, wheel_right_joint; set left_wheel_names and right_wheel_names in the "
        "robot file"
    )


def test_bags_without_ticks(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "bag", [("/pose", 1, ros.pose(1, 0.0, 0.0, 0.0))])
    with pytest.raises(InputError, match=r"no topic holds ticks .* it has /pose \(geometry_msgs/"):
        read_run(bag, robot())
    empty = ros.write(tmp_path / "empty", [])
    with pytest.raises(InputError, match=r"no topic holds ticks .* it has nothing"):
        read_run(empty, robot())
    lonely = ros.write(
        tmp_path / "lonely", [("/left", 1, ros.count(1)), ("/right", 10**9, ros.count(1))]
    )
    with pytest.raises(InputError, match="no two counts within the pairing_window"):
        read_run(lonely, robot())


def test_the_window_that_takes_counts_apart_is_told(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = [
        (f"/{side}_ticks", (200 * n + late) * MS, ros.count(n))
        for n in range(1, 9)
        for late, side in ((0, "left"), (50, "right"))
    ]
    bag = ros.write(tmp_path / "bag", entries)
    told = (
        r"pairing_window of the robot file, 0\.02 s; .* 0\.05 s apart .*: pairing_window: 0\.06 t"
    )
    with pytest.raises(InputError, match=told):
        read_run(bag, robot("pairing_window: 0.02"))
    assert read_run(bag, robot("pairing_window: 0.06")).ticks.rows == 8


@pytest.mark.parametrize("plugin", ["mcap", "sqlite3"])
def test_damaged_bags(tmp_path: Path, ros: Any, robot: Any, plugin: str) -> None:
    entries = joint_drive(ros) * 10
    bag = ros.write(tmp_path / "bag", entries, plugin)
    file = next(each for each in bag.iterdir() if each.suffix != ".yaml")
    whole = file.read_bytes()
    rng = np.random.default_rng(1)
    damaged = [b"", whole[:100], whole[: len(whole) // 2], whole[:-1], b"\0" * len(whole)]
    for _ in range(40):
        flipped = bytearray(whole)
        for place in rng.integers(0, len(whole), 20):
            flipped[place] ^= int(rng.integers(1, 256))
        damaged.append(bytes(flipped))
    for content in damaged:
        file.write_bytes(content)
        try:
            read_run(bag, robot())
        except InputError as error:
            said = str(error)
        else:
            said = str(bag)
        assert str(bag) in said
    file.unlink()
    with pytest.raises(InputError, match="cannot be read as a bag: Some database files are missin"):
        read_run(bag, robot())
    (bag / "metadata.yaml").write_text("just words")
    with pytest.raises(InputError, match="cannot be read as a bag"):
        read_run(bag, robot())


def test_paths_that_are_no_run(tmp_path: Path, robot: Any) -> None:
    file = robot()
    (tmp_path / "day" / "square").mkdir(parents=True)
    (tmp_path / "day" / "square" / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n0,1,2\n")
    (tmp_path / "old.bag").write_text("")
    (tmp_path / "log").mkdir()
    (tmp_path / "log" / "kobuki.csv").write_text("left,right,time\n1,2,3\n")
    day = tmp_path / "day"
    columns = "; a log of text is read from a folder of its own with ticks.csv (t_s,left_ticks,"
    for path, said in (
        (tmp_path / "none", "there is no such run"),
        (day, f"neither ticks.csv nor a bag (metadata.yaml); did you mean {day}/square?"),
        (day / "square" / "ticks.csv", f"give the folder that holds it, {day}/square"),
        (tmp_path / "old.bag", "cannot be read as a bag: File"),
        (file.path, "is neither a run folder nor a bag (.mcap, .db3, .bag)"),
        (tmp_path / "log", f"holds neither ticks.csv nor a bag (metadata.yaml){columns}"),
        (tmp_path / "log" / "kobuki.csv", f"a bag (.mcap, .db3, .bag){columns}"),
        (Path("a\0b"), "there is no such run"),
    ):
        with pytest.raises(InputError, match=re.escape(said)):
            read_run(path, file)


def test_without_rosbags_the_remedy_is_named(
    tmp_path: Path, ros: Any, robot: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    bag = ros.write(tmp_path / "bag", joint_drive(ros))
    monkeypatch.setitem(sys.modules, "rosbags.rosbag2", None)
    with pytest.raises(InputError, match=re.escape('pip install "werrimbi_odom[tools]"')):
        read_run(bag, robot())


def test_a_folder_that_is_there_is_not_recorded_over(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"record: .* cannot be written: .* exists"):
        BagWriter(tmp_path)


def test_progress_is_told(tmp_path: Path, ros: Any, robot: Any) -> None:
    shares: list[float] = []
    read_run(ros.write(tmp_path / "bag", joint_drive(ros) * 800), robot(), progress=shares.append)
    assert len(shares) == 3
    assert shares == sorted(shares)
    assert shares[-1] <= 1.0


@pytest.mark.skipif(not (RECORDINGS / "square_bag").exists(), reason="no recordings/square_bag")
def test_the_shipped_bag_and_folder_are_one_drive(tmp_path: Path) -> None:
    pytest.importorskip("rosbags.rosbag2", reason="rosbags is not installed")
    from werrimbi_odom.files.robot_files.robot_file import read_robot_file

    file = read_robot_file(RECORDINGS / "square" / "robot.yaml")
    bag = tmp_path / "bag"
    shutil.copytree(RECORDINGS / "square_bag", bag)
    runs = [read_run(path, file) for path in (RECORDINGS / "square", bag)]
    driven = [
        trajectory(file.robot, run.ticks.time, run.ticks.left, run.ticks.right) for run in runs
    ]
    for name in ("x", "y", "yaw"):
        folder, recorded = (getattr(each, name) for each in driven)
        np.testing.assert_allclose(recorded, folder, rtol=0.0, atol=1e-9)
        folder, recorded = (getattr(run.reference, name) for run in runs)
        np.testing.assert_allclose(recorded, folder, rtol=0.0, atol=1e-6)
    assert len(driven[0].pieces) == len(driven[1].pieces)
