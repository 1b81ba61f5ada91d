# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses by scans against the truth of simulated drives: how far off, how sure, and when none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from test.evidence import in_evidence
from test.scans.drives import (
    Matched,
    ahead,
    brisk,
    hops,
    in_circles,
    matched,
    of_sweeps,
    rms,
    seen,
    to_and_fro,
)
from test.scans.pitching import before_stairs_up, corridor_to_stairs
from werrimbi_odom.scans.sweep import sweep_of
from werrimbi_odom.scans.three_pass_odometry import ScanMatcher
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.engine import PERIOD, AxlePose, TruePath
from werrimbi_odom.simulation.lidar import Lidar, Room, scanned


@pytest.mark.parametrize("beams", [218, in_evidence(681)])
def test_a_metre_in_a_room(beams: int) -> None:
    lidar = Lidar(beams=beams) if beams == 218 else Lidar(beams=beams, noise=0.01, noise_share=0.0)
    found = matched(in_circles(25.0), rooms.living_room(people=beams == 218), lidar)
    assert set(found.path.piece) == {found.path.piece[0]}
    assert found.path.time.size > 0.97 * found.path.scans
    position, heading = rms(found.legs()[0])
    assert position < 2.5
    assert heading < 2.5
    _, nees = found.steps()
    assert 0.8 < nees.mean() < 1.5


@pytest.mark.evidence
def test_what_all_echoes_of_a_scan_err_together_is_read_off_the_drive() -> None:
    """A lidar whose turns begin at an angle that jitters by 4 mrad: no match can see it.

    A minute: of 20 s it is told to a fifth only.
    """
    _, given = seen(in_circles(60.0), rooms.living_room(), Lidar())
    rng = np.random.default_rng(3)
    matcher = ScanMatcher()
    for sweep in given:
        angle = 4e-3 * rng.standard_normal()
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        matcher.take(replace(sweep, points=sweep.points @ turn))
    found = matcher.path()
    assert found.common[1] == pytest.approx(4e-3, rel=0.25)
    assert np.sqrt(np.median(found.covariances[:, 2, 2])) > 3e-3


@pytest.mark.evidence
def test_starts_and_stops_are_no_noise_of_the_lidar() -> None:
    """Its course has corners then; taken for noise they made poses half as sure as they are."""
    found = matched(hops(16.0), rooms.living_room(), Lidar())
    assert found.path.common == (1.0, 0.0)
    assert 0.7 < found.steps()[1].mean() < 1.5


@pytest.mark.evidence
def test_walls_that_are_no_lines_leave_poses_as_sure_as_they_say() -> None:
    """Vertices every 6 cm, 4 mm beside the wall, and a fine lidar.

    With what a drive's scatter told for all directions alike, the squared errors of steps were 0.67
    of what was stated.
    """
    rng = np.random.default_rng(0)
    parts = []
    for x, y, to_x, to_y in rooms.arena().walls:
        pieces = max(1, round(np.hypot(to_x - x, to_y - y) / 0.06))
        corners = np.linspace((x, y), (to_x, to_y), pieces + 1)
        corners[1:-1] += 4e-3 * rng.standard_normal((pieces - 1, 2))
        parts.append(np.hstack([corners[:-1], corners[1:]]))
    fine = Lidar(noise=2e-3, noise_share=2e-3)
    found = matched(in_circles(30.0, 0.12), Room(np.vstack(parts)), fine)
    assert 0.8 < found.steps()[1].mean() < 1.2


@pytest.mark.parametrize(
    "written",
    [
        *(in_evidence(each) for each in (np.inf, np.nan, 0.0, -1.0)),
        4.0,
        3.95,
        in_evidence(5.0),
    ],
)
def test_whatever_is_written_for_beams_without_an_echo_they_have_none(written: float) -> None:
    """A fifth of the beams. At the lidar's own range they were a wall that goes with the robot.

    Legs erred by 16 mm, with a NEES of 15, and by half a metre in a larger room.
    """
    lidar = Lidar(farthest=4.0 if written != 3.95 else 3.9)
    room = Room(1.2 * rooms.living_room().walls)
    sweeps = scanned(in_circles(14.0), room, lidar, seed=3)
    none = ~np.isfinite(sweeps.ranges)
    assert 0.1 < none.mean() < 0.3
    ranges = np.where(none, written, sweeps.ranges)
    found = of_sweeps(replace(sweeps, ranges=ranges), replace(lidar, farthest=4.0))
    errors, nees = found.legs()
    assert rms(errors)[0] < 4.0
    assert nees.mean() < 1.6


