# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses from a lidar, by matching scans as they are read."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import BagMessage, stamp_of
from werrimbi_odom.files.bags.bag_chain import ChainCollector
from werrimbi_odom.files.bags.frames import Chain
from werrimbi_odom.files.bags.measured_topic import Measured
from werrimbi_odom.files.mount import Mount
from werrimbi_odom.files.run import Collected, Reference
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.beam_order import Order
from werrimbi_odom.scans.limits import FIXED_STANDS, FIXED_TURNED, LONGEST_SWEEP
from werrimbi_odom.scans.room_odometry import RoomOdometry
from werrimbi_odom.scans.scan_odometry import Flag
from werrimbi_odom.scans.sweep import sweep_of
from werrimbi_odom.scans.three_pass_odometry import ScanPath

WHY: dict[Flag, str] = {
    "few": "too little within the lidar's reach",
    "weak": "what was seen leaves a direction free, as a bare corridor does",
    "disagree": "what was seen did not agree with what was seen before",
    "unsettled": "the match settled on no place",
    "fast": "a place farther away than a robot drives",
}
"""Reasons why a scan is not matched, as the end of a sentence."""

_AROUND = 3.0 * np.pi
"""Angle between the first and the last beam above which it is in degrees [rad]: no lidar goes
around one and a half times in a scan, and 10 degrees are more."""
_FAR = 200.0
"""Usual range above which ranges are in millimetres [m]: 0.2 m, or farther than lidars reach."""

_LEVEL = np.radians(1.0)
"""Tilt above which the floor may be seen [rad]: from 17 cm above it, 10 m ahead."""

_USUAL_HEIGHT = 0.2
"""Height above the floor for which a tilt is told [m]: of most small robots 0.1 to 0.3 m."""

_ORDERS: dict[Order, str] = {
    "first to last": "from the first to the last",
    "last to first": "from the last to the first",
}


