# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The information limit is where a score test finds an effect in 95 % of cases, by trying it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import NOISE_XY, NOISE_YAW, run_by, runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import chi2_survival, noncentrality
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.manoeuvres.detection_limits import (
    _best,
    _calibrated,
    _limits,
    _looked_at,
    _typical,
)
from werrimbi_odom.inference.manoeuvres.expected_evidence import Experiment
from werrimbi_odom.model.pose import Floats

TRIED = 60
THREE = (-2.1, 0.0, 2.1)
NOISE = EvaluationOptions(sigma_xy=NOISE_XY, sigma_yaw=NOISE_YAW)


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    return runs_of(ROBOT, (1, 2), 30)


def limits(
    names: tuple[str, ...],
    runs: list[Run],
    options: EvaluationOptions = NOISE,
    power: float = rules.POWER,
) -> dict[str, dict[str, float]]:
    """Distance from null of each parameter, beside calibration and per-run parameters alone."""
    candidates = [_typical(find(name)) for name in names]
    look = _looked_at(drives_of(runs, options), candidates + _calibrated(), ())
    return {
        each.name: {
            limit.parameter: limit.minimum_detectable for limit in _limits(each, look, TRIED, power)
        }
        for each in candidates
    }


def drives_of(runs: list[Run], options: EvaluationOptions = NOISE) -> Experiment:
    laid = concatenated(match_for_fit(runs, ROBOT, options.leg))
    return Experiment(laid, start_point(laid, ROBOT, options))


def change(drives: Experiment, name: str, **values: float) -> Floats:
    """What an effect of a size does to the innovations, in units of their noise."""
    return drives.whitened(drives.change(find(name).using(**values)))[:, 0]


def columns(drives: Experiment, name: str) -> Floats:
    return drives.whitened(drives.marks(Candidate(find(name), {})))


@pytest.mark.parametrize(
    ("name", "parameter"),
    [
        ("lateral_slip", "creep"),
        ("longitudinal_slip", "coefficient"),
        ("floor_slope", "x"),
        ("radius_drift", "per_second"),
        ("track_width", "multiplier"),
    ],
)
def test_at_the_limit_95_in_100_are_found(name: str, parameter: str, runs: list[Run]) -> None:
    """Monte Carlo of the linear model: signal, nuisances of any size, and white noise."""
    item = find(name).parameters[parameter]
    size = limits((name,), runs)[name][parameter]
    drives, random = drives_of(runs), np.random.default_rng(7)
    signal = change(drives, name, **{parameter: item.null + size})
    wanted = columns(drives, name)
    beside = [columns(drives, each) for each in CALIBRATED if each != name]
    nuisance = np.concatenate([drives.nuisances(()), *beside], axis=-1)
    draws = 4000
    shown = signal[:, None] + random.normal(size=(signal.size, draws))
    shown += nuisance @ random.normal(0.0, 100.0, (nuisance.shape[1], draws))

    def cost(design: Floats) -> Floats:
        basis = np.linalg.svd(design / np.linalg.norm(design, axis=0), full_matrices=False)[0]
        return np.asarray(np.sum((shown - basis @ (basis.T @ shown)) ** 2, axis=0))

    gains = cost(nuisance) - cost(np.concatenate([nuisance, wanted], axis=-1))
    found = [chi2_survival(gain, wanted.shape[1]) < rules.SURE / TRIED for gain in gains]
    assert np.mean(found) == pytest.approx(0.95, abs=0.012)


def test_a_phase_of_each_run_costs_two_numbers_a_run(runs: list[Run]) -> None:
    """The amplitude at the phase that shows least, for twice as many numbers as runs."""
    amplitude = limits(("eccentric_left_wheel",), runs)["eccentric_left_wheel"]["amplitude"]
    drives = drives_of(runs)
    nuisance = np.concatenate(
        [drives.nuisances(()), *(columns(drives, each) for each in CALIBRATED)], axis=-1
    )
    basis = np.linalg.svd(nuisance / np.linalg.norm(nuisance, axis=0), full_matrices=False)[0]
    wanted = noncentrality(4, rules.SURE / TRIED, 0.95)
    shown = []
    for phase in (0.0, 0.5 * np.pi):
        signal = change(drives, "eccentric_left_wheel", amplitude=amplitude, phase=phase)
        by_run = drives.each_run(signal[:, None])
        shown.append(float(np.sum((by_run - basis @ (basis.T @ by_run)) ** 2)))
    assert min(shown) == pytest.approx(wanted, rel=0.02)