def turning_hard(path: TruePath, time: np.ndarray) -> np.ndarray:
    """Steps between poses in which the rate of turning changes by more than 3 rad/s^2."""
    hard = np.abs(np.gradient(np.gradient(path.yaw_rad, path.t_s), path.t_s)) > 3.0
    begin = time[:-1] - 0.05
    changing = np.interp(begin + 0.2, path.t_s, np.cumsum(hard))
    changing -= np.interp(begin, path.t_s, np.cumsum(hard))
    return changing > 0.0


@pytest.mark.evidence
def test_a_brisk_robot_is_as_sure_as_it_says() -> None:
    """Starts of up to 6 rad/s^2 have no course that is smooth for longer than half a second."""
    path = brisk(30.0, seed=4)
    found = matched(path, rooms.around(path.x_m, path.y_m, 4), Lidar(), seed=4)
    assert 0.8 < found.steps()[1][turning_hard(path, found.path.time)].mean() < 1.5
    assert 0.8 < found.legs(0.25)[1].mean() < 1.25


@pytest.mark.evidence
def test_where_turning_begins_and_ends_a_scan_is_deskewed_by_its_own_course() -> None:
    """With a parabola through five poses steps erred by more than stated (NEES 1.5 and more)."""
    path = brisk(30.0, seed=9)
    found = matched(path, rooms.around(path.x_m, path.y_m, 9), Lidar(), seed=9)
    assert np.mean(found.steps()[1][turning_hard(path, found.path.time)]) < 1.35


@pytest.mark.evidence
def test_in_turning_poses_are_not_ahead_of_the_truth() -> None:
    """Where the first pass deskewed by the motion before alone, by 0.45 ms over three scans."""
    clean = Lidar(noise=0.0, noise_share=0.0, lost=0.0)
    errors, faster = [], []
    for seed in (20, 21):
        path = brisk(20.0, seed=seed)
        found = matched(path, rooms.around(path.x_m, path.y_m, seed), clean, seed=seed)
        assert np.ptp(found.path.piece) == 0
        rate = np.interp(found.path.time, path.t_s, np.gradient(path.yaw_rad, path.t_s))
        error = np.unwrap(found.path.poses[:, 2] - found.truth[:, 2])
        errors.append(error[3:] - error[:-3])
        faster.append(rate[3:] - rate[:-3])
    (ahead,), *_ = np.linalg.lstsq(np.concatenate(faster)[:, None], np.concatenate(errors))
    assert abs(ahead) < 0.15e-3


@pytest.mark.evidence
def test_far_walls_with_cupboards_before_them_do_not_let_the_path_walk() -> None:
    """Elements of 1.2 m took in wall and cupboard: 5.5 mm in 2 m, in place of 3.6 mm."""
    path = brisk(30.0, seed=6)
    found = matched(path, rooms.around(path.x_m, path.y_m, 6, margin=2.0), Lidar(), seed=6)
    position, heading = rms(found.legs(2.0)[0])
    assert position < 4.5
    assert heading < 1.1


@pytest.mark.evidence
def test_cupboards_edges_do_not_pull_the_map() -> None:
    """Their elements take in both sides. Counted as all others: 1.9 mm in 5 m, in place of 1.0."""
    fine = Lidar(noise=3e-3, noise_share=2e-3)
    found = matched(in_circles(30.0), rooms.living_room(), fine, seed=7)
    assert rms(found.legs(5.0)[0])[0] < 1.4


@pytest.mark.evidence
def test_cupboards_hold_the_robot_along_a_corridor() -> None:
    """By the ratio to the direction across, a limit of 0.03 rejected 12 matches of 299."""
    found = matched(ahead(30.0), rooms.corridor_with_cupboards(seed=5), Lidar(), seed=5)
    assert found.path.time.size == found.path.scans
    assert rms(found.legs(3.0)[0])[0] < 6.0


