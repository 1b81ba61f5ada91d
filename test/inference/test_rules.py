# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that decide are in `inference.rules`, each with its reason; the reasons' figures hold."""

from __future__ import annotations

import ast
import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest
from scipy import stats

import werrimbi_odom
from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.consistency import chance_bounds
from werrimbi_odom.inference.distributions import noncentrality
from werrimbi_odom.inference.set_up.few_poses import _settings
from werrimbi_odom.inference.set_up.positions import _grid

PACKAGE = Path(werrimbi_odom.__file__).parent
INFERENCE = PACKAGE / "inference"
RULES = INFERENCE / "rules"

ELSEWHERE = {
    "calibration/noise_likelihood.py": {
        "_LEAST": "as good as zero: where the search of a variance ends",
        "_MOST": "the same, upwards",
    },
    "calibration/umbmark_equations.py": {"QUARTER": "a corner of a square"},
    "changes/scatter.py": {"_MEDIAN_CHI2_1": "a quantile"},
    "changes/change_points.py": {"_FEW": "time that it takes"},
    "distributions.py": {
        "MEDIAN_TO_SIGMA": "of the normal law",
        "NORMAL_95": "a quantile",
        "CHI2_95": "quantiles",
    },
    "events/common_cause.py": {"MOVES": "as good as standing, in a leg of a tenth of a second"},
    "events/steps.py": {"STRETCH": "time that it takes", "_HEARD": "a rank"},
    "comparison/local_map_errors.py": {
        "_MEDIAN_OF_A_SHARE": "a quantile",
        "_ROUNDS": "passes of the search of a doubt",
    },
    "comparison/over_variable.py": {
        "_BINS": "of a figure",
        "_FEWEST": "of a figure",
        "_PARTS": "of a figure",
        "_FEW": "of a figure",
        "FINE": "of a figure",
    },
    "comparison/position_filter.py": {
        "_MEDIAN_CHI2_2": "a quantile",
        "_MOST_DOUBT": "beyond any doubt: where the search of it ends",
        "_ROUNDS": "passes of that search",
    },
    "comparison/reference_noise.py": {
        "_THIRD": "binomial coefficients",
        "_SPANS": "of the differences: by doubles",
    },
    "comparison/systematic.py": {
        "_HUBER": "the usual one of Huber's estimate",
        "_FACTORS": "a grid",
        "_SAME": "a quantile: chi-squared of 99.9 %",
        "_BLOCK": "size of a block",
    },
    "diagnosis/cross_validation.py": {"_RANK": "a rank"},
    "diagnosis/evidence.py": {"BATCH": "size of a block"},
    "diagnosis/step_jacobians.py": {"BLOCK": "size of a block"},
    "diagnosis/without_events.py": {"_ROUNDS": "passes of a robust fit"},
    "comparison/reference_checks.py": {"_PAIRED": "time that it takes"},
    "diagnosis/response_curve.py": {
        "PARTS": "of a figure",
        "_UNTOLD": "of a figure: which error bars are too long to draw",
        "_BLURRED": "a rank",
        "_SAME": "rounding",
    },
    "fitting/caches.py": {
        "THREADS": "time that it takes",
        "_KEPT": "of memory",
        "MODELS": "size of a cache",
        "DELAYS": "size of a cache",
        "DRIVES": "size of a cache",
    },
    "fitting/candidate_starts.py": {"_SHARES": "where a fit starts"},
    "fitting/start_headings.py": {"ALL_ROUND": "where a fit starts", "_FIRST_NODES": "the same"},
    "fitting/filtering.py": {
        "STRETCH": "size of a block",
        "SIDE_BY_SIDE": "size of a block",
        "_COLUMNS": "size of a block",
    },
    "fitting/leg_loop.py": {"UNMEASURED": "as good as infinite"},
    "fitting/fit.py": {
        "_MEDIAN_CHI2_3": "a quantile",
        "_TAIL": "Student's t until jumps are known; the fit itself is without it",
    },
    "fitting/correlated_filter.py": {"ANEW": "as good as infinite"},
    "fitting/correlated_loop.py": {"GYRO_STATES": "size of a state"},
    "fitting/free_parameters.py": {"STEP": "of a derivative"},
    "fitting/noise.py": {
        "_LOWEST": "where the search of a variance ends",
    },
    "fitting/angle_score.py": {"FINE": "a grid", "_ROUNDS": "rounds of a fit"},
    "fitting/leg_noise.py": {"_BLOCK": "size of a block"},
    "legs/agreement.py": {
        "_TRIES": "laws that are tried",
        "REFITS": "rounds of a fit",
        "_RATIOS": "a grid",
        "TINY": "as good as zero",
        "_PARALLEL": "a rank",
        "CLEARLY": "what is too small to be divided by",
    },
    "legs/held_or_carried.py": {"_GRID": "of times"},
    "legs/motion_states.py": {"_GRID": "of times", "_REACH": "of times"},
    "legs/windows.py": {
        "_GRID": "of times",
        "_WINDOWS": "size of a sample",
        "_STILL": "as good as zero",
    },
    "legs/count_interpolation.py": {"ROUNDING": "of stamps"},
    "legs/cutting.py": {"ROUNDING": "of sums"},
    "linear.py": {"DETERMINED": "a rank", "ROUNDING": "a rank", "SILENT": "rounding"},
    "manoeuvres/ideal_drives.py": {"REST": "of an ideal drive [s]", "FINE": "its steps [s]"},
    "manoeuvres/expected_evidence.py": {"_RELUCTANT": "a rank, by the noise", "_WILLING": "a rank"},
    "set_up/clock_offset_search.py": {"_PERIOD": "of a grid"},
    "set_up/regression.py": {"_LARGE": "the usual one of Tukey's biweight"},
    "set_up/few_poses.py": {
        "STEPS": "time that it takes",
        "NUDGE": "of a derivative",
        "SAME": "rounding",
    },
}
"""Named numbers that decide nothing, by file, each with what it is."""

