# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Local map: echoes of the last key scans, and their line elements."""

from __future__ import annotations

from collections import deque

import numpy as np

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.line_features import Elements, line_elements

KEYS = 24
"""Number of key scans: with 12 the poses drift a little more, with 40 no less."""
FARTHER, TURNED = 0.10, 0.15
"""Distance [m] and rotation [rad] after which a scan becomes a key scan."""
AT_REST = 3
"""While the map is not full, a scan also becomes a key scan this many scans after the last one: a
robot at rest improves the map of its start."""


class LocalMap:
    """Key scans around the robot; memory and time do not grow with the drive."""

    def __init__(self) -> None:
        self._keys: deque[tuple[Floats, Floats]] = deque(maxlen=KEYS)
        self._last = np.zeros(3)
        self._since = 0
        self.elements: Elements | None = None

    def take(self, pose: Floats, points: Floats, reach: Floats) -> bool:
        """Add a scan if it shows something new, and say whether it did.

        Pose (3,), deskewed echoes (k, 2), reach (k,).
        """
        self._since += 1
        moved = np.abs(pose - self._last)
        new = max(moved[0], moved[1]) > FARTHER or moved[2] > TURNED
        if self._keys and not new and (len(self._keys) == KEYS or self._since < AT_REST):
            return False
        cos, sin = np.cos(pose[2]), np.sin(pose[2])
        placed = points @ np.array([[cos, sin], [-sin, cos]]) + pose[:2]
        self._keys.append((placed, reach))
        self._last, self._since = pose, 0
        clouds, reaches = zip(*self._keys, strict=True)
        # Until the first of all leaves it, a new one moves the map by its share alone.
        ages = np.arange(len(clouds), 0, -1) * (1.0 if len(clouds) == KEYS else 2.0)
        age = np.repeat(ages, [len(cloud) for cloud in clouds])
        self.elements = line_elements(np.concatenate(clouds), np.concatenate(reaches), age)
        return True
