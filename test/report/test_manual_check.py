# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a ruler is said to show is what a robot with that effect does."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from test.model.drives import ROBOT, read
from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.inference.diagnosis.estimated_values import Value
from werrimbi_odom.inference.diagnosis.result import Diagnosis
from werrimbi_odom.model.trajectory import trajectory
from werrimbi_odom.report.diagnosis import phrases
from werrimbi_odom.report.diagnosis.manual_check import expected_words


def number(words: str) -> float:
    found = re.search(r"[\d.]+", words)
    assert found is not None, words
    return float(found[0])


@pytest.mark.parametrize("multiplier", [0.98, 1.02, 1.68])
def test_ten_turns_fall_short_by_as_much_as_is_said(multiplier: float) -> None:
    count = 50 * 60
    spin = read(ROBOT, 50.0, np.zeros(count), np.full(count, 20.0 * np.pi / 60.0))
    applied = find("track_width").using(multiplier=multiplier)
    path = trajectory(replace(ROBOT, effects=(applied,)), *spin)
    short = 3600.0 - np.degrees(path.yaw[-1])
    words = expected_words("track_width", applied.values, ROBOT)
    assert number(words) == pytest.approx(abs(short), rel=0.06)
    assert ("short" in words) == (short > 0.0)


@pytest.mark.parametrize("multiplier", [0.01, 0.17])
def test_a_base_that_was_entered_far_too_wide_is_measured_with_a_ruler(multiplier: float) -> None:
    """Centimetres for metres: a robot that spins ten turns by that file spins for a week."""
    robot = replace(ROBOT, wheel_separation=ROBOT.wheel_separation / multiplier)
    words = expected_words("track_width", {"multiplier": multiplier}, robot)
    assert "by a ruler" in words
    unit = 0.01 if "cm" in words else 1e-3 if "mm" in words else 1.0
    assert unit * number(words) == pytest.approx(ROBOT.wheel_separation, rel=0.06)


@pytest.mark.parametrize("delay", [0.0996, 0.1])
def test_a_length_near_a_decimetre_has_no_power_of_ten(delay: float) -> None:
    words = expected_words("reference_delay", {"delay": delay}, ROBOT)
    assert re.search(r"expect (100 mm|10 cm) ", words), words


@pytest.mark.parametrize("ratio", [0.99, 1.03])
def test_a_larger_wheel_leads_aside_as_far_as_is_said(ratio: float) -> None:
    line = read(ROBOT, 50.0, np.full(500, 0.3), np.zeros(500))
    applied = find("unequal_wheel_radii").using(ratio=ratio)
    path = trajectory(replace(ROBOT, effects=(applied,)), *line)
    words = expected_words("unequal_wheel_radii", applied.values, ROBOT)
    unit = 0.01 if "cm" in words else 1e-3
    assert unit * number(words) == pytest.approx(abs(path.y[-1]), rel=0.06)
    assert ("left" in words) == (path.y[-1] > 0.0)


@pytest.mark.parametrize("effect", [item for item in LIBRARY if item.parameters])
def test_every_effect_that_can_be_measured_has_its_number(effect: object) -> None:
    values = {name: item.typical for name, item in effect.parameters.items()}  # type: ignore[attr-defined]
    words = expected_words(effect.name, values, ROBOT)  # type: ignore[attr-defined]
    assert words.startswith("expect ")
    assert re.search(r"\d", words)
    assert "nan" not in words


def test_what_the_drives_do_not_tell_is_not_expected(monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside a y that was not determined, 0.87 mm to the right were to be expected by tape."""
    unseen = Value(-0.2e-3, 0.2e-3, "m", "left", 0.0)
    untold = replace(unseen, std=math.nan, determined=False)
    arm = find("reference_lever_arm")
    diagnosis = SimpleNamespace(robot=ROBOT, runs=SimpleNamespace(headings_alone=False))
    said = []
    for y in (unseen, untold):
        found = {"x": Value(0.04, 1e-4, "m", "ahead", 0.0), "y": y}
        monkeypatch.setattr(phrases, "values_of", lambda *_, found=found: found)
        said += phrases.ruler(cast("Diagnosis", diagnosis), arm, "Check it")
    assert said[0].endswith("and across it; expect 40 mm ahead.")
    assert said[1].endswith("and across it.")
