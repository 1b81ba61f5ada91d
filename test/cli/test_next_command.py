# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command that follows is one that a shell takes, for the same files and options."""

from __future__ import annotations

import shlex
import shutil
from pathlib import Path

import pytest

from test.cli.commands import RECORDING
from test.command_line import Werrimbi, ran
from werrimbi_odom.cli.main import _parser


def pasted(command: str) -> list[str]:
    """Its words as a shell makes them, patterns filled in."""
    done = ran(["sh", "-c", command.replace("werrimbi ", "printf '%s\\0' ", 1)])
    assert done.returncode == 0
    return done.stdout.split("\0")[:-1]


@pytest.mark.parametrize("every", [True, False])
def test_what_compare_prints_can_be_pasted(tmp_path: Path, werrimbi: Werrimbi, every: bool) -> None:
    runs = [tmp_path / "my drives" / name for name in ("a b", "it's", "{c}")]
    for folder in runs:
        shutil.copytree(RECORDING, folder)
    text = (
        (RECORDING / "robot.yaml")
        .read_text()
        .replace("wheel_separation: 0.35 ", "wheel_separation: 0.4 ")
    )
    robot = tmp_path / "my robot.yaml"
    robot.write_text(text)
    given = runs if every else runs[:2]
    words = ["--robot", str(robot), "--leg", "0.5", "--reference-sigma-xy", "0.001"]
    lines = werrimbi("compare", *words, *given).out.splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("    werrimbi diagnose"))
    assert lines[first - 1].endswith((".", "noise.", "mistake."))
    command = "\n".join(lines[first : lines.index("", first)])
    again = pasted(command)
    assert again == ["diagnose", *words, *map(str, given)]
    assert ("/*" in command) == every
    assert _parser(again).parse_args(again).leg == 0.5
    assert shlex.split(command.replace("\\\n", " "))[:2] == ["werrimbi", "diagnose"]
