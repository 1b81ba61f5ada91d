# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The whole proof: every rule over fresh hidden sets. Long: `make evidence`, or ALL=1 with it."""

from __future__ import annotations

import os
from collections.abc import Sequence

import pytest

from test.hidden import field_table, plan
from test.hidden.__main__ import extent_wanted, judged_lines, works
from test.hidden.result_line import Judged
from test.hidden.resumable_jobs import done, kept, mark, results_of
from test.hidden.rules import RULES, Rule
from test.hidden.sets import make_all

pytestmark = pytest.mark.evidence


@pytest.fixture(scope="module")
def lines() -> Sequence[Judged]:
    """All results; what is not there yet is made now."""
    extent, start, workers = extent_wanted(), plan.start_of(mark()), os.cpu_count() or 1
    wanted = plan.plan(start, extent.sizes)
    for _ in make_all(wanted, workers):
        pass
    there = [each for each in wanted if each.path.exists()]
    part = works(there, start, extent)["judge"]
    for _ in done(results_of("judge"), part.tasks, part.by, workers):
        pass
    return judged_lines(there)


@pytest.mark.parametrize("rule", RULES, ids=[rule.says for rule in RULES])
def test_rule(lines: Sequence[Judged], rule: Rule) -> None:
    there = rule.of(lines)
    assert there, "no set that the rule speaks of"
    broken = "\n".join(
        f"  {line.name}: {' > '.join(line.verdicts)} {line.error} ends {line.ended}"
        for line in rule.broken_by(lines)
    )
    assert rule.share(lines) >= rule.needed, f"of {len(there)} sets otherwise:\n{broken}"


@pytest.mark.parametrize("part", ["field", "scans"])
def test_rules_of_ordinary_recordings(part: str) -> None:
    """Bags by a gyro, a localiser, both, positions alone and scans; others by scans alone."""
    work = works([], plan.start_of(mark()), extent_wanted())[part]
    for _ in done(results_of(part), work.tasks, work.by, os.cpu_count() or 1):
        pass
    there = {key: line for key, line in kept(results_of(part)).items() if key in work.tasks}
    assert len(there) == len(work.tasks)
    counted = field_table.rules(there)
    broken = {says: found for says, found in counted.items() if found[0] < found[2] * found[1]}
    assert not broken
