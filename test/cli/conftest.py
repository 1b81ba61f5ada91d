# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A run that tests of the command line change as they need it."""

from __future__ import annotations

from pathlib import Path

import pytest

from test.cli.odometry import ROBOT, ticks


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A robot that drives straight on for 100 ticks."""
    (tmp_path / "robot.yaml").write_text(ROBOT)
    ticks(tmp_path, [(0.1 * n, 10 * n, 10 * n) for n in range(11)])
    return tmp_path
