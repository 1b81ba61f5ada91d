# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference in a recording of its own; and two references of one drive as one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.recordings import Asked, DriveOptions, read
from werrimbi_odom.files.references.merged_reference import merged, with_one_scale
from werrimbi_odom.files.run import Reference

MS = 10**6
WHEELS = ["left_wheel_joint", "right_wheel_joint"]
TIME = np.arange(0.0, 60.0, 0.2)
YAW = 4.0 * np.sin(0.3 * TIME) + 0.2 * TIME
NONE = np.full(TIME.size, np.nan)


def localiser(noise: float = 0.02) -> Reference:
    """Poses whose headings are rough, and jump by 0.3 rad for a while."""
    rng = np.random.default_rng(4)
    yaw = YAW + rng.normal(0.0, noise, TIME.size)
    yaw[100:110] += 0.3
    return Reference(TIME, np.cos(TIME), np.sin(TIME), np.angle(np.exp(1j * yaw)))


def gyro(scale: float = 1.0) -> Reference:
    """Headings at 50 Hz that begin at zero and drift by 0.01 rad/s."""
    time = np.arange(-1.0, 61.0, 0.02)
    yaw = scale * (4.0 * np.sin(0.3 * time) + 0.2 * time) + 0.01 * time
    return Reference(time, *(np.full(time.size, np.nan),) * 2, yaw - yaw[0])


def test_a_gyros_headings_are_laid_upon_a_localisers() -> None:
    for both in ((localiser(), gyro()), (gyro(), localiser())):
        found, told = merged("bag", *both)
        np.testing.assert_array_equal(found.x, localiser().x)
        assert np.abs(found.yaw - found.yaw[0] - (YAW - YAW[0])).max() < 0.01
        assert np.abs(np.diff(found.yaw - YAW)).max() < 1e-3, "its own noise, not the localiser's"
        assert "steady drift of" in told
        assert "+34" in told or "-34" in told, "0.01 rad/s are 34 degrees a minute"
        assert with_one_scale([found], [found]) == [found], "its scale is right"


@pytest.mark.parametrize("late", [0.1, -0.04])
def test_a_gyro_is_put_on_the_clock_of_scans(late: float) -> None:
    """Their headings are of the instant of their places; a localiser's may be of another one."""
    rng = np.random.default_rng(5)
    turned = 4.0 * np.sin(0.3 * (TIME - late)) + 0.2 * (TIME - late)
    seen = turned + rng.normal(0.0, 2e-3, TIME.size)
    scans = replace(localiser(), yaw=np.angle(np.exp(1j * seen)), own_axes=True)
    found, told = merged("bag", scans, gyro())
    off = found.yaw - turned
    assert np.abs(off - off.mean())[1:-1].max() < 2e-3
    assert f"{1e3 * abs(late):.0f} ms {'before' if late > 0.0 else 'after'} it does" in told
    found, told = merged("bag", replace(scans, own_axes=False), gyro())
    off = found.yaw - turned
    assert np.abs(off - off.mean()).max() > 0.5 * abs(late)
    assert "ms" not in told


def test_a_gyro_that_shows_too_little_of_a_turn_is_mended_by_the_localiser() -> None:
    found, _ = merged("bag", localiser(0.005), gyro(0.98))
    (mended,) = with_one_scale([found], [found])
    assert np.abs(found.yaw - found.yaw[0] - (YAW - YAW[0])).max() > 0.1
    assert np.abs(mended.yaw - mended.yaw[0] - (YAW - YAW[0])).max() < 0.01


def test_a_gyros_scale_is_no_drift_in_a_drive_that_turns_to_one_side() -> None:
    """Nor an angle: both were fitted without it, and it was put right afterwards."""
    turned = np.cumsum(np.where((TIME > 5.0) & (TIME < 14.0), -0.4, 0.1 * np.cos(0.4 * TIME)))
    rng = np.random.default_rng(7)
    scans = replace(localiser(), yaw=turned + rng.normal(0.0, 1e-3, TIME.size))
    shows = Reference(TIME, NONE, NONE, 0.99 * turned + 1e-3 * TIME)
    found, told = merged("bag", scans, shows)
    (mended,) = with_one_scale([found], [found])
    off = np.angle(np.exp(1j * (mended.yaw - turned)))
    assert abs(np.mean(off)) < 3e-4
    assert np.abs(off).max() < 2e-3
    drift = float(told.split("steady drift of ")[1].split("°")[0])
    assert drift == pytest.approx(-np.degrees(60.0 * 1e-3 / 0.99), abs=0.4)


