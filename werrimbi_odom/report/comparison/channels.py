# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the figures of a comparison call motions and errors, and in which units."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.inference.comparison.compare import Comparison

NAMES = {"line": "straight", "arc": "curves", "spin": "spins"}
CHANNELS = (("along", "mm", 1e3), ("sideways", "mm", 1e3), ("heading", "°", float(np.degrees(1.0))))
"""Name, unit and factor to it of each column of the legs' errors."""


def measured_channels(comparison: Comparison) -> list[int]:
    """Columns of the errors that were measured at all."""
    return [
        column for column in range(3) if np.isfinite(comparison.legs.errors.error[:, column]).any()
    ]