class LidarCollector:
    """Collects scans and transforms, and computes the poses of the base at the end."""

    def __init__(self, path: Path, source: Measured, mounting: Chain | None) -> None:
        """Chain `mounting` leads from the robot's base to the lidar; None if unknown."""
        self._place = f"{path}: {source.name}"
        self._name = source.name
        self._frame = source.child
        self._mounting = ChainCollector(self._place, mounting) if mounting else None
        self._matcher = RoomOdometry()
        self._echoes, self._reach = 0, (0.0, np.inf)
        self._undirected = 0
        self._around, self._ranges = 0.0, list[float]()
        self.topics = (source.name, *(self._mounting.topics if self._mounting else ()))

    def take(self, message: BagMessage) -> None:
        """Add a message of one of the topics."""
        if message.topic != self._name:
            assert self._mounting is not None
            self._mounting.take(message)
            return
        scan = message.content
        ranges = np.asarray(scan.ranges, dtype=np.float64)
        angles = float(scan.angle_min) + float(scan.angle_increment) * np.arange(float(ranges.size))
        if float(scan.angle_increment) == 0.0 or not np.isfinite(angles).all():
            self._undirected += 1
            ranges, angles = np.zeros(0), np.zeros(0)
        self._around = max(self._around, abs(float(scan.angle_increment)) * angles.size)
        echoes = ranges[np.isfinite(ranges) & (ranges > 0.0)]
        self._ranges += [float(np.median(echoes))] if echoes.size else []
        interval = float(scan.time_increment)
        if not abs(interval) * ranges.size <= LONGEST_SWEEP:  # nor NaN
            interval = 0.0
        limits = float(scan.range_min), float(scan.range_max)
        if not limits[0] < limits[1]:
            limits = 0.0, np.inf
        sweep = sweep_of(stamp_of(message), ranges, angles, interval, *limits)
        self._echoes, self._reach = self._echoes + len(sweep.points), limits
        self._matcher.take(sweep)

    def reference(self) -> Collected:
        """The reference, its description in words, and where it is cut.

        InputError if the scans do not determine the robot's path.
        """
        found = self._matcher.path()
        words = _in_degrees(self._around)  # a few of them may match all the same
        if not words and found.time.size == 0:
            if 2 * self._undirected > found.scans:
                words = _undirected(self._undirected, found)
            else:
                words = _in_millimetres(self._ranges) or (
                    _lost(found) if self._echoes else _blind(found, self._reach)
                )
        if words:
            raise InputError(f"{self._place}: {'; '.join((words, *_fixed(self._matcher)))}")
        mount = self._mounting.mount() if self._mounting else None
        poses, covariances, walked = of_base(found, mount or Mount(0.0, 0.0, 0.0))
        # One number for both axes is that of the wider: the mean is too sure along a corridor.
        sigma_xy = np.sqrt(np.linalg.eigvalsh(covariances[:, :2, :2])[:, 1])
        sigma_yaw = np.sqrt(covariances[:, 2, 2])
        damage = [f"{self._name}: {each}" for each in (*_fixed(self._matcher), *_standing(found))]
        if found.cuts:
            damage.append(f"the path by {self._name} is in pieces: {_unmatched(found)}")
        told = f"{self._mounted(mount)}; {_in_words(found, sigma_xy, sigma_yaw)}"
        beams = self._matcher.matcher
        if beams.order != "stated":
            told += (
                f"; its beams are deskewed {_ORDERS[beams.order]}, for so the walls are "
                "sharper while it turns: its driver states them "
                f"{'all at one instant' if beams.at_once else 'the other way round'}"
            )
        x, y, yaw = (np.ascontiguousarray(each) for each in poses.T)
        # Not local_map: in a room the map drifts by less than the error of a match (docs/scans.md),
        # and a fitted drift would absorb the effect of a misaligned lidar.
        reference = Reference(
            found.time,
            x,
            y,
            yaw,
            sigma_xy,
            sigma_yaw,
            kind="absolute",
            own_axes=True,
            mount=mount,
            walked=walked,
            covariance=covariances,
        )
        return Collected(reference, told, tuple(damage), tuple(found.cuts))

    def _mounted(self, mount: Mount | None) -> str:
        if self._mounting is None or mount is None:
            return (
                f"frame {self._frame or 'of no name'}: no transform says where the lidar sits, so "
                "its own path is compared (reference_lever_arm, reference_yaw_offset)"
            )
        down = ", upside down" if mount.inverted else ""
        if mount.tilt > _LEVEL:
            down += (
                f", tilted by {np.degrees(mount.tilt):.1f}°: where it looks down, the floor may "
                "look like a wall that goes with the robot"
            )
        topics = dict.fromkeys(edge.topic for edge in self._mounting.chain.steps)
        sits = _beside(mount.x, "ahead of", "behind"), _beside(mount.y, "left of", "right of")
        return (
            f"frame {mount.base}: by {' and '.join(topics)} the lidar sits "
            f"{sits[0]} and {sits[1]} it, turned by {np.degrees(mount.yaw):.1f}°{down}"
        )


def _beside(length: float, one: str, other: str) -> str:
    return f"{1e3 * abs(length):.0f} mm {one if length >= 0.0 else other}"


def of_base(found: ScanPath, mount: Mount) -> tuple[Floats, Floats, Floats]:
    """Poses of the base (n, 3) from the origin on, covariances (n, 3, 3), and walks (n, 2)."""
    x, y, yaw = found.poses.T
    sense = np.array([1.0, -1.0, -1.0] if mount.inverted else [1.0, 1.0, 1.0])
    y, yaw = sense[1] * y, sense[2] * yaw
    sits = mount.x + 1j * mount.y
    lever = sits * np.exp(1j * yaw)  # both yaws start at zero: the base turns as the lidar does
    base = sits + (x + 1j * y) * np.exp(1j * mount.yaw) - lever
    cos, sin = np.cos(mount.yaw), np.sin(mount.yaw)
    into = np.tile(np.eye(3), (yaw.size, 1, 1))
    into[:, :2, :2] = [[cos, -sin], [sin, cos]]
    into[:, 0, 2], into[:, 1, 2] = lever.imag, -lever.real
    into *= sense
    covariances = into @ found.covariances @ into.swapaxes(1, 2)
    swing = 0.5 * np.abs(sits) ** 2
    walked = found.walked + swing * found.walked[:, 1:] * [1.0, 0.0]
    return np.column_stack([base.real, base.imag, yaw]), covariances, walked


def _in_words(found: ScanPath, sigma_xy: Floats, sigma_yaw: Floats) -> str:
    words = [
        f"{found.scans} scans, matched with the walls of the last metres to "
        f"{1e3 * float(np.median(sigma_xy)):.1f} mm and "
        f"{1e3 * float(np.median(sigma_yaw)):.1f} mrad each"
    ]
    if found.time.size < found.scans and not found.cuts:
        words.append(_unmatched(found))
    return "; ".join(words)


