# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers each of which a robot may have, and which together make none: one line from each verb."""

from __future__ import annotations

from pathlib import Path

import pytest

from test.command_line import Werrimbi

GOOD = {
    "wheel_separation": "0.35",
    "wheel_radius": "0.05",
    "wheel_separation_multiplier": "1.0",
    "left_wheel_radius_multiplier": "1.0",
    "left_ticks_per_revolution": "2000.0",
    "right_ticks_per_revolution": "2000.0",
    "left_wheel_noise": "4.0e-4",
}
SQUARE = Path(__file__).parents[2] / "werrimbi_odom" / "recordings" / "square"


def robot_file(folder: Path, **changes: str) -> Path:
    lines = [f"    {name}: {value}" for name, value in {**GOOD, **changes}.items()]
    file = folder / "robot.yaml"
    file.write_text("\n".join(["odom_node:", "  ros__parameters:", *lines, ""]))
    return file


@pytest.mark.parametrize("verb", ["odom", "compare"])
@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("wheel_separation", "1.0e-160"),
        ("wheel_separation", "1.0e-300"),
        ("wheel_separation", "5.0e-324"),
        ("wheel_separation", "1.0e+300"),
        ("wheel_separation_multiplier", "1.0e-300"),
        ("wheel_radius", "1.0e+155"),
        ("wheel_radius", "1.0e+300"),
        ("left_wheel_radius_multiplier", "1.0e+308"),
        ("left_ticks_per_revolution", "1.0e-300"),
        ("right_ticks_per_revolution", "5.0e-324"),
        ("left_wheel_noise", "1.0e+160"),
    ],
)
def test_a_robot_that_cannot_be_is_refused_in_a_line(
    tmp_path: Path, werrimbi: Werrimbi, verb: str, name: str, value: str
) -> None:
    robot, out = robot_file(tmp_path, **{name: value}), tmp_path / "out"
    where = ["--out" if verb == "odom" else "--json", str(out)]
    said = werrimbi(verb, "--robot", robot, SQUARE, *where, code=2).err
    line = list(GOOD).index(name) + 3
    assert said.startswith(f"werrimbi {verb}: {robot}, line {line}: "), said
    assert name in said
    assert said.count("\n") == 1
    assert not out.exists()
