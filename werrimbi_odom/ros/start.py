# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Executables of the nodes; without ROS they explain how to install it."""

from __future__ import annotations

import sys
from importlib import import_module


def odom_node() -> int:
    """Run `odom_node`; return the exit code."""
    return _started("odom_node")


def compare_node() -> int:
    """Run `compare_node`; return the exit code."""
    return _started("compare_node")


def simulated_robot() -> int:
    """Run `simulated_robot`; return the exit code."""
    return _started("simulated_robot")


def drive_node() -> int:
    """Run `drive_node`; return the exit code."""
    return _started("drive_node")


def _started(name: str) -> int:
    try:
        node = import_module(f"werrimbi_odom.ros.{name}")
    except ModuleNotFoundError as missing:
        if (missing.name or "").startswith("werrimbi_odom"):
            raise
        print(
            f"{name} needs ROS 2, and its Python package {missing.name}: source its setup.bash, "
            "or pip install 'werrimbi_odom[ros]'",
            file=sys.stderr,
        )
        return 2
    code: int = node.main()
    return code
