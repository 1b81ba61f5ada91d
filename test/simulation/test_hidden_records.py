# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects hidden in the measuring change the records and leave the drive as it was."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import asdict
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom import simulation as sim
from werrimbi_odom.simulation.hidden import Entry
from werrimbi_odom.simulation.hidden.axle_and_reference import (
    DriftingClock,
    ReferenceDelay,
    ReferenceMirrored,
    ReferenceMount,
    WarmingGyro,
)
from werrimbi_odom.simulation.hidden.counters import (
    EncoderSkew,
    MissedTicks,
    WheelReversed,
    WheelsSwapped,
)
from werrimbi_odom.simulation.hidden.geometry import TrackWidth, WheelRadiusScale
from werrimbi_odom.simulation.hidden.skid import SkidSteer
from werrimbi_odom.simulation.sensors import wrap

EXACT = sim.ReferenceSensor(sigma_xy=0.0, sigma_yaw=0.0)
DRIVE = sim.free(12.0, seed=4, speed=0.7)
SHORT = sim.free(5.0, seed=4, speed=0.7)
HOP = sim.moves("hop", [(0.2, 0.3)])


@lru_cache
def plain_run(manoeuvre: sim.Manoeuvre, reference: sim.ReferenceSensor) -> sim.Recording:
    """Nothing hidden."""
    return sim.record(sim.TrueRobot(), manoeuvre, seed=1, reference=reference)


def pair(odd: sim.Peculiarity) -> tuple[sim.Recording, sim.Recording]:
    """The same drive without and with it."""
    plain = plain_run(DRIVE, EXACT)
    odd_one = sim.record(sim.TrueRobot(), DRIVE, seed=1, reference=EXACT, hidden=[odd])
    np.testing.assert_array_equal(plain.true_path.x_m, odd_one.true_path.x_m)
    return plain, odd_one


def at(recording: sim.Recording, times: np.ndarray) -> np.ndarray:
    """True poses (n, 3) at `times`."""
    path = recording.true_path
    columns = (path.x_m, path.y_m, path.yaw_rad)
    return np.column_stack([np.interp(times, path.t_s, column) for column in columns])


def measured(recording: sim.Recording) -> np.ndarray:
    return np.column_stack(
        (recording.reference_x_m, recording.reference_y_m, recording.reference_yaw_rad)
    )


def test_counts_are_lost_at_speed_alone() -> None:
    fraction, above = 0.05, 0.3
    plain, odd = pair(MissedTicks("left", fraction, above))
    np.testing.assert_array_equal(plain.right_ticks, odd.right_ticks)
    lost = plain.left_ticks - odd.left_ticks
    steps = np.diff(plain.left_ticks)
    speed = steps / 2000 * 2 * math.pi * 0.05 / np.diff(plain.t_s)
    slow, fast = np.abs(speed) < 0.27, np.abs(speed) > 0.33
    assert np.abs(np.diff(lost)[slow]).max() <= 1
    assert np.diff(lost)[fast].sum() == pytest.approx(fraction * steps[fast].sum(), rel=0.02)


def test_the_right_counter_is_read_late() -> None:
    plain, odd = pair(EncoderSkew(0.015))
    np.testing.assert_array_equal(plain.left_ticks, odd.left_ticks)
    later = np.interp(plain.t_s + 0.015, plain.t_s, plain.right_ticks)
    assert np.abs(odd.right_ticks - later)[:-1].max() < 4.0
    assert np.abs(odd.right_ticks - plain.right_ticks).max() > 20


def test_a_gyro_that_warms_up_turns_away_faster_and_faster() -> None:
    """Without unrest: as a chip that nears the warmth about it, to either side in a drive."""
    plain, odd = pair(WarmingGyro(5e-4, settles=10.0, unrest=0.0))
    np.testing.assert_array_equal(plain.reference_x_m, odd.reference_x_m)
    np.testing.assert_array_equal(plain.left_ticks, odd.left_ticks)
    off = np.unwrap(odd.reference_yaw_rad - plain.reference_yaw_rad)
    t = odd.reference_t_s
    law = 10.0 * (t - 10.0 * (1.0 - np.exp(-t / 10.0)))
    rate = (law @ off) / (law @ law)
    np.testing.assert_allclose(off, rate * law, atol=1e-3 * np.abs(off).max())
    assert 2.5e-4 < abs(rate) < 7.5e-4


def test_its_bias_walks_besides_and_another_way_in_each_drive() -> None:
    odd = WarmingGyro(1e-4, unrest=3.0)
    runs = [sim.record(sim.TrueRobot(), DRIVE, seed=seed, hidden=[odd]) for seed in (1, 2)]
    plain = [sim.record(sim.TrueRobot(), DRIVE, seed=seed) for seed in (1, 2)]
    ends = [
        math.remainder(float(a.reference_yaw_rad[-1] - b.reference_yaw_rad[-1]), 2 * math.pi)
        for a, b in zip(runs, plain, strict=True)
    ]
    assert abs(ends[0] - ends[1]) > 1e-3


