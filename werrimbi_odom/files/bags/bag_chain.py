# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Composes chains of transforms: poses of map -> odom -> base_link, and the pose of a sensor.

Poses are composed at the times of measurement; the pose of a sensor comes from constant transforms.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import BagMessage, stamp_of
from werrimbi_odom.files.bags.frames import MOVED, Chain, Edge, chain, frame, is_static
from werrimbi_odom.files.bags.own_odometry import is_base
from werrimbi_odom.files.mount import Mount
from werrimbi_odom.files.references.levelled import levelled
from werrimbi_odom.files.run import Collected, Reference, ReferenceKind
from werrimbi_odom.model.pose import Floats

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation


POSTDATED = 0.1
"""Stamps that are further ahead of the wheels' [s], by when both were received, are set back.

A localiser dates its transform forward by its `transform_tolerance` (AMCL: a second as a rule),
and computed it with the odometry of its last scan: the odometry of that time is no measurement."""


LEVEL = 0.985
"""Cosine of 10 degrees. A lidar with a larger tilt measures walls 1.5 % too far away, and at a
height of 1 m sees the floor within 6 m."""


class _Moved(NamedTuple):
    """A transform over time; n instants, ascending."""

    time: Floats
    ahead: float
    """By how much its stamps are ahead of their receipt, as a rule [s]."""
    where: Floats
    """Shape (n, 3)."""
    turn: Rotation