BARE = {
    ("drafting/law_forms.py", 3.1415927): "half a turn",
    ("calibration/noise_likelihood.py", 10.0): "a decade above where the search ends",
    ("diagnosis/evidence.py", 0.999): "a logarithm that stays finite",
    ("events/steps.py", 2.0): "either side",
    ("fitting/fisher_scoring.py", 0.01): "damping of a search",
    ("legs/even_stamps.py", 20.0): "what no wheel does between two messages: counters that wrap",
    ("legs/monotone_cubic.py", 3.0): "what keeps a cubic monotone (Fritsch and Carlson)",
    ("manoeuvres/ideal_drives.py", 0.2): "messages of an ideal drive [s]",
    ("manoeuvres/next_manoeuvre.py", 0.1): "in mm below it, in m above",
    ("set_up/positions.py", 0.002): "the last step of a descent",
    ("set_up/few_poses.py", 50.0): "an exponential that stays finite",
    ("set_up/regression.py", 15): "rounds before the weights change",
    ("set_up/regression.py", 16): "the same, and one",
}
"""Numbers in comparisons that decide nothing."""


@cache
def modules() -> list[tuple[str, ast.Module]]:
    """All of inference but the rules."""
    return [
        (path.relative_to(INFERENCE).as_posix(), ast.parse(path.read_text("utf-8")))
        for path in sorted(INFERENCE.rglob("*.py"))
        if RULES not in path.parents
    ]


def assigned(body: list[ast.stmt]) -> Iterator[tuple[str, ast.expr, ast.stmt | None]]:
    """Names with an upper-case name, what they are given, and the statement that follows."""
    for number, each in enumerate(body):
        after = body[number + 1] if number + 1 < len(body) else None
        if isinstance(each, ast.Assign):
            (target,) = each.targets
        elif isinstance(each, ast.AnnAssign):
            target = each.target
        else:
            continue
        names = target.elts if isinstance(target, ast.Tuple) else [target]
        for name in names:
            if isinstance(name, ast.Name) and name.id.isupper() and each.value is not None:
                yield name.id, each.value, after


def is_numeric(value: ast.expr) -> bool:
    """A number, several, or what is worked out of some by numpy or math."""
    if isinstance(value, ast.Dict):
        return False
    parts = list(ast.walk(value))
    constants = [part.value for part in parts if isinstance(part, ast.Constant)]
    names = {part.id for part in parts if isinstance(part, ast.Name)}
    return (
        bool(constants)
        and all(isinstance(item, (int, float)) and item is not True for item in constants)
        and names <= {"math", "np"}
    )


@cache
def of_rules() -> dict[str, tuple[str, ast.stmt | None]]:
    """File of each rule, and the statement that follows it."""
    found: dict[str, tuple[str, ast.stmt | None]] = {}
    for path in sorted(RULES.glob("*.py")):
        for name, _, after in assigned(ast.parse(path.read_text("utf-8")).body):
            assert name not in found, f"{name} is in {path.name} and in {found[name][0]}"
            found[name] = path.name, after
    return found


