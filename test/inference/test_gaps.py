# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A gap is a gap: no leg spans it, no fit uses it, and it is no jump of the reference.

A reference that repeats its pose to the last digit stands still itself.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import NOISE_XY, NOISE_YAW, parts, run_of, runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects.lookup import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.likelihood import innovations
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.cutting import leg_ends, match, match_for_fit
from werrimbi_odom.inference.legs.gaps import STUCK, gaps_in
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.robot import Robot

SPANS = ((20.0, 23.5), (50.0, 54.0))


def silent(run: Run, spans: tuple[tuple[float, float], ...] = SPANS) -> Run:
    """The run without what its reference said in some spans of time."""
    assert run.reference is not None
    time = run.reference.time
    kept = np.all([(time < begin) | (time > end) for begin, end in spans], axis=0)
    return replace(run, reference=run.reference.chosen(kept))


def without_ticks(run: Run) -> Run:
    """The run without its ticks in some spans of time."""
    ticks = run.ticks
    kept = np.all([(ticks.time < begin) | (ticks.time > end) for begin, end in SPANS], axis=0)
    return replace(
        run,
        ticks=replace(ticks, time=ticks.time[kept], left=ticks.left[kept], right=ticks.right[kept]),
    )


def paused(run: Run) -> Run:
    """The run without either."""
    return silent(without_ticks(run))


@pytest.mark.parametrize("which", ["poses", "positions", "yaw"])
def test_a_pose_that_waited_for_the_end_of_a_silence_begins_no_leg(which: str) -> None:
    """Its stamp is of when it came: the robot was said to have been thrown half a metre ahead."""
    run = silent(run_of(ROBOT, 1, 60))
    seen = run.reference
    assert seen is not None
    first = [int(np.searchsorted(seen.time, end)) for _, end in SPANS]
    poses = np.stack([seen.x, seen.y, seen.yaw])
    poses[:, first] = poses[:, [row - 1 for row in first]] + 1e-4
    late = replace(seen, x=poses[0], y=poses[1], yaw=poses[2])
    for reference, more in ((seen, 0), (late, 1)):
        record = record_of(parts(replace(run, reference=reference), which), ROBOT)
        ends = [part.end for part in record.left_out if part.words.startswith("the reference is")]
        assert ends == [pytest.approx(seen.time[row + more], abs=1e-9) for row in first]


@pytest.mark.parametrize("name", ["left_wheel_reversed", "right_wheel_reversed", "wheels_swapped"])
def test_how_far_a_robot_drives_does_not_depend_on_its_wiring(name: str) -> None:
    """The file says how its counters are wired. By their columns 11 m were 3, in gaps too."""
    finer = replace(ROBOT, left_ticks_per_revolution=2.0 * ROBOT.left_ticks_per_revolution)
    seen = silent(run_of(ROBOT, 3, 60))
    left, right = 2.0 * seen.ticks.left, seen.ticks.right
    plain = replace(seen, ticks=replace(seen.ticks, left=left))
    columns = {
        "left_wheel_reversed": (-left, right),
        "right_wheel_reversed": (left, -right),
        "wheels_swapped": (right, left),
    }[name]
    wired = replace(seen, ticks=replace(seen.ticks, left=columns[0], right=columns[1]))
    says_so = replace(finer, effects=(*finer.effects, find(name).using()))
    (expected, found) = (compare([run], robot) for run, robot in ((plain, finer), (wired, says_so)))
    assert found.runs[0].distance_m == pytest.approx(expected.runs[0].distance_m)
    assert [part.words for part in found.left_out] == [part.words for part in expected.left_out]
    assert "turned" in found.left_out[0].words


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    return runs_of(ROBOT, range(40, 44))


@pytest.mark.parametrize(
    ("lose", "who"),
    [
        (silent, "the reference is"),
        (without_ticks, "the ticks are"),
        (paused, "reference and ticks are"),
    ],
)
def test_every_gap_is_found_and_no_leg_spans_one(runs: list[Run], lose: object, who: str) -> None:
    assert callable(lose)
    lost = [lose(run) for run in runs]
    found = compare(lost, ROBOT)
    assert [part.why for part in found.prepared.left_out] == ["gap"] * len(found.prepared.left_out)
    for index, run in enumerate(lost):
        gaps = [part for part in found.prepared.left_out if part.run == run.path]
        for part, (begin, end) in zip(gaps, SPANS, strict=True):
            assert part.begin <= begin + 0.25
            assert part.end >= end - 0.25
            assert part.end - part.begin < end - begin + 0.6
            assert part.words.startswith(f"{who} silent while the robot ")
        own = found.legs.run == index
        for begin, end in SPANS:
            spans = (found.legs.start_time[own] < end - 0.3) & (
                found.legs.end_time[own] > begin + 0.3
            )
            assert not spans.any()
    # A leg is a leg's worth of way and at most an interval of the reference more.
    way = found.legs.errors.length / 1.0 + np.abs(found.legs.errors.turn) / (0.5 * np.pi)
    assert way.max() < 1.4


