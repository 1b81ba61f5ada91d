# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The robot file at start-up, and changes at run time, on the real node."""

from __future__ import annotations

import math
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.evidence import in_evidence

pytest.importorskip("rclpy")

from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters

from werrimbi_odom.effects import find, lookup
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.parameters import PARAMETERS, VIRTUAL_TICKS_PER_REVOLUTION
from werrimbi_odom.ros.odom_parameters import CHANGEABLE, settings_of

Robot = dict[str, Any]
Refused = Callable[..., str]

BARE = {"wheel_separation": 0.35, "wheel_radius": 0.05}


# ------------------------------------------------------------------------ at start-up


def test_all_that_is_missing_is_named_with_the_place_to_write_it(refused: Refused) -> None:
    assert refused({"position_unit": "ticks"}) == (
        "missing: wheel_separation (m), wheel_radius (m), left_ticks_per_revolution (ticks), "
        "right_ticks_per_revolution (ticks); write them under ros__parameters of odom_node "
        "(or of /**) in the file given with --params-file"
    )


def test_an_unknown_key_names_the_nearest_known_one(refused: Refused) -> None:
    words = refused(BARE | {"wheel_seperation": 0.35})
    assert words == "unknown parameter wheel_seperation; the nearest known one is wheel_separation"


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"wheel_radius": -0.05}, "wheel_radius must be a number greater than 0 (m), not -0.05"),
        in_evidence({"wheel_radius": "5 cm"}, "wheel_radius must be a number (m), not '5 cm'"),
        ({"encoder_bits": 65}, "encoder_bits must be a whole number of at most 64 (bits), not 65"),
        in_evidence({"enable_odom_tf": "yes please"}, "enable_odom_tf must be true or false"),
        ({"left_wheel_names": [1, 2]}, "left_wheel_names must be a list of names"),
        ({"effects": ["drift"]}, "unknown effect drift; the nearest known one is radius_drift"),
        ({"enable_odom_tf": True}, "enable_odom_tf needs tf2_ros, which is not installed here"),
        ({"slip_imu_topic": "1imu"}, "'1imu' is not the name of a topic: topic name token must"),
        ({"use_sim_time": 3}, "'use_sim_time'"),
        in_evidence(
            {"qos_overrides": {"/joint_states": {"subscription": {"depth": "deep"}}}},
            "QoS override of joint_states",
        ),
        (
            {"qos_overrides": {"/odom": {"publisher": {"reliability": "perhaps"}}}},
            "QoS override of odom",
        ),
    ],
    ids=lambda value: next(iter(value)) if isinstance(value, dict) else "",
)
def test_a_wrong_value_is_refused(refused: Refused, wrong: Robot, words: str) -> None:
    assert words in refused(BARE | wrong)


def test_a_file_that_is_no_yaml(refused: Refused, tmp_path: Path) -> None:
    file = tmp_path / "broken.yaml"
    file.write_text("odom_node: [", encoding="utf-8")
    assert "broken.yaml" in refused(BARE, "--params-file", str(file), of_rcl=True)


@pytest.fixture
def refused(run_node: Callable[..., subprocess.CompletedProcess[str]]) -> Refused:
    """Start a node that must refuse: what it says in its one line."""

    def run(robot: Robot, *arguments: str, of_rcl: bool = False) -> str:
        done = run_node(robot, *arguments)
        assert done.returncode == 2, done.stderr
        assert "Traceback" not in done.stderr
        lines = done.stderr.splitlines()
        if of_rcl:  # which says its own line before ours
            return lines[-1]
        assert len(lines) == 1, done.stderr
        assert lines[0].startswith("[FATAL]")
        return lines[0].split("[odom_node]: ")[1]

    return run


def test_everything_wrong_is_said_at_once() -> None:
    with pytest.raises(InputError) as error:
        settings_of({"wheel_radius": -1.0, "wheel_with": 2.0})
    for words in ("wheel_radius must be", "unknown parameter wheel_with", "missing: wheel_sep"):
        assert words in str(error.value)


