# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""~/status, ~/pieces and /diagnostics, as a person or RViz sees them; ~/reset and set_pose."""

from __future__ import annotations

import math
import time
from collections import Counter
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from visualization_msgs.msg import Marker

from test.ros.messages import PLANE, in_plane, values_of, yaw_of

TICK = 2.0 * math.pi * 0.05 / 2000.0
LINE = [(100, 50)] * 60
SPIN = [(-35, 17.5)] * 50  # 90 degrees
ARC = [(100, 40)] * 60


@pytest.fixture(scope="module")
def status(node: Any) -> list[Any]:
    return node.keep(DiagnosticStatus, "odom_node/status")


def told_since_now(node: Any, status: list[Any]) -> None:
    """Until a status has come that was made from now on."""
    before = len(status)
    node.until(lambda: len(status) >= before + 2, "status")


def test_status_is_plain_to_read(node: Any, status: list[Any]) -> None:
    node.reset()
    node.drive(LINE)
    told_since_now(node, status)
    values = values_of(status[-1])
    assert status[-1].name == "odom_node: estimate"
    assert status[-1].message == (
        "line 0.94 m; 0.94 m driven; 1 sigma 0.3 mm along, 1.1 mm across, 0.11 deg"
    )
    assert values["piece"] == "line"
    assert values["piece length"] == values["distance"] == values["x"] == "0.942 m"
    assert values["piece turn"] == values["heading"] == "0.0 deg"
    assert values["piece radius"] == "straight"
    node.drive(SPIN)
    told_since_now(node, status)
    values = values_of(status[-1])
    assert status[-1].message.startswith("spin 90.0 deg to the left; 0.94 m driven; 1 sigma ")
    assert values["piece"] == "spin"
    assert values["piece turn"] == values["heading"] == "90.0 deg"
    # The robot has turned: what was across the path is now along its heading.
    assert values["1 sigma along"] == "1.1 mm"
    assert values["1 sigma across"] == "0.4 mm"


def test_status_comes_five_times_a_second(node: Any, status: list[Any]) -> None:
    told_since_now(node, status)
    before, since = len(status), time.monotonic()
    node.until(lambda: len(status) >= before + 10, "ten of them", 10.0)
    assert time.monotonic() - since == pytest.approx(2.0, abs=0.6)


def test_diagnostics_say_the_rates(node: Any) -> None:
    """Over an interval in which messages come at 50 Hz."""
    node.report()
    reports = len(node.diagnostics)
    while len(node.diagnostics) == reports:
        node.step(10, 5)
        node.rest(0.02)
    status = node.diagnostics[-1]
    assert status.level == DiagnosticStatus.OK
    rates = {k: float(v.split()[0]) for k, v in values_of(status).items() if "rate" in k}
    assert 25.0 < rates["input rate"] <= 50.0
    assert rates["output rate"] == rates["input rate"]
    assert status.message == f"{rates['input rate']} Hz in, {rates['output rate']} Hz out"


@pytest.fixture(scope="module")
def driven(node: Any) -> dict[tuple[str, int], Any]:
    """Markers on display after a line, a spin and an arc, all of them finished."""
    display: dict[tuple[str, int], Any] = {}
    node.reset()
    arrays = node.pieces()
    node.rest(0.5)
    node.drive(LINE + SPIN + ARC + [(-100, -40)] * 10)
    node.rest(1.2)
    show(display, arrays)
    return display


def show(display: dict[tuple[str, int], Any], arrays: list[Any]) -> None:
    """What RViz does with marker arrays."""
    for array in arrays:
        for marker in array.markers:
            if marker.action == Marker.DELETEALL:
                display.clear()
            elif marker.action == Marker.DELETE:
                del display[(marker.ns, marker.id)]
            else:
                display[(marker.ns, marker.id)] = marker


def longest(display: dict[tuple[str, int], Any], kind: str) -> Any:
    """The path marker of a kind with the most to it."""
    return max(
        (marker for (namespace, _), marker in display.items() if namespace == kind),
        key=lambda marker: path_length(marker.points),
    )


def path_length(points: list[Any]) -> float:
    return sum(math.dist((a.x, a.y), (b.x, b.y)) for a, b in pairwise(points))