def test_what_cannot_be_put_together_is_said() -> None:
    with pytest.raises(InputError, match="both hold positions"):
        merged("bag", localiser(), localiser())
    with pytest.raises(InputError, match="neither holds positions"):
        merged("bag", gyro(), gyro())
    late = Reference(gyro().time + 1.7e9, gyro().x, gyro().y, gyro().yaw)
    with pytest.raises(InputError, match=r"t_s 0 to 59\.8 and t_s 1699999999 to 170000006"):
        merged("bag", localiser(), late)


def wheels(ros: Any) -> list[Any]:
    return [
        ("/joint_states", n * MS, ros.joints(n * MS, WHEELS, [0.01 * n, 0.01 * n]))
        for n in range(100, 3000, 100)
    ]


def poses(ros: Any, begin: int = 0) -> list[Any]:
    return [
        ("/mocap", n * MS, ros.pose(n * MS, 1e-3 * n, 0.0, 0.2))
        for n in range(begin + 100, begin + 3000, 50)
    ]


def test_two_topics_of_a_bag(tmp_path: Path, ros: Any, robot: Any) -> None:
    gyros = [("/imu", n * MS, ros.imu(n * MS, 0.5)) for n in range(90, 3100, 10)]
    bag = ros.write(tmp_path / "bag", [*wheels(ros), *poses(ros), *gyros])
    run = read_run(bag, robot(), reference_topic=("/mocap", "/imu"))
    assert run.reference is not None
    assert run.reference.x.size == 58
    np.testing.assert_allclose(run.reference.yaw, 0.2, atol=1e-6)  # 0.5 rad/s is all drift
    assert "headings are those of the one without positions" in run.notes[-1]
    with pytest.raises(InputError, match="3 references were asked for; two at most"):
        read_run(bag, robot(), reference_topic=("/mocap", "/imu", "/mocap"))


def test_a_reference_in_a_recording_of_its_own(tmp_path: Path, ros: Any, robot: Any) -> None:
    drive = ros.write(tmp_path / "drive", wheels(ros))
    room = ros.write(tmp_path / "room", poses(ros), "sqlite3")
    folder = tmp_path / "by_tape"
    folder.mkdir()
    (folder / "reference.csv").write_text("t_s,x_m,y_m,yaw_rad\n0.1,0,0,0\n2.9,2,0,\n3.5,2")
    run = read_run(drive, robot(), reference=room)
    assert run.ticks.rows == 29
    assert run.reference is not None
    assert run.reference.x.size == 58
    assert run.notes[1:] == (
        f"reference from {room}",
        "reference from /mocap (geometry_msgs/msg/PoseStamped), frame map",
    )
    tape = read_run(drive, robot(), reference=folder)
    assert tape.reference is not None
    assert tape.reference.x.tolist() == [0.0, 2.0]
    told = f"{folder}: reference.csv, line 4: cut off in mid-row; read up to there"
    assert tape.damage == (told,)
    with pytest.raises(InputError, match="there is no reference in it"):
        read_run(drive, robot(), reference=drive)
    with pytest.raises(InputError, match="there is no such run"):
        read_run(drive, robot(), reference=tmp_path / "nowhere")


def test_one_for_each_run_and_clocks_that_are_apart(tmp_path: Path, ros: Any, robot: Any) -> None:
    source = robot()
    from werrimbi_odom.effects.lookup import all_effects

    drive = ros.write(tmp_path / "drive", wheels(ros))
    room = ros.write(tmp_path / "room", poses(ros, begin=1_700_000_000_000))
    how = DriveOptions(references=(room,))
    with pytest.raises(InputError, match="1 times --reference for 2 runs: give it once for each"):
        read(Asked(source.path, (drive,), (drive,), how), all_effects(()))
    with pytest.raises(InputError) as caught:
        read(Asked(source.path, (drive,), (), how), all_effects(()))
    assert "t_s 1700000000.1 to 1700000002.95" in str(caught.value)
    assert "the ticks (0.1 to 2.9)" in str(caught.value)
