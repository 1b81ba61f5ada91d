# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Names of other drivers' parameter files, which a robot file may begin as, and what they are here.

diff_drive_controller (ros2_controllers) names the geometry as we do; the rest of its parameters are
about commands, and mean nothing to odometry. TurtleBot3 names it otherwise. Neither says how many
counts a turn has, for their wheels' positions come in radians.
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
        "publish_limited_velocity",
        "publish_rate",
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
"""Its own names, over its versions; `linear` and `angular` are blocks."""

TURTLEBOT = "wheels"
"""Block of TurtleBot3's file that holds the geometry."""
OF_TURTLEBOT = frozenset(("motors", "opencr", "sensors"))
"""Its other blocks."""
_TURTLEBOT = {"separation": "wheel_separation", "radius": "wheel_radius"}


def is_of_diff_drive(name: object) -> bool:
    """Whether it is a parameter of that controller which is not needed here; also with dots."""
    return isinstance(name, str) and name.partition(".")[0] in OF_DIFF_DRIVE


def remark_on(names: Iterable[str], whose: str = DIFF_DRIVE) -> tuple[str, ...]:
    """What is said of names that are not needed; nothing where there are none."""
    listed = ", ".join(names)
    return (f"of {whose}; not needed here: {listed}",) if listed else ()


def translated(block: Mapping[Any, Any]) -> dict[str, Any]:
    """What TurtleBot3's `wheels` holds, by our names; empty where it is not its file.

    Parameters
    ----------
    block
        All parameters of a node.
    """
    wheels = block.get(TURTLEBOT)
    if not isinstance(wheels, Mapping):
        return {}
    return {ours: wheels[theirs] for theirs, ours in _TURTLEBOT.items() if theirs in wheels}
