# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the reference may have to do with sizes that are off: its own metre, or this odometry."""

from __future__ import annotations

from dataclasses import replace

import pytest

from test.inference.driven import COMMON, runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.report.diagnosis.reference_remarks import (
    moved_by_its_odometry,
    or_its_axes,
    or_the_reference_s_scale,
)


def seen(runs: list[Run], scale: float, across: float | None = None) -> list[Run]:
    """By a camera whose metre is off, and perhaps another one across."""
    found = []
    for run in runs:
        assert run.reference is not None
        places = {"x": scale * run.reference.x, "y": (across or scale) * run.reference.y}
        found.append(replace(run, reference=replace(run.reference, **places)))
    return found


@pytest.mark.parametrize(("scale", "said"), [(0.98, "2 % too little"), (1.03, "3 % too much")])
def test_a_camera_s_wrong_metre_looks_like_base_and_radii_off_by_one_factor(
    scale: float, said: str
) -> None:
    found = diagnose(seen(runs_of(ROBOT, (1, 2), 40), scale), ROBOT, COMMON[:3])
    assert set(found.found) == {"wheel_radius_scale", "track_width"}
    [told] = or_the_reference_s_scale(found)
    assert said in told
    assert "reference_scale" in told
    assert "10 m beside a tape" in told


def test_a_camera_whose_axes_differ_looks_like_a_floor_with_a_grain() -> None:
    few = [find("anisotropic_floor"), *COMMON[:2]]
    found = diagnose(seen(runs_of(ROBOT, (1, 2), 60), 1.02, 0.98), ROBOT, few)
    assert found.found == ("anisotropic_floor",)
    [told] = or_its_axes(found)
    assert "too long by about 5 %" in told  # by the floor's law, which is not quite it
    assert "mend the reference" in told


def test_base_and_radii_that_are_off_by_two_factors_are_the_robot_s() -> None:
    off = replace(
        ROBOT,
        wheel_separation_multiplier=1.02,
        left_wheel_radius_multiplier=0.98,
        right_wheel_radius_multiplier=0.98,
    )
    found = diagnose(runs_of(off, (1, 2), 40), ROBOT, COMMON[:3])
    assert set(found.found) == {"wheel_radius_scale", "track_width"}
    assert or_the_reference_s_scale(found) == []


@pytest.mark.parametrize(
    ("base", "localised", "said"), [(1.05, True, True), (1.05, False, False), (1.01, True, False)]
)
def test_a_localiser_is_moved_by_the_odometry_that_it_judges(
    base: float, localised: bool, said: bool
) -> None:
    """With a base that is too small it turns too far until a scan corrects it."""
    runs = []
    for run in runs_of(replace(ROBOT, wheel_separation_multiplier=base), (1, 2), 40):
        assert run.reference is not None
        kind = "local_map" if localised else "absolute"
        runs.append(replace(run, reference=replace(run.reference, kind=kind)))
    found = diagnose(runs, ROBOT, COMMON[:3])
    assert found.found == ("track_width",)
    told = " ".join(moved_by_its_odometry(found))
    assert ("5 % too much until each scan corrects it" in told) is said
    assert bool(told) is said
