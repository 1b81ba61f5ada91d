# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""docs/faults.md states the limits that the code has."""

from __future__ import annotations

import math

import pytest

from test.command_line import ROOT
from werrimbi_odom.files import text_files
from werrimbi_odom.files.tables import csv_table

PAGE = (ROOT / "docs" / "faults.md").read_text(encoding="utf-8")


def test_limits_of_files() -> None:
    assert text_files.MAX_BYTES == 10**6
    assert "more than 1 MB" in PAGE
    assert math.isclose(csv_table.MAX_ROWS, 20e6)
    assert "more than 20 million rows" in PAGE


def test_limits_of_messages() -> None:
    pytest.importorskip("rclpy")
    from werrimbi_odom.ros import planar, wheel_side

    assert wheel_side.COUNTER_LIMIT == 2**63
    assert "beyond 2⁶³ counts" in PAGE
    assert planar.FARTHEST == 1e12
    assert "beyond 10¹² m" in PAGE
