# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Draws what RViz is given to show, without RViz: displays of rviz/simulated.rviz, from above.

    python docs/make_rviz_picture.py

A robot with wheels farther apart than its file says drives a square; the topics, colours and
namespaces are read from RViz's own file, the messages are those that the nodes published.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import rclpy
from geometry_msgs.msg import PoseStamped
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse, FancyArrow, Patch
from matplotlib.ticker import MultipleLocator
from nav_msgs.msg import Odometry
from rclpy.qos import DurabilityPolicy, QoSProfile
from ruamel.yaml import YAML
from visualization_msgs.msg import Marker, MarkerArray

from werrimbi_odom.demo.node_processes import Stage

ROOT = Path(__file__).parents[1]
DISPLAYS = ROOT / "rviz" / "simulated.rviz"
PICTURE = ROOT / "docs" / "pictures" / "rviz.png"
GROUND = "#fafafa"
LINES, ELLIPSES = 2, 3
"""What lies above what: all of it is on the floor."""
KINDS = {"MarkerArray": MarkerArray, "Marker": Marker, "Odometry": Odometry, "Pose": PoseStamped}
"""Displays that listen to a topic; the grid does not, and /tf is left out."""
PACE = 0.5
"""Simulated seconds in a second, so that a busy machine keeps up."""
ROBOT = {"hide": "track_width=1.05", "publish_clock": True, "real_time_factor": PACE}
DRIVE: dict[str, object] = {
    "manoeuvre": "umbmark_ccw",
    "length": 2.0,
    "area_radius": 4.0,
    "max_vel_x": 0.6,
    "max_vel_theta": 1.4,
    "acc_lim_x": 1.0,
    "odom_timeout": 2.0,
    "max_deviation": 1.0,
}


class Shown:
    """What a display holds: markers by namespace and number, or the last message."""

    def __init__(self, display: Any) -> None:
        self.display = display
        self.kind = str(display["Class"]).rpartition("/")[2]
        self.markers: dict[tuple[str, int], Any] = {}
        self.last: Any = None

    def take(self, message: Any) -> None:
        """As RViz does: add, replace, delete."""
        self.last = message
        for marker in getattr(message, "markers", [message] if self.kind == "Marker" else []):
            if marker.action == Marker.DELETEALL:
                self.markers.clear()
            elif marker.action == Marker.DELETE:
                self.markers.pop((marker.ns, marker.id), None)
            else:
                self.markers[marker.ns, marker.id] = marker

    def draw(self, axes: Axes) -> None:
        """As RViz draws it from above, each kind of thing with a label."""
        name, wanted = self.display["Name"], self.display.get("Namespaces", {})
        for (namespace, _), marker in self.markers.items():
            if wanted.get(namespace, not wanted):
                # What is still open has the colour of its kind.
                of_kind = "" if namespace == "open" else f"Driven: a {namespace}"
                _marker(axes, marker, of_kind if wanted else name)
        if self.kind == "Odometry":
            _position(axes, self.last.pose.covariance, self.last.pose.pose, self.display)
            _arrow(axes, self.last.pose.pose, self.display["Shape"], name)
        elif self.kind == "Pose":
            _arrow(axes, self.last.pose, self.display, name)


def _marker(axes: Axes, marker: Any, label: str) -> None:
    of = marker.color
    colour, place = (of.r, of.g, of.b), marker.pose.position
    if marker.type == Marker.LINE_STRIP:
        x, y = [point.x for point in marker.points], [point.y for point in marker.points]
        pixels = axes.transData.transform([(0.0, 0.0), (marker.scale.x, 0.0)])
        points = (pixels[1, 0] - pixels[0, 0]) * 72.0 / axes.figure.get_dpi()
        axes.plot(x, y, color=colour, alpha=of.a, linewidth=points, zorder=LINES, label=label)
    elif marker.type == Marker.CYLINDER:
        angle = math.degrees(_yaw(marker.pose))
        size = marker.scale.x, marker.scale.y
        shape = Ellipse((place.x, place.y), *size, angle=angle, color=colour, alpha=of.a)
        axes.add_patch(shape).set_zorder(ELLIPSES)
    else:
        raise ValueError(f"a marker of type {marker.type} has no drawing here")


def _position(axes: Axes, covariance: Any, pose: Any, display: Any) -> None:
    shown = display["Covariance"]["Position"]
    variances, vectors = np.linalg.eigh(np.reshape(covariance, (6, 6))[:2, :2])
    width, height = 2.0 * shown["Scale"] * np.sqrt(variances)
    angle = math.degrees(math.atan2(vectors[1, 0], vectors[0, 0]))
    place, colour = (pose.position.x, pose.position.y), _colour(shown["Color"])
    shape = Ellipse(place, width, height, angle=angle, color=colour, alpha=shown["Alpha"])
    axes.add_patch(shape).set_zorder(ELLIPSES)


