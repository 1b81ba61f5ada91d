# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The whole proof: every rule over all hidden sets. Hours: `make evidence`."""

from __future__ import annotations

import os
from collections.abc import Sequence

import pytest

from test.hidden import plan
from test.hidden.__main__ import chosen, judge_all, results_file
from test.hidden.judge import Judged, results
from test.hidden.rules import RULES, Rule
from test.hidden.sets import make_all

pytestmark = pytest.mark.evidence


@pytest.fixture(scope="module")
def lines() -> Sequence[Judged]:
    """All results; what is not there yet is made now."""
    wanted, workers = plan.everything(), os.cpu_count() or 1
    for _ in make_all(wanted, workers):
        pass
    judge_all(wanted, workers, results_file())
    return chosen(list(results(results_file())), wanted)


@pytest.mark.parametrize("rule", RULES, ids=[rule.says for rule in RULES])
def test_rule(lines: Sequence[Judged], rule: Rule) -> None:
    there = rule.of(lines)
    assert there, "no set that the rule speaks of"
    broken = "\n".join(
        f"  {line.name}: {line.verdict} {line.found or line.error} rivals {line.rivals}"
        for line in rule.broken_by(lines)
    )
    assert rule.share(lines) >= rule.needed, f"of {len(there)} sets otherwise:\n{broken}"