def test_a_joint_is_of_one_side() -> None:
    with pytest.raises(InputError, match="wheel is in left_wheel_names and in right_wheel_names"):
        settings_of({**BARE, "left_wheel_names": ["wheel"], "right_wheel_names": ["wheel", "b"]})


def test_whole_numbers_and_an_empty_list_of_effects_are_taken() -> None:
    """2000 arrives as an integer, [] as a parameter that is not set."""
    values = settings_of({**BARE, "wheel_separation": 1, "effects": None}).values
    assert values["wheel_separation"] == 1.0
    assert isinstance(values["wheel_separation"], float)
    assert values["left_ticks_per_revolution"] == VIRTUAL_TICKS_PER_REVOLUTION


def test_ticks_may_be_left_out_on_both_sides_only_and_without_wrapping() -> None:
    with pytest.raises(InputError, match=r"missing: right_ticks_per_revolution \(ticks\)"):
        settings_of({**BARE, "left_ticks_per_revolution": 2000.0})
    with pytest.raises(InputError, match="encoder_bits needs left_ticks_per_revolution"):
        settings_of({**BARE, "encoder_bits": 16})


def test_everything_wrong_with_effects_is_said_at_once_too() -> None:
    with pytest.raises(InputError) as error:
        settings_of(
            {
                **BARE,
                "effects": ["lateral_slip", "wheels_swapped"],
                "lateral_slip.crep": 0.01,
                "lateral_slip.creep": 5.0,
                "wheels_swapped": True,
                "castor_kick.angle": 0.1,
                "encoder_bit": 8,
            }
        )
    for words in (
        "lateral_slip has no parameter crep; it has creep",
        "lateral_slip.creep must be a number of at most 0.1 (s), not 5.0",
        "wheels_swapped has no parameters; take this line out",
        "this is a block of parameters for castor_kick, but effects does not list castor_kick",
        "unknown parameter encoder_bit; the nearest known one is encoder_bits",
    ):
        assert words in str(error.value)


def test_effects_come_with_their_values_and_what_is_not_given_is_unknown() -> None:
    names = ["eccentric_left_wheel", "radius_drift"]
    amplitude = {"eccentric_left_wheel.amplitude": 1e-3}
    wheel, drift = settings_of({**BARE, "effects": names, **amplitude}).effects
    assert wheel.values["amplitude"] == 1e-3
    assert wheel.unknown == ("phase",)
    assert drift == find("radius_drift").using()


def test_an_empty_block_is_a_block() -> None:
    """{} arrives as a parameter that is not set."""
    (slip,) = settings_of({**BARE, "effects": ["lateral_slip"], "lateral_slip": None}).effects
    assert slip == find("lateral_slip").using()


def test_an_effect_that_needs_a_channel_does_not_run_live(monkeypatch: pytest.MonkeyPatch) -> None:
    slip = find("lateral_slip")
    fed = replace(slip, name="fed_slip", channels=("payload_kg",))
    monkeypatch.setattr(lookup, "LIBRARY", (fed,))
    with pytest.raises(InputError, match="effect fed_slip looks at the measured channel payload_"):
        settings_of({**BARE, "effects": ["fed_slip"]})


# ------------------------------------------------------------------------ at run time


