# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The story of the README through commands alone: simulate, compare, diagnose, add, compare."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from test.hidden.sets import ROOT, runs_of
from werrimbi_odom.cli.main import VERBS

pytest.importorskip("mujoco", reason="hidden sets need the physics engine (pip install mujoco)")
pytestmark = pytest.mark.skipif(
    not {"diagnose", "add"} <= set(VERBS), reason="the verbs diagnose and add do not exist yet"
)

SEED = "6"
"""Hides a castor that kicks: --hide random draws the effect and its strength."""


def werrimbi(*words: object) -> str:
    done = subprocess.run(
        [sys.executable, "-m", "werrimbi_odom.cli.main", *map(str, words)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def told(file: Path) -> dict[str, Any]:
    found = json.loads(file.read_text(encoding="utf-8"))
    assert isinstance(found, dict)
    return found


@pytest.mark.evidence
def test_a_random_hidden_effect_is_found_added_and_gone(
    tmp_path: Path, simulated: Callable[..., Path]
) -> None:
    day, better = simulated("--hide", "random", "--seed", SEED), tmp_path / "better.yaml"
    robot = day / "robot.yaml"
    train, holdout = runs_of(day, "train"), runs_of(day, "holdout")
    werrimbi("compare", "--robot", robot, *holdout, "--json", tmp_path / "before.json")
    apart = ["--holdout", *holdout]
    words = ["--robot", robot, *train, *apart, "--json", tmp_path / "diagnosis.json"]
    werrimbi("diagnose", *words)
    diagnosis = told(tmp_path / "diagnosis.json")
    assert diagnosis["verdict"] == "named"
    effect = diagnosis["effect"]
    words = ["--robot", robot, *train, *apart, "--out", better, "--json", tmp_path / "added.json"]
    werrimbi("add", effect, *words)
    werrimbi("compare", "--robot", better, *holdout, "--json", tmp_path / "after.json")
    before, after = (
        told(tmp_path / f"{name}.json")["legs"]["rmse_position_m"] for name in ("before", "after")
    )
    added = told(tmp_path / "added.json")
    assert added["effect"] == effect
    assert added["holdout"]["before"] == pytest.approx(before, rel=0.02)
    assert added["holdout"]["after"] == pytest.approx(after, rel=0.02)
    assert after < before / 1.1
    (hidden,) = told(day / "truth.json")["hidden"]
    assert hidden["effect"] == effect, "read last"
