# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Scans in bags: read, matched, brought to the robot's base, and cut where they were lost."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.scans.drives import ahead, in_circles
from test.scans.test_floor_strikes import pitched, tilted
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import opened_bag
from werrimbi_odom.files.bags.bag_contents import contents_of
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.comparison.measured_path_figure import path_figure
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.engine import AxlePose, TruePath
from werrimbi_odom.simulation.lidar import Lidar, Room, Sweeps, scanned

EPOCH = 1_700_000_000
LIDAR = Lidar(beams=180, mount=AxlePose(0.15, -0.05, 0.7))
BASE, WHEEL, COUNTS = 0.4, 0.1, 1000.0


@cache
def path() -> TruePath:
    return in_circles(9.0)


@cache
def sweeps(upside_down: bool = False) -> Sweeps:
    return scanned(path(), rooms.arena(3.0), replace(LIDAR, upside_down=upside_down), 1)


def early(seen: Sweeps) -> Sweeps:
    """Its rest and its first bend: for what asks for words, or compares paths alone."""
    kept = seen.time < 6.0
    return Sweeps(seen.time[kept], seen.ranges[kept], seen.truth[kept])


@cache
def ticks() -> list[tuple[float, int, int]]:
    """Times of the messages, and the counts of both wheels; the right one's are half as large."""
    drive = path()
    speed = np.gradient(drive.x_m, drive.t_s) * np.cos(drive.yaw_rad)
    speed += np.gradient(drive.y_m, drive.t_s) * np.sin(drive.yaw_rad)
    rate = np.gradient(drive.yaw_rad, drive.t_s)
    gone, turned = (
        np.append(0.0, np.cumsum(0.5 * (each[1:] + each[:-1]) * np.diff(drive.t_s)))
        for each in (speed, rate)
    )
    left, right = (
        np.round((gone + side * 0.5 * BASE * turned) / (2.0 * np.pi * WHEEL) * COUNTS * k)
        for k, side in ((1, -1.0), (2, 1.0))
    )
    rows = range(0, drive.t_s.size, 4)
    return [(float(drive.t_s[row]), int(left[row]), int(right[row])) for row in rows]


def entries(
    ros: Any, seen: Sweeps, lidar: Lidar = LIDAR, turn: tuple[float, ...] | None = (0.0, 0.0)
) -> list[Any]:
    """Counters at 50 Hz, scans, and how the lidar is mounted: roll and pitch, or nothing."""
    found: list[Any] = []
    if turn is not None:
        found.append(("/tf_static", EPOCH * 10**9, ros.transforms(mounted(ros, lidar, *turn))))
    found += [("/ticks", at(time), ros.counts(*counts)) for time, *counts in ticks()]
    for time, ranges in zip(seen.time, seen.ranges, strict=True):
        found.append(("/scan", at(time), ros.scan(at(time), lidar, ranges)))
    return sorted(found, key=lambda each: each[1])


def at(time: float) -> int:
    return EPOCH * 10**9 + round(1e9 * (time + 1.0))


def mounted(ros: Any, lidar: Lidar, roll: float, pitch: float) -> Any:
    from scipy.spatial.transform import Rotation

    kind, message = ros.transform(0, ("base_link", "laser"), lidar.mount.x, lidar.mount.y, 0.0)
    x, y, z, w = Rotation.from_euler("ZYX", [lidar.mount.yaw, pitch, roll]).as_quat()
    turned = ros.make("geometry_msgs/msg/Quaternion", x, y, z, w)
    return kind, replace(message, transform=replace(message.transform, rotation=turned))


def compared(run: Run) -> tuple[float, float]:
    """Rms distance [m] and angle [rad] of its reference from the true path, begun at its pose."""
    reference, drive = run.reference, path()
    assert reference is not None
    time = reference.time - EPOCH - 1.0
    x, y, yaw = (np.interp(time, drive.t_s, each) for each in (drive.x_m, drive.y_m, drive.yaw_rad))
    place = (x - x[0] + 1j * (y - y[0])) * np.exp(-1j * yaw[0])
    found = reference.x + 1j * reference.y
    apart = found - found[0] - place
    turned = reference.yaw - reference.yaw[0] - (yaw - yaw[0])
    return float(np.sqrt(np.mean(np.abs(apart) ** 2))), float(np.sqrt(np.mean(turned**2)))


def test_scans_give_poses_of_the_base(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "run", entries(ros, sweeps()))
    run = read_run(bag, robot())
    position, heading = compared(run)
    assert position < 5e-3
    assert heading < 3e-3
    assert run.reference is not None
    assert run.reference.sigma_xy is not None
    assert 3e-4 < np.median(run.reference.sigma_xy) < 5e-3
    assert "150 mm ahead of and 50 mm right of it" in " ".join(run.notes)
    with opened_bag(bag) as opened:
        (source,) = contents_of(opened).independent
    assert (source.name, source.measures, source.child) == ("/scan", "poses", "laser")


