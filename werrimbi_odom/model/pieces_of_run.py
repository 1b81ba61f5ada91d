# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The pieces of a recorded run, stored in columns; few of a million are read at a time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np

from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.motion import BodyMotion, WheelTravel
from werrimbi_odom.model.pieces import Piece, kind_of
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.recorded_propagation import PathInPieces

_BLOCK = 1024  # pieces constructed together


@dataclass(frozen=True, slots=True, eq=False)
class PiecesOfRun(Sequence[Piece]):
    """A run cut into pieces; each is constructed when it is accessed."""

    track: float
    time: Floats
    """Stamps before the first step and after each [s], shape (n + 1,)."""
    course: PathInPieces

    def __len__(self) -> int:
        return self.course.start.size

    @overload
    def __getitem__(self, which: int) -> Piece: ...

    @overload
    def __getitem__(self, which: slice) -> tuple[Piece, ...]: ...

    def __getitem__(self, which: int | slice) -> Piece | tuple[Piece, ...]:
        if isinstance(which, slice):
            return tuple(self[at] for at in range(*which.indices(len(self))))
        (piece,) = self._made(range(len(self))[which], 1)
        return piece

    def __iter__(self) -> Iterator[Piece]:
        for first in range(0, len(self), _BLOCK):
            yield from self._made(first, min(_BLOCK, len(self) - first))

    def _made(self, first: int, count: int) -> Iterator[Piece]:
        course, which = self.course, slice(first, first + count)
        begin = course.start[which]
        end = np.append(course.start[first + 1 :][:count], self.time.size - 1)[:count]
        columns = zip(
            self.time[begin].tolist(),
            self.time[end].tolist(),
            course.poses[:, begin].T.tolist(),
            course.covariances[:, begin].T.tolist(),
            course.sums[:, which].T.tolist(),
            strict=True,
        )
        for at, (since, until, pose, errors, (left, right, *motion)) in enumerate(columns, first):
            body = BodyMotion(*motion)
            yield Piece(
                kind_of(body, self.track),
                since,
                until,
                Pose(*pose),
                WheelTravel(left, right),
                body,
                course.reset.get(at) or PoseCovariance(*errors),
            )
