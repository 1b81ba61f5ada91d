# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The harness itself: what it counts, reads from printed words, weighs and keeps."""

from __future__ import annotations

import json
import math
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import binom

pytest.importorskip("mujoco", reason="hidden sets need the physics engine (pip install mujoco)")

from test.hidden import (
    coverage,
    field,
    field_table,
    fisher,
    history,
    margins,
    plan,
    resumable_jobs,
    set_judging,
    smallest,
    survive,
)
from test.hidden.__main__ import SCANS
from test.hidden.evidence_tables import tables
from test.hidden.follow import Followed, commands, follow, typed
from test.hidden.followed_to_rest import at_the_truth, without_detour
from test.hidden.intervals import clopper_pearson
from test.hidden.page import page, with_part
from test.hidden.result_line import Judged, is_right, judgement
from test.hidden.rules import RULES
from test.hidden.sets import HiddenSet
from test.hidden.table_layout import Table
from test.hidden.true_values import multipliers_of, noises_of, values_of

LINE = Judged(
    name="own-castor_kick-1",
    group="effect",
    setup="own",
    seen="",
    hidden=("castor_kick",),
    strengths=(0.01,),
    entered=(),
    commit="abc",
    seconds=1.0,
    verdict="named",
    effect="castor_kick",
    found=("castor_kick",),
    before=5e-3,
    after=2e-3,
    floor=2e-3,
    rested=2e-3,
    verdicts=("named castor_kick", "none"),
    steps=(("castor_kick",),),
    ended="none",
    mean_is_right=True,
)


def other(**changes: object) -> Judged:
    return Judged.of(json.loads(json.dumps({**LINE.line(), **changes})))


# ------------------------------------------------------------------ counting


@pytest.mark.parametrize(("hits", "tries"), [(0, 10), (10, 10), (3, 40), (172, 172)])
def test_an_interval_holds_the_rates_that_would_show_as_much(hits: int, tries: int) -> None:
    low, high = clopper_pearson(hits, tries)
    assert low == 0.0 if hits == 0 else binom.sf(hits - 1, tries, low) == pytest.approx(0.025)
    assert high == 1.0 if hits == tries else binom.cdf(hits, tries, high) == pytest.approx(0.025)


def test_a_count_of_more_than_all_is_refused() -> None:
    with pytest.raises(ValueError, match="5 of 4"):
        clopper_pearson(5, 4)


# ------------------------------------------------------------------ the plan


def test_seeds_of_two_states_of_the_code_have_nothing_in_common() -> None:
    one, two = (plan.start_of(mark) for mark in ("0f0f0f0f0f0f", "0f0f0f100f0f"))
    assert one != two
    assert plan.OLD not in (one, two)
    seeds = [{each.seed for each in plan.plan(start, plan.ALL)} for start in (one, two)]
    assert not seeds[0] & seeds[1]
    for start, own in zip((one, two), seeds, strict=True):
        assert all(start <= seed < start + plan.APART for seed in own)


def test_another_byte_of_the_judged_code_gives_other_seeds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from test.hidden import sets

    monkeypatch.setattr(sets, "ROOT", tmp_path)
    starts = []
    for text in ("SURE = 1e-3\n", "SURE = 2e-3\n"):
        (tmp_path / "rules.py").write_text(text)
        sets.code_mark.cache_clear()
        starts.append(plan.start_of(sets.code_mark("rules.py")))
    sets.code_mark.cache_clear()
    assert starts[0] != starts[1]


def test_the_sample_has_some_of_every_kind_and_is_part_of_no_old_set() -> None:
    start = plan.start_of("abcdef012345")
    some, everything = plan.plan(start, plan.SAMPLE), plan.plan(start, plan.ALL)
    groups = Counter(each.group for each in some)
    assert set(groups) == {each.group for each in everything}
    assert set(some) <= set(everything)
    assert {name for each in some if each.group == "effect" for name in each.names} == set(
        plan.EFFECTS
    )
    assert not set(some) & set(plan.plan(plan.OLD, plan.ALL))


@pytest.mark.parametrize("wanted", [0, 1, 3, 7, 9])
def test_evenly_picks_as_many_as_wanted(wanted: int) -> None:
    things = list("abcdefg")
    for start in (0, 3 * plan.APART, 12 * plan.APART):
        picked = plan.evenly(things, wanted, start)
        assert len(picked) == len(set(picked)) == min(wanted, 7)


# ------------------------------------------------------------------ printed commands

