# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters in an array have no names: which is left, and which runs backwards, is measured."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from test.cli.commands import PLAIN, ROBOT_FILE, write_controllers, write_run
from test.command_line import Werrimbi
from test.evidence import in_evidence
from test.files.conftest import Messages
from test.files.unseen import poses, stamp_of
from test.inference.driven import run_of
from werrimbi_odom.files.run import Run, Ticks

DRIVEN = "By its wheels, with that put right, it went"
EXCHANGED = "left and right counters are exchanged"
LEFT_BACK, RIGHT_BACK = (f"the {side} counter has the wrong sign" for side in ("left", "right"))
ASTERN = "180° against the robot's"
Order = Callable[[int, int], tuple[int, ...]]


@cache
def drive() -> Run:
    return run_of(PLAIN, 1, 60)


def recorded(folder: Path, order: Order, kind: str = "counts", measured: bool = True) -> Path:
    ros, run = Messages(), drive()
    counts = zip(run.ticks.time, run.ticks.left, run.ticks.right, strict=True)
    sent = [
        ("/data", stamp_of(at), getattr(ros, kind)(*order(int(left), int(right))))
        for at, left, right in counts
    ]
    if measured:
        sent += poses(ros, run)
    return ros.write(folder / "bag", sorted(sent, key=lambda each: each[1]))


@pytest.mark.parametrize(
    ("order", "mistakes", "says"),
    [
        pytest.param(lambda left, right: (left, right), [], "turns confirm", id="right"),
        pytest.param(
            lambda left, right: (right, left), [EXCHANGED], "--ticks-topic /data:1:0", id="swapped"
        ),
        pytest.param(lambda left, right: (-left, right), [LEFT_BACK], DRIVEN, id="left back"),
        in_evidence(lambda left, right: (left, -right), [RIGHT_BACK], DRIVEN, id="right back"),
        pytest.param(
            lambda left, right: (-left, -right), [LEFT_BACK, RIGHT_BACK], DRIVEN, id="both back"
        ),
        pytest.param(
            lambda left, right: (right, -left),
            [EXCHANGED, LEFT_BACK],
            "it counts backwards, once both are exchanged",
            id="swapped, left back",
        ),
        pytest.param(
            lambda left, right: (-right, -left),
            [ASTERN],
            "or what the counters take for ahead is its rear",
            id="astern",
        ),
    ],
)
def test_what_is_left_and_what_counts_backwards_is_told_at_once(
    order: Order, mistakes: list[str], says: str, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    robot = tmp_path / "robot.yaml"
    robot.write_text(ROBOT_FILE)
    said = werrimbi("info", recorded(tmp_path, order), "--robot", robot).words
    assert says in said
    told = [each for each in (EXCHANGED, LEFT_BACK, RIGHT_BACK, ASTERN) if each in said]
    assert told == mistakes
    seen = drive().reference
    assert seen is not None
    way = float(np.hypot(np.diff(seen.x), np.diff(seen.y)).sum())
    assert float(said.partition(" it went ")[2].split()[0]) == pytest.approx(way, rel=0.01)


def test_nothing_tells_left_from_right_where_nothing_measured(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    said = werrimbi("info", recorded(tmp_path, lambda *both: both, measured=False)).words
    assert "in their order, as nothing shows which is left" in said


@pytest.mark.parametrize("kind", ["counts", in_evidence("floats")])
@pytest.mark.parametrize(
    ("order", "topic", "alike"),
    [
        pytest.param(
            lambda left, right: (left, right, left + left // 50, right + right // 40),
            "/data:0:1",
            "number 0 (2 alike) as the left wheel's and number 1 (3 alike)",
            id="front, rear",
        ),
        pytest.param(
            lambda left, right: (left, left + left // 50, -right, right),
            "/data:0:2",
            "number 0 (1 alike) as the left wheel's and number 2 (3 alike)",
            id="left, right, one mounted the other way round",
        ),
        pytest.param(
            lambda left, right: (left, right, 0, 7), "/data:0:1", "number 0 as the", id="unused"
        ),
    ],
)
def test_wheels_of_a_side_are_told_by_turning_alike(
    order: Order, topic: str, alike: str, kind: str, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    said = werrimbi("info", recorded(tmp_path, order, kind)).words
    assert f"Wheels: {topic}, counters" in said
    assert alike in said


def test_two_floats_are_counters_if_they_run_on_as_counters_do(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    said = werrimbi("info", recorded(tmp_path, lambda *both: both, "floats")).words
    assert "Wheels: /data:0:1, counters" in said


def test_of_a_table_the_columns_are_to_be_exchanged(tmp_path: Path, werrimbi: Werrimbi) -> None:
    run = drive()
    exchanged = Ticks(run.ticks.time, run.ticks.right, run.ticks.left)
    write_run(tmp_path / "run", replace(run, ticks=exchanged))
    said = werrimbi("info", tmp_path / "run").words
    assert EXCHANGED in said
    assert "exchange their names in the first line of ticks.csv" in said


def test_a_first_robot_file_of_counters_has_the_node_s_kind_of_input(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    sizes = tmp_path / "controllers.yaml"
    write_controllers(sizes, PLAIN)
    bag, out = recorded(tmp_path, lambda left, right: (left, right)), tmp_path / "robot.yaml"
    assert (
        f"4096 in {out} is a placeholder"
        in werrimbi("info", bag, "--robot", sizes, "--out", out).words
    )
    assert "    input_type: int64_multi_array\n" in out.read_text()
