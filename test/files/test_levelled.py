# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""References whose frame is not level: y upwards, a camera on a stand, frames with odd names."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.references.levelled import levelled

MS = 10**6
TIME = np.arange(1.0, 9.0, 0.04)
X, Y, YAW = 2.0 * np.cos(TIME), np.sin(1.3 * TIME), 0.8 * TIME
FLOOR = np.stack([X, Y, np.full(TIME.size, 0.1)], axis=1)
ROBOT = Rotation.from_euler("z", YAW[:, None])
Y_UP = Rotation.from_matrix([[0, 1, 0], [0, 0, 1], [1, 0, 0]])


def camera(tilt: float) -> tuple[Any, np.ndarray]:
    """Turn and place of a camera 3 m above the floor that looks down, `tilt` degrees aside."""
    return Rotation.from_euler("zx", [0.3, np.pi + np.radians(tilt)]), np.array([0.0, -2.0, 3.0])


def assert_moves_like_the_robot(x: Any, y: Any, yaw: Any) -> None:
    """Ways and headings seen from the robot itself, whichever frame they are given in."""

    def steps(x: Any, y: Any, yaw: Any) -> Any:
        along = (np.diff(x) + 1j * np.diff(y)) * np.exp(-1j * yaw[:-1])
        return np.angle(along[1:] / along[:-1]), np.abs(along), np.diff(np.unwrap(yaw))

    for found, true in zip(steps(x, y, yaw), steps(X, Y, YAW), strict=True):
        np.testing.assert_allclose(found, true, atol=1e-9)


@pytest.mark.parametrize("tilt", [4.0, 12.0, 35.0, 90.0, 150.0])
def test_poses_are_taken_on_the_plane_in_which_the_robot_moved(tilt: float) -> None:
    """Their x and y would make ways along one direction shorter: a floor with a grain."""
    turn = Rotation.from_euler("xz", [tilt, 20.0], degrees=True)
    found = levelled(turn.apply(FLOOR), (turn * ROBOT).as_quat())
    assert found is not None
    assert_moves_like_the_robot(*found[:3])
    assert f"tilted by {min(tilt, 180 - tilt):.0f}°" in found[3]


def test_level_poses_and_wrong_heights_stay_as_they_are() -> None:
    level = ROBOT.as_quat()
    assert levelled(FLOOR, level) is None
    drifted = FLOOR + np.outer(0.05 * X, [0, 0, 1])  # the robot stands upright all the same
    assert levelled(drifted, level) is None
    bumps = FLOOR + np.outer(0.1 * np.sin(9.0 * TIME), [0, 0, 1])
    assert levelled(bumps, level) is None
    line = np.stack([X, 0.0 * X, 0.1 * X], axis=1)  # along one line its tilt is not known
    assert levelled(line, level) is None


def posed(ros: Any, n: int, where: Any, turn: Any) -> tuple[str, Any]:
    kind, message = ros.pose(round(1e3 * TIME[n]) * MS, 0.0, 0.0, 0.0)
    for part, value in zip("xyz", where, strict=True):
        setattr(message.pose.position, part, float(value))
    for part, value in zip("xyzw", turn.as_quat(), strict=True):
        setattr(message.pose.orientation, part, float(value))
    return kind, message


def moved(ros: Any, n: int | None, frames: tuple[str, str], where: Any, turn: Any) -> Any:
    stamp = 0 if n is None else round(1e3 * TIME[n]) * MS
    kind, message = ros.transform(stamp, frames, 0.0, 0.0, 0.0)
    for part, value in zip("xyz", where, strict=True):
        setattr(message.transform.translation, part, float(value))
    for part, value in zip("xyzw", turn.as_quat(), strict=True):
        setattr(message.transform.rotation, part, float(value))
    return ros.transforms((kind, message))


def test_motion_capture_with_y_upwards_is_read(tmp_path: Path, ros: Any, robot: Any) -> None:
    """A rigid body's axes are those of the room where it was defined: its y is upwards too."""
    entries: list[Any] = [("/ticks", 1, ros.counts(1, 2))]
    for n in range(TIME.size):
        pose = posed(ros, n, Y_UP.apply(FLOOR[n]), Y_UP * ROBOT[n] * Y_UP.inv())
        entries.append(("/optitrack", 10 + n, pose))
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert run.reference is not None
    assert_moves_like_the_robot(run.reference.x, run.reference.y, run.reference.yaw)
    assert "not level" in str(run)


def tags(ros: Any, room: bool) -> list[Any]:
    """A camera on a stand that sees the tag on the robot, and maybe where the camera stands."""
    turn, place = camera(35.0)
    entries: list[Any] = [("/ticks", 1, ros.counts(1, 2))]
    if room:
        stand = moved(ros, None, ("world", "camera"), place, turn)
        entries.append(("/tf_static", 2, stand))
    for n in range(TIME.size):
        tag = turn.inv().apply(FLOOR[n] - place), turn.inv() * ROBOT[n]
        entries.append(("/tf", 10 + n, moved(ros, n, ("camera", "tag36h11:5"), *tag)))
    return entries


@pytest.mark.parametrize("room", [True, False])
def test_a_tag_seen_by_a_camera_on_a_stand_is_a_reference(
    tmp_path: Path, ros: Any, robot: Any, room: bool
) -> None:
    run = read_run(ros.write(tmp_path / "bag", tags(ros, room)), robot())
    assert run.reference is not None
    assert_moves_like_the_robot(run.reference.x, run.reference.y, run.reference.yaw)
    assert run.reference.kind is None, "each view errs by itself, whatever the camera stands on"
    if room:
        np.testing.assert_allclose(run.reference.x, X, atol=1e-9)
        np.testing.assert_allclose(run.reference.y, Y, atol=1e-9)
        assert "world -> camera -> tag36h11:5" in str(run)


@pytest.mark.parametrize("wish", ["/tf:camera:tag36h11:5", "/tf:world:tag36h11:5"])
def test_frames_with_colons_in_their_names_can_be_asked_for(
    tmp_path: Path, ros: Any, robot: Any, wish: str
) -> None:
    run = read_run(ros.write(tmp_path / "bag", tags(ros, room=True)), robot(), reference_topic=wish)
    assert run.reference is not None
    assert_moves_like_the_robot(run.reference.x, run.reference.y, run.reference.yaw)
