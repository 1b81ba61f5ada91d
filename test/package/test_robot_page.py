# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of docs/robot.md name launch files, arguments and executables that there are."""

from __future__ import annotations

import re

import pytest

from test.command_line import ROOT
from test.package.launching import launched

PAGE = (ROOT / "docs" / "robot.md").read_text(encoding="utf-8")
LAUNCHES = re.findall(r"^ros2 launch werrimbi_odom (\S+)(.*)$", PAGE, re.M)


@pytest.mark.parametrize(("name", "rest"), LAUNCHES)
def test_a_shown_launch_starts_nodes_with_its_arguments(name: str, rest: str) -> None:
    given = dict(word.split(":=") for word in rest.split())
    words = [word for process in launched(ROOT, name, **given) for word in process.arguments]
    for value in given.values():
        assert any(value in word for word in words), value


def test_every_launch_file_is_shown_with_all_its_arguments() -> None:
    assert {name for name, _ in LAUNCHES} == {path.name for path in (ROOT / "launch").iterdir()}
    for path in (ROOT / "launch").iterdir():
        row = next(line for line in PAGE.splitlines() if line.startswith(f"| `{path.name}` |"))
        stated = set(re.findall(r"`(\w+)`", row.split("|")[3]))
        assert stated == set(re.findall(r'<arg name="(\w+)"(?! value)', path.read_text()))


def test_shown_executables_are_installed() -> None:
    entry_points = (ROOT / "setup.py").read_text(encoding="utf-8")
    shown = re.findall(r"^ros2 run werrimbi_odom (\w+)", PAGE, re.M)
    assert shown
    for name in shown:
        assert f'f"{name} = ' in entry_points
