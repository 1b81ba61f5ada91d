# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The Python API says what the command line says, to the last digit, and shows itself."""

from __future__ import annotations

import ast
import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import PLAIN, ROBOT_FILE, write_run
from test.command_line import Werrimbi, ran
from test.inference.driven import run_of
from werrimbi_odom.cli.main import main
from werrimbi_odom.effects import find

PACKAGE = Path(__file__).parents[2] / "werrimbi_odom"
EFFECT = "castor_kick"
SHELLS = ("cli", "fleet", "workbench", "demo")


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three short drives of a robot whose castor kicks, and its file, which does not know."""
    folder = tmp_path_factory.mktemp("drives")
    (folder / "robot.yaml").write_text(ROBOT_FILE)
    truth = replace(PLAIN, effects=(find(EFFECT).using(angle=-0.02),))
    for seed in range(3):
        write_run(folder / f"run_{seed}", run_of(truth, seed, 40))
    return folder


def runs(drives: Path) -> list[Path]:
    return sorted(path for path in drives.iterdir() if path.is_dir())


def plain(figures: dict[str, Any]) -> dict[str, Any]:
    """As JSON has it."""
    found = json.loads(json.dumps(figures))
    assert isinstance(found, dict)
    return found


def test_importing_it_imports_nothing_heavy() -> None:
    code = (
        "import sys, werrimbi_odom as wo; print(sorted(set(sys.modules) & "
        "{'numpy', 'scipy', 'plotly', 'rclpy', 'mujoco', 'rosbags'})); print(len(dir(wo)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    heavy, names = done.stdout.splitlines()
    assert heavy == "[]"
    assert int(names) == len(wo.__all__)


def test_every_name_is_there() -> None:
    for name in wo.__all__:
        assert getattr(wo, name) is not None
    with pytest.raises(AttributeError, match="no attribute 'odometrie'"):
        wo.odometrie  # noqa: B018


def test_odometry_of_lists_has_a_covariance(drives: Path) -> None:
    robot = wo.read_robot(drives / "robot.yaml")
    found = wo.odometry(robot, [0.0, 0.1, 0.2], [0, 100, 200], [0, 100, 200])
    assert found.covariance.shape == (3, 3, 3)
    assert found.x[-1] > 0.0
    assert np.linalg.eigvalsh(found.covariance[-1]).min() >= -1e-15
    with pytest.raises(ValueError, match="as long as each other"):
        wo.odometry(robot, [0.0, 0.1], [0], [0])


def test_references_that_lie_elsewhere(drives: Path, tmp_path: Path) -> None:
    """Counters in one folder and what was measured in another are the same drives."""
    robot, apart = wo.read_robot(drives / "robot.yaml"), []
    for run in runs(drives):
        for name in ("ticks", "reference"):
            folder = tmp_path / name / run.name
            folder.mkdir(parents=True)
            (folder / f"{name}.csv").symlink_to(run / f"{name}.csv")
        apart.append(tmp_path / "ticks" / run.name)
    references = sorted((tmp_path / "reference").iterdir())
    found = wo.compare(robot, apart, references=references).to_dict()
    assert found["legs"] == wo.compare(robot, runs(drives)).to_dict()["legs"]
    with pytest.raises(wo.InputError, match="2 times"):
        wo.compare(robot, apart, references=references[:2])
    out = [tmp_path / name for name in ("apart.csv", "whole.csv")]
    common = ["odom", "--robot", str(robot.path), "--out"]
    assert main([*common, str(out[0]), str(apart[0]), "--reference", str(references[0])]) == 0
    assert main([*common, str(out[1]), str(runs(drives)[0])]) == 0
    assert out[0].read_text() == out[1].read_text()


def test_odometry_is_that_of_the_command(drives: Path, tmp_path: Path) -> None:
    path = runs(drives)[0]
    out = tmp_path / "odom.csv"
    assert main(["odom", "--robot", str(drives / "robot.yaml"), str(path), "--out", str(out)]) == 0
    table = np.genfromtxt(out, delimiter=",", names=True)
    robot = wo.read_robot(drives / "robot.yaml")
    run = wo.read_run(path, robot)
    start = (table["x_m"][0], table["y_m"][0], table["yaw_rad"][0])
    ticks = run.ticks
    found = wo.odometry(robot, ticks.time, ticks.left, ticks.right, start=start)
    np.testing.assert_array_equal(found.x, table["x_m"])
    np.testing.assert_array_equal(found.covariance[:, 0, 0], table["xx"])


@pytest.mark.evidence
def test_sums_are_made_by_one_thread(drives: Path) -> None:
    """As on the command line; also in a process that has loaded no scipy yet."""
    looks = (
        "import sys, json\n"
        "from threadpoolctl import threadpool_info\n"
        "import werrimbi_odom as wo\n"
        "def threads():\n"
        "    return [pool['num_threads'] for pool in threadpool_info()"
        " if pool['user_api'] == 'blas']\n"
        "during = []\n"
        "robot, *runs = sys.argv[1:]\n"
        "wo.diagnose(wo.read_robot(robot), runs, show=lambda *_: during.append(threads()))\n"
        "print(json.dumps([during, threads()]))\n"
    )
    words = [sys.executable, "-c", looks, str(drives / "robot.yaml"), str(runs(drives)[0])]
    done = ran(words, OPENBLAS_NUM_THREADS="2")
    assert done.returncode == 0, done.stderr
    during, after = json.loads(done.stdout)
    assert during
    assert all(set(pools) == {1} for pools in during)
    assert set(after) == {2}


CASES: dict[str, tuple[list[str], Any]] = {
    "compare": (
        ["compare", "--robot", "robot.yaml", "run_0", "run_1"],
        lambda robot: wo.compare(robot, ["run_0", "run_1"]),
    ),
    "compare in another way": (
        ["compare", "--robot", "robot.yaml", "--leg", "0.5", "--reference-kind", "incremental",
         "run_0"],
        lambda robot: wo.compare(robot, "run_0", leg=0.5, reference_kind="incremental"),
    ),
    "diagnose": (
        ["diagnose", "--robot", "robot.yaml", "run_0", "run_1", "--holdout", "run_2"],
        lambda robot: wo.diagnose(
            robot, [wo.read_run(f"run_{n}", robot) for n in (0, 1)], holdout="run_2"
        ),
    ),
    "add": (
        ["add", EFFECT, "--robot", "robot.yaml", "run_0", "--holdout", "run_2", "--out", "n.yaml",
         "--force"],
        lambda robot: wo.add(EFFECT, robot, "run_0", holdout="run_2", force=True),
    ),
    "calibrate fit": (
        ["calibrate", "fit", "--robot", "robot.yaml", "run_0", "--holdout", "run_2",
         "--out", "n.yaml", "--force"],
        lambda robot: wo.calibrate_fit(robot, "run_0", holdout="run_2"),
    ),
    "calibrate umbmark": (
        ["calibrate", "umbmark", "squares.csv", "--side", "4", "--robot", "robot.yaml",
         "--out", "n.yaml", "--force"],
        lambda robot: wo.calibrate_umbmark(robot, "squares.csv", 4.0),
    ),
    "calibrate noise": (
        ["calibrate", "noise", "noise.csv", "--distance", "10", "--robot", "robot.yaml",
         "--out", "n.yaml", "--force"],
        lambda robot: wo.calibrate_noise(robot, "noise.csv", 10.0),
    ),
    "odom": (
        ["odom", "--robot", "robot.yaml", "run_0", "--out", "n.csv"],
        lambda robot: wo.odom(robot, "run_0"),
    ),
}  # fmt: skip


@pytest.mark.usefixtures("few_effects")
@pytest.mark.parametrize("case", CASES)
def test_a_verb_says_what_the_command_says(
    drives: Path, case: str, monkeypatch: pytest.MonkeyPatch, werrimbi: Werrimbi
) -> None:
    """Words, JSON and robot file, to the last digit."""
    monkeypatch.chdir(drives)
    command, verb = CASES[case]
    offsets = ("ccw,0.097,-0.094", "ccw,0.095,-0.090", "cw,0.032,0.031", "cw,0.030,0.034")
    Path("squares.csv").write_text("\n".join(("sense,x_m,y_m", *offsets)))
    ends = (f"{0.002 * (-1) ** i},{0.03 * (i % 5 - 2)},{0.004 * (i % 4 - 1.5)}" for i in range(20))
    Path("noise.csv").write_text("\n".join(("ex_m,ey_m,eyaw_rad", *ends)))
    said = werrimbi(*command, "--json", "said.json").out
    found = verb(wo.read_robot("robot.yaml"))
    assert said.startswith(f"{found.summary()}\n")
    assert plain(found.to_dict()) == json.loads(Path("said.json").read_text())
    if "n.yaml" in command:
        found.write_robot("python.yaml", force=True)
        assert Path("python.yaml").read_text() == Path("n.yaml").read_text()
    assert "\n" not in repr(found)
    assert len(repr(found)) < 200


@pytest.mark.evidence
def test_a_draft_is_that_of_the_command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    simulated = ["simulate", "--out", "d", "--hide", "one_tyre_backwards", "--seed", "6"]
    assert main(simulated) == 0
    given = ["--robot", "d/robot.yaml", *map(str, sorted(Path("d/train").iterdir()))]
    capsys.readouterr()
    assert main(["draft", *given, "--out", "e", "--json", "said.json", "--force"]) == 0
    said = capsys.readouterr().out
    found = wo.draft(wo.read_robot("d/robot.yaml"), given[2:], force=True)
    assert said.startswith(f"{found.summary()}\n")
    told = json.loads(Path("said.json").read_text())
    files = told["draft"].pop("files")
    assert plain(found.to_dict()) == told
    written = found.write_package("f")
    assert [path.read_text() for path in written] == [Path(file).read_text() for file in files]


def test_shells_have_no_verbs_of_their_own() -> None:
    """What works a verb out is called by the API alone; import-linter keeps the rest."""
    verbs = {
        "compare", "judged", "diagnose", "advised_diagnosis", "add_effects", "best_draft",
        "calibrate", "umbmark", "fit_noise", "detection_limits", "next_manoeuvre",
    }  # fmt: skip
    called = set()
    for shell in (*SHELLS, "api"):
        place = PACKAGE / shell
        for file in [place] if place.is_file() else place.rglob("*.py"):
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if not isinstance(node, ast.ImportFrom) or node.module is None:
                    continue
                below = node.module.startswith(("werrimbi_odom.inference", "werrimbi_odom.report"))
                names = {alias.name for alias in node.names} & verbs if below else set()
                assert shell == "api" or not names, f"{file}: {names}"
                called |= names
    assert verbs - called <= {"detection_limits", "next_manoeuvre"}, "all are known"


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (["run_0", "run_0"], "run_0 is given twice"),
        (["nowhere"], "nowhere: there is no such run"),
        ([], "no drives were given"),
    ],
)
def test_what_the_command_refuses_is_refused(
    drives: Path, given: list[str], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(drives)
    with pytest.raises(wo.InputError, match=said):
        wo.compare(wo.read_robot("robot.yaml"), given)


def test_nothing_is_not_added(drives: Path) -> None:
    """As `found` of a diagnosis that finds nothing: a fit of nothing would take as long as any."""
    with pytest.raises(wo.InputError, match="no effect was given"):
        wo.add((), wo.read_robot(drives / "robot.yaml"), drives / "run_0")


def test_a_result_shows_itself(drives: Path, tmp_path: Path) -> None:
    robot = wo.read_robot(drives / "robot.yaml")
    found = wo.compare(robot, runs(drives)[:2])
    assert repr(found)[1:-1].partition(": ")[2] in found.summary()
    assert "iframe" in found._repr_html_()
    assert {"motion", "nees"} <= set(found.figures())
    (page,) = found.write_report(tmp_path / "compare.html")
    assert page.stat().st_size > 10_000
    with pytest.raises(wo.InputError, match="changes no robot file"):
        found.write_robot(tmp_path / "none.yaml")


def test_what_is_given_in_the_wrong_order_is_told(drives: Path) -> None:
    robot = wo.read_robot(drives / "robot.yaml")
    with pytest.raises(TypeError, match="the robot comes first"):
        wo.compare(runs(drives), robot)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="unknown option legs; there are reference_kind, leg"):
        wo.compare(robot, runs(drives), legs=2.0)  # type: ignore[call-arg]