def _arrow(axes: Axes, pose: Any, shape: Any, label: str) -> None:
    length, yaw = shape["Shaft Length"] + shape["Head Length"], _yaw(pose)
    arrow = FancyArrow(
        pose.position.x,
        pose.position.y,
        length * math.cos(yaw),
        length * math.sin(yaw),
        width=2.0 * shape["Shaft Radius"],
        head_width=2.0 * shape["Head Radius"],
        head_length=shape["Head Length"],
        length_includes_head=True,
        color=_colour(shape["Color"]),
        label=label,
    )
    axes.add_patch(arrow).set_zorder(LINES)


def _yaw(pose: Any) -> float:
    return 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)


def _colour(words: str) -> list[float]:
    return [int(each) / 255.0 for each in words.split(";")]


def displays() -> list[Any]:
    """Of RViz's file, those that are switched on."""
    there = YAML(typ="safe").load(DISPLAYS.read_text(encoding="utf-8"))
    return [each for each in there["Visualization Manager"]["Displays"] if each["Enabled"]]


def driven() -> list[Shown]:
    """A drive, and what each display then holds."""
    shown = [Shown(each) for each in displays() if each["Class"].rpartition("/")[2] in KINDS]
    with Stage() as stage:
        viewer = rclpy.create_node("viewer")
        for each in shown:
            topic = each.display["Topic"]
            latched = topic["Durability Policy"] == "Transient Local"
            kept = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
            qos = QoSProfile(depth=topic["Depth"], durability=kept)
            viewer.create_subscription(KINDS[each.kind], topic["Value"], each.take, qos)

        def ended() -> bool:
            for _ in range(20):
                rclpy.spin_once(viewer, timeout_sec=0.0)
            return stage.told("drive_node: drive").startswith(("done", "stopped"))

        stage.start("simulated_robot", ROBOT)
        stage.start("odom_node", params_file=ROOT / "config" / "robot.yaml")
        stage.start("drive_node", DRIVE)
        stage.until(lambda: stage.ask("drive_node/check").success, "robot that could start")
        stage.ask("drive_node/start")
        stage.until(ended, "end of the drive", 240.0 / PACE)
        print(stage.told("drive_node: drive"))
        viewer.destroy_node()
    return shown


def ended_at(shown: Sequence[Shown]) -> tuple[float, float, float]:
    """Middle and half a side of a square with both, where the robot is and where it says to be."""
    poses = [each.last.pose for each in shown if each.kind in ("Odometry", "Pose")]
    places = [getattr(pose, "pose", pose).position for pose in poses]
    x, y = (np.array([getattr(place, axis) for place in places]) for axis in "xy")
    return float(x.mean()), float(y.mean()), 0.5 + 0.5 * float(max(np.ptp(x), np.ptp(y)))


def draw(shown: Sequence[Shown], path: Path) -> None:
    """A PNG, from above: all of it, and where the drive ended."""
    figure = Figure(figsize=(13.0, 7.0), dpi=100, facecolor=GROUND)
    labelled: dict[str, Any] = {}
    for left, title, (x, y, half) in (
        (0.05, "The whole drive", (1.0, 1.0, 1.5)),
        (0.54, "Where it ended", ended_at(shown)),
    ):
        axes = figure.add_axes((left, 0.16, 0.44, 0.78), facecolor=GROUND)
        axes.set(xlim=(x - half, x + half), ylim=(y - half, y + half), aspect="equal")
        axes.set(title=title, xlabel="x [m]", ylabel="y [m]")
        step = 1.0 if half > 1.0 else 0.2
        axes.xaxis.set_major_locator(MultipleLocator(step))
        axes.yaxis.set_major_locator(MultipleLocator(step))
        axes.grid(color="#c8c8c8")  # RViz's own is of 1 m
        axes.set_axisbelow(True)
        for each in reversed(shown):
            each.draw(axes)
        labelled |= dict(zip(*reversed(axes.get_legend_handles_labels()), strict=True))
    of_same_width = [Patch(color=_drawn(handle), label=label) for label, handle in labelled.items()]
    figure.legend(handles=of_same_width, loc="lower center", ncols=3, frameon=False)
    figure.savefig(path)


def _drawn(handle: Any) -> Any:
    """The colour of a line or a patch."""
    return handle.get_facecolor() if isinstance(handle, Patch) else handle.get_color()


def main() -> None:
    """Drive, draw, and say what is on it."""
    shown = driven()
    draw(shown, PICTURE)
    for each in shown:
        names = sorted({namespace for namespace, _ in each.markers})
        print(f"{each.display['Name']}: {each.display['Topic']['Value']} {', '.join(names)}")
    print(PICTURE)


if __name__ == "__main__":
    main()