def test_rules_are_read_in_one_way() -> None:
    """As rules.NAME, so that one sees where a number that decides is from."""
    wrong = [
        path.relative_to(PACKAGE).as_posix()
        for path in PACKAGE.rglob("*.py")
        if f"from {rules.__name__} import" in path.read_text("utf-8")
    ]
    assert not wrong


def test_no_other_module_names_a_number() -> None:
    found = {
        (module, name)
        for module, tree in modules()
        for name, value, _ in assigned(tree.body)
        if is_numeric(value)
    }
    listed = {(module, name) for module, names in ELSEWHERE.items() for name in names}
    assert found - listed == set(), "what decides belongs in inference/rules/, with its reason"
    assert listed - found == set(), "listed, and not there"


def literals(value: ast.AST) -> Iterator[float]:
    """Numbers of an expression, but for indices and what is handed to functions."""
    if isinstance(value, ast.Constant) and isinstance(value.value, (int, float)):
        if not isinstance(value.value, bool):
            yield value.value
    elif isinstance(value, ast.Subscript):
        yield from literals(value.value)
    elif not isinstance(value, ast.Call):
        for part in ast.iter_child_nodes(value):
            yield from literals(part)


def bare(tree: ast.Module) -> Iterator[float]:
    """Numbers that something is compared with, or held above or below by `max` and `min`.

    None is nothing, one and a half are too common; two, as a count, is what makes more than one;
    below 1e-3 and above 1e3 are rounding and infinity.
    """
    for part in ast.walk(tree):
        held = isinstance(part, ast.Call) and getattr(part.func, "id", "") in ("max", "min")
        if isinstance(part, ast.Compare):
            places: list[ast.expr] = [part.left, *part.comparators]
        elif isinstance(part, ast.Call) and held:
            places = [each for each in part.args if isinstance(each, ast.Constant)]
        else:
            continue
        for place in places:
            for value in literals(place):
                usual = value in (0, 0.5, 1) or (value == 2 and isinstance(value, int))
                if not usual and 1e-3 < abs(value) < 1e3:
                    yield value


def test_nothing_is_compared_with_a_bare_number() -> None:
    found = {(module, value) for module, tree in modules() for value in bare(tree)}
    assert found - set(BARE) == set(), "give it a name in inference/rules/, and its reason"
    assert set(BARE) - found == set(), "listed, and not there"


def test_a_bare_or_named_number_would_be_found() -> None:
    tree = ast.parse(
        "FEW = 3\n_SPAN = (0.5, 2.0)\nWORDS = ('a', 2)\nok = a > 8.0 * b[3] + max(c, 4)"
    )
    assert [name for name, value, _ in assigned(tree.body) if is_numeric(value)] == ["FEW", "_SPAN"]
    assert sorted(bare(tree)) == [4, 8.0]


@pytest.mark.parametrize("name", of_rules())
def test_every_rule_has_its_reason_and_is_used(name: str) -> None:
    file, after = of_rules()[name]
    assert isinstance(after, ast.Expr), f"{file}: {name} has no reason"
    assert isinstance(after.value, ast.Constant)
    assert isinstance(after.value.value, str)
    assert len(after.value.value.split()) >= 8, f"{name}: that is no reason"
    assert hasattr(rules, name)
    assert name in used(), f"{name} is used by nobody"


@pytest.mark.parametrize(
    "file", ["model/slip.py", "ros/compare_motion.py", "ros/recent_messages.py"]
)
def test_what_decides_on_the_robot_has_its_reason_where_it_stands(file: str) -> None:
    """The core and the nodes cannot import from the rules, or need not."""
    tree = ast.parse((PACKAGE / file).read_text(encoding="utf-8"))
    named = [(name, after) for name, value, after in assigned(tree.body) if is_numeric(value)]
    assert named
    for name, after in named:
        assert isinstance(after, ast.Expr), f"{file}: {name} has no reason"
        assert isinstance(after.value, ast.Constant)
        assert len(str(after.value.value).split()) >= 8, f"{file}: {name}: that is no reason"


@cache
def used() -> set[str]:
    """Rules that some module reads as rules.NAME, or that another rule is made of."""
    found = set()
    for path in PACKAGE.rglob("*.py"):
        parts = list(ast.walk(ast.parse(path.read_text("utf-8"))))
        if path.parent == RULES:
            found |= {
                part.id
                for part in parts
                if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Load)
            }
        found |= {
            part.attr
            for part in parts
            if isinstance(part, ast.Attribute) and getattr(part.value, "id", "") == "rules"
        }
    return found


