# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files from a stranger, given to the node: ROS's own reader comes before ours."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("rclpy")

from test.robot_file import BARE
from test.ros.conftest import environment
from werrimbi_odom.ros.domain import free_domain


def limits() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (4 * 2**30, 4 * 2**30))
    resource.setrlimit(resource.RLIMIT_CPU, (60, 60))


BOMB = "a0: &a0 [lol, lol]\n" + "".join(
    f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 20)
)


HOSTILE = {
    "aliases": BOMB + BARE,
    "tag": BARE.replace("0.35", "!!python/object/apply:os.system [touch pwned]"),
    "huge": BARE.replace("0.35", "1e999"),
    "digits": BARE.replace("0.35", "9" * 5000),
    "depth": BARE.replace("0.35", "[" * 5000 + "]" * 5000),
    "key": BARE + "    " + "x" * 100_000 + ": 1.0\n",
    "path": BARE + "    effects: [../../evil, os.system]\n",
    "value": BARE + "    effects: [lateral_slip]\n    lateral_slip: {creep: 1.0e300}\n",
    "mixed": BARE + "    odom_frame_id: [a, 1]\n",
    "nul": "\0" * 1000,
    "empty": "",
}
OFTEN = ("aliases", "tag", "depth", "path", "nul")
"""Of each kind of harm one; all of them in `make evidence`."""


@pytest.mark.parametrize(
    "text",
    [
        pytest.param(text, id=name, marks=[pytest.mark.evidence] * (name not in OFTEN))
        for name, text in HOSTILE.items()
    ],
)
def test_the_node_refuses_and_runs_nothing(tmp_path: Path, text: str) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(text, encoding="utf-8")
    domain, lock = free_domain()
    node = [sys.executable, "-m", "werrimbi_odom.ros.odom_node"]
    try:
        done = subprocess.run(
            [*node, "--ros-args", "--params-file", str(file)],
            cwd=tmp_path,
            env=environment(domain, tmp_path),
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
            preexec_fn=limits,
            timeout=120.0,
        )
    finally:
        lock.close()
    assert done.returncode == 2, done.stderr[-500:]
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "pwned").exists()
