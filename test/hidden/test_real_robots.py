# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Real robots, mended by the tool's own advice alone, come near what can be had at all."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

import pytest

from test.recorded_robots import with_recordings

ROOT = Path(__file__).parents[2]

ATTAINABLE = {
    "optitrack_robot": 1.9e-3,
    "khepera_laser_to_the_side": 4e-3,
    "khepera_laser_moved": 3.3e-3,
    "labyrinth": 26e-3,
}
"""With everything that is wrong found and fitted on other parts [m]."""

BY_NOISE = {"khepera_laser_to_the_side", "khepera_laser_moved"}
"""Robots of which the scan matcher's own noise is left, and is told to be."""


def _advice() -> ModuleType:
    spec = importlib.util.spec_from_file_location("follow_advice", ROOT / "docs/follow_advice.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules["follow_advice"] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.evidence
@with_recordings
@pytest.mark.parametrize("robot", ATTAINABLE)
def test_the_tools_advice_comes_within_a_fifth_of_what_can_be_had(
    robot: str, tmp_path: Path
) -> None:
    advice = _advice()
    case = next(case for case in advice.CASES if case.robot == robot)
    steps = advice.followed(case, tmp_path)
    assert steps[0].added
    assert advice.error(case, steps[-1].robot, tmp_path) < 1.2 * ATTAINABLE[robot]
    left = steps[-1].answer["left"]
    assert (robot in BY_NOISE) == (left is not None and left["is_reference_noise"])