class ChainCollector:
    """Collects transforms, and computes the poses at the end.

    A localiser corrects the odometry's origin on its map from time to time; between two corrections
    the chain moves as the wheels do. So the chain is composed only at the stamps at which a
    measured transform changes.
    """

    def __init__(self, place: str, chain: Chain) -> None:
        """`place`: location of the data, for error messages."""
        self._place = place
        self.chain = chain
        self._found: dict[tuple[str, str], array[float]] = {
            (edge.parent, edge.child): array("d") for edge in chain.steps
        }

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics of the messages to collect."""
        steps = self.chain.steps
        return tuple(dict.fromkeys((self.chain.topic, *(edge.topic for edge in steps))))

    def take(self, message: BagMessage) -> None:
        """Add a message of one of the topics."""
        for each in message.content.transforms:
            found = self._found.get((frame(each.header.frame_id), frame(each.child_frame_id)))
            if found is not None:
                time = 0.0 if is_static(message.topic) else stamp_of(message, each)
                ahead = time - 1e-9 * message.received
                where, turn = each.transform.translation, each.transform.rotation
                place = where.x, where.y, where.z
                found.extend((time, ahead, *place, turn.x, turn.y, turn.z, turn.w))

    def reference(self) -> Collected:
        """The reference, and its frames in words.

        InputError if the transforms were never available at the same time.
        """
        moved = [self._moved(edge) for edge in self.chain.steps]
        ahead = self._ahead_of_wheels(moved)
        if ahead > POSTDATED:
            moved = [
                each._replace(time=each.time - ahead) if edge in self.chain.measures else each
                for edge, each in zip(self.chain.steps, moved, strict=True)
            ]
        time = self._stamps(moved)
        for edge, each in zip(self.chain.steps, moved, strict=True):
            if not edge.static:
                time = time[(time >= each.time[0]) & (time <= each.time[-1])]
        if time.size == 0:
            raise InputError(
                f"{self._place}: the transforms of {self.chain.in_words()} were never there at "
                "one time"
            )
        steps = (_at(each, time) for each in moved)
        where, turn, yaw = _composed(steps, self.chain.backwards)
        kind: ReferenceKind | None = None
        told = self.chain.in_words()
        measured = self.chain.measures
        if measured and any(each.made_from_wheels for each in self.chain.steps):
            names = " and ".join(f"{each.parent} -> {each.child}" for each in measured)
            told += f", composed at each change of {names}"
            # A localiser corrects itself gradually, so its errors at successive corrections are
            # correlated.
            kind = "local_map"
        if ahead > POSTDATED:
            told += f", which is stamped {ahead:.2g} s ahead of its receipt and set back by that"
        x, y = where[:, 0].copy(), where[:, 1].copy()
        if on_plane := levelled(where, turn.as_quat()):
            x, y, yaw, tilted = on_plane
            told += f", {tilted}"
        return Collected(Reference(time, x, y, yaw, kind=kind), told)

    def mount(self) -> Mount:
        """Pose of the sensor at the end of a constant chain, on the base at its begin.

        InputError if it is not level, or a transform is invalid.
        """
        moved = [self._moved(edge) for edge in self.chain.steps]
        steps = ((each.where[-1:], each.turn[-1:]) for each in moved)
        (where,), turn, (yaw,) = _composed(steps, self.chain.backwards)
        up = float(turn.apply([0.0, 0.0, 1.0])[0, 2])
        tilt = float(np.arccos(min(abs(up), 1.0)))
        if abs(up) < LEVEL:
            raise InputError(
                f"{self._place}: by its transforms ({self.chain.in_words()}) the lidar is tilted "
                f"by {np.degrees(tilt):.0f}°: its scans are no plan of the floor; "
                "give one that lies level, or mend the transforms"
            )
        ends = self.chain.parent, self.chain.child
        return Mount(float(where[0]), float(where[1]), float(yaw), up < 0.0, *ends, tilt)

    def _ahead_of_wheels(self, moved: list[_Moved]) -> float:
        """By how much what is measured is stamped ahead of the wheels' transforms [s].

        By when both were received; 0 for a chain without wheels.
        """
        steps = list(zip(self.chain.steps, moved, strict=True))
        measured = [each.ahead for edge, each in steps if edge in self.chain.measures]
        wheels = [each.ahead for edge, each in steps if edge.made_from_wheels]
        return min(measured) - max(wheels) if measured and wheels else 0.0

    def _moved(self, edge: Edge) -> _Moved:
        from scipy.spatial.transform import Rotation

        table = np.array(self._found[edge.parent, edge.child]).reshape(-1, 9)
        squared = (table[:, 5:] ** 2).sum(axis=1)
        table = table[np.isfinite(table).all(axis=1) & (squared > 0.5) & (squared < 2.0)]
        if table.size == 0:
            raise InputError(f"{self._place}: {edge.parent} -> {edge.child} is never a transform")
        table = table[-1:] if edge.static else table[np.unique(table[:, 0], return_index=True)[1]]
        ahead = float(np.median(table[:, 1]))
        return _Moved(table[:, 0], ahead, table[:, 2:5], Rotation.from_quat(table[:, 5:]))

    def _stamps(self, moved: list[_Moved]) -> Floats:
        """Times of measurement [s]: the changes of the transform that changes least often."""
        steps = self.chain.steps
        chosen = self.chain.measures or [each for each in steps if not each.static] or steps
        told = (each for edge, each in zip(steps, moved, strict=True) if edge in chosen)
        each = min(told, key=lambda each: each.time.size)
        if len(self.chain.measures) == sum(not edge.static for edge in steps):
            return each.time  # the chain does not involve the wheels
        values = np.concatenate([each.where, each.turn.as_matrix()[:, :, 0]], axis=1)
        new: NDArray[np.bool_] = np.ones(each.time.size, dtype=np.bool_)
        new[1:] = (np.abs(np.diff(values, axis=0)) > MOVED).any(axis=1)
        return each.time[new]


def _composed(
    steps: Iterable[tuple[Floats, Rotation]], backwards: Sequence[bool]
) -> tuple[Floats, Rotation, Floats]:
    """Position (n, 3), rotation and yaw of the last frame of a chain in its first."""
    where, turn = np.zeros((1, 3)), None
    for (step, rotated), back in zip(steps, backwards, strict=True):
        if back:
            rotated = rotated.inv()
            step = -rotated.apply(step)
        where = where + (step if turn is None else turn.apply(step))
        turn = rotated if turn is None else turn * rotated
    assert turn is not None
    ahead = turn.apply([1.0, 0.0, 0.0])
    return where, turn, np.arctan2(ahead[:, 1], ahead[:, 0])


def _at(moved: _Moved, time: Floats) -> tuple[Floats, Any]:
    """Interpolate translation (n, 3) and rotation at some instants."""
    from scipy.spatial.transform import Rotation, Slerp

    if moved.time.size == 1:
        where = np.repeat(moved.where, time.size, axis=0)
        return where, Rotation.from_quat(np.repeat(moved.turn.as_quat(), time.size, axis=0))
    where = np.stack([np.interp(time, moved.time, column) for column in moved.where.T], axis=1)
    return where, Slerp(moved.time - moved.time[0], moved.turn)(time - moved.time[0])


def mounting_chain(edges: Sequence[Edge], base: str, sensor: str) -> Chain | None:
    """Constant transforms from the robot's base to a sensor's frame; None if there are none."""
    fixed = [edge for edge in edges if edge.static or not edge.changes]
    frames = dict.fromkeys([base, *(f for edge in fixed for f in (edge.parent, edge.child))])
    bases = [each for each in frames if each == base or is_base(each)]
    for each in bases:
        found = chain(fixed, each, sensor)
        if found is not None:
            return found
    return None
