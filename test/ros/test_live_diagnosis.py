# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""compare_node looks for what is missing while the robot drives, and writes it when asked."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

pytest.importorskip("rclpy")
pytest.importorskip("rosbags")

from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import String
from std_srvs.srv import Trigger

import werrimbi_odom as wo
from test.ros.beside import arguments
from test.ros.messages import values_of
from test.ros.test_compare_node import (
    COMMAND,
    DEEP,
    ROOT,
    TRUE,
    Comparing,
    play,
    recorded,
    robot_file,
)
from test.ros.test_compare_node import compare as compare  # a fixture
from werrimbi_odom.ros.live_diagnosis import Watching

SERVICE = "compare_node/write_robot_file"


def watched(
    launch: Any, compare: Any, folder: Path, wide: float
) -> tuple[Any, Comparing, Path, list[Any]]:
    """A drive of a robot whose base is `wide` times that of its file, looked at when it ends."""
    values = robot_file() | {"wheel_separation": TRUE.separation / wide}
    file = folder / "robot.yaml"
    file.write_text(json.dumps({"odom_node": {"ros__parameters": values}}))
    launched = launch(values)
    comparing = compare(
        launched,
        robot_file=str(file),
        diagnose_every=1.0,
        qos_overrides={"/odom": DEEP, "/reference": DEEP, "/joint_states": DEEP},
    )
    words = launched.keep(String, "compare_node/diagnosis")
    play(launched, recorded(3, 100.0), comparing)
    launched.until(lambda: bool(words), "a diagnosis", 300.0)
    comparing.verdict()
    return launched, comparing, file, words


def missing(comparing: Comparing) -> tuple[Any, dict[str, str]]:
    status = comparing.told["what is missing"][-1]
    return status, values_of(status)


def test_what_is_missing_is_told_and_written_beside_the_file_in_use(
    launch: Any, compare: Any, tmp_path: Path
) -> None:
    launched, comparing, file, words = watched(launch, compare, tmp_path, wide=1.04)
    before = file.read_bytes()
    status, told = missing(comparing)
    assert status.level == DiagnosticStatus.WARN
    assert status.message.startswith("One thing is missing: track_width. ")
    assert (told["verdict"], told["effect"]) == ("named", "track_width")
    assert "How large: multiplier = 1.0" in words[-1].data, "the words of the terminal"
    command = f"{file} --ticks-topic /joint_states --reference-topic /reference \\\n      RUN..."
    assert f"werrimbi add track_width --robot {command}" in words[-1].data, "for a bag of one's own"
    answer = launched.call(Trigger, SERVICE, Trigger.Request())
    assert answer.success, answer.message
    better = wo.read_robot(tmp_path / "robot_better.yaml").robot
    assert better.track == pytest.approx(TRUE.separation, rel=0.005)
    assert file.read_bytes() == before
    again = launched.call(Trigger, SERVICE, Trigger.Request())
    assert not again.success
    assert "is there already" in again.message
    assert "One thing is missing" in comparing.stop()


@pytest.mark.evidence
def test_where_nothing_is_missing_nothing_is_written(
    launch: Any, compare: Any, tmp_path: Path
) -> None:
    launched, comparing, _, _ = watched(launch, compare, tmp_path, wide=1.0)
    status, told = missing(comparing)
    assert status.level == DiagnosticStatus.OK, status.message
    assert told["verdict"] == "none", status.message
    answer = launched.call(Trigger, SERVICE, Trigger.Request())
    assert not answer.success
    assert answer.message.startswith("there is nothing to write: Nothing is missing")
    assert not list(tmp_path.glob("*better*"))


def test_the_file_in_use_is_never_the_new_one(tmp_path: Path) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(json.dumps({"odom_node": {"ros__parameters": robot_file()}}))
    given = arguments({"robot_file": file, "new_robot_file": file})
    run = subprocess.run(
        [*COMMAND, *given], cwd=ROOT, capture_output=True, text=True, check=False, timeout=60.0
    )
    assert run.returncode == 2
    assert "is the robot file in use; name another" in run.stderr


def test_files_that_are_deleted_while_it_looks_end_no_node(tmp_path: Path) -> None:
    """As by what tidies up /tmp on a computer that is never switched off."""
    told: list[str] = []
    watching: Any = SimpleNamespace(
        _found={},
        _folder=tmp_path / "deleted",
        _looks=0,
        _used=0.0,
        _words=SimpleNamespace(publish=lambda message: told.append(message.data)),
        _verdict=lambda: (DiagnosticStatus.OK, ""),
        close=lambda: None,
    )
    Watching._end(watching)
    assert told == ["the diagnosis failed: its files were deleted"]