def test_the_table_is_declared_with_words_and_ranges(node: Any) -> None:
    names = [item.name for item in PARAMETERS]
    listed = node.call(
        ListParameters, "odom_node/list_parameters", ListParameters.Request()
    ).result.names
    assert set(names) < set(listed)
    described = node.call(
        DescribeParameters, "odom_node/describe_parameters", DescribeParameters.Request(names=names)
    ).descriptors
    for item, descriptor in zip(PARAMETERS, described, strict=True):
        assert descriptor.description.startswith(item.says)
        assert descriptor.read_only == (item.name not in CHANGEABLE)
        assert bool(descriptor.floating_point_range) == (item.kind == "float")
    values = node.call(
        GetParameters, "odom_node/get_parameters", GetParameters.Request(names=names)
    ).values
    assert len(values) == len(names), "so that `ros2 param dump` works"


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("wheel_radius", -0.05, "wheel_radius"),
        ("wheel_radius", 0.0, "wheel_radius must be a number greater than 0 (m), not 0.0"),
        ("wheel_radius", math.nan, "wheel_radius"),
        ("wheel_radius", "thick", "Wrong parameter type"),
        ("left_wheel_noise", -1e-9, "left_wheel_noise"),
        ("encoder_bits", 16, "read-only parameter: encoder_bits"),
        ("left_ticks_per_revolution", 100.0, "read-only parameter: left_ticks_per_revolution"),
        ("odom_frame_id", "map", "read-only parameter: odom_frame_id"),
        ("wheel_with", 1.0, "undeclared parameter"),
        ("wheel_separation", 1e-160, "wheel_separation times wheel_separation_multiplier must be"),
        ("wheel_separation", 1e-300, "wheel_separation times wheel_separation_multiplier must be"),
        ("wheel_separation", 5e-324, "must be from 1e-09 to 1e+09 m, it is 4.94066e-324 m"),
        ("wheel_radius", 1e155, "wheel_radius times left_wheel_radius_multiplier must be"),
        ("wheel_radius", 1e300, "wheel_radius times left_wheel_radius_multiplier must be"),
        ("left_wheel_noise", 1e160, "left_wheel_noise must be at most 1000"),
        ("left_wheel_radius_multiplier", 1e308, "must be from 1e-09 to 1e+09 m"),
    ],
)
def test_a_change_is_refused_with_its_reason(
    node: Any, name: str, value: object, reason: str
) -> None:
    result = node.set_parameters(**{name: value})
    assert not result.successful
    assert reason in result.reason
    message = node.drive([(20, 10), (20, 11)])
    assert np.isfinite(message.pose.covariance).all()


def test_a_change_moves_nothing_that_was_driven(node: Any, robot: Robot) -> None:
    """Only what follows is reckoned with the new values; no count is lost between."""
    node.reset()
    before = node.drive([(100, 50)] * 20 + [(40, 50)] * 10)
    counts = node.counts()
    result = node.set_parameters(wheel_radius=0.1, wheel_separation=1, left_wheel_noise=0.0)
    assert result.successful, result.reason
    try:
        at_rest = node.drive([(0, 0)])
        assert at_rest.pose.pose == before.pose.pose
        np.testing.assert_allclose(at_rest.pose.covariance, before.pose.covariance, rtol=1e-9)
        after = node.drive([(200, 100)])
        dx = after.pose.pose.position.x - before.pose.pose.position.x
        dy = after.pose.pose.position.y - before.pose.pose.position.y
        assert math.hypot(dx, dy) == pytest.approx(200 * 2 * math.pi * 0.1 / 2000, rel=1e-9)
        left, right = (2 * math.pi * 0.1 * n / per for n, per in ((200, 2000), (160, 1000)))
        turned = node.drive([(200, 160)])
        assert turned.twist.twist.angular.z == pytest.approx((right - left) / 1.0 / 0.02, rel=1e-9)
        node.report()  # of all that was driven
        assert all(node.counts()[each] == counts[each] for each in ("resets", "jumps"))
    finally:
        old = {name: robot[name] for name in ("wheel_radius", "wheel_separation")}
        assert node.set_parameters(**old, left_wheel_noise=4.0e-4).successful


def test_a_calibration_is_taken_or_refused_whole(node: Any) -> None:
    result = node.set_parameters(wheel_separation_multiplier=2.0, wheel_radius=-1.0)
    assert not result.successful
    node.reset()
    message = node.drive([(0, 0), (-200, 100)])
    turn = 2.0 * math.pi * 0.05 * 0.2 / 0.35
    assert message.pose.pose.orientation.z == pytest.approx(math.sin(0.5 * turn), abs=1e-9)
