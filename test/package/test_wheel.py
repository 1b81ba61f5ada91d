# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""sdist and wheel can be uploaded; the wheel alone runs, and says what it lacks and how to get it.

Needs `pip install werrimbi_odom[release]` and a package registry.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SQUARE = ROOT / "werrimbi_odom" / "recordings" / "square"
GIVEN = ("--robot", str(SQUARE / "robot.yaml"), str(SQUARE))
LACKS = {
    ("compare", *GIVEN): "werrimbi_odom[tools]",
    ("diagnose", *GIVEN): "werrimbi_odom[tools]",
    ("add", "castor_kick", *GIVEN, "--out", "new.yaml"): "werrimbi_odom[tools]",
    ("calibrate", "fit", *GIVEN, "--out", "new.yaml"): "werrimbi_odom[tools]",
    ("workbench", *GIVEN): "werrimbi_odom[workbench]",
    ("simulate", "--out", "drives"): "werrimbi_odom[simulation]",
    ("odom", *GIVEN[:2], f"{SQUARE}_bag", "--out", "odom.csv"): "werrimbi_odom[tools]",
}


def test_the_version_is_one() -> None:
    """setup.py, package.xml and the changelog agree."""
    (ours,) = re.findall(r'version="(.+?)"', (ROOT / "setup.py").read_text())
    (ros,) = re.findall(r"<version>(.+?)</version>", (ROOT / "package.xml").read_text())
    log = (ROOT / "CHANGELOG.md").read_text()
    heads = re.findall(r"^## (.+)$", log, re.M)
    assert heads[0] == "[Unreleased]"
    assert re.fullmatch(rf"\[{re.escape(ours)}\] - \d{{4}}-\d\d-\d\d", heads[1])
    assert ours == ros


def run(command: list[str], cwd: Path, *, alone: bool = True) -> subprocess.CompletedProcess[str]:
    """Run a command; alone: with nothing of the environment that runs the tests."""
    environment = {k: v for k, v in os.environ.items() if not (alone and k == "PYTHONPATH")}
    return subprocess.run(
        command, cwd=cwd, env=environment, capture_output=True, text=True, check=False
    )


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with sdist and wheel, of what git holds or would hold."""
    pytest.importorskip("build.__main__", reason="needs werrimbi_odom[release]")
    source, out = tmp_path_factory.mktemp("source"), tmp_path_factory.mktemp("dist")
    listed = run(["git", "ls-files", "-co", "--exclude-standard"], ROOT).stdout.splitlines()
    for name in listed:
        if (ROOT / name).is_file():
            (source / name).parent.mkdir(parents=True, exist_ok=True)
            (source / name).write_bytes((ROOT / name).read_bytes())
    made = run(
        [sys.executable, "-m", "build", "--outdir", str(out), str(source)], source, alone=False
    )
    assert made.returncode == 0, made.stdout[-2000:] + made.stderr[-2000:]
    return out


@pytest.fixture(scope="module")
def alone(built: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The executables of an environment that holds the wheel and what it asks for, no more."""
    place = tmp_path_factory.mktemp("alone")
    assert run([sys.executable, "-m", "venv", str(place)], place).returncode == 0
    (wheel,) = built.glob("*.whl")
    pip = run([str(place / "bin" / "pip"), "install", "--quiet", str(wheel)], place)
    assert pip.returncode == 0, pip.stderr[-2000:]
    return place / "bin"


@pytest.mark.evidence
def test_twine_finds_nothing_to_mend(built: Path) -> None:
    pytest.importorskip("twine", reason="needs werrimbi_odom[release]")
    files = sorted(str(path) for path in built.iterdir())
    assert [path.rsplit(".", 1)[1] for path in files] == ["whl", "gz"]
    checked = run([sys.executable, "-m", "twine", "check", "--strict", *files], built, alone=False)
    assert checked.returncode == 0, checked.stdout


@pytest.mark.evidence
def test_the_wheel_alone_helps_explains_and_reckons(alone: Path, tmp_path: Path) -> None:
    for words in (["--help"], ["explain"], ["explain", "castor_kick"]):
        told = run([str(alone / "werrimbi"), *words], tmp_path)
        assert told.returncode == 0, told.stderr
        assert told.stdout.strip()
    reckoned = run([str(alone / "werrimbi"), "odom", *GIVEN, "--out", "odom.csv"], tmp_path)
    assert reckoned.returncode == 0, reckoned.stderr
    assert (tmp_path / "odom.csv").read_text().startswith("t_s,x_m,y_m,yaw_rad,")


@pytest.mark.evidence
@pytest.mark.parametrize("words", LACKS, ids=lambda words: words[0])
def test_what_is_missing_is_said_in_one_line(
    alone: Path, tmp_path: Path, words: tuple[str, ...]
) -> None:
    told = run([str(alone / "werrimbi"), *words], tmp_path)
    assert told.returncode == 2
    assert len(told.stderr.splitlines()) == 1, told.stderr
    assert f"pip install {LACKS[words]!r}" in told.stderr.replace('"', "'")


@pytest.mark.evidence
@pytest.mark.parametrize("node", ["odom_node", "compare_node", "drive_node", "simulated_robot"])
def test_a_node_without_ros_says_so(alone: Path, tmp_path: Path, node: str) -> None:
    told = run([str(alone / node), "--ros-args"], tmp_path)
    assert told.returncode == 2
    assert "pip install 'werrimbi_odom[ros]'" in told.stderr
    assert "Traceback" not in told.stderr
