# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses from a chain of transforms: map -> odom -> base_link, composed where it was measured."""

from __future__ import annotations

from array import array
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag import Message, stamp_of
from werrimbi_odom.files.frames import MOVED, Chain, Edge, frame, is_static
from werrimbi_odom.files.run import Collected, Reference, ReferenceKind
from werrimbi_odom.model.pose import Floats

if TYPE_CHECKING:
    from scipy.spatial.transform import Rotation


class _Moved(NamedTuple):
    """A transform over time; n instants, ascending."""

    time: Floats
    where: Floats
    """Shape (n, 3)."""
    turn: Rotation


class ChainCollector:
    """Takes messages with transforms, one at a time, and gives the poses at the end.

    A localiser tells where the odometry's start is on its map, now and then; between two such
    corrections the chain goes on as the wheels do. So it is composed at the stamps at which what
    was measured changes, and there alone.
    """

    def __init__(self, path: Path, chain: Chain) -> None:
        self._place = f"{path}: {chain.topic}"
        self._chain = chain
        self._found: dict[tuple[str, str], array[float]] = {
            (edge.parent, edge.child): array("d") for edge in chain.steps
        }

    @property
    def topics(self) -> tuple[str, ...]:
        """Whose messages it takes."""
        return tuple(
            dict.fromkeys((self._chain.topic, *(edge.topic for edge in self._chain.steps)))
        )

    def take(self, message: Message) -> None:
        """Take a message of one of the topics."""
        for each in message.content.transforms:
            found = self._found.get((frame(each.header.frame_id), frame(each.child_frame_id)))
            if found is not None:
                time = 0.0 if is_static(message.topic) else stamp_of(message, each)
                where, turn = each.transform.translation, each.transform.rotation
                found.extend((time, where.x, where.y, where.z, turn.x, turn.y, turn.z, turn.w))

    def reference(self) -> Collected:
        """The reference, and in words the frames it is about.

        Raises
        ------
        InputError
            When the transforms were never there at one time.
        """
        moved = [self._moved(edge) for edge in self._chain.steps]
        time = self._stamps(moved)
        for edge, each in zip(self._chain.steps, moved, strict=True):
            if not edge.static:
                time = time[(time >= each.time[0]) & (time <= each.time[-1])]
        if time.size == 0:
            raise InputError(
                f"{self._place}: the transforms of {self._chain.in_words()} were never there at "
                "one time"
            )
        where, turn = np.zeros((time.size, 3)), None
        for each, back in zip(moved, self._chain.backwards, strict=True):
            step, rotated = _at(each, time)
            if back:
                rotated = rotated.inv()
                step = -rotated.apply(step)
            where = where + (step if turn is None else turn.apply(step))
            turn = rotated if turn is None else turn * rotated
        assert turn is not None
        ahead = turn.apply([1.0, 0.0, 0.0])
        yaw = np.arctan2(ahead[:, 1], ahead[:, 0])
        kind: ReferenceKind | None = None
        told = self._chain.in_words()
        measured = self._chain.measures
        if measured and len(moved) > len(measured):
            names = " and ".join(f"{each.parent} -> {each.child}" for each in measured)
            told += f", composed at each change of {names}"
            # A localiser corrects itself little by little: its error at one correction is much
            # that of the one before.
            kind = "local_map"
        x, y = where[:, 0].copy(), where[:, 1].copy()
        return Collected(Reference(time, x, y, yaw, kind=kind), told)

    def _moved(self, edge: Edge) -> _Moved:
        from scipy.spatial.transform import Rotation

        table = np.array(self._found[edge.parent, edge.child]).reshape(-1, 8)
        squared = (table[:, 4:] ** 2).sum(axis=1)
        table = table[np.isfinite(table).all(axis=1) & (squared > 0.5) & (squared < 2.0)]
        if table.size == 0:
            raise InputError(f"{self._place}: {edge.parent} -> {edge.child} is never a transform")
        table = table[-1:] if edge.static else table[np.unique(table[:, 0], return_index=True)[1]]
        return _Moved(table[:, 0], table[:, 1:4], Rotation.from_quat(table[:, 4:]))

    def _stamps(self, moved: list[_Moved]) -> Floats:
        """When the chain was measured [s]: of what changes most seldom, its changes."""
        steps = self._chain.steps
        chosen = self._chain.measures or [each for each in steps if not each.static] or steps
        each = min((m for e, m in zip(steps, moved, strict=True) if e in chosen), key=_size)
        if len(self._chain.measures) == sum(not edge.static for edge in steps):
            return each.time  # nothing of the wheels is in it
        values = np.concatenate([each.where, each.turn.as_matrix()[:, :, 0]], axis=1)
        new: NDArray[np.bool_] = np.ones(each.time.size, dtype=np.bool_)
        new[1:] = (np.abs(np.diff(values, axis=0)) > MOVED).any(axis=1)
        return each.time[new]


def _size(moved: _Moved) -> int:
    return int(moved.time.size)


def _at(moved: _Moved, time: Floats) -> tuple[Floats, Any]:
    """Translation (n, 3) and rotation at some instants, between those that are known."""
    from scipy.spatial.transform import Rotation, Slerp

    if moved.time.size == 1:
        where = np.repeat(moved.where, time.size, axis=0)
        return where, Rotation.from_quat(np.repeat(moved.turn.as_quat(), time.size, axis=0))
    where = np.stack([np.interp(time, moved.time, column) for column in moved.where.T], axis=1)
    return where, Slerp(moved.time - moved.time[0], moved.turn)(time - moved.time[0])
