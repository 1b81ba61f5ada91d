# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""compare_node watches a robot: no alarm while it is sound, and what sets in is named soon."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("rclpy")
pytest.importorskip("rosbags")
pytest.importorskip("mujoco", reason="needs mujoco (pip install werrimbi_odom[all])")

from test.ros.watched_hours import looks


@pytest.mark.evidence
@pytest.mark.parametrize("hour", [0.3, 0.33])
def test_what_sets_in_is_named_within_ten_minutes_of_driving(hour: float, tmp_path: Path) -> None:
    """Wherever between two looks it sets in; before it nothing is an alarm."""
    name = "track_width"
    found = list(looks("paper", 5101, hour + 0.25, f"{name}=1.02", hour, tmp_path))
    sound = [each for each in found if not each.since >= 0.0]
    ill = [each for each in found if each.since >= 0.0]
    assert len(sound) >= 3
    assert {(each.verdict, each.names) for each in sound} == {("none", "")}
    assert sound[-1].alarms == {}
    named = [each for each in ill if (each.verdict, each.names) == ("named", name)]
    assert named
    assert named[0].since <= 10.0
    assert found[-1].resident < found[1].resident + 10.0
