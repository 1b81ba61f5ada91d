# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""References that contain the odometry or copy it, as far as the bag shows it.

If a marker or a map is observed only at times, nodes extrapolate the pose by the wheels in between,
one message per odometry message; or they move the points of a scan by odometry. Such references are
partly measurements and are not rejected, but the underlying measurement is the better reference.
Others are the robot's own odometry under another name: the same poses, published twice.
"""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import stamp_of
from werrimbi_odom.files.bags.own_odometry import ODOMETRY, names_a_sensor

if TYPE_CHECKING:
    from werrimbi_odom.files.bags.bag import Bag
    from werrimbi_odom.files.bags.measured_topic import Measured


_MOSTLY = 0.9  # of the stamps; a sensor's own stamps never equal another node's to the nanosecond
_FEWEST_STAMPS = 10


def second_hand(bag: Bag, references: Sequence[Measured]) -> dict[str, str]:
    """References that contain odometry, by name, with the reason: the end of a sentence."""
    return _moved_scans(references) | _carried_on(bag, references)


def _carried_on(bag: Bag, references: Sequence[Measured]) -> dict[str, str]:
    poses = [
        each.name
        for each in references
        if each.independent and each.measures == "poses" and not each.is_scan and not each.chain
    ]
    own = [each.name for each in references if each.kind == ODOMETRY and not each.independent]
    if len(poses) < 2 or not own:
        return {}
    stamps: dict[str, set[tuple[int, int]]] = {name: set() for name in (*poses, *own)}
    for message in bag.messages([*poses, *own]):
        header = getattr(message.content, "header", None)
        if header is not None:  # Pose2D has none
            stamps[message.topic].add((header.stamp.sec, header.stamp.nanosec))
    found = {}
    for name in poses:
        for odometry in own:
            shared = len(stamps[name] & stamps[odometry])
            if shared >= max(_FEWEST_STAMPS, _MOSTLY * len(stamps[name])):
                found[name] = (
                    f"stamped as {odometry} message by message, so the wheels carry it on between "
                    "its own measurements"
                )
    return found


def _moved_scans(references: Sequence[Measured]) -> dict[str, str]:
    scans = [each.name for each in references if each.is_scan]
    found = {}
    for name in scans:
        tail = name.rpartition("/")[2]
        for other in scans:
            made_of = other.rpartition("/")[2]
            longer = tail.startswith(f"{made_of}_") or tail.endswith(f"_{made_of}")
            if longer and "filter" not in tail:  # a filter removes points but moves none
                found[name] = f"made of {other} by its name, and perhaps moved by the odometry"
    return found


_POSES = {
    ODOMETRY: lambda content: content.pose.pose.position,
    "geometry_msgs/msg/PoseStamped": lambda content: content.pose.position,
    "geometry_msgs/msg/PoseWithCovarianceStamped": lambda content: content.pose.pose.position,
}
_FEWEST_POSES = 20
_SAME = 2e-4
"""Largest rms distance of two aligned paths that are one, as a share of their extent. Odometry
drifts from a measured path by a hundred times that; odometry published between its own messages
differs by some 1e-5."""
_FARTHEST = 0.1
"""Least extent of a path for this test [m]; over less, odometry without drift may be as close."""

Path = NDArray[np.complex128]


def copies(bag: Bag, references: Sequence[Measured]) -> dict[str, str]:
    """References that are copies of the robot's own odometry, by name, and the topic they copy.

    References with the name of a sensor are excluded: /odom may itself contain the sensor's poses,
    and the values do not show which is the original.
    """
    there = [each for each in references if each.kind in _POSES and not each.chain]
    own = [each.name for each in there if each.kind == ODOMETRY and not each.independent]
    others = [each.name for each in there if each.independent and not names_a_sensor(each.name)]
    if not own or not others:
        return {}
    kinds = {each.name: each.kind for each in there}
    rows: dict[str, array[float]] = {name: array("d") for name in (*own, *others)}
    with suppress(InputError):  # unreadable messages are reported when the topic is read
        for message in bag.messages([*own, *others]):
            place: Any = _POSES[kinds[message.topic]](message.content)
            rows[message.topic].extend((stamp_of(message), float(place.x), float(place.y)))
    paths = {name: np.array(values).reshape(-1, 3) for name, values in rows.items()}
    found = {}
    for name in others:
        for odometry in own:
            if _is_same(paths[name], paths[odometry]):
                found[name] = odometry
                break
    return found


def _is_same(one: NDArray[np.float64], other: NDArray[np.float64]) -> bool:
    """Whether two paths, shape (n, 3) of time and position each, agree up to a rigid motion."""
    one, other = (each[np.isfinite(each).all(axis=1)] for each in (one, other))
    if len(one) < _FEWEST_POSES or len(other) < _FEWEST_POSES:
        return False
    order = np.argsort(other[:, 0], kind="stable")
    time, x, y = other[order].T
    inside = (one[:, 0] >= time[0]) & (one[:, 0] <= time[-1])
    if inside.sum() < _FEWEST_POSES or inside.mean() < 0.5:
        return False
    at = one[inside, 0]
    there: Path = np.interp(at, time, x) + 1j * np.interp(at, time, y)
    here: Path = one[inside, 1] + 1j * one[inside, 2]
    here, there = here - here.mean(), there - there.mean()
    turn = np.vdot(here, there)
    extent = float(np.abs(there).max())
    if extent < _FARTHEST or abs(turn) == 0.0:
        return False
    apart = np.sqrt(np.mean(np.abs(here * (turn / abs(turn)) - there) ** 2))
    return bool(apart < _SAME * extent)