PRINTED = """One thing is missing: castor_kick.
Next: add it to the model, fitted with all calibration; `werrimbi add` says more:
    werrimbi add castor_kick --robot 'my robot.yaml' \\
      train/* \\
      --holdout a b \\
      --out better.yaml

written: x.json
Is more missing?  werrimbi diagnose --robot better.yaml RUN... --holdout RUN...
Try it:      werrimbi add draft --effects draft.py \\
               --robot r.yaml --out new.yaml RUN...
"""


def test_commands_are_read_as_a_shell_would(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("two", "one"):
        (tmp_path / "train" / name).mkdir(parents=True)
    add, tried = commands(PRINTED, "add")
    (again,) = commands(PRINTED, "diagnose")
    assert typed(add, ["t"], ["h"]) == [
        *("add", "castor_kick", "--robot", "my robot.yaml", "train/one", "train/two"),
        *("--holdout", "a", "b", "--out", "better.yaml"),
    ]
    assert typed(again, ["t1", "t2"], ["h"])[1:] == [
        *("--robot", "better.yaml", "t1", "t2", "--holdout", "h")
    ]
    assert typed(tried, ["t"], ["h"])[-1] == "t"
    assert commands("Nothing is missing; `werrimbi compare` says more.", "compare") == []


# ------------------------------------------------------------------ at the truth


def test_the_truth_is_reached_by_its_name_and_near_the_floor() -> None:
    assert at_the_truth(LINE)
    assert not at_the_truth(other(steps=[["left_backlash"]]))
    assert not at_the_truth(other(steps=[["castor_kick"], ["left_backlash"]]))
    assert not at_the_truth(other(rested=2.6e-3))
    assert not at_the_truth(other(ended="again"))
    assert not at_the_truth(other(steps=[], ended="none"))


def test_twins_and_calibration_fitted_along_are_the_truth_too() -> None:
    twin = other(hidden=["sideways_drift"], steps=[["reference_yaw_offset"]])
    assert at_the_truth(twin)
    beside = other(hidden=["track_width", "castor_kick"], steps=[["castor_kick"]])
    assert at_the_truth(beside), "calibration is fitted along with any effect"
    several = other(hidden=["castor_kick", "encoder_skew"], steps=[["castor_kick,encoder_skew"]])
    assert not at_the_truth(several), "names are parted by whoever follows"
    assert at_the_truth(
        other(hidden=["castor_kick", "encoder_skew"], steps=[["castor_kick", "encoder_skew"]])
    )


def test_nothing_hidden_and_outsiders_are_at_the_truth_where_nothing_is_added() -> None:
    clean = other(group="clean", hidden=[], strengths=[], steps=[], verdicts=["none"])
    assert at_the_truth(clean)
    assert not at_the_truth(other(group="clean", hidden=[], strengths=[]))
    outside = other(group="outsider", hidden=["cable_pull"], steps=[], ended="unknown")
    assert at_the_truth(outside)
    assert not at_the_truth(other(group="outsider", hidden=["cable_pull"]))


def test_a_detour_is_more_steps_than_effects() -> None:
    assert without_detour(LINE)
    assert not without_detour(other(steps=[["castor_kick"], ["castor_kick"]]))


# ------------------------------------------------------------------ work that can be stopped


def _square(number: int) -> resumable_jobs.Line:
    if number < 0:
        raise ValueError(number)
    return {"square": number * number}


@pytest.mark.evidence
def test_work_goes_on_where_it_was_stopped_and_one_failure_is_not_the_end(tmp_path: Path) -> None:
    file = tmp_path / "results" / "part.jsonl"
    first = dict(resumable_jobs.done(file, {"two": 2, "bad": -1}, _square, 1))
    assert first == {"two": {"square": 4}}
    with file.open("a", encoding="utf-8") as out:
        out.write('{"key": "cut')
    assert resumable_jobs.kept(file) == {"two": {"square": 4}}
    file.write_text(file.read_text().rsplit("\n", 1)[0] + "\n")
    second = dict(resumable_jobs.done(file, {"two": 2, "three": 3}, _square, 1))
    assert second == {"three": {"square": 9}}, "what is known is not done again"


@pytest.mark.parametrize(("seen_from", "below"), [(0.003, False), (0.008, True), (None, True)])
def test_rivals_are_asked_for_where_the_diagnosis_says_that_it_sees_them(
    seen_from: float | None, below: bool
) -> None:
    """A delay of 4 ms at one speed, in drives that show one of 3 ms, or only one of 8."""
    none = replace(LINE, group="rivals", hidden=("reference_delay",), strengths=(0.004,),
                   verdict="none", effect=None, found=())  # fmt: skip
    sight = {"effect": "reference_delay", "seen_from": seen_from}
    assert set_judging.below_limit(none, {"could_have_been_seen": [sight]}) is below
    assert not set_judging.below_limit(none, {"could_have_been_seen": []})
    (rule,) = (rule for rule in RULES if rule.short == "rivals")
    assert rule.speaks_of(replace(none, below_limit=below)) is not below


@pytest.mark.parametrize(
    ("said", "kept", "asked"),
    [
        ({"verdict": "named", "effect": "reference_delay", "found": ("reference_delay",)}, 1, 0),
        ({"verdict": "named", "effect": "coulomb_slip", "found": ("coulomb_slip",)}, 0, 0),
        ({"verdict": "ambiguous", "rivals": ("coulomb_slip", "reference_delay")}, 1, 1),
        ({"verdict": "ambiguous", "rivals": ("coulomb_slip", "longitudinal_slip")}, 0, 0),
        ({"verdict": "none", "effect": None, "found": ()}, 0, 0),
    ],
)
def test_of_rivals_a_wrong_name_is_never_right(
    said: dict[str, object], kept: int, asked: int
) -> None:
    told = {"group": "rivals", "hidden": ("reference_delay",), "next_manoeuvre": "arcs"}
    line = replace(LINE, **{**told, **said})
    rules = {rule.short: rule for rule in RULES}
    assert len(rules["rivals"].broken_by([line])) == 1 - kept
    assert len(rules["resolved"].of([line])) == asked, "who was told the name drives no more"


# ------------------------------------------------------------------ certainty that survives


@pytest.mark.parametrize(
    ("said", "how"),
    [
        ({"changes": ("reference_delay",)}, "missed"),
        ({}, "wrong"),
        ({"changes": ("left_wheel",)}, "wrong"),
        ({"changes": ("reference_delay",), "verdict": "unknown"}, "wrong"),
        (
            {"changes": ("reference_delay",), "found": ("reference_delay", "longitudinal_slip")},
            "wrong",
        ),
        ({"changes": ("reference_delay",), "hidden": ("longitudinal_slip",)}, "wrong"),
    ],
)
def test_a_delay_that_is_another_in_each_drive_is_a_part_of_a_clock_that_drifts(
    said: dict[str, object], how: str
) -> None:
    """One delay for all is not, nor is a delay where there is no clock; and it is not all."""
    hidden, delay = ("reference_clock_drift",), "reference_delay"
    told = {"hidden": hidden, "verdict": "named", "effect": delay, "found": (delay,)}
    line = other(**{**told, **said})
    assert judgement(line) == how
    assert not is_right(line)


def test_agreement_tells_less_sure_from_changed() -> None:
    def now(verdict: str, *names: str) -> resumable_jobs.Line:
        rivals = list(names) if verdict == "ambiguous" else []
        return {"verdict": verdict, "effect": names[0] if names else None, "found": list(names),
                "rivals": rivals}  # fmt: skip

    assert survive.agreement(LINE, now("named", "castor_kick")) == "the same"
    assert survive.agreement(LINE, now("ambiguous", "left_backlash", "castor_kick")) == "less sure"
    assert survive.agreement(LINE, now("none")) == "not seen any more"
    assert survive.agreement(LINE, now("named", "left_backlash")) == "changed"
    assert survive.agreement(LINE, now("unknown")) == "changed"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    place = tmp_path / "set"
    for part, count in (("train", 3), ("holdout", 2)):
        for number in range(count):
            run = place / part / f"{number}"
            run.mkdir(parents=True)
            (run / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n")
            rows = "".join(f"{time},0,0,0\n" for time in range(5))
            (run / "reference.csv").write_text("t_s,x_m,y_m,yaw_rad\n" + rows)
    (place / "robot.yaml").write_text("odom_node: {}\n")
    return place


def test_odd_and_even_rows_share_none_and_miss_none(folder: Path) -> None:
    seen = []
    for how in ("odd rows", "even rows"):
        with survive.changed(folder, how) as place:
            (file, *_) = sorted((place / "train").glob("*/reference.csv"))
            head, *rows = file.read_text().splitlines()
            assert head == "t_s,x_m,y_m,yaw_rad"
            seen.append({row.split(",")[0] for row in rows})
    assert seen == [{"1", "3"}, {"0", "2", "4"}]


def test_another_split_holds_out_as_many_other_drives(folder: Path) -> None:
    with survive.changed(folder, "another split") as place:
        names = {
            part: sorted(run.name for run in (place / part).iterdir())
            for part in ("train", "holdout")
        }
    assert names["holdout"] == ["train_0", "train_1"]
    assert names["train"] == ["holdout_0", "holdout_1", "train_2"]


# ------------------------------------------------------------------ as people record


def said(
    verdict: str, *found: str, rivals: tuple[str, ...] = (), **more: object
) -> resumable_jobs.Line:
    return {"verdict": verdict, "found": list(found), "rivals": list(rivals), **more}


SCALE = ("track_width", "reference_scale")


@pytest.mark.parametrize(
    ("hidden", "by", "line", "worth"),
    [
        (["castor_kick"], "localiser", said("named", "castor_kick"), "named"),
        (["castor_kick"], "localiser", said("named", "castor_kick", "track_width"), "wrong"),
        (["castor_kick"], "localiser", said("none"), "missed"),
        (["castor_kick"], "localiser", said("unknown"), "wrong"),
        (["castor_kick"], "localiser", said("refused", error="no"), "wrong"),
        (["castor_kick"], "gyro", said("ambiguous", SCALE[0], rivals=SCALE), "missed"),
        (["castor_kick"], "gyro", said("ambiguous", *SCALE[:1], "castor_kick", rivals=SCALE),
         "named"),
        (["castor_kick"], "gyro", said("ambiguous", SCALE[0], "encoder_skew", rivals=SCALE,
         rivals_of_others={"encoder_skew": ["castor_kick"]}), "ambiguous"),
        (["castor_kick"], "gyro", said("ambiguous", SCALE[0], "encoder_skew", rivals=SCALE,
         rivals_of_others={"encoder_skew": ["left_backlash"]}), "wrong"),
        (["castor_kick"], "gyro", said("named", "castor_kick", SCALE[0]), "wrong"),
        (["castor_kick"], "gyro", said("named", "castor_kick", SCALE[0],
         rivals_of_others={SCALE[0]: SCALE[1:]}), "named"),
        (["track_width"], "gyro", said("ambiguous", SCALE[0], rivals=SCALE), "ambiguous"),
        (["wheel_radius_scale"], "gyro", said("named", "track_width"), "named"),
        (["wheel_radius_scale"], "both", said("named", "track_width"), "wrong"),
        (["reference_delay"], "gyro", said("named", "reference_heading_delay"), "named"),
        (["sideways_drift"], "localiser", said("named", "reference_yaw_offset"), "named"),
        ([], "gyro", said("ambiguous", SCALE[0], rivals=SCALE), "named"),
        ([], "localiser", said("ambiguous", SCALE[0], rivals=SCALE), "wrong"),
        ([], "positions", said("none"), "named"),
        (["floor_slope"], "scans", said("unknown"), "missed"),
        (["floor_slope"], "localiser", said("unknown"), "wrong"),
        (["radius_by_channel"], "localiser", said("unknown"), "missed"),
        (["radius_by_channel"], "localiser", said("named", "track_width"), "wrong"),
        (["radius_by_channel"], "localiser", said("named", "wheel_radius_scale"), "named"),
    ],
)  # fmt: skip
def test_what_a_verdict_by_an_ordinary_reference_is_worth(
    hidden: list[str], by: str, line: resumable_jobs.Line, worth: str
) -> None:
    assert field.how(hidden, by, line) == worth


def test_of_ordinary_recordings_each_rule_counts_what_it_speaks_of() -> None:
    seen = {"castor_kick": 0.02}
    there = {"held": [["train/a", 1.0, True]], "carried": [["train/a", 9.0, False]]}
    good = said("named", "castor_kick", seen_from=seen, stretches=there)
    small, large = (said("none", seen_from=seen, stretches={}) for _ in range(2))
    wrong = said("named", "floor_slope", seen_from=seen, stretches={})
    lines = {
        key: {
            "hidden": ["castor_kick"],
            "strength": strength,
            "said": {"localiser": one, "gyro": other},
            "circles": {"/odom": True},
        }
        for key, strength, one, other in (("a", 0.01, good, small), ("b", 0.03, wrong, large))
    }
    counted = field_table.rules(lines)
    assert [(kept, of) for kept, of, _ in counted.values()] == [(3, 4), (1, 1), (0, 1), (2, 2)]
    rules, effects, wrongs = field_table.tables(lines)
    assert [row[-1] for row in rules.rows] == ["BROKEN", "kept", "BROKEN", "kept"]
    assert effects.rows == (("castor_kick", "1 small, 1 missed", "1 named, 1 WRONG"),)
    assert [row[0] for row in wrongs.rows] == ["`b`"]


def test_where_a_lidar_is_all_that_there_is_the_table_has_its_column_alone() -> None:
    """What scans hold nothing of is missed and no wrong name; the floor's also if it is unknown."""
    given = {"floor_slope": "unknown", "track_width": "unknown", "reference_heading_delay": "none"}
    lines = {
        name: {
            "hidden": [name],
            "strength": 0.01,
            "said": {
                "scans": said(verdict, seen_from=dict.fromkeys({*given} - {"floor_slope"}, 0.001))
            },
        }
        for name, verdict in given.items()
    }
    rules, effects, wrongs = field_table.tables_by_scans(lines)
    assert effects.columns == ("hidden", "a lidar's scans")
    assert effects.rows == (
        ("track_width", "1 WRONG"),
        ("floor_slope", "1 small"),
        ("reference_heading_delay", "1 small"),
    )
    assert [(row[0], row[1]) for row in rules.rows] == [("no wrong name", "2 of 3")]
    assert [row[0] for row in wrongs.rows] == ["`track_width`"]


def test_field_sets_have_seeds_of_their_own() -> None:
    start = plan.start_of("abcdef012345")
    own = field.sets(start, 4, 12, len(plan.EFFECTS))
    assert len({each.name for each in own}) == len(own) == 4 * len(field.IN_BAGS) + 12
    scans = field.sets(start + SCANS, 4, 12, len(plan.EFFECTS))
    assert not {each.seed for each in own} & {each.seed for each in scans}
    others = {each.seed for each in plan.plan(start, plan.ALL)}
    assert not others & {each.seed for each in own + scans}
    assert all(start <= each.seed < start + plan.APART for each in own + scans)


# ------------------------------------------------------------------ margins


@pytest.mark.evidence
def test_every_deciding_number_can_be_perturbed_and_comes_back() -> None:
    before = margins.constants()
    assert len(before) > 5
    for name, value in before.items():
        with margins.perturbed(name, margins.times(value, 1.4)) as count:
            assert count > 0, f"nobody holds {name}"
            assert margins.constants()[name] == margins.times(value, 1.4) != value
    assert margins.constants() == before


def test_only_what_a_diagnosis_reads_is_made_larger_and_smaller() -> None:
    read = margins.judging()
    assert {"SURE", "RIVAL", "LAW_SHARE", "LASTING_PARTS", "JUMP_OF_A_LEG"} <= read.keys()
    assert {"PENALTY_FLOOR", "SCORE_FLOOR", "REFITTED"} <= read.keys(), "read as rules.NAME"
    assert not {"HONEST_WITHIN", "LEAST_SQUARES", "MOST_DRAFTED", "LONGEST_DRIVE"} & read.keys()
    assert read.keys() < margins.constants().keys()


def test_a_whole_number_moves_by_one_at_least_and_stays_above_none() -> None:
    assert margins.times(3, 1.4) == 4
    assert margins.times(2, 0.7) == 1
    assert margins.times(1, 0.7) == 1
    assert margins.times(10.0, 0.7) == pytest.approx(7.0)


def test_sureness_parts_what_is_hidden_from_what_is_likeliest_where_nothing_is() -> None:
    p_values = [["castor_kick", 1e-9], ["left_backlash", 1e-2], ["track_width", None]]
    lines = [other(p_values=p_values), other(hidden=[], strengths=[], p_values=p_values[1:])]
    true, false = margins.sureness(lines)
    assert true == pytest.approx([9.0])
    assert false == pytest.approx([2.0])


# ------------------------------------------------------------------ how small


def test_whitened_changes_hold_what_the_whole_covariance_says() -> None:
    """The filter against one large matrix: of poses with noise that adds up and noise that does."""
    chance = np.random.default_rng(4)
    count, noise = 7, np.array([1e-3, 2e-3, 3e-3])
    path = np.cumsum(chance.normal(size=(count, 3)), axis=0)
    moves, added, cumulated = [], [], [np.zeros((3, 3))]
    for index in range(1, count):
        step = path[index] - path[index - 1]
        move = np.eye(3)
        move[0, 2], move[1, 2] = -step[1], step[0]
        root = 1e-3 * chance.normal(size=(3, 3))
        moves.append(move)
        added.append(root @ root.T)
        cumulated.append(move @ cumulated[-1] @ move.T + added[-1])
    changes = chance.normal(size=(count, 3, 2))
    white = fisher.whitened(changes, path, np.array(cumulated), noise)
    # Each pose's error is linear in the start and in what was added on the way.
    parts = np.zeros((3 * count, 3 * count))
    for index in range(count):
        here = np.eye(3)
        for back in range(index, -1, -1):
            parts[3 * index : 3 * index + 3, 3 * back : 3 * back + 3] = here
            if back:
                here = here @ moves[back - 1]
    start = fisher.ANYWHERE**2 * np.eye(3)
    blocks = np.zeros((3 * count, 3 * count))
    for index, block in enumerate([start, *added]):
        blocks[3 * index : 3 * index + 3, 3 * index : 3 * index + 3] = block
    whole = parts @ blocks @ parts.T + np.kron(np.eye(count), np.diag(noise**2))
    flat = changes.reshape(3 * count, 2)
    assert white.T @ white == pytest.approx(flat.T @ np.linalg.solve(whole, flat), rel=1e-4)


def test_effects_are_told_apart_from_the_size_on_that_is_printed() -> None:
    """By simulation: of two columns at an angle, the wrong one told seldom, the right one often."""
    chance, power, angle, cases = 1e-2, 0.95, 0.7, 200_000
    random = np.random.default_rng(3)
    rival = np.array([np.cos(angle), np.sin(angle)])
    size = fisher.tellable(1.0 / np.sin(angle), chance, power)
    sure = 2.3263**2

    def ahead(truth: np.ndarray) -> np.ndarray:
        """Cost of the rival's model less that of the effect's, which is along the first axis."""
        seen = truth + random.standard_normal((cases, 2))
        return seen[:, 0] ** 2 - (seen @ rival) ** 2

    assert np.mean(ahead(np.array([size, 0.0])) > sure) == pytest.approx(power, abs=0.01)
    wrong = [np.mean(ahead(other * rival) > sure) for other in (2.0, 4.0, 6.0)]
    assert 0.5 * chance < max(wrong) < 1.3 * chance


def test_what_a_rival_leaves_is_what_it_cannot_do() -> None:
    own, known = np.array([3.0, 4.0, 1.0]), np.array([0.0, 2.0, 0.0])
    assert fisher._left(own, [known]) == pytest.approx(math.hypot(3.0, 1.0))
    assert fisher._left(own, [known, own + 1e-9]) == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("truth", [0.2, 0.51, 1.0, 2.7, 4.6])
def test_the_size_from_which_an_effect_is_named_is_closed_in_upon(truth: float) -> None:
    asked: list[float] = []

    def is_named(size: float) -> bool:
        asked.append(size)
        return size >= truth

    found = smallest.first_that_is(is_named)
    assert found == pytest.approx(max(truth, smallest.LADDER[0]), rel=smallest.STEP - 1.0)
    assert len(asked) <= 4
    assert smallest.first_that_is(lambda size: False) is None


def test_what_scatters_from_session_to_session_gives_the_size_named_in_95_of_100() -> None:
    chance = np.random.default_rng(5)
    true_ratio = {name: 1.0 + 0.1 * number for number, name in enumerate(plan.EFFECTS[:20])}
    results = {
        f"{name} {session}": {
            "effect": name,
            "named_from": 2.0 * true_ratio[name] * math.exp(0.2 * (chance.normal() - 1.645)),
            "limit": 1.0,
            "limit_named": 2.0,
        }
        for name in true_ratio
        for session in range(25)
    }
    found = smallest.ratios(results, "named")
    off = [
        math.log(ratio / true_ratio[name]) / math.log(error)
        for name, (ratio, error) in found.items()
    ]
    assert len(off) == 20
    assert max(map(abs, off)) < 3.5
    assert 0.6 < float(np.std(off)) < 1.5
    results["never"] = {"effect": plan.EFFECTS[0], "named_from": None}
    left_out = set(found) - set(smallest.ratios(results, "named"))
    assert left_out == {plan.EFFECTS[0]}


def test_of_many_sessions_the_middle_one_and_the_ends_are_told() -> None:
    assert smallest._steps([0.7, None]) == "0.70, > 4.7"
    assert smallest._steps([2.0, None, 0.7, 1.0]) == "2.00 (0.70 to > 4.7)"


def test_what_each_drive_has_of_its_own_is_unknown_in_the_bound() -> None:
    first, second = np.array([1.0, 2.0]), np.array([3.0])
    apart = fisher._of_each([first, second])
    assert [each.tolist() for each in apart] == [[1.0, 2.0, 0.0], [0.0, 0.0, 3.0]]


# ------------------------------------------------------------------ intervals


def test_coverage_of_honest_and_of_too_narrow_intervals() -> None:
    chance = np.random.default_rng(6)
    honest = {("add", "x"): chance.normal(size=4000).tolist()}
    narrow = {("add", "x"): (2.0 * chance.normal(size=4000)).tolist()}
    hold = [coverage.table(each).rows[0][3] for each in (honest, narrow)]
    assert hold[0].endswith("(95%)")
    assert int(hold[1].partition("(")[2].rstrip("%)")) < 75
    counts = coverage.ranks(honest, "add")
    assert sum(counts) == 4000
    assert min(counts) > 300
    edges = coverage.ranks(narrow, "add")
    assert edges[0] > 700 < edges[-1]


def test_which_wheels_noise_is_known_and_by_which_name() -> None:
    robot = {"left_wheel_noise": 4e-4, "right_wheel_noise": 5.8e-4}

    def known(hidden: str, *said: str, seen: str = "") -> list[float | None]:
        truth = {"robot_before_hiding": robot, "hidden": [{"effect": hidden}], "seen": seen}
        found = noises_of(truth, said)
        return [found.get(f"{side}_wheel_noise") for side in ("left", "right")]

    assert known("lateral_slip", "lateral_slip") == [4e-4, 5.8e-4]
    assert known("wheels_swapped", "wheels_swapped") == [4e-4, 5.8e-4]
    assert known("reference_mirrored", "wheels_swapped") == [5.8e-4, 4e-4]
    assert known("left_backlash", "left_backlash") == [None, 5.8e-4]
    assert known("right_missed_ticks", "right_missed_ticks") == [4e-4, None]
    assert known("lateral_slip", "lateral_slip", seen="scan_matcher") == [None, None]


# ------------------------------------------------------------------ history


def test_a_state_of_the_code_has_one_line_and_others_stay(tmp_path: Path) -> None:
    file = tmp_path / "history.jsonl"
    lines = [LINE, other(verdict="none", effect=None, found=[])]
    for digest in ("one", "two", "two"):
        entries = history.append(history.entry_of(lines, digest, 10_000), file)
    assert [each["digest"] for each in entries] == ["one", "two"]
    assert history.read(file) == entries
    assert entries[0]["rules"]["named"] == [1, 2]
    table = history.table(entries)
    assert isinstance(table, Table)
    assert table.rows[0][2] == "`two`", "the newest first"


def test_rules_have_short_names_of_their_own() -> None:
    assert len({rule.short for rule in RULES}) == len(RULES)


def test_the_page_holds_every_rule_with_its_interval_and_what_went_astray() -> None:
    lost = other(name="own-castor_kick-2", ended="refused", error="no | help", steps=[])
    text = page(
        tables([LINE, lost]),
        [("evidence_ranks.png", "Ranks")],
        how="",
        judged=2,
        planned=3,
        commit="abc",
        digest="def",
        fresh=True,
    )
    assert "2 of 3 sets judged" in text
    low, high = clopper_pearson(1, 2)
    interval = f"{100 * low:.1f} to {100 * high:.1f} %"
    assert f"| the printed commands, followed, come to rest | 1 of 2 | 50.0% | {interval}" in text
    assert "| `own-castor_kick-2` | named castor_kick → none | refused | no / help |" in text
    assert "![Ranks](pictures/evidence_ranks.png)" in text


def test_what_was_not_run_stays_on_the_page_with_the_code_that_it_is_of() -> None:
    def written(code: str, before: str, *tables: Table, **picture: str) -> str:
        not_run = [table.title for table in tables if not table.rows and table is not RIGHT]
        return page(
            tables,
            list(picture.items()),
            how="",
            judged=1,
            planned=1,
            commit=code,
            digest="def",
            fresh=True,
            before=before,
            not_run=not_run,
        )

    limits, none = (Table("Limits", ("effect",), rows) for rows in ((("slip",),), ()))
    wrong = Table("Wrong", ("set",), (("slip 7",),))
    first = written("aaa", "", limits, wrong, limits="How small")
    second = written("bbb", first, none, RIGHT)
    third = written("ccc", second, none, RIGHT)
    for text in (second, third):
        told = "*Not run anew (code `aaa`)*\n\n| effect |\n| --- |\n| slip |\n"
        assert f"## Limits\n\n{told}" in text
        assert "![How small (code `aaa`)](pictures/limits)" in text
        assert "slip 7" not in text, "the part was run, and nothing was wrong"
    assert "Not run anew" not in written("ddd", third, limits)
    says = "Run by itself, 1 of 2 (code `eee`)"
    alone = with_part(third, [replace(limits, rows=(("kick",),)), RIGHT], says)
    told = f"## Limits\n\n*{says}*\n\n| effect |\n| --- |\n| kick |\n"
    for text in (alone, written("fff", alone, none, RIGHT)):
        assert told in text
        assert "slip" not in text
    assert alone.count("## Limits") == 1
    assert "![How small (code `aaa`)](pictures/limits)" in alone


RIGHT = Table("Wrong", ("set",), ())


def test_a_line_of_the_results_is_what_was_judged() -> None:
    assert Judged.of(json.loads(json.dumps(LINE.line()))) == LINE
    assert HiddenSet("effect", ("castor_kick",), 1).name == LINE.name


def test_true_parameters_are_those_that_the_library_knows_within_its_bounds() -> None:
    from dataclasses import asdict

    from werrimbi_odom.effects import find
    from werrimbi_odom.simulation import hide

    for name in plan.EFFECTS:
        hidden = hide(name, seed=3)
        values = values_of(name, asdict(hidden.peculiarity))
        assert values, f"nobody knows what {name} is in the library's words"
        effect = find(name)
        for key, value in values.items():
            low, high = effect.parameters[key].bounds
            assert low <= value <= high
        away = [key for key, value in values.items() if value != effect.parameters[key].null]
        assert away, f"{name} as it is hidden is none at all to the library"
    assert values_of("cable_pull", {"rate": 0.01}) == {}


def test_true_multipliers_turn_counts_into_the_true_way() -> None:
    robot = {
        "wheel_separation": 0.4,
        "left_wheel_radius": 0.05,
        "right_wheel_radius": 0.05,
        "nominal": {"wheel_separation": 0.4, "wheel_radius": 0.05},
    }
    ratio = {"effect": "unequal_wheel_radii", "parameters": {"ratio": 1.01}}
    base = {"effect": "track_width", "parameters": {"multiplier": 1.02}}
    truth = {
        "robot_before_hiding": robot,
        "hidden": [ratio, base],
        "entered": [["wheel_radius", 2.0]],
    }
    found = multipliers_of(truth)
    left, right = found["left_wheel_radius_multiplier"], found["right_wheel_radius_multiplier"]
    assert right / left == pytest.approx(1.01)
    assert 0.5 * (left + right) == pytest.approx(0.5), "the radius was entered twice as large"
    assert found["wheel_separation_multiplier"] == pytest.approx(1.02)


def test_a_command_that_ends_with_an_error_ends_the_walk_where_it_began(folder: Path) -> None:
    before = Path.cwd()
    told = follow(folder)
    assert told.ended == "refused"
    assert told.error.startswith("werrimbi diagnose: ")
    assert (told.verdicts, told.added, told.first) == ([], [], {})
    assert Path.cwd() == before


def test_a_crash_of_the_tool_is_a_finding_and_not_the_end(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(words: object) -> None:
        raise ZeroDivisionError("float division by zero")

    monkeypatch.setattr("test.hidden.follow.run", broken)
    told = follow(folder)
    assert (told.ended, told.error) == ("crashed", "ZeroDivisionError: float division by zero")


def test_each_number_is_perturbed_in_one_of_three_samples() -> None:
    sets = [HiddenSet("clean", (), seed) for seed in range(3)]

    def numbers(start: int, every: int) -> Counter[str]:
        tasks = margins.tasks(sets, (1, every), start * plan.APART)
        return Counter(name for _, name, _ in tasks.values())

    parts = [numbers(start, 3) for start in (7, 8, 9)]
    assert sum(parts, Counter()) == numbers(7, 1)
    assert max(map(len, parts)) - min(map(len, parts)) <= 1


def test_what_all_effects_ask_of_the_same_drives_is_diagnosed_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    asked = []

    def followed(folder: Path, most: int) -> Followed:
        asked.append(folder)
        seen = [{"effect": name, "seen_from": 0.5, "unit": "m"} for name in ("a", "left_backlash")]
        return Followed(first={"could_have_been_seen": seen})

    monkeypatch.setattr(smallest, "follow", followed)
    monkeypatch.setattr(smallest, "make", lambda clean: Path(clean.name))
    clean = HiddenSet("clean", (), -1, smallest.SETUP)
    for _ in range(2):
        assert smallest.claimed(clean, "left_backlash") == 0.5
        assert smallest.claimed(clean, "castor_kick") is None
    assert len(asked) == 1