@pytest.mark.parametrize("begin", [15.0, 19.0, 21.0, 22.0])
def test_ticks_that_are_silent_beyond_what_is_put_aside_are_a_gap(begin: float) -> None:
    """The way was laid evenly over the seconds of silence: a robot with a wrong base was unknown.

    What is put aside for judging may begin or end in a gap of the ticks.
    """
    run = without_ticks(run_of(ROBOT, 1, 60))
    seen, gone = run.reference, (begin, begin + 3.0)
    assert seen is not None
    kept = seen.chosen((seen.time <= gone[0]) | (seen.time >= gone[1]))
    record = record_of(replace(run, reference=kept, taken_out=(gone,), put_aside=(gone,)), ROBOT)
    inside = (record.measured.time >= SPANS[0][0]) & (record.measured.time <= SPANS[0][1])
    assert record.gap[np.flatnonzero(inside)[:-1]].all()
    told = [part.begin for part in record.left_out]
    assert told == [pytest.approx(at, abs=0.1) for at, _ in SPANS]


def test_a_gap_is_no_jump_of_the_reference_and_spoils_no_figure(runs: list[Run]) -> None:
    late = replace(ROBOT, effects=(AppliedEffect(find("reference_delay"), {"delay": 0.08}),))
    whole = compare(runs, late)
    holed = compare([silent(run) for run in runs], late)
    assert holed.main.all.outliers == whole.main.all.outliers == 0
    before, after = whole.main.all.figures, holed.main.all.figures
    assert after.rmse_position_m == pytest.approx(before.rmse_position_m, rel=0.1)
    assert after.count < before.count


def test_legs_without_a_gap_stay_where_they_were(runs: list[Run]) -> None:
    whole, holed = (match(run, ROBOT) for run in (runs[0], silent(runs[0], ((200.0, 201.0),))))
    np.testing.assert_array_equal(whole.measured.time, holed.measured.time)
    assert not holed.gap.any()


@pytest.mark.parametrize("which", ["poses", "positions", "yaw"])
@pytest.mark.parametrize("kind", ["absolute", "incremental"])
def test_a_gap_is_not_counted_and_what_follows_is_white(
    runs: list[Run], which: str, kind: ReferenceKind
) -> None:
    if kind == "incremental" and which == "positions":
        pytest.skip("positions without headings have no increments")
    laid = concatenated(match_for_fit([silent(parts(run, which)) for run in runs], ROBOT, 1.0))
    assert laid.gap.sum() == 2 * len(runs)
    truth = replace(ROBOT, left_wheel_noise=1e-5, right_wheel_noise=1e-5)
    point = start_point(
        laid, truth, EvaluationOptions(reference_kind=kind, sigma_xy=NOISE_XY, sigma_yaw=NOISE_YAW)
    )
    point = fit_model(laid, point, (), find_jumps=False, rounds=1).point
    found = innovations(
        point.model.robot,
        laid,
        predict_all(point.model, laid),
        point.variances,
        kind,
        start_yaws=point.model.start_yaws,
    )
    assert not found.known[laid.gap].any()
    white = found.whitened()
    after = np.flatnonzero(laid.gap) + 1
    squares = white[after][found.known[after]] ** 2
    assert squares.mean() < 4.0
    assert laid.data == int(np.isfinite(laid.finish[~laid.gap]).sum())


def test_a_wrong_way_through_a_gap_does_not_move_a_fit(runs: list[Run]) -> None:
    """A robot that was set aside in a gap: its wheels tell nothing of the way there."""
    lost = []
    for run in runs:
        gone = silent(run)
        reference = gone.reference
        assert reference is not None
        late = reference.time > SPANS[0][1]
        lost.append(
            replace(gone, reference=replace(reference, x=reference.x + np.where(late, 0.7, 0.0)))
        )
    fits = []
    for some in ([silent(run) for run in runs], lost):
        laid = concatenated(match_for_fit(some, ROBOT, 1.0))
        fits.append(
            fit_model(
                laid,
                start_point(laid, ROBOT, EvaluationOptions(sigma_xy=1e-3, sigma_yaw=2e-3)),
                find_jumps=False,
            ).robot
        )
    for name in ("wheel_separation_multiplier", "left_wheel_radius_multiplier"):
        assert getattr(fits[0], name) == pytest.approx(getattr(fits[1], name), abs=1e-9)