def _unmatched(found: ScanPath) -> str:
    words = f"{found.scans - found.time.size} of {found.scans} scans were not matched"
    words += _because(found)
    known = sum(np.ptp(found.time[found.piece == piece]) for piece in np.unique(found.piece))
    words += f", and the path is known for {known:.1f} s in all"
    if found.cuts:
        started = found.time[0]
        when = ", ".join(
            f"{begin - started:.1f} to {end - started:.1f} s" for begin, end in found.cuts
        )
        words += f"; it is cut from {when} after its first pose, and no leg spans a cut"
    return words


def _because(found: ScanPath) -> str:
    if not found.flags:
        return ""
    flag = max(found.flags, key=lambda each: found.flags[each])
    return f", mostly for {WHY[flag]}" if flag == "few" else f", mostly because {WHY[flag]}"


def _fixed(matcher: RoomOdometry) -> tuple[str, ...]:
    """What goes with the robot, if anything does."""
    if not matcher.lines:
        return ()
    told = []
    for line in matcher.lines:
        tilt = np.degrees(np.arctan2(_USUAL_HEIGHT, line.distance))
        told.append(
            f"{line.distance:.1f} m away at {round(np.degrees(line.bearing))}° in its scans (as if "
            f"it were {_USUAL_HEIGHT:g} m above the floor and tilted by {tilt:.1f}°)"
        )
    words = (
        f"{100.0 * matcher.share:.0f} % of the echoes stay on a straight line at one place before "
        f"the lidar while the room turns, {' and '.join(told)}: it sees the floor there, or the "
        "robot itself. They are left out"
    )
    if matcher.lost:
        words += f", and so are the first {matcher.lost} scans, which were matched with them"
    return (words,)


def _standing(found: ScanPath) -> tuple[str, ...]:
    """What else a lidar may have seen that stands by its scans, if most of them tell."""
    if 2 * found.time.size < found.scans or np.ptp(found.poses[:, :2], axis=0).max() > FIXED_STANDS:
        return ()
    if np.std(found.poses[:, 2]) > FIXED_TURNED:
        return ()
    return (
        "by its scans the lidar stands wherever they are matched. If it was driven, what it sees "
        "ahead goes with it, as the floor does if it is tilted: it turned too little for that to "
        "be told from walls",
    )


def _undirected(count: int, found: ScanPath) -> str:
    return (
        "the scans do not say where their beams point: angle_increment, the angle from one beam to "
        f"the next, is 0 or no number in {count} of {found.scans} scans (2 pi over the number of "
        "beams, if they go once around). Mend that where the lidar's driver is set up, or choose "
        "another reference"
    )


def _in_degrees(around: float) -> str:
    """Sentence about beams that go around farther than once and a half [rad]; "" if none do."""
    if around > _AROUND:
        return (
            f"the beams of a scan go around by {around:.4g} rad: angle_min, angle_max and "
            "angle_increment are in degrees, and must be in radians (times pi/180). Mend that "
            "where the lidar's driver is set up, or choose another reference"
        )
    return ""


def _in_millimetres(ranges: list[float]) -> str:
    """Sentence about median ranges of scans that fit nowhere, too far for metres; "" if none is."""
    usual = float(np.median(ranges)) if ranges else 0.0
    if usual > _FAR:
        return (
            f"half of all ranges are beyond {usual:.4g} m: they are in millimetres, and must be in "
            "metres, as range_min and range_max. Mend that where the lidar's driver is set up, or "
            "choose another reference"
        )
    return ""


def _blind(found: ScanPath, reach: tuple[float, float]) -> str:
    return (
        f"the scans do not hold where the robot was: none of {found.scans} scans holds an echo "
        f"between {reach[0]:g} and {reach[1]:g} m, its range_min and range_max. A lidar that is "
        "covered, that looks at something nearer, or that stands in a hall with all walls "
        "farther away, sees so; or it does not measure, or its limits are wrong. Mend that, or "
        "choose another reference"
    )


def _lost(found: ScanPath) -> str:
    return (
        f"the scans do not hold where the robot was: of {found.scans} scans not enough could be "
        f"matched one after the other{_because(found)}; drive where walls and furniture are within "
        "4 m on several sides, or choose another reference"
    )
