# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""References from bags: poses, transforms and a gyro."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run

MS = 10**6
POSES = [(1.0, 2.0, 0.5), (1.5, -2.0, 3.0), (2.0, 0.0, -2.5)]
BASE = ("map", "base_link")


def ticks(ros: Any) -> tuple[str, int, Any]:
    return ("/ticks", 1, ros.counts(1, 2))


def written(ros: Any, path: Path, entries: list[Any]) -> Path:
    return Path(ros.write(path / "bag", [ticks(ros), *entries]))


@pytest.mark.parametrize("kind", ["pose", "odometry", "transform", "tf"])
def test_poses(tmp_path: Path, ros: Any, robot: Any, kind: str) -> None:
    def message(t: int, pose: tuple[float, float, float]) -> Any:
        if kind in ("transform", "tf"):
            stamped = ros.transform(t, BASE, *pose)
            return ros.transforms(stamped) if kind == "tf" else stamped
        return getattr(ros, kind)(t, *pose)

    entries = [
        (f"/{kind}", 999 * MS + n, message(n * MS, pose)) for n, pose in enumerate(POSES, start=1)
    ]
    reference = read_run(written(ros, tmp_path, entries), robot()).reference
    assert reference is not None
    assert reference.time.tolist() == [0.001, 0.002, 0.003]
    found = np.stack([reference.x, reference.y, reference.yaw], axis=1)
    np.testing.assert_allclose(found, POSES, atol=1e-12)
    assert reference.sigma_xy is None
    assert reference.sigma_yaw is None