def along(found: Matched, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Errors along the path of legs of a length [m], and their variances with the map's walk."""
    errors, covariances, walked = found.stated_legs(length)
    return errors[:, 0], covariances[:, 0, 0] + walked[:, 0]


def test_along_a_corridor_poses_are_as_sure_as_they_say() -> None:
    """Few echoes tell the way, and the map soon knows none of the start: NEES of 2 m was 2."""
    found = matched(ahead(32.0), rooms.corridor_with_cupboards(seed=21), Lidar(), seed=21)
    error, variance = along(found, 2.0)
    assert abs(error.mean()) < 2e-3  # elements of edges made the path longer by 2.6 mm
    assert 0.6 < np.mean(np.square(error) / variance) < 1.5


@pytest.mark.evidence
def test_a_robot_that_turns_while_the_lidar_turns_is_deskewed() -> None:
    """Lines of a room are bent by 0.1 rad a turn; without deskewing legs are 9 to 17 mrad off."""
    turning = matched(in_circles(15.0), rooms.living_room(), Lidar())
    still = matched(in_circles(15.0), rooms.living_room(), Lidar(rotates=False))
    for one, other in zip(rms(turning.legs()[0]), rms(still.legs()[0]), strict=True):
        assert one < 1.4 * other + 0.2
    assert abs(turning.legs()[0][:, 2].mean()) < 1e-3


@pytest.mark.parametrize(
    ("room", "why"),
    [
        (rooms.corridor(), "weak"),
        (Room(rooms.box(-60.0, -60.0, 60.0, 60.0)), "few"),  # an empty hall
        (Room(rooms.box(-0.08, -0.08, 0.08, 0.08)), "few"),  # nearer than the lidar sees
        (Room(np.array([[1.0, -50.0, 1.0, 50.0]])), "weak"),  # one wall
        (Room(np.zeros((0, 4))), "few"),
    ],
    ids=["bare corridor", "empty hall", "walls at 8 cm", "one wall", "all infinite"],
)
def test_where_scans_do_not_hold_the_robot_there_are_no_poses(room: Room, why: str) -> None:
    found = matched(ahead(10.0, speed=0.0 if len(room.walls) == 4 else 0.3), room, Lidar())
    assert found.path.time.size == 0
    assert max(found.path.flags, key=lambda each: found.path.flags[each]) == why


@pytest.mark.evidence
@pytest.mark.parametrize("beams", [360, in_evidence(720)])
def test_a_lidar_of_poor_ranges_and_close_beams_sees_lines_too(beams: int) -> None:
    """As a TurtleBot3's LDS-01. A line between three beams to each side would be noise alone."""
    lidar = Lidar(rate_hz=5.0, beams=beams, noise=0.015, noise_share=0.01)
    found = matched(in_circles(20.0), rooms.living_room(), lidar)
    assert found.path.time.size == found.path.scans
    errors, nees = found.legs()
    assert rms(errors)[0] < 5.0
    assert nees.mean() < 1.5


@pytest.mark.parametrize(("rate", "seed"), [(5.0, 0), in_evidence(10.0, 1)])
def test_dents_that_go_with_the_lidar_do_not_hold_it_along_a_corridor(
    rate: float, seed: int
) -> None:
    """Its ranges err by 3.5 mm, at each angle by its own, as a real Neato's; they scatter by 1 mm.

    Bare walls then have dents, which go with it: it seemed to stand, 26 mm in place of 1.15 m. The
    end wall comes into sight on the way, and nothing is seen for a while in the middle.
    """
    lidar = Lidar(rate_hz=rate, noise=1e-3, noise_share=1e-3)
    room = Room(np.vstack([rooms.corridor().walls, [[11.0, -1.0, 11.0, 1.0]]]))
    sweeps = scanned(ahead(32.0), room, lidar, seed)
    rng = np.random.default_rng(seed + 1)
    dents = gaussian_filter1d(rng.standard_normal(lidar.beams), 3.0, mode="wrap")
    ranges = sweeps.ranges + 3.5e-3 * dents / dents.std()
    ranges[(sweeps.time > 25.0) & (sweeps.time < 27.5)] = np.nan
    found = of_sweeps(replace(sweeps, ranges=ranges), lidar)
    assert found.path.time[-1] > 31.0
    assert np.abs(found.legs(0.5)[0][:, 0]).max() < 0.02


@pytest.mark.parametrize(("every", "seed"), [(1.0, 0), in_evidence(4.0, 1)])
def test_before_stairs_alone_a_path_is_cut_where_another_step_is_seen(
    every: float, seed: int
) -> None:
    """A pitch of 1.5 degrees. Matches took the next riser: single poses leapt by up to 0.3 m."""
    path = to_and_fro(18.0 if seed == 0 else 50.0)
    sweeps = before_stairs_up(path, corridor_to_stairs(), Lidar(), seed, every)
    found = of_sweeps(sweeps, Lidar())
    assert found.path.time.size > 0.1 * found.path.scans
    errors, nees = found.legs(0.5)
    assert np.abs(errors[:, 0]).max() < 0.1  # a third of a step
    assert nees.mean() < 2.0


def test_a_path_is_cut_where_the_robot_is_carried_and_never_bridged() -> None:
    """Carried away by 3 m and turned by half a turn, in a second: two pieces, both good."""
    path = in_circles(24.0)
    gone = path.t_s > 12.0
    x, y, yaw = path.x_m.copy(), path.y_m.copy(), path.yaw_rad.copy()
    x[gone], y[gone], yaw[gone] = -x[gone] * 0.5, 1.0 - y[gone], yaw[gone] + np.pi
    carried = TruePath(path.t_s, x, y, yaw, path.left_angle_rad, path.right_angle_rad)
    found = matched(carried, rooms.living_room(), Lidar())
    assert len(found.path.cuts) == 1
    begin, end = found.path.cuts[0]
    assert begin - 0.1 < 12.0 < end
    position, heading = rms(found.legs()[0])
    assert position < 3.0
    assert heading < 2.5


@pytest.mark.evidence
def test_a_door_that_opens_and_a_pane_of_glass_cost_little() -> None:
    """2 m of a wall are a door that opens, or a pane that three beams of ten see."""
    lidar, path, glass = Lidar(), in_circles(12.0), rooms.living_room_with_glass()
    opened, closed = Room(glass.walls), Room(np.vstack([glass.walls, glass.panes]))
    (shut, _), (through, _), (pane, _) = (
        seen(path, room, lidar) for room in (closed, opened, glass)
    )
    ranges = np.where(shut.time[:, None] < 6.0, shut.ranges, through.ranges)
    for sweeps in (replace(shut, ranges=ranges), pane):
        found = of_sweeps(sweeps, lidar)
        assert found.path.cuts == []
        assert found.path.time.size > 0.95 * found.path.scans
        position, heading = rms(found.legs()[0])
        assert position < 3.0
        assert heading < 2.5


def test_a_hole_in_the_stamps_is_a_cut() -> None:
    _, given = seen(in_circles(12.0), rooms.living_room(), Lidar())
    matcher = ScanMatcher()
    for sweep in given:
        if not 5.0 < sweep.time < 8.0:
            matcher.take(sweep)
    assert len(matcher.path().cuts) == 1


def test_scans_of_varying_beams_and_stamps_that_go_back() -> None:
    """Some lidars send another number of beams each turn; a scan that came before is left out."""
    lidar = Lidar()
    sweeps, _ = seen(in_circles(6.0), rooms.living_room(), lidar)
    matcher = ScanMatcher()
    for row, (time, ranges) in enumerate(zip(sweeps.time, sweeps.ranges, strict=True)):
        kept = lidar.beams - row % 9
        angles = lidar.increment * np.arange(kept)
        matcher.take(sweep_of(time, ranges[:kept], angles, lidar.beam_interval, 0.12, 8.0))
        if row == 40:
            matcher.take(
                sweep_of(time - 1.0, ranges[:kept], angles, lidar.beam_interval, 0.12, 8.0)
            )
    found = matcher.path()
    assert found.time.size > 0.95 * found.scans
    assert (np.diff(found.time) > 0.0).all()


@pytest.mark.evidence
def test_where_it_spins_the_lidars_arc_tells_how_far_behind_it_sits() -> None:
    """A radian on the spot, as a TurtleBot3 turned; its lidar's turns begin anywhere (4 mrad)."""
    t = np.arange(0.0, 9.0, PERIOD)
    yaw, still = -0.215 * np.clip(t - 3.0, 0.0, 5.0), np.zeros(t.size)
    lidar = Lidar(mount=AxlePose(-0.032, 0.0, 0.0))
    levers = []
    for seed in range(5):
        rng = np.random.default_rng(seed)
        x, y, heading = rng.uniform([-1.5, -1.0, -3.0], [1.5, 1.0, 3.0])
        path = TruePath(t, x + still, y + still, heading + yaw, still, still)
        matcher = ScanMatcher()
        for sweep in seen(path, rooms.living_room(), lidar, seed)[1]:
            turn = np.exp(-4e-3j * rng.standard_normal()) * (sweep.points @ [1.0, 1.0j])
            matcher.take(replace(sweep, points=np.column_stack([turn.real, turn.imag])))
        found = matcher.path()
        spins = (found.time > 3.2) & (found.time < 7.8)
        time, (x, y, yaws) = found.time[spins], found.poses[spins].T
        smooth = np.polyval(np.polyfit(time - 5.5, np.unwrap(yaws), 3), time - 5.5)
        arc = np.column_stack([np.ones(time.size), np.exp(1j * smooth)])
        levers.append(np.linalg.lstsq(arc, x + 1j * y, rcond=None)[0][1])
    assert np.mean(levers) == pytest.approx(-0.032, abs=1.5e-3)
    assert np.abs(np.array(levers) + 0.032).max() < 4e-3
