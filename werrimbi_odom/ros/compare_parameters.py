# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of compare_node."""

from __future__ import annotations

from werrimbi_odom.files.evaluation_options import LEAST, MOST
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter
from werrimbi_odom.inference import rules
from werrimbi_odom.ros.compare_inputs import REFERENCE_TYPES
from werrimbi_odom.ros.declared_parameters import table, within

# fmt: off
PARAMETERS: tuple[NodeParameter, ...] = (
    NodeParameter("reference_type", "pose_stamped",
        "Kind of the messages on `reference`.", choices=tuple(REFERENCE_TYPES)),
    NodeParameter("leg", 1.0,
        "Path of a leg; a quarter turn on the spot makes one too. Too short: the reference's noise "
        "hides what the odometry does.", unit="m", above=0.0),
    within("window", 20, "legs", 5, 100_000,
        "Legs that the verdict looks back on. More: it sees smaller faults, and later."),
    within("reference_sigma_xy", rules.TAPE_XY, "m", LEAST, MOST,
        "Standard deviation of the reference's x and y, where its messages state none."),
    within("reference_sigma_yaw", rules.TAPE_YAW, "rad", LEAST, MOST, "The same of its heading."),
    NodeParameter("robot_file", "",
        "Robot file of odom_node: tell what is missing in it; empty: do not look. It is read, "
        "never written."),
    within("diagnose_every", 5.0, "min", 0.1, 60.0,
        "Driving between two looks for what is missing, each of which is at twice as much."),
    NodeParameter("reference_kind", "auto",
        "What the reference's noise is like, as for `werrimbi diagnose --reference-kind`; auto: as "
        "it takes it by itself.", choices=("auto", "absolute", "incremental", "local_map")),
    NodeParameter("new_robot_file", "",
        "What `~/write_robot_file` writes; empty: beside `robot_file`, with _better in its name."),
)
# fmt: on


if __name__ == "__main__":
    print(table(PARAMETERS), end="")
