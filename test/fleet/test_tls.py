# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A Dask cluster that talks TLS alone, by Dask's own configuration, as docs/fleet.md says."""

from __future__ import annotations

import gc
import json
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator

import pytest

from test.command_line import ROOT
from test.fleet.test_process_pool import nowhere
from werrimbi_odom.errors import InputError
from werrimbi_odom.fleet.cluster import on_cluster

distributed = pytest.importorskip("distributed", reason="pip install werrimbi_odom[cluster]")

ASK = """
import sys
from test.fleet.test_process_pool import nowhere
from werrimbi_odom.fleet.cluster import on_cluster
for row in on_cluster([nowhere("robot_1"), nowhere("robot_2")], sys.argv[1], patience=60.0):
    print(row.robot, row.error)
"""


@pytest.fixture(scope="module")
def certified(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Environment of a machine that has a certificate, signed by itself."""
    if shutil.which("openssl") is None:
        pytest.skip("no openssl to make a certificate with")
    folder = tmp_path_factory.mktemp("tls")
    key, certificate = folder / "own.key", folder / "own.pem"
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2",
         "-subj", "/CN=werrimbi", "-keyout", str(key), "-out", str(certificate)],
        check=True, capture_output=True,
    )  # fmt: skip
    shown = re.search(r"  ```sh\n(.*?)  ```", (ROOT / "docs" / "fleet.md").read_text(), re.S)
    assert shown is not None
    words = shown[1].replace("ca.pem", str(certificate))
    words = words.replace("cert.pem", str(certificate)).replace("=key.pem", f"={key}")
    told = subprocess.run(
        ["bash", "-c", f"{words}\nenv -0"], check=True, capture_output=True, text=True
    ).stdout
    environment = dict(entry.split("=", 1) for entry in told.split("\0") if entry)
    return {**environment, "PYTHONPATH": str(ROOT)}


@pytest.fixture(scope="module")
def guarded(certified: dict[str, str], tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Address of a scheduler with a worker."""
    folder = tmp_path_factory.mktemp("cluster")
    told = folder / "scheduler.json"
    dask = [sys.executable, "-m"]
    words = ["--no-dashboard", "--scheduler-file", str(told)]
    commands = [
        [*dask, "distributed.cli.dask_scheduler", "--protocol", "tls", "--port", "0",
         "--host", "127.0.0.1", *words],
        [*dask, "distributed.cli.dask_worker", "--nthreads", "1", *words],
    ]  # fmt: skip
    processes = [
        subprocess.Popen(command, cwd=folder, env=certified, stderr=subprocess.DEVNULL)
        for command in commands
    ]
    try:
        while not told.exists():
            assert processes[0].poll() is None
            time.sleep(0.05)
        yield str(json.loads(told.read_text())["address"])
    finally:
        for process in reversed(processes):
            process.terminate()
            process.wait(60.0)


@pytest.mark.evidence
def test_robots_go_over_tls(guarded: str, certified: dict[str, str]) -> None:
    assert guarded.startswith("tls://")
    done = subprocess.run(
        [sys.executable, "-c", ASK, guarded],
        env=certified, capture_output=True, text=True, check=False, timeout=180,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    lines = sorted(done.stdout.splitlines())
    assert [line.split()[0] for line in lines] == ["robot_1", "robot_2"]
    assert all("robot.yaml" in line for line in lines), "each says what it lacks"


@pytest.mark.evidence
@pytest.mark.parametrize("protocol", ["tls", "tcp"])
def test_who_has_no_certificate_is_not_let_in(guarded: str, protocol: str) -> None:
    address = guarded.replace("tls://", f"{protocol}://")
    with pytest.raises(InputError, match="no Dask scheduler answers there"):
        list(on_cluster([nowhere("robot_1")], address, patience=5.0))
    clients = [item for item in gc.get_objects() if isinstance(item, distributed.Client)]
    open_ones = [client for client in clients if client.status not in ("closed", "newly-created")]
    assert open_ones == [], "Dask hangs if they are collected while another client starts"
