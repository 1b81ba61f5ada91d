# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""References that are put together: chains of transforms, and fixes of satellites."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.model.pose import Pose, between, compose

MS = 10**6


def truth(t: float) -> Pose:
    return Pose(2.0 + np.cos(t), -1.0 + np.sin(1.3 * t), 0.8 * t)


def wandered(t: float) -> Pose:
    """Where the odometry believes the robot to be."""
    return Pose(0.9 * t, 0.1 * t * t, 0.7 * t)


def localised(ros: Any) -> list[Any]:
    """Odometry at 50 Hz, a localiser that corrects it every 0.5 s and says it again at 10 Hz."""
    entries: list[Any] = [
        ("/ticks", 1, ros.counts(1, 2)),
        (
            "/tf_static",
            2,
            ros.transforms(
                ros.transform(0, ("base_footprint", "base_link"), 0.0, 0.0, 0.0),
                ros.transform(0, ("base_link", "laser"), 0.2, -0.1, np.pi / 2),
            ),
        ),
    ]
    for n in range(round(50 * 4.0) + 1):
        at = 1000 + 20 * n  # a stamp of zero is none
        odom = ros.transform(at * MS, ("odom", "base_footprint"), *wandered(at / 1e3))
        entries.append(("/tf", at * MS + 3, ros.transforms(odom)))
        if n % 5 == 0:
            corrected = at // 500 * 0.5
            shift = compose(truth(corrected), between(wandered(corrected), Pose(0.0, 0.0, 0.0)))
            to_odom = ros.transform(at * MS, ("map", "odom"), *shift)
            entries.append(("/tf", at * MS + 4, ros.transforms(to_odom)))
    return entries


def test_a_chain_is_composed_where_it_was_measured(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "bag", localised(ros))
    for wish in (None, "/tf", "/tf:map:base_link"):
        reference = read_run(bag, robot(), reference_topic=wish).reference
        assert reference is not None
        np.testing.assert_allclose(reference.time, 1.0 + 0.5 * np.arange(9), atol=1e-9)
        expected = np.array([truth(t) for t in reference.time])
        found = np.stack([reference.x, reference.y, np.unwrap(reference.yaw)], axis=1)
        np.testing.assert_allclose(found, expected, atol=1e-9)
        assert reference.kind == "local_map", "a localiser's error wanders"


def test_fixed_transforms_are_part_of_it_and_it_may_go_upwards(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    bag = ros.write(tmp_path / "bag", localised(ros))
    laser = read_run(bag, robot(), reference_topic="/tf:map:laser").reference
    back = read_run(bag, robot(), reference_topic="/tf:laser:map").reference
    assert laser is not None
    assert back is not None
    for n, t in enumerate(laser.time):
        expected = compose(truth(t), Pose(0.2, -0.1, np.pi / 2))
        assert laser.x[n] == pytest.approx(expected.x)
        assert laser.y[n] == pytest.approx(expected.y)
        here = compose(Pose(back.x[n], back.y[n], back.yaw[n]), expected)
        np.testing.assert_allclose((here.x, here.y, np.sin(here.yaw)), 0.0, atol=1e-9)


def test_a_map_that_never_corrects_is_the_odometry(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = localised(ros)
    still = ros.transforms(ros.transform(0, ("map", "odom"), 1.0, 2.0, 0.3))
    entries = [
        (topic, n, still if message[1].transforms[0].header.frame_id == "map" else message)
        if topic == "/tf"
        else (topic, n, message)
        for topic, n, message in entries
    ]
    run = read_run(
        ros.write(tmp_path / "bag", entries), robot(), reference_topic="/tf:map:base_link"
    )
    assert "map -> odom never changes" in run.circle


def test_fixes_of_satellites_are_metres(tmp_path: Path, ros: Any, robot: Any) -> None:
    """A second of latitude and of longitude at 60 degrees, by the ellipsoid's radii there."""
    pytest.importorskip("pyproj", reason="pyproj is not installed")
    second = 1.0 / 3600.0
    places = [(60.0, 25.0), (60.0 + second, 25.0), (60.0, 25.0 + second)]
    entries = [("/fix", n, ros.fix(n * MS, place)) for n, place in enumerate(places, start=2)]
    # Without a fix, and as drivers send that: zeros with the status of a fix.
    entries += [("/fix", n, ros.fix(n * MS, (0.0, 0.0), fixed=n > 9)) for n in (9, 10)]
    run = read_run(
        ros.write(tmp_path / "bag", [("/ticks", 1, ros.counts(1, 2)), *entries]), robot()
    )
    assert run.reference is not None
    sine, axis, flat = np.sin(np.radians(60.0)) ** 2, 6378137.0, 0.0066943799901413
    across = axis / np.sqrt(1.0 - flat * sine) + 50.0
    along = axis * (1.0 - flat) / (1.0 - flat * sine) ** 1.5 + 50.0
    arc = np.radians(second)
    nothing = [np.nan, np.nan]
    np.testing.assert_allclose(run.reference.x, [0, 0, 0.5 * across * arc, *nothing], atol=2e-3)
    np.testing.assert_allclose(run.reference.y, [0, along * arc, 0, *nothing], atol=2e-3)
    assert not run.reference.has_yaw.any()
    np.testing.assert_allclose(run.reference.sigma_xy, 5 * [0.2])
    assert run.reference.kind == "local_map", "what they err by lasts, and is no robot's"


def test_without_pyproj_the_remedy_is_named(
    tmp_path: Path, ros: Any, robot: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyproj", None)
    entries = [("/ticks", 1, ros.counts(1, 2)), ("/fix", 2, ros.fix(2 * MS, (60.0, 25.0)))]
    with pytest.raises(InputError, match=r'pip install "werrimbi_odom\[gps\]"'):
        read_run(ros.write(tmp_path / "bag", entries), robot())


def test_what_a_localiser_dates_forward_is_set_back_to_its_odometry(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """By a second, as AMCL does: of each pose a second was the odometry's, with its errors."""
    entries: list[Any] = [("/ticks", 1, ros.counts(1, 2))]
    for n in range(201):
        at = 1000 + 20 * n
        odom = ros.transform(at * MS, ("odom", "base_link"), *wandered(at / 1e3))
        entries.append(("/tf", at * MS + 3, ros.transforms(odom)))
        if n % 25 == 0:
            now = at / 1e3
            shift = compose(truth(now), between(wandered(now), Pose(0.0, 0.0, 0.0)))
            ahead = ros.transform((at + 1000) * MS, ("map", "odom"), *shift)
            entries.append(("/tf", at * MS + 3, ros.transforms(ahead)))
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert run.reference is not None
    np.testing.assert_allclose(run.reference.time, 1.0 + 0.5 * np.arange(9), atol=1e-9)
    found = np.stack([run.reference.x, run.reference.y, np.unwrap(run.reference.yaw)], axis=1)
    np.testing.assert_allclose(found, [truth(t) for t in run.reference.time], atol=1e-9)
    assert "stamped 1 s ahead of its receipt and set back by that" in str(run)