def test_each_kind_has_its_colour_and_its_true_path(driven: dict[tuple[str, int], Any]) -> None:
    line, arc, spin = (longest(driven, kind) for kind in ("line", "arc", "spin"))
    colours = {(m.color.r, m.color.g, m.color.b) for m in (line, arc, spin)}
    assert len(colours) == 3
    assert all(m.type == Marker.LINE_STRIP for m in (line, arc, spin))
    assert all(m.header.frame_id == "odom" for m in (line, arc, spin))
    assert path_length(line.points) == pytest.approx(6000 * TICK, rel=0.03)
    way, turn = 0.5 * (6000 + 4800) * TICK, (4800 - 6000) * TICK / 0.35
    assert path_length(arc.points) == pytest.approx(way, rel=0.03)
    assert len(arc.points) >= abs(turn) / 0.1
    centre = (line.points[-1].x, line.points[-1].y)
    radii = [math.dist(centre, (point.x, point.y)) for point in spin.points]
    assert radii == pytest.approx([0.175] * len(radii), abs=0.01)


def test_each_piece_ends_in_its_ellipse(driven: dict[tuple[str, int], Any]) -> None:
    line = longest(driven, "line")
    ellipse = driven[("line ellipse", line.id)]
    assert ellipse.type == Marker.CYLINDER
    end = line.points[-1]
    assert (ellipse.pose.position.x, ellipse.pose.position.y) == pytest.approx((end.x, end.y))
    # 95 % of a normal vector lies within 2.448 sigma; across a line sigma is 1.1 mm here.
    assert ellipse.scale.x == pytest.approx(2 * 2.448 * 1.095e-3, rel=0.05)
    assert ellipse.scale.y < ellipse.scale.x
    across = yaw_of(ellipse.pose)
    assert abs(math.sin(across)) == pytest.approx(1.0, abs=0.05)


def test_the_open_piece_is_shown_too(driven: dict[tuple[str, int], Any]) -> None:
    path = driven[("open", 0)]
    assert path_length(path.points) == pytest.approx(900 * TICK, rel=0.2)
    assert ("open ellipse", 0) in driven


def test_the_number_of_markers_is_bounded_and_a_late_viewer_sees_them_all(
    launch: Callable[..., Any], robot: dict[str, Any]
) -> None:
    node = launch(robot).begin()
    early = node.pieces()
    node.rest(0.5)
    node.drive([(100, 50), (200, 100), (-100, -50), (-200, -100)] * 130)  # 260 reversals
    node.rest(0.5)
    display: dict[tuple[str, int], Any] = {}
    show(display, early)
    paths = {key: marker for key, marker in display.items() if key[0] in ("line", "arc", "spin")}
    assert len(paths) == 200
    assert len(display) <= 2 * 201
    newest = max(number for _, number in paths)
    assert newest == 258
    late = node.keep(type(early[0]), "odom_node/pieces")
    node.until(lambda: any(each.markers for each in late), "the pieces again")
    node.rest(1.0)
    again: dict[tuple[str, int], Any] = {}
    show(again, late)
    assert {key for key in again if key[0] != "open"} >= set(paths)
    node.reset()
    node.rest(0.3)
    show(again, late)
    assert not [key for key in again if key[0] in ("line", "arc", "spin")]


COVARIANCE = np.array([[0.04, 0.01, 0.002], [0.01, 0.09, -0.003], [0.002, -0.003, 0.01]])


def pose_message(covariance: np.ndarray = COVARIANCE, **changes: float) -> Any:
    """At (2, -1), heading north, in odom."""
    message = PoseWithCovarianceStamped()
    message.header.frame_id = "odom"
    values = {"x": 2.0, "y": -1.0, "qx": 0.0, "qz": math.sqrt(0.5), "qw": math.sqrt(0.5)} | changes
    pose = message.pose.pose
    pose.position.x, pose.position.y = values["x"], values["y"]
    pose.orientation.x, pose.orientation.z = values["qx"], values["qz"]
    pose.orientation.w = values["qw"]
    whole = np.zeros((6, 6))
    whole[PLANE] = covariance
    message.pose.covariance = whole.ravel()
    return message


def test_reset_sets_everything_to_zero(node: Any) -> None:
    node.drive([(100, 50)] * 30 + [(0, 50)] * 10)
    node.reset()
    message = node.drive([(0, 0)])
    assert (message.pose.pose.position.x, message.pose.pose.position.y) == (0.0, 0.0)
    assert message.pose.pose.orientation.w == 1.0
    assert not in_plane(message.pose.covariance).any()


