# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter names of other drivers' files, from which a robot file may be made.

diff_drive_controller (ros2_controllers) uses the same names for the geometry; its other parameters
concern commands and do not matter for odometry. TurtleBot3 uses other names. Neither has the counts
per turn, since their wheel positions are in radians.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

DIFF_DRIVE = "diff_drive_controller"
OF_DIFF_DRIVE = frozenset(
    (
        "allow_multiple_cmd_vel_publishers",
        "angular",
        "autostart",
        "cmd_vel_timeout",
        "linear",
        "open_loop",
        "pose_covariance_diagonal",
        "position_feedback",
        "preserve_turning_radius",
        "publish_cmd",
        "publish_limited_velocity",
        "publish_rate",
        "publish_wheel_data",
        "publish_wheel_joint_controller_state",
        "tf_frame_prefix",
        "tf_frame_prefix_enable",
        "twist_covariance_diagonal",
        "type",
        "update_rate",
        "use_stamped_vel",
        "velocity_rolling_window_size",
        "wheels_per_side",
    )
)
"""Its own parameter names in all versions; `linear` and `angular` are blocks."""

TURTLEBOT = "wheels"
"""Block of TurtleBot3's file with the geometry."""
OF_TURTLEBOT = frozenset(("enable_stamped_cmd_vel", "motors", "opencr", "sensors"))
"""What else is in it."""
_TURTLEBOT = {"separation": "wheel_separation", "radius": "wheel_radius"}


def is_of_diff_drive(name: object) -> bool:
    """Whether it is a parameter of that controller that is not needed here; also with dots."""
    return isinstance(name, str) and name.partition(".")[0] in OF_DIFF_DRIVE


def remark_on(names: Iterable[str], whose: str = DIFF_DRIVE) -> tuple[str, ...]:
    """Remark on names that are not needed; empty without any."""
    listed = ", ".join(names)
    return (f"of {whose}; not needed here: {listed}",) if listed else ()


def translated(block: Mapping[Any, Any]) -> dict[str, Any]:
    """Geometry from TurtleBot3's `wheels`, under our names; empty for other files.

    `block`: all parameters of a node.
    """
    wheels = block.get(TURTLEBOT)
    if not isinstance(wheels, Mapping):
        return {}
    return {ours: wheels[theirs] for theirs, ours in _TURTLEBOT.items() if theirs in wheels}