def test_a_lidar_of_no_times_is_stamped_half_a_turn_before_its_middle(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Its poses were 50 ms early: 8 mm and 20 mrad off in bends, as by a late clock."""
    found = [
        (topic, time, (kind, replace(message, time_increment=0.0) if topic == "/scan" else message))
        for topic, time, (kind, message) in entries(ros, sweeps())
    ]
    position, heading = compared(read_run(ros.write(tmp_path / "run", found), robot()))
    assert position < 5e-3
    assert heading < 3e-3


def test_a_message_that_comes_twice_is_one_scan(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Half of them were said not to be matched."""
    once = entries(ros, early(sweeps()))
    bag = ros.write(tmp_path / "run", sorted([*once, *once[1:]], key=lambda each: each[1]))
    assert "not matched" not in " ".join(read_run(bag, robot()).notes)


@pytest.mark.evidence
def test_a_pose_is_no_surer_along_a_corridor_than_it_is(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Its walls hold it across, and only its cupboards along; one sigma is told for both."""
    lidar = Lidar()
    seen = scanned(ahead(20.0), rooms.corridor_with_cupboards(), lidar, 1)
    bag = ros.write(tmp_path / "run", entries(ros, seen, lidar, None))
    found = read_run(bag, robot()).reference
    assert found is not None
    assert found.sigma_xy is not None
    middle = seen.time + 0.5 * (lidar.beams - 1) * lidar.beam_interval
    truth = np.interp(found.time - EPOCH - 1.0, middle, seen.truth[:, 0])
    variance = np.asarray(found.sigma_xy) ** 2
    nees = np.diff(found.x - truth) ** 2 / (variance[1:] + variance[:-1])
    assert 0.7 < nees[np.diff(found.time) < 0.15].mean() < 1.3


def test_a_lidar_that_hangs_upside_down(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "run", entries(ros, early(sweeps(True)), turn=(np.pi, 0.0)))
    run = read_run(bag, robot())
    assert max(compared(run)) < 5e-3
    assert "upside down" in " ".join(run.notes)


def test_without_transforms_it_is_the_path_of_the_lidar(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Read alike from every kind of bag."""
    held = entries(ros, early(sweeps()), turn=None)
    runs = [
        read_run(bag, robot())
        for bag in (
            ros.write(tmp_path / "a", held),
            ros.write(tmp_path / "b", held, "sqlite3"),
            ros.write_ros1(tmp_path / "c.bag", held),
        )
    ]
    poses = [np.column_stack([r.time, r.x, r.y, r.yaw]) for run in runs if (r := run.reference)]
    assert len(poses) == 3
    assert np.ptp(poses, axis=0).max() == 0.0
    assert compared(runs[0])[0] > 0.05
    assert compared(runs[0])[1] < 3e-3
    assert "no transform says where the lidar sits" in " ".join(runs[0].notes)


def test_a_lidar_that_is_tilted_is_refused(tmp_path: Path, ros: Any, robot: Any) -> None:
    bag = ros.write(tmp_path / "run", entries(ros, early(sweeps()), turn=(0.0, 0.5)))
    with pytest.raises(InputError, match="the lidar is tilted by 29°: its scans are no plan"):
        read_run(bag, robot())


def test_of_a_lidar_that_is_a_little_tilted_it_is_said_what_it_may_see(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    bag = ros.write(tmp_path / "run", entries(ros, early(sweeps()), turn=(0.0, 0.05)))
    told = " ".join(read_run(bag, robot()).notes)
    assert "tilted by 2.9°: where it looks down, the floor may look like a wall that goes" in told


def test_a_floor_that_it_sees_is_told_and_left_out(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Of a lidar that no transform tilts."""
    whole = scanned(path(), rooms.arena(7.0), LIDAR, 1)
    seen, share = pitched(early(whole), tilted(4.0), aside=-0.7)
    (told,) = read_run(ros.write(tmp_path / "run", entries(ros, seen)), robot()).damage
    echoes = np.isfinite(seen.ranges).mean()
    assert f"{100 * share / echoes:.0f} % of the echoes stay on a straight line" in told
    assert "2.4 m away at -40° in its scans" in told
    assert "0.2 m above the floor and tilted by 4.7°" in told
    assert "They are left out" in told


def test_of_a_lidar_that_stands_it_is_said_what_else_it_may_be(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Straight along a bare corridor, by the floor alone."""
    lidar = Lidar(beams=160, rate_hz=5.0, lost=0.0)
    drive = replace(ahead(9.0), y_m=0.0 * ahead(9.0).t_s, yaw_rad=0.0 * ahead(9.0).t_s)
    seen, _ = pitched(scanned(drive, rooms.corridor(), lidar, 0), tilted(5.0))
    (told,) = read_run(ros.write(tmp_path / "run", entries(ros, seen, lidar)), robot()).damage
    assert "the lidar stands wherever they are matched. If it was driven" in told


@pytest.mark.parametrize("ranges", [np.inf, np.nan, 0.0, 0.1])
def test_without_an_echo_it_says_so(ranges: float, tmp_path: Path, ros: Any, robot: Any) -> None:
    """All infinite, or all nearer than the lidar measures: a wall at 10 cm, a box over it."""
    nothing = replace(sweeps(), ranges=np.full_like(sweeps().ranges, ranges))
    bag = ros.write(tmp_path / "run", entries(ros, nothing))
    with pytest.raises(InputError, match=r"none of 89 scans holds an echo between 0\.12 and 8 m"):
        read_run(bag, robot())


@pytest.mark.parametrize(
    ("names", "times", "said"),
    [
        (
            ("angle_min", "angle_max", "angle_increment"),
            180.0 / np.pi,
            r"around by 360 rad: .* in ",
        ),
        (("ranges", "range_min", "range_max"), 1000.0, "they are in millimetres, and must be in"),
    ],
)
def test_other_units_of_a_scan_are_told(
    names: tuple[str, ...], times: float, said: str, tmp_path: Path, ros: Any, robot: Any
) -> None:
    """Too little was said to be within its reach, and more walls to be asked for."""
    held = entries(ros, early(sweeps()))
    for topic, _, (_, scan) in held:
        for name in names if topic == "/scan" else ():
            setattr(scan, name, getattr(scan, name) * times)
    with pytest.raises(InputError, match=said):
        read_run(ros.write(tmp_path / "run", held), robot())


def test_in_an_empty_hall_it_says_so(tmp_path: Path, ros: Any, robot: Any) -> None:
    """A few chairs are within its reach."""
    hall = Room(np.concatenate([rooms.box(x, 4.0, x + 0.1, 4.1) for x in (-1.0, 0.0, 1.0)]))
    bag = ros.write(tmp_path / "run", entries(ros, scanned(path(), hall, LIDAR, 1)))
    with pytest.raises(
        InputError, match=r"do not hold where the robot was.*within the lidar's reach"
    ):
        read_run(bag, robot())


def test_in_a_hall_beyond_its_reach_it_says_so(tmp_path: Path, ros: Any, robot: Any) -> None:
    hall = Room(rooms.box(-60.0, -60.0, 60.0, 60.0))
    bag = ros.write(tmp_path / "run", entries(ros, scanned(path(), hall, LIDAR, 1)))
    with pytest.raises(InputError, match="in a hall with all walls farther away"):
        read_run(bag, robot())


def test_before_a_wall_at_10_cm_it_says_so(tmp_path: Path, ros: Any, robot: Any) -> None:
    """One that the lidar still measures."""
    near = replace(LIDAR, nearest=0.05)
    off = np.angle(np.exp(1j * near.increment * np.arange(near.beams)))
    wall = np.where(np.abs(off) < 1.2, 0.1 / np.cos(np.clip(off, -1.2, 1.2)), np.inf)
    noise = np.random.default_rng(0).normal(0.0, 2e-3, sweeps().ranges.shape)
    bag = ros.write(tmp_path / "run", entries(ros, replace(sweeps(), ranges=wall + noise), near))
    with pytest.raises(InputError, match="leaves a direction free, as a bare corridor does"):
        read_run(bag, robot())


def test_along_a_bare_corridor_it_says_so(tmp_path: Path, ros: Any, robot: Any) -> None:
    walls = Room(rooms.corridor().walls * np.array([5.0, 1.0, 5.0, 1.0]))
    bag = ros.write(tmp_path / "run", entries(ros, scanned(path(), walls, LIDAR, 1)))
    with pytest.raises(InputError, match="leaves a direction free, as a bare corridor does"):
        read_run(bag, robot())


@pytest.mark.parametrize("step", [0.0, np.nan])
def test_scans_whose_beams_all_point_one_way_are_told_so(
    step: float, tmp_path: Path, ros: Any, robot: Any
) -> None:
    """They were said to have been driven along a bare corridor."""
    bag = ros.write(
        tmp_path / "run",
        [
            (topic, time, (kind, replace(scan, angle_increment=step) if topic == "/scan" else scan))
            for topic, time, (kind, scan) in entries(ros, sweeps())
        ],
    )
    with pytest.raises(InputError, match="do not say where their beams point: angle_increment"):
        read_run(bag, robot())


def test_a_leg_never_spans_a_cut(tmp_path: Path, ros: Any, robot: Any) -> None:
    """The recorder lost the scans of more than a second, as the robot drove."""
    seen, kept = sweeps(), (sweeps().time < 5.0) | (sweeps().time > 6.3)
    seen = Sweeps(seen.time[kept], seen.ranges[kept], seen.truth[kept])
    run = read_run(ros.write(tmp_path / "run", entries(ros, seen)), robot())
    assert len(run.taken_out) == 1
    begin, end = run.taken_out[0]
    (words,) = run.damage
    assert "the path by /scan is in pieces" in words
    assert "no leg spans a cut" in words
    assert run.reference is not None
    known = float(np.ptp(run.reference.time)) - (end - begin)
    assert f"the path is known for {known:.1f} s in all" in words
    cut = match(run, Robot(BASE, WHEEL, WHEEL, COUNTS, 2.0 * COUNTS), leg=0.1)
    spans = (cut.measured.time[:-1] <= begin) & (cut.measured.time[1:] >= end)
    assert spans.sum() == 1
    assert cut.gap[spans].all()
    compared = compare([run], Robot(BASE, WHEEL, WHEEL, COUNTS, 2.0 * COUNTS))
    assert np.isnan(compared.runs[0].end_error_m), "axes begin anew after the cut"
    assert np.isnan(compared.runs[0].end_error_rad)
    measured = next(trace for trace in path_figure(compared).data if trace.name == "measured")
    assert np.isnan(np.asarray(measured.x, dtype=float)).sum() == 1, "drawn in two pieces"


@pytest.mark.evidence
def test_a_gyros_headings_are_laid_upon_each_piece(tmp_path: Path, ros: Any, robot: Any) -> None:
    """The scans of 2 s are missing; the gyro drifts by 3 degrees a second all the time."""
    seen, kept = sweeps(), (sweeps().time < 4.0) | (sweeps().time > 6.0)
    held = entries(ros, Sweeps(seen.time[kept], seen.ranges[kept], seen.truth[kept]))
    rate = 0.05 + np.gradient(path().yaw_rad, path().t_s)
    held += [
        ("/imu", at(t), ros.imu(at(t), turning))
        for t, turning in zip(path().t_s[::2].tolist(), rate[::2].tolist(), strict=True)
    ]
    bag = ros.write(tmp_path / "run", sorted(held, key=lambda each: each[1]))
    run = read_run(bag, robot(), reference_topic=("/scan", "/imu"))
    assert len(run.taken_out) == 1
    assert "in pieces" in run.damage[0]
    assert "in each of its 2 pieces by itself" in run.notes[-1]
    assert run.reference is not None
    time = run.reference.time - EPOCH - 1.0
    apart = run.reference.yaw - np.interp(time, path().t_s, path().yaw_rad)
    for piece in (time < 5.0, time > 5.0):
        assert piece.sum() > 20
        assert np.ptp(np.unwrap(apart[piece])) < 4e-3  # the gyro's; the scans' alone scatter more
    both = read_run(bag, robot(), reference_topic="/scan").reference
    assert both is not None
    np.testing.assert_array_equal(both.x, run.reference.x)


@pytest.mark.evidence
def test_scans_are_taken_where_they_are_asked_for(tmp_path: Path, ros: Any, robot: Any) -> None:
    """A bag with a gyro is read as ever; who wants the scans says so."""
    held = entries(ros, sweeps())
    held += [("/imu", at(t), ros.imu(at(t), 0.1)) for t in np.arange(0.0, 9.0, 0.05)]
    bag = ros.write(tmp_path / "run", sorted(held, key=lambda each: each[1]))
    gyro = read_run(bag, robot()).reference
    assert gyro is not None
    assert not gyro.has_position.any()
    assert compared(read_run(bag, robot(), reference_topic="/scan"))[0] < 5e-3


def test_a_cloud_of_points_is_no_scan(tmp_path: Path, ros: Any, robot: Any) -> None:
    kind = "sensor_msgs/msg/PointCloud2"
    none = np.zeros(0, dtype=np.uint8)
    cloud = ros.make(kind, ros.header(1), 1, 0, [], False, 16, 0, none, True)
    bag = ros.write(
        tmp_path / "run", [("/ticks", 1, ros.counts(1, 2)), ("/points", 2, (kind, cloud))]
    )
    with pytest.raises(InputError, match=r"clouds of points; .* pointcloud_to_laserscan"):
        read_run(bag, robot(), reference_topic="/points")