def test_a_marker_off_the_axle() -> None:
    _, odd = pair(ReferenceMount(x=0.1, y=-0.03))
    x, y, yaw = at(odd, odd.reference_t_s).T
    np.testing.assert_allclose(
        odd.reference_x_m, x + 0.1 * np.cos(yaw) + 0.03 * np.sin(yaw), atol=1e-12
    )
    np.testing.assert_allclose(
        odd.reference_y_m, y + 0.1 * np.sin(yaw) - 0.03 * np.cos(yaw), atol=1e-12
    )


def test_a_marker_askew() -> None:
    plain, odd = pair(ReferenceMount(yaw=0.04))
    np.testing.assert_array_equal(plain.reference_x_m, odd.reference_x_m)
    np.testing.assert_allclose(
        wrap(odd.reference_yaw_rad - plain.reference_yaw_rad), 0.04, atol=1e-12
    )


def test_late_stamps() -> None:
    _, odd = pair(ReferenceDelay(delay=0.08))
    expected = at(odd, odd.reference_t_s - 0.08)
    np.testing.assert_allclose(measured(odd)[:, :2], expected[:, :2], atol=1e-12)
    np.testing.assert_allclose(wrap(odd.reference_yaw_rad - expected[:, 2]), 0.0, atol=1e-12)


def test_a_heading_later_than_its_position() -> None:
    plain, odd = pair(ReferenceDelay(heading_delay=0.08))
    np.testing.assert_array_equal(plain.reference_x_m, odd.reference_x_m)
    expected = at(odd, odd.reference_t_s - 0.08)[:, 2]
    np.testing.assert_allclose(wrap(odd.reference_yaw_rad - expected), 0.0, atol=1e-12)


@pytest.mark.parametrize("exchanged", [False, True])
def test_a_mirrored_frame_turns_the_other_way(exchanged: bool) -> None:
    plain, odd = pair(ReferenceMirrored(exchanged))
    turned = np.diff(np.unwrap(plain.reference_yaw_rad))
    np.testing.assert_allclose(np.diff(np.unwrap(odd.reference_yaw_rad)), -turned, atol=1e-9)
    moved = np.diff(odd.reference_x_m) + 1j * np.diff(odd.reference_y_m)
    true = np.diff(plain.reference_x_m) + 1j * np.diff(plain.reference_y_m)
    np.testing.assert_allclose(moved, (1j if exchanged else 1) * np.conj(true), atol=1e-12)
    ahead = np.exp(1j * odd.reference_yaw_rad[:-1])
    true_ahead = np.exp(1j * plain.reference_yaw_rad[:-1])
    np.testing.assert_allclose((moved / ahead).real, (true / true_ahead).real, atol=1e-12)


def test_wiring() -> None:
    plain, odd = pair(WheelsSwapped())
    np.testing.assert_array_equal(plain.left_ticks, odd.right_ticks)
    np.testing.assert_array_equal(plain.right_ticks, odd.left_ticks)
    plain, odd = pair(WheelReversed("right"))
    np.testing.assert_array_equal(plain.right_ticks, -odd.right_ticks)
    np.testing.assert_array_equal(plain.left_ticks, odd.left_ticks)


@pytest.mark.parametrize(
    ("odd", "key", "value"),
    [
        (WheelRadiusScale(0.5), "wheel_radius", 0.1),
        (WheelRadiusScale(0.001), "wheel_radius", 50.0),
        (TrackWidth(2.0), "wheel_separation", 0.175),
    ],
)
def test_a_simple_factor_is_a_slip_of_the_pen(
    odd: sim.Peculiarity, key: str, value: float, tmp_path: Path
) -> None:
    """The diameter for the radius, millimetres, half the base: in the file, not in the workshop."""
    plain, odd_one = pair(odd)
    np.testing.assert_array_equal(plain.left_ticks, odd_one.left_ticks)
    text = sim.write_robot_file(odd.written(sim.TrueRobot()), tmp_path / "robot.yaml").read_text(
        "utf-8"
    )
    line = next(line for line in text.splitlines() if line.strip().startswith(f"{key}:"))
    assert float(line.split(":")[1].split("#")[0]) == pytest.approx(value)


@pytest.mark.parametrize("entry", sim.CATALOGUE, ids=lambda entry: entry.name)
def test_everything_in_the_catalogue_can_be_hidden(entry: Entry) -> None:
    """At its weakest and strongest, and it changes what is recorded."""
    hidden = sim.hide(entry.name, seed=3)
    assert entry.low * 0.999 <= abs(hidden.strength - entry.null) <= entry.high * 1.001
    plain = plain_run(HOP, sim.ReferenceSensor())
    for strength in (entry.null + entry.low, entry.null + entry.high):
        odd = sim.hide(entry.name, strength, seed=3).peculiarity
        run = sim.record(sim.TrueRobot(), HOP, seed=1, hidden=[odd])
        assert np.isfinite(run.reference_x_m).all()
        assert asdict(odd) is not None
        same_ticks = np.array_equal(run.right_ticks, plain.right_ticks) and np.array_equal(
            run.left_ticks, plain.left_ticks
        )
        same_reference = np.array_equal(measured(run), measured(plain))
        same_reference &= np.array_equal(run.reference_t_s, plain.reference_t_s)
        acts_later = entry.name in {
            "castor_kick", "slippery_spot", "left_backlash", "one_tyre_backwards",
                "left_tread_bump", "right_tread_bump",  # once in a turn
        }  # fmt: skip
        acts_later |= entry.kind == "event"  # now and then, in a drive that is long enough
        at_speed = entry.name.endswith("missed_ticks")
        assert not (same_ticks and same_reference) or acts_later or at_speed


