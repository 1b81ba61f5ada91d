# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of the reports anew, in Chromium, from simulated drives: `make pictures`.

Each kind of report and each verdict has its robot, with something else hidden; the whole of it
takes some minutes.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

from werrimbi_odom.cli.main import main as werrimbi
from werrimbi_odom.report.save import find_browser

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "pictures"
sys.path[:0] = [str(ROOT), str(ROOT / "test" / "report"), str(ROOT / "benchmark")]

from browser import visit  # noqa: E402
from history_year import ROBOT_FILE, make  # noqa: E402

WIDTH, PHONE = 1100, 390

VERDICTS = {
    "diagnose": (("eccentric_left_wheel=0.0015",), "7"),
    "none": ((), "5"),
    "ambiguous": (("sideways_drift=0.012",), "4"),
    "unknown": (("slippery_spot=0.25",), "15"),
    "set_up": (("wheels_swapped",), "6"),
}
"""What is hidden, and the seed; by the name of the picture."""

MISCALIBRATED = (("track_width=1.04", "unequal_wheel_radii=1.03"), "9")
"""The same, for `calibrate fit`."""

YEAR = (60, 60.0)
"""Drives of a robot's history, and how long each lasts [s]."""


def main() -> None:
    """Simulate, write every kind of report, and take their pictures."""
    browser = find_browser()
    if browser is None:
        sys.exit("no Chrome or Chromium found; e.g. apt install chromium")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)  # so that the pages show short names
        pages = Path()
        for name, (hidden, seed) in VERDICTS.items():
            data = simulated(name, hidden, seed)
            run("diagnose", *drives(data), *held_out(data), "--report", pages / f"{name}.html")
        data = Path("diagnose")
        run("compare", *drives(data), "--report", "compare.html")
        run("add", "eccentric_left_wheel", *drives(data), *held_out(data),
            "--out", "new.yaml", "--report", "add.html")  # fmt: skip
        run("calibrate", "fit", *drives(simulated("calibration", *MISCALIBRATED)),
            "--out", "fit.yaml", "--report", "fit.html")  # fmt: skip
        history()
        robot = ("--robot", "none/robot.yaml")
        Path("SQUARES.csv").write_text(SQUARES)
        run("calibrate", "umbmark", "SQUARES.csv", "--side", "4", *robot,
            "--out", "u.yaml", "--report", "umbmark.html")  # fmt: skip
        Path("RUNS.csv").write_text(out_and_back())
        run("calibrate", "noise", "RUNS.csv", "--distance", "10", *robot, "--out", "n.yaml",
            "--reference-sigma-xy", "0.001", "--reference-sigma-yaw", "0.002",
            "--report", "noise.html")  # fmt: skip
        for name, dark, width, tallest in SHOWN:
            picture = PICTURES / f"report_{name}.png"
            page = pages / f"{name.removesuffix('_phone')}.html"
            visit(page, browser=browser, dark=dark, width=width, picture=picture, tallest=tallest)
            print(picture)
        os.chdir(ROOT)


SHOWN = (
    ("compare", False, WIDTH, 3000),
    ("diagnose", False, WIDTH, 3900),
    ("none", True, WIDTH, 1500),
    ("ambiguous", False, WIDTH, 1900),
    ("unknown", False, WIDTH, 2500),
    ("set_up", False, WIDTH, 2150),
    ("add", True, WIDTH, 1900),
    ("fit", False, WIDTH, 1440),
    ("umbmark", False, WIDTH, 2120),
    ("noise", False, WIDTH, 1220),
    ("history", False, WIDTH, 2350),
    ("compare_phone", False, PHONE, 2300),
)
"""Name of the picture, whether dark, width and greatest height; below it are tables."""

SQUARES = """\
sense,x_m,y_m
cw,0.029,0.034
cw,0.036,0.027
cw,0.031,0.035
cw,0.034,0.029
cw,0.028,0.031
ccw,0.092,-0.090
ccw,0.102,-0.098
ccw,0.096,-0.093
ccw,0.099,-0.097
ccw,0.094,-0.091
"""
"""Ends of squares as a tape measures them."""


def simulated(name: str, hidden: Sequence[str], seed: str) -> Path:
    """A folder with drives of a robot that something is hidden in."""
    hides = [word for each in hidden for word in ("--hide", each)]
    run("simulate", "--out", name, *hides, "--seed", seed)
    return Path(name)


def history() -> None:
    """The year of docs/history.md."""
    year = Path("year")
    year.mkdir()
    (year / "robot.yaml").write_text(ROBOT_FILE)
    runs = [make(year, number, *YEAR) for number in range(YEAR[0])]
    run("history", "--robot", year / "robot.yaml", *runs, "--cache", "kept",
        "--report", "history.html")  # fmt: skip


def out_and_back() -> str:
    """Ends of 60 drives of 10 m out and back, of wheels with the paper's noise."""
    import numpy as np

    random, base, step = np.random.default_rng(1), 0.35, 0.05
    way = np.arange(0.0, 20.0, step) + 0.5 * step
    left, right = (
        random.normal(0.0, noise * np.sqrt(step), (60, way.size)) for noise in (4.0e-4, 5.8e-4)
    )
    turned = (right - left) / base
    poses = np.stack(
        [
            0.5 * (left + right).sum(axis=1),
            -(np.minimum(way, 20.0 - way) * turned).sum(axis=1),
            turned.sum(axis=1),
        ],
        axis=-1,
    )
    poses += random.normal(0.0, np.sqrt(2.0) * np.array([1e-3, 1e-3, 2e-3]), poses.shape)
    rows = [",".join(f"{value:.5f}" for value in pose) for pose in poses]
    return "\n".join(["ex_m,ey_m,eyaw_rad", *rows]) + "\n"


def drives(data: Path) -> list[object]:
    """The robot file and the drives to learn from."""
    return ["--robot", data / "robot.yaml", *sorted((data / "train").iterdir())]


def held_out(data: Path) -> list[object]:
    """The drives to judge on."""
    return ["--holdout", *sorted((data / "holdout").iterdir())]


def run(*words: object) -> None:
    """A command of werrimbi; ends here when it fails."""
    sys.argv = ["werrimbi", *map(str, words)]
    if code := werrimbi(sys.argv[1:]):
        sys.exit(code)


if __name__ == "__main__":
    main()