def test_sparse_and_irregular_references_have_no_gaps() -> None:
    run = run_of(ROBOT, 5, 600)
    assert run.reference is not None
    random = np.random.default_rng(1)
    count = run.reference.time.size
    for kept in (
        np.isin(np.arange(count), [0, count - 1]),
        random.random(count) < 0.02,
        np.arange(count) % 100 == 0,
    ):
        record = record_of(replace(run, reference=run.reference.chosen(kept)), ROBOT)
        assert not record.left_out


def test_one_that_speaks_by_way_has_no_gap_while_the_robot_stands() -> None:
    time = np.cumsum(np.where(np.arange(80) % 20 == 0, 40.0, 0.5))
    assert not gaps_in(time, 0.25 * np.arange(80)).any()
    way = 0.05 * np.arange(80) + np.where(np.arange(80) >= 60, 1.0, 0.0)
    assert np.flatnonzero(gaps_in(time, way)).tolist() == [59]


def test_shorter_legs_end_wherever_longer_ones_do() -> None:
    random = np.random.default_rng(3)
    for _ in range(50):
        way = np.cumsum(random.exponential(0.03, 400))
        gap = random.random(399) < 0.01
        ends = {times: set(leg_ends(way, gap, times).tolist()) for times in (0.25, 0.5, 1.0, 2.0)}
        assert ends[2.0] <= ends[1.0] <= ends[0.5] <= ends[0.25]


def test_joined_legs_are_what_the_steps_say() -> None:
    """Long legs of short ones, against each length from all its steps."""
    robot: Robot = replace(ROBOT, left_wheel_noise=4e-4, right_wheel_noise=6e-4)
    prepared = prepare([silent(run_of(robot, seed)) for seed in (1, 2)], robot)
    from werrimbi_odom.inference.fitting.free_parameters import Model
    from werrimbi_odom.inference.fitting.joined_legs import predict_joined

    mounted = AppliedEffect(
        find("reference_lever_arm"), find("reference_lever_arm").nulls | {"x": 0.1, "y": -0.05}
    )
    turned = AppliedEffect(find("reference_yaw_offset"), {"angle": 0.3})
    for effects in ((), (mounted, turned)):
        model = Model(replace(robot, effects=effects), ({}, {}))
        for (runs,) in prepared.cuts.values():
            assert runs.finer is not None
            direct, quick = predict_all(model, runs), predict_joined(model, runs)
            for name in ("relative", "per_left", "per_right", "length", "along", "turn"):
                expected = getattr(direct, name)
                np.testing.assert_allclose(
                    getattr(quick, name), expected, rtol=1e-7, atol=1e-9 * np.abs(expected).max()
                )


BEGIN, END = 26.0, 27.2


@pytest.mark.parametrize("rate", [5, 10, 20])
@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_a_repeated_pose_is_told_of_the_reference(rate: float, noise: float) -> None:
    """As incremental references are judged, whose equal poses are not taken out."""
    run, random = run_of(ROBOT, 3, 40), np.random.default_rng(3)
    seen = run.reference
    assert seen is not None
    time = np.arange(seen.time[0], seen.time[-1], 1.0 / rate)
    poses = np.stack(
        [
            np.interp(time, seen.time, part) + 1e-3 * random.standard_normal(time.size)
            for part in (seen.x, seen.y, np.unwrap(seen.yaw))
        ]
    )
    inside = (time > BEGIN) & (time < END)
    last = poses[:, inside][:, :1]
    poses[:, inside] = last + noise * random.standard_normal((3, inside.sum()))
    x, y, yaw = poses
    found = with_no_driving(
        replace(run, reference=replace(seen, time=time, x=x, y=y, yaw=yaw)), ROBOT
    )
    assert found.no_driving is not None
    (part,) = found.no_driving
    assert part.begin == pytest.approx(BEGIN, abs=0.3)
    assert part.end == pytest.approx(END, abs=0.3)
    if noise:
        assert part.why in ("held", "carried")
    else:
        assert (part.why, part.words) == ("gap", STUCK)
