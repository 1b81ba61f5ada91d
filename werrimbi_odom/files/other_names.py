# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Names of other drivers' parameter files, which a robot file may begin as, and what they are here.

diff_drive_controller (ros2_controllers) names the geometry as we do; the rest of its parameters are
about commands, and mean nothing to odometry from counts. TurtleBot3 names it otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping

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
_TURTLEBOT = {"separation": "wheel_separation", "radius": "wheel_radius"}


def is_of_diff_drive(name: object) -> bool:
    """Whether it is a parameter of that controller which is not needed here; also with dots."""
    return isinstance(name, str) and name.partition(".")[0] in OF_DIFF_DRIVE


def remark_on(names: Iterable[str]) -> tuple[str, ...]:
    """What is said of names that are not needed; nothing where there are none."""
    listed = ", ".join(names)
    return (f"of {DIFF_DRIVE}; not needed here: {listed}",) if listed else ()


def translated(block: object) -> str:
    """What to write in the place of TurtleBot3's `wheels`; "" where it is another block."""
    if not isinstance(block, Mapping) or not set(block) & set(_TURTLEBOT):
        return ""
    lines = (f"{ours}: {block[theirs]}" for theirs, ours in _TURTLEBOT.items() if theirs in block)
    return f"wheels is of TurtleBot3's driver; write in its place {' and '.join(lines)}"
