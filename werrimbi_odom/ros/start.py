# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Executables of the nodes, which return the exit code; without ROS they say how to install it."""

from __future__ import annotations

import sys
from functools import partial
from importlib import import_module


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


odom_node = partial(_started, "odom_node")
compare_node = partial(_started, "compare_node")
simulated_robot = partial(_started, "simulated_robot")
drive_node = partial(_started, "drive_node")