def test_a_covariance_of_each_pose_is_kept(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = [
        ("/amcl", 2, ros.pose_with_covariance(1 * MS, *POSES[0], (0.01, 0.03, 0.0004))),
        ("/amcl", 3, ros.pose_with_covariance(2 * MS, *POSES[1], (0.0, 0.0, 0.0))),
    ]
    reference = read_run(written(ros, tmp_path, entries), robot()).reference
    assert reference is not None
    np.testing.assert_allclose(reference.sigma_xy, [math.sqrt(0.02), np.nan])
    np.testing.assert_allclose(reference.sigma_yaw, [0.02, np.nan])
    assert reference.kind == "local_map", "on a map: AMCL, SLAM"


@pytest.mark.parametrize(("frame", "kind"), [("robot1/map", "local_map"), ("mocap", None)])
def test_a_huge_variance_is_unknown_and_a_map_may_have_a_namespace(
    tmp_path: Path, ros: Any, robot: Any, frame: str, kind: str | None
) -> None:
    """Publishers write 1e6 for unknown: the reference's own noise was 1e+06 mm."""
    entries = []
    for n, pose in enumerate(POSES[:2], start=1):
        of, message = ros.pose_with_covariance(n * MS, *pose, (1e6, 1e6, 99999.0))
        message.header.frame_id = frame
        entries.append(("/amcl", n + 1, (of, message)))
    reference = read_run(written(ros, tmp_path, entries), robot()).reference
    assert reference is not None
    assert (reference.sigma_xy, reference.sigma_yaw) == (None, None)
    assert reference.kind == kind


def test_poses_without_a_stamp_are_of_when_they_came(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Motion capture gives Pose2D; how far a controller is from its goal is no pose."""
    entries = []
    for n in (2, 3):
        entries.append(("/mocap/ground_pose", n * 10**9, ros.plane_pose(1.0 * n, 2.0, 0.5)))
        entries.append(("/error", n * 10**9, ros.plane_pose(0.1 * n, 0.0, 0.0)))
    bag = written(ros, tmp_path, entries)
    reference = read_run(bag, robot()).reference
    assert reference is not None
    assert reference.time.tolist() == [2.0, 3.0]
    assert reference.x.tolist() == [2.0, 3.0]
    assert reference.yaw.tolist() == [0.5, 0.5]


def test_of_poses_that_come_in_bursts_the_last_is_kept(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Measured at 100 Hz, sent ten at a time: the others were measured earlier than they came.

    Pauses between bursts, a hundred times the usual interval, looked like losses of the reference.
    """
    entries = [
        ("/mocap", (100 * (n // 10) + 100) * MS + n, ros.plane_pose(0.01 * n, 0.0, 0.0))
        for n in range(100)
    ]
    run = read_run(written(ros, tmp_path, entries), robot())
    assert run.reference is not None
    np.testing.assert_allclose(run.reference.time, 0.1 * np.arange(1, 11), atol=1e-6)
    np.testing.assert_allclose(run.reference.x, 0.1 * np.arange(1, 11) - 0.01)
    assert any("all come 10 at a time, of which the last is kept" in note for note in run.notes)


def test_an_imu_that_states_no_rate_is_told_as_that(tmp_path: Path, ros: Any, robot: Any) -> None:
    """It was asked for a frame, of which there are none."""
    entries = [("/imu", n * MS, ros.imu(n * MS, 0.1, known=False)) for n in (1, 2, 3)]
    with pytest.raises(InputError, match=r"/imu: no message holds a yaw rate: angular_velocity_c"):
        read_run(written(ros, tmp_path, entries), robot())


@pytest.mark.parametrize("stamps", [[1, 2, 3, 4], [1, 2, 60, 61, 62, 120, 121, 122]])
def test_what_a_person_measured_together_is_kept(
    stamps: list[int], tmp_path: Path, ros: Any, robot: Any
) -> None:
    entries = [
        ("/tape", n, ros.pose(1000 * MS * at, *POSES[n % 3])) for n, at in enumerate(stamps, 2)
    ]
    reference = read_run(written(ros, tmp_path, entries), robot()).reference
    assert reference is not None
    assert reference.time.size == len(stamps)


def test_what_is_no_pose_is_not_measured(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = [
        ("/pose", 2, ros.pose(1 * MS, 1.0, 2.0, math.nan)),
        ("/pose", 3, ros.pose(2 * MS, math.inf, 2.0, 0.5)),
    ]
    reference = read_run(written(ros, tmp_path, entries), robot()).reference
    assert reference is not None
    np.testing.assert_array_equal(reference.x, [1.0, np.nan])
    np.testing.assert_array_equal(reference.y, [2.0, np.nan])
    np.testing.assert_allclose(reference.yaw, [np.nan, 0.5])


def test_nothing_measured_at_all(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = [("/pose", 2, ros.pose(1 * MS, math.nan, 2.0, math.nan))]
    with pytest.raises(InputError, match="/pose: no message holds a finite pose"):
        read_run(written(ros, tmp_path, entries), robot())


def test_a_gyro_gives_yaw_alone(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Yaw rate 2 t for 1 s is one radian; trapezia are exact for it, at uneven intervals too."""
    stamps = [0, 100, 150, 400, 400, 390, 1000]
    entries = [
        ("/imu", n, ros.imu(10**9 + t * MS, 2e-3 * t)) for n, t in enumerate(stamps, start=2)
    ]
    entries.insert(3, ("/imu", 5, ros.imu(10**9 + 300 * MS, 99.0, known=False)))
    entries.insert(3, ("/imu", 5, ros.imu(10**9 + 300 * MS, math.nan)))
    entries = [(topic, n, message) for n, (topic, _, message) in enumerate(entries, start=2)]
    reference = read_run(written(ros, tmp_path, entries), robot()).reference
    assert reference is not None
    assert np.isnan(reference.x).all()
    assert reference.yaw[0] == 0.0
    assert reference.yaw[3] == pytest.approx(0.16, abs=1e-6)
    assert reference.yaw[4] == reference.yaw[5] == reference.yaw[3], "late stamps turn nothing"
    assert reference.yaw[-1] == pytest.approx(1.0, abs=0.01)


def transforms(ros: Any, *pairs: tuple[str, str]) -> list[Any]:
    return [
        (
            "/tf",
            n,
            ros.transforms(
                *(ros.transform(n * MS, pair, float(k), n, 0.0) for k, pair in enumerate(pairs))
            ),
        )
        for n in (2, 3)
    ]


def test_among_transforms_the_chain_to_the_base_or_the_frame_that_is_named(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    bag = written(ros, tmp_path, transforms(ros, ("map", "odom"), ("/odom", "/base_link")))
    run = read_run(bag, robot())
    assert run.reference is not None
    assert run.reference.x.tolist() == [1.0, 1.0]
    assert run.reference.y.tolist() == [4.0, 6.0]
    assert run.notes[-1] == (
        "reference from /tf (tf2_msgs/msg/TFMessage), map -> odom -> base_link, composed at each "
        "change of map -> odom"
    )
    assert run.circle == ""
    run = read_run(bag, robot(), reference_topic="/tf:base_link")
    assert run.notes[-1] == "reference from /tf (tf2_msgs/msg/TFMessage), odom -> base_link"
    assert run.circle.startswith("/tf:odom:base_link: odom -> base_link is the robot's own odometr")
    assert "independent references in the bag: /tf:map:base_link (poses)" in run.circle
    said = "/tf:odom is where the odometry starts, as a localiser corrects it, and no pose of the"
    with pytest.raises(InputError, match=re.escape(said)) as caught:
        read_run(bag, robot(), reference_topic="/tf:odom")
    assert "--reference-topic /tf:map:base_link" in str(caught.value)
    run = read_run(bag, robot(), reference_topic="/tf:odom", force=True)
    assert run.reference is not None
    assert run.reference.x.tolist() == [0.0, 0.0]
    said = "/tf: name the frames with --reference-topic /tf:PARENT:CHILD; it has: map -> odom, odom"
    with pytest.raises(InputError, match=re.escape(said)):
        read_run(bag, robot(), reference_topic="/tf:tracker")
    said = "/tf: no transforms lead from map to tracker; it has: map -> odom, odom -> base_link"
    with pytest.raises(InputError, match=re.escape(said)):
        read_run(bag, robot(), reference_topic="/tf:map:tracker")


def test_several_candidates_are_listed_and_none_may_be_wished(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    entries = [
        ("/mocap", 2, ros.pose(1 * MS, *POSES[0])),
        ("/odom", 3, ros.odometry(1 * MS, *POSES[1])),
        ("/tf_static", 4, ros.transforms(ros.transform(1, BASE, *POSES[2]))),
    ]
    bag = written(ros, tmp_path, entries)
    run = read_run(bag, robot())
    assert run.notes[-1] == "reference from /mocap (geometry_msgs/msg/PoseStamped), frame map"
    other = written(ros, tmp_path / "two", [*entries, ("/imu", 5, ros.imu(1 * MS, 0.0))])
    with pytest.raises(InputError) as caught:
        read_run(other, robot())
    assert str(caught.value) == (
        f"{other}: choose with --reference-topic (none for no reference); candidates are: /mocap "
        "(geometry_msgs/msg/PoseStamped), /imu (sensor_msgs/msg/Imu); made from the wheels, and so "
        "no reference: /odom"
    )
    assert read_run(bag, robot(), reference_topic="none").reference is None
    run = read_run(bag, robot(), reference_topic="odom")
    assert run.reference is not None
    assert run.reference.x.tolist() == [1.5]
    for wish in ("/laser", "/ticks"):
        with pytest.raises(InputError, match=f"there is no reference in {wish}; candidates are"):
            read_run(bag, robot(), reference_topic=wish)
