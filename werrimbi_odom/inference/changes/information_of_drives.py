# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Each drive summarised by its information matrix and score, for all questions about changes.

To first order the log-likelihood of a drive is quadratic in the parameters. Its curvature and slope
suffice for an estimate by each drive, by any stretch of drives, and with any parameter free to step
at any drive. The recordings themselves are not needed again.

Source: sufficient statistics of the linear model. The per-run parameters of each drive (start
headings, phases, a gyro's drift) are projected out first (Frisch, Waugh and Lovell).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class DriveNumbers:
    """Information of R drives about s parameters."""

    names: tuple[str, ...]
    """Names of the parameters."""
    information: Floats
    """Information matrix of each drive, (R, s, s)."""
    weighted: Floats
    """The information times the drive's own estimate, (R, s)."""
    time: Floats
    """Time of each drive, (R,) [s]."""

    @property
    def count(self) -> int:
        """Number of drives."""
        return int(self.time.size)

    def chosen(self, which: NDArray[np.intp]) -> DriveNumbers:
        """Some of the drives, in that order."""
        return DriveNumbers(
            self.names, self.information[which], self.weighted[which], self.time[which]
        )

    def without(self, known: Mapping[str, tuple[float, float]]) -> DriveNumbers:
        """Project out some parameters.

        `known`: by name, value and standard deviation before the drives.
        """
        if not known:
            return self
        rest = [index for index, name in enumerate(self.names) if name not in known]
        gone = [self.names.index(name) for name in known]
        value, std = np.array([*known.values()], dtype=np.float64).reshape(-1, 2).T
        cross = self.information[:, rest][:, :, gone]
        share = cross @ np.linalg.inv(self.information[:, gone][:, :, gone] + np.diag(std**-2.0))
        information = self.information[:, rest][:, :, rest] - share @ cross.swapaxes(-1, -2)
        told = self.weighted[:, gone] + value * std**-2.0
        return DriveNumbers(
            tuple(self.names[index] for index in rest),
            0.5 * (information + information.swapaxes(-1, -2)),
            self.weighted[:, rest] - (share @ told[..., None])[..., 0],
            self.time,
        )

    def with_scatter(self, scatter: Floats) -> DriveNumbers:
        """Add a random effect: scatter of each parameter from drive to drive.

        `scatter` (s,): its standard deviation.
        """
        spread = np.diag(scatter**2)
        shrunk = np.linalg.inv(np.eye(scatter.size) + self.information @ spread)
        information = shrunk @ self.information
        return DriveNumbers(
            self.names,
            0.5 * (information + information.swapaxes(-1, -2)),
            (shrunk @ self.weighted[..., None])[..., 0],
            self.time,
        )
