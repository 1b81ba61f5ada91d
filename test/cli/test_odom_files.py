# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi odom`: what it writes where, and what it refuses to read or to write."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from test.cli.odometry import ROBOT, command, odom, reference, table, ticks
from test.command_line import Complaint


def test_an_existing_file_is_replaced_and_parts_are_gone(place: Path) -> None:
    (place / "odom.csv").write_text("old")
    assert odom(place) == 0
    assert len(table(place / "odom.csv")) == 11
    names = ["odom.csv", "robot.yaml", "run"]
    assert sorted(path.name for path in place.iterdir()) == names


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda p: ticks(p, [(0, 0, 0), (1, "x", 2)]), "run/ticks.csv, line 3, column left_ticks"),
        (lambda p: ticks(p, [(0, "nan", 0)]), "run: no row has a finite time and finite counts"),
        (lambda p: ticks(p, [(0, 0, 0), (1, "1e308", 2)]), "run: the pose grows beyond all numb"),
        (lambda p: (p / "run" / "ticks.csv").unlink(), "run holds neither ticks.csv nor a bag"),
        (lambda p: reference(p, "0,a,0,0"), "run/reference.csv, line 2, column x_m: 'a' is not"),
        (
            lambda p: (p / "robot.yaml").write_text(ROBOT.replace("0.1", "-0.1")),
            "robot.yaml, line 4: wheel_radius must be a number greater than 0 (m), not -0.1",
        ),
        (
            lambda p: (p / "robot.yaml").write_text(ROBOT.replace("wheel_radius", "wheel_radus")),
            "robot.yaml, line 4: unknown parameter wheel_radus; the nearest known one is wheel_ra",
        ),
        (
            lambda p: (p / "robot.yaml").write_text(ROBOT[: ROBOT.index("    left_ticks")]),
            "run/ticks.csv holds counts, and {place}/robot.yaml does not say how many there are in",
        ),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(
    place: Path, complaint: Complaint, spoil: Any, said: str
) -> None:
    spoil(place)
    before = sorted(path.name for path in place.iterdir())
    told = complaint(*command(place, "--json", place / "figures.json"))
    assert told.startswith(f"werrimbi odom: {place}/{said.format(place=place)}")
    assert sorted(path.name for path in place.iterdir()) == before


def test_both_files_or_neither(place: Path, complaint: Complaint) -> None:
    (place / "odom.csv").write_text("old")
    complaint(*command(place, "--json", place / "nowhere" / "figures.json"))
    assert (place / "odom.csv").read_text() == "old"
    told = complaint(*command(place, "--json", place / "odom.csv"))
    assert "odom.csv would overwrite --out" in told


def test_a_device_is_written_to_and_stays_one(place: Path) -> None:
    assert odom(place, "--out", "/dev/null") == 0
    assert not Path("/dev/null").is_file()