def test_set_pose_goes_on_from_there(node: Any) -> None:
    node.drive([(100, 50)] * 30)
    node.set_pose(pose_message())
    message = node.drive([(0, 0)])
    position = message.pose.pose.position
    assert (position.x, position.y) == (2.0, -1.0)
    assert yaw_of(message.pose.pose) == pytest.approx(0.5 * math.pi)
    got = in_plane(message.pose.covariance)
    np.testing.assert_allclose(got, COVARIANCE, rtol=1e-9)
    message = node.drive([(2000, 1000)])
    way = 2.0 * math.pi * 0.05
    assert message.pose.pose.position.y == pytest.approx(-1.0 + way, abs=1e-9)
    carried = np.array([[1.0, 0.0, -way], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    got = in_plane(message.pose.covariance)
    np.testing.assert_allclose(got, carried @ COVARIANCE @ carried.T, atol=1e-5)


INDEFINITE = np.diag([0.01, -0.01, 0.01])
LOPSIDED = COVARIANCE + np.array([[0, 0.01, 0], [0, 0, 0], [0, 0, 0]])
HIDDEN_NEGATIVE = np.diag([1e6, 1.0, -1e-4])  # small beside the largest entry, but not to a heading
HIDDEN_TOO_CLOSE = np.array([[1e10, 0.0, 0.0], [0.0, 1.0, 2.0], [0.0, 2.0, 1.0]])
TOO_CLOSE = np.array([[0.01, 0.02, 0.0], [0.02, 0.01, 0.0], [0.0, 0.0, 0.01]])

REFUSED = {
    "frame": (pose_message(), "wrong frame"),
    "nan": (pose_message(x=math.nan), "pose not finite"),
    "infinite": (pose_message(y=math.inf), "pose not finite"),
    "far": (pose_message(x=1e13), "pose out of range"),
    "nan_quaternion": (pose_message(qw=math.nan), "pose not finite"),
    "no_rotation": (pose_message(qz=0.0, qw=0.0), "orientation not a rotation"),
    "tilted": (pose_message(qx=0.5, qz=0.5, qw=math.sqrt(0.5)), "orientation not planar"),
    "nan_covariance": (pose_message(COVARIANCE * math.nan), "covariance not finite"),
    "huge_covariance": (pose_message(COVARIANCE * 1e30), "covariance out of range"),
    "asymmetric": (pose_message(LOPSIDED), "covariance not symmetric"),
    "negative": (pose_message(INDEFINITE), "covariance not positive semi-definite"),
    "indefinite": (pose_message(TOO_CLOSE), "covariance not positive semi-definite"),
    "beside_a_large_one": (pose_message(HIDDEN_NEGATIVE), "covariance not positive semi-definite"),
    "correlation_of_2": (pose_message(HIDDEN_TOO_CLOSE), "covariance not positive semi-definite"),
    "long_quaternion": (pose_message(qz=1e200, qw=0.0), "orientation not a rotation"),
    "long_tilted": (pose_message(qx=1e200, qz=0.0, qw=0.0), "orientation not a rotation"),
}
REFUSED["frame"][0].header.frame_id = "map"
# Half of what set_pose keeps for a busy node: more at once and DDS may rightly drop the oldest.
QUEUE = 5


@pytest.fixture(scope="module")
def counts_after_all(node: Any) -> dict[str, int]:
    """Counts once every pose above has been sent; none of them has moved the robot."""
    node.reset()
    for sent, (message, _) in enumerate(REFUSED.values(), start=1):
        node.send(PoseWithCovarianceStamped, "set_pose", message)
        if sent % QUEUE == 0 or sent == len(REFUSED):
            node.counted(Counter(), refused_set_pose=sent)
    assert node.drive([(0, 0)]).pose.pose.position.x == 0.0
    return node.counts()


@pytest.mark.parametrize("case", REFUSED)
def test_a_pose_that_cannot_be_set(node: Any, counts_after_all: dict[str, int], case: str) -> None:
    cause = REFUSED[case][1]
    same = sum(cause == other for _, other in REFUSED.values())
    assert counts_after_all[f"refused set_pose: {cause}"] == same
    assert node.stderr().count(f"set_pose refused: {cause}: ") == 1