def test_a_clocks_rate_is_seen_beside_a_delay_of_each_drives_own(runs: list[Run]) -> None:
    """By what it shows with its delay it was to be seen from half the size on."""
    found = limits(("reference_clock_drift",), runs)["reference_clock_drift"]
    assert list(found) == ["rate"]
    drives = drives_of(runs)
    sizes = [columns(drives, each) for each in CALIBRATED]
    delays = drives.each_run(columns(drives, "reference_delay"))
    beside = np.concatenate([drives.nuisances(()), *sizes, delays], axis=-1)
    basis = np.linalg.svd(beside / np.linalg.norm(beside, axis=0), full_matrices=False)[0]
    signal = change(drives, "reference_clock_drift", delay=0.0, rate=found["rate"])
    left = np.sum((signal - basis @ (basis.T @ signal)) ** 2)
    wanted = noncentrality(len(runs), rules.SURE / TRIED, rules.POWER)
    assert left == pytest.approx(wanted, rel=0.02)


def test_a_bump_at_any_place_is_seen_beside_the_radius_that_it_is_too(runs: list[Run]) -> None:
    """Each run by itself hides no radius behind its place; half the height was said to be seen."""
    height = limits(("left_tread_bump",), runs)["left_tread_bump"]["height"]
    drives, random = drives_of(runs), np.random.default_rng(7)
    nuisance = np.concatenate(
        [drives.nuisances(()), *(columns(drives, each) for each in CALIBRATED)], axis=-1
    )
    basis = np.linalg.svd(nuisance / np.linalg.norm(nuisance, axis=0), full_matrices=False)[0]
    shown = []
    for place in random.uniform(-np.pi, np.pi, 24):
        signal = change(drives, "left_tread_bump", height=height, place=place)
        by_run = drives.each_run(signal[:, None])
        shown.append(by_run - basis @ (basis.T @ by_run))
    anywhere = [
        float(np.sum((shown[one][:, 0] + shown[other][:, 1]) ** 2))
        for one, other in random.integers(len(shown), size=(200, 2))
    ]
    assert np.mean(anywhere) == pytest.approx(noncentrality(3, rules.SURE / TRIED, 0.95), rel=0.1)


def test_an_effect_of_ones_own_may_try_three_places(runs: list[Run]) -> None:
    """One with fewer than four ended a diagnosis with a ValueError."""
    bump = find("left_tread_bump")
    place = bump.parameters["place"]
    three = replace(bump, parameters={**bump.parameters, "place": replace(place, tries=THREE)})
    found = []
    for effect in (bump, three):
        candidate = _typical(effect)
        look = _looked_at(drives_of(runs), [candidate, *_calibrated()], ())
        found.append(_best(candidate, look, TRIED, ()).minimum_detectable)
    assert found[1] == pytest.approx(found[0], rel=0.15)


def test_more_noise_and_fewer_drives_show_less(runs: list[Run]) -> None:
    names = ("lateral_slip",)
    here = limits(names, runs)["lateral_slip"]["creep"]
    assert limits(names, runs[:1])["lateral_slip"]["creep"] > 1.2 * here
    noisy = limits(names, runs, replace(NOISE, sigma_xy=5.0 * NOISE_XY))["lateral_slip"]["creep"]
    assert noisy > 1.5 * here
    half = limits(names, runs, power=0.5)["lateral_slip"]["creep"]
    assert half < here


def test_what_leaves_no_trace_has_no_limit() -> None:
    positions = runs_of(ROBOT, (3,), 30)
    for run in positions:
        assert run.reference is not None
        run.reference.yaw[:] = np.nan
    found = limits(("reference_yaw_offset", "lateral_slip"), positions)
    assert found["reference_yaw_offset"]["angle"] == np.inf
    assert np.isfinite(found["lateral_slip"]["creep"])


def test_no_limit_is_beyond_what_is_physically_possible() -> None:
    """A spin hardly shows a mount askew: "seen from 80 rad" is never."""
    spin = run_by(ROBOT, np.full(800, 1e-4), np.full(800, 0.5))
    names = ("sideways_drift", "load_transfer", "unequal_wheel_radii", "castor_kick", "track_width")
    for name, found in limits(names, [spin]).items():
        for parameter, size in found.items():
            assert size == np.inf or size <= find(name).parameters[parameter].reach
    assert np.isfinite(limits(("reference_lever_arm",), [spin])["reference_lever_arm"]["x"])


def test_the_noncentrality_gives_the_power() -> None:
    random = np.random.default_rng(2)
    for degrees in (1, 3):
        value = noncentrality(degrees, 1e-3, 0.9)
        drawn = random.normal(size=(100_000, degrees))
        drawn[:, 0] += np.sqrt(value)
        found = [chi2_survival(each, degrees) < 1e-3 for each in np.sum(drawn**2, axis=1)[:20_000]]
        assert np.mean(found) == pytest.approx(0.9, abs=0.01)
