# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses by the room alone: echoes that go with the robot are found and left out of matching.

A line that goes with the robot shows only after some turning. So the first minutes of scans are
kept, and are matched anew without it once it is found.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace

import numpy as np

from werrimbi_odom.scans.beam_order import AnyOrder
from werrimbi_odom.scans.body_fixed import FixedLine, fixed_line
from werrimbi_odom.scans.limits import FIXED_SCANS
from werrimbi_odom.scans.sweep import Sweep
from werrimbi_odom.scans.three_pass_odometry import ScanPath

_EVERY, _OF = 200, 400
"""Scans after which such a line is sought, and in how many of the last."""
_KEPT = 400_000
"""Echoes that are kept to be matched anew: three minutes of 218 beams at 10 Hz, in 13 MB."""


class RoomOdometry:
    """An `AnyOrder` that leaves out what goes with the robot; takes scans in the order of time."""

    def __init__(self) -> None:
        self._kept: deque[Sweep] = deque()
        self._echoes = self._since = self._scans = 0
        self._all = self._fixed = 0
        self.matcher = AnyOrder()
        """It has the scans that are left."""
        self.lines: tuple[FixedLine, ...] = ()
        """What goes with the robot."""
        self.lost = 0
        """Scans that are in no path, as they were no longer kept when a line was found."""

    @property
    def share(self) -> float:
        """Of all echoes, those that were left out."""
        return self._fixed / max(self._all, 1)

    def take(self, sweep: Sweep) -> None:
        """Take a scan, as `sweep_of` reads it from its message."""
        self._scans += 1
        self._all += len(sweep.points)
        for line in self.lines:
            sweep = self._without(line, sweep)
        self._kept.append(sweep)
        self._echoes += len(sweep.points)
        while self._echoes > _KEPT:
            self._echoes -= len(self._kept.popleft().points)
        self.matcher.take(sweep)
        self._since += 1
        if self._since >= _EVERY:
            self._seek()

    def path(self) -> ScanPath:
        """The path of all scans taken; call it last."""
        while self._since >= FIXED_SCANS and self._seek():
            self._since = FIXED_SCANS  # another line may show without this one
        return self.matcher.path()

    def _seek(self) -> bool:
        """Whether another line goes with the robot; then all scans kept are matched without it."""
        self._since = 0
        matched = {time: (yaw, piece) for time, yaw, piece in self.matcher.headings(_OF)}
        sweeps = [sweep for sweep in self._kept if sweep.time in matched]
        headings = np.array([matched[sweep.time] for sweep in sweeps]).reshape(-1, 2)
        line = fixed_line(sweeps, *headings.T)
        if line is None:
            return False
        self.lines += (line,)
        self.lost = self._scans - len(self._kept)
        self._kept = deque(self._without(line, sweep) for sweep in self._kept)
        self._echoes = sum(len(sweep.points) for sweep in self._kept)
        self.matcher = AnyOrder()
        for sweep in self._kept:
            self.matcher.take(sweep)
        return True

    def _without(self, line: FixedLine, sweep: Sweep) -> Sweep:
        left = ~line.has(sweep.points)
        self._fixed += left.size - int(np.count_nonzero(left))
        return replace(
            sweep, points=sweep.points[left], share=sweep.share[left], reach=sweep.reach[left]
        )