def test_the_figures_in_the_reasons_hold() -> None:
    r = rules
    chi2 = stats.chi2.sf
    assert 2.0 * stats.norm.sf(r.SIGNIFICANT) == pytest.approx(0.046, abs=5e-4)
    assert chi2(r.PENALTY_FLOOR, 1) == pytest.approx(0.014, abs=5e-4)
    assert math.exp(0.5 * r.RIVAL) == pytest.approx(150.0, rel=0.02)
    shown = stats.norm.sf((r.RIVAL - r.ENOUGH) / (2.0 * math.sqrt(r.ENOUGH)))
    assert shown == pytest.approx(0.97, abs=0.005)
    limits = [math.sqrt(noncentrality(1, r.SURE / 60, power)) for power in (r.POWER, 0.5)]
    assert limits == pytest.approx([5.95, 4.3], abs=0.01)
    strange = math.log(r.STRANGE_NOISE / r.TYPICAL_WHEEL_NOISE) / r.WHEEL_NOISE_SPREAD
    assert strange == pytest.approx(2.5, abs=0.01)
    assert stats.norm.sf(strange) == pytest.approx(6e-3, abs=5e-4)
    assert pytest.approx(7e-3, abs=1e-4) == 1.0 / r.JUMP_SCATTER**2
    held = r.NO_DRIVING_NOISE * stats.norm.isf(0.25)
    assert held == pytest.approx(3.4, abs=0.05)
    assert 1.0 / (2.0 * stats.norm.sf(held)) == pytest.approx(1300.0, rel=0.05)
    assert chi2(r.JUMP_OF_A_LEG, 3) == pytest.approx(1e-8, rel=0.1)
    floors = [chi2(degrees + r.SCORE_FLOOR, degrees) for degrees in (1, 2)]
    assert floors == pytest.approx([0.003, 0.007], abs=5e-4)
    assert stats.chi2.isf(r.SURE / 60, 1) == pytest.approx(18.5, abs=0.05)
    assert stats.f.isf(r.SURE, 1, r.LASTING_PARTS - 1) == pytest.approx(13.6, abs=0.05)
    assert stats.f.isf(r.SURE, 1, r.LASTING_FEWEST - 1) == pytest.approx(167.0, abs=0.5)
    assert stats.chi2.isf(r.VERY_SURE, r.FLOOR_CELLS) == pytest.approx(90.0, abs=0.2)
    assert math.sqrt(4.0 / math.pi) < r.NEAR == pytest.approx(1.128, abs=0.003)
    assert r.NEAR * r.ORDINARY < 2.0
    assert stats.t.isf(r.SURE_OF_LEGS / 2, r.LEGS_OF_A_PART - 1) == pytest.approx(11.2, abs=0.05)
    cells = r.CELLS_ACROSS**2
    assert stats.t.isf(r.SURE_OF_LEGS / cells, r.LEGS_IN_A_CELL - 1) == pytest.approx(89, abs=0.5)
    assert 1.0 / math.sqrt(2.0 * 3.0 * r.MANY_LEGS) == pytest.approx(0.07, abs=5e-3)
    bounds = chance_bounds(3 * r.FEWEST_LEGS, r.HONEST_CHANCE)
    assert bounds == pytest.approx((0.29, 2.33), abs=0.02)


def test_the_counts_and_bounds_in_the_reasons_hold() -> None:
    lags = round(2 * rules.DELAY_LONGEST / 0.1) + 1
    assert lags * math.exp(-rules.DELAY_EVIDENCE) == pytest.approx(3e-5, rel=0.05)
    tried = len(list(_settings()))
    assert tried == 588
    assert tried * math.exp(-rules.SPARSE_MARGIN) == pytest.approx(0.03, abs=0.005)
    assert len(_grid()) == 1260
    assert find("reference_lever_arm").parameters["x"].bounds[1] == rules.LONGEST_ARM
    assert find("reference_delay").parameters["delay"].bounds[1] == rules.DELAY_LONGEST
    assert rules.POSITION_CUTS == 5 * rules.WINDOW
    assert pytest.approx(math.sqrt(2.0) * rules.TAPE_XY, abs=2e-4) == rules.SPARSE_MOVE


@pytest.mark.parametrize(
    ("corner", "sides"), [(56.0, rules.LARGEST_OFFSET), (67.5, 1.3), (85.0, rules.LAP_TOLERANCE)]
)
def test_wrong_corners_put_the_end_of_a_square_where_the_reasons_say(
    corner: float, sides: float
) -> None:
    turn = math.radians(corner)
    end = abs(sum(complex(math.cos(leg * turn), math.sin(leg * turn)) for leg in range(4)))
    assert end == pytest.approx(sides, abs=0.04)