def test_a_heading_drifts_also_by_a_clock_that_is_behind() -> None:
    """The reference's stamps then begin before the drive does."""
    plain = plain_run(HOP, sim.ReferenceSensor())
    slow, gyro = DriftingClock(-5e-3), WarmingGyro(1e-4)
    late = slow.recording(plain, sim.TrueRobot(), np.random.default_rng(1))
    assert late.reference_t_s[0] < 0.0
    drifting = gyro.recording(late, sim.TrueRobot(), np.random.default_rng(1))
    assert 0.0 < np.abs(drifting.reference_yaw_rad - plain.reference_yaw_rad).max() < 0.01


@pytest.mark.evidence
@pytest.mark.parametrize(
    "entry", [e for e in sim.CATALOGUE if e.kind not in ("mistake", "robot")], ids=lambda e: e.name
)
def test_no_strength_is_no_effect(entry: Entry) -> None:
    manoeuvre = DRIVE if entry.kind == "event" else SHORT  # in which what is not null would show
    plain = plain_run(manoeuvre, sim.ReferenceSensor())
    odd = sim.hide(entry.name, entry.null, seed=3).peculiarity
    run = sim.record(sim.TrueRobot(), manoeuvre, seed=1, hidden=[odd])
    assert np.abs(run.left_ticks - plain.left_ticks).max() <= 1
    assert np.abs(run.right_ticks - plain.right_ticks).max() <= 1
    np.testing.assert_allclose(run.reference_x_m, plain.reference_x_m, atol=2e-5)
    np.testing.assert_allclose(run.reference_y_m, plain.reference_y_m, atol=2e-5)


def test_the_catalogue_holds_the_vocabulary_of_the_contract() -> None:
    names = {entry.name for entry in sim.CATALOGUE if entry.kind == "effect"}
    assert names == {
        "track_width", "unequal_wheel_radii", "wheel_radius_scale",
        "eccentric_left_wheel", "eccentric_right_wheel",
        "longitudinal_slip", "lateral_slip", "turn_dependent_track", "sideways_drift",
        "floor_slope", "castor_kick", "left_backlash", "right_backlash",
        "left_missed_ticks", "right_missed_ticks", "radius_drift",
        "reference_lever_arm", "reference_yaw_offset", "reference_delay",
        "reference_heading_delay", "encoder_skew",
        "oval_left_wheel", "oval_right_wheel", "radius_by_channel", "tyre_squash",
        "load_transfer", "anisotropic_floor",
        "left_tread_bump", "right_tread_bump", "reference_gyro_drift", "coulomb_slip",
        "reference_clock_drift", "castor_swing",
    }  # fmt: skip
    assert {entry.name for entry in sim.CATALOGUE if entry.kind == "mistake"} == {
        "wheels_swapped", "left_wheel_reversed", "right_wheel_reversed", "reference_mirrored",
    }  # fmt: skip
    assert sum(entry.kind == "outside" for entry in sim.CATALOGUE) >= 3


def test_random_hides_an_effect_of_the_vocabulary() -> None:
    chosen = {sim.hide("random", seed=s).entry.name for s in range(40)}
    assert len(chosen) > 12
    assert sim.hide("random", seed=1) == sim.hide("random", seed=1)


def test_seeds_that_are_written_down_go_on_hiding_what_they_hid() -> None:
    """In README.md and the demo; effects that came later took others."""
    assert [sim.hide("random", seed=s).entry.name for s in (6, 149)] == [
        "castor_kick", "unequal_wheel_radii",
    ]  # fmt: skip


def test_random_hides_every_effect_alike() -> None:
    drawn = Counter(sim.hide("random", seed=s).entry.name for s in range(1000, 2350))
    names = {entry.name for entry in sim.CATALOGUE if entry.kind == "effect"}
    assert set(drawn) == names
    expected = 1350 / len(names)
    chi_squared = sum((count - expected) ** 2 / expected for count in drawn.values())
    assert chi_squared < len(names) - 1 + 3.0 * (2.0 * (len(names) - 1)) ** 0.5


def test_a_name_that_is_not_there() -> None:
    with pytest.raises(sim.UnknownEffectError, match="did you mean castor_kick"):
        sim.hide("caster_kick", seed=1)


def test_four_wheels_without_skid_turn_as_two() -> None:
    odd = sim.wished(["skid_steer=1"], seed=3)[0].peculiarity
    assert isinstance(odd, SkidSteer)
    along, _, turn = odd.spin(0.35)
    assert (along, turn) == (pytest.approx(0.0, abs=1e-5), pytest.approx(2.0 / 0.35))
