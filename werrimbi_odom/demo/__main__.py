# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`make demo`."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from werrimbi_odom.cli.packages import refuse_without
from werrimbi_odom.demo.simulated_procedure import second_act
from werrimbi_odom.demo.through_node import RECORDING, first_act
from werrimbi_odom.errors import InputError


def main(argv: list[str] | None = None) -> int:
    """Run the demo; 0 on success, 2 for input that cannot be used."""
    parser = argparse.ArgumentParser(
        prog="make demo",
        description="Recorded ticks through the real odom_node over DDS, and how far off it ends; "
        "then a robot in a physics engine drives, is told what its robot file lacks, and drives "
        "with that added.",
    )
    parser.add_argument("--robot", type=Path, default=RECORDING / "robot.yaml")
    parser.add_argument("--run", type=Path, default=RECORDING, help="folder or bag")
    parser.add_argument("--out", type=Path, default=Path("demo"), help="folder for the pictures")
    parser.add_argument("--first-act", action="store_true", help="the node alone")
    arguments = parser.parse_args(argv)
    both = not arguments.first_act and arguments.run == RECORDING
    try:
        more = ("scipy", "mujoco", "rosbags") if both else ()
        for package in ("rclpy", "plotly", "rich", *more):
            refuse_without(package, "it")
        first_act(arguments.robot, arguments.run, arguments.out)
        if both:
            second_act(arguments.out)
    except InputError as error:
        print(f"demo: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
