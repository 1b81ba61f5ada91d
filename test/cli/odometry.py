# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot and its run, written for `werrimbi odom`, and what it makes of them."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from werrimbi_odom.cli.main import main

COLUMNS = "t_s,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw"
ROBOT = """\
odom_node:
  ros__parameters:
    wheel_separation: 0.4
    wheel_radius: 0.1
    left_ticks_per_revolution: 1000.0
    right_ticks_per_revolution: 1000.0
"""
TICK = 2.0 * math.pi * 0.1 / 1000.0


def ticks(place: Path, rows: list[tuple[Any, Any, Any]]) -> None:
    (place / "run").mkdir(exist_ok=True)
    text = "".join(",".join(map(str, row)) + "\n" for row in rows)
    (place / "run" / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n" + text)


def reference(place: Path, *rows: str) -> None:
    text = "".join(f"{row}\n" for row in rows)
    (place / "run" / "reference.csv").write_text("t_s,x_m,y_m,yaw_rad\n" + text)


def command(place: Path, *more: str | Path) -> list[str]:
    words = ["odom", "--robot", place / "robot.yaml", place / "run", "--out", place / "odom.csv"]
    return [str(word) for word in (*words, *more)]


def odom(place: Path, *more: str | Path) -> int:
    return main(command(place, *more))


def table(path: Path) -> np.ndarray:
    with path.open() as file:
        assert file.readline() == COLUMNS + "\n"
        return np.array([[float(cell) for cell in row] for row in csv.reader(file)])


def figures(place: Path) -> dict[str, Any]:
    assert odom(place, "--json", place / "figures.json") == 0
    found: dict[str, Any] = json.loads((place / "figures.json").read_text())
    return found
