# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Of random nonsense no size is told that its drives or a robot cannot have, by any command.

A gyro that stood still made `calibrate fit` say "not determined (below 2.7e+24 m)".
"""

from __future__ import annotations

import contextlib
import io
import json
import math
import re
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from test.cli.commands import refuse
from test.cli.nonsense import KINDS, Nonsense, nonsense
from werrimbi_odom.cli.main import main
from werrimbi_odom.inference import rules

DOCUMENTED = (0, 2)
PERCENT = 400.0
"""A wheel four times as large as entered (`CALIBRATION_BOUNDS`), or as small."""
SECONDS = 3 * 12.0
SIZES = re.compile(
    r"([\d.]+(?:e[+-]?\d+)?)\)?(?:e([+-]?\d+))? ?(mm|m\^0\.5|ms|mrad|m|s|rad|°|%)(?![\w/^])"
)


def said(*words: object) -> tuple[int, str]:
    """Code of a command, and all that it printed."""
    out = io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
        code = main([*map(str, words)])
    return code, out.getvalue()


def largest(data: Nonsense) -> dict[str, float]:
    """The largest size of each unit that the drives have, or a robot or its reference."""
    length = max(data.length, rules.LARGEST_OFFSET)
    return {
        "m": length,
        "mm": 1e3 * length,
        "s": SECONDS,
        "ms": 1e3 * SECONDS,
        "%": PERCENT,
        "rad": data.turning,
        "mrad": 1e3 * data.turning,
        "°": math.degrees(data.turning),
        "m^0.5": rules.STRANGE_NOISE,
    }


def beyond(words: str, limits: dict[str, float]) -> list[str]:
    """Printed sizes that there are not, and words for numbers that are none."""
    found = [
        each[0]
        for each in SIZES.finditer(words)
        if float(each[1]) * 10.0 ** int(each[2] or 0) > 1.01 * limits[each[3]] + 0.1
    ]
    return found + re.findall(r"\b(?:nan|inf|None)\b", words)


def numbers(item: Any, name: str = "") -> Iterator[tuple[str, float]]:
    """All numbers of a JSON document, each with its name, or with its unit."""
    if isinstance(item, dict):
        for key, each in item.items():
            own = key in ("value", "std", "before", "after", "size", "low", "high")
            unit = item.get("unit")
            yield from numbers(each, f"{name} _{unit}" if own and unit else name if own else key)
    elif isinstance(item, list):
        for each in item:
            yield from numbers(each, name)
    elif isinstance(item, float | int) and not isinstance(item, bool):
        yield name, float(item)


def beyond_in(document: Any, limits: dict[str, float]) -> list[tuple[str, float]]:
    """Numbers of a JSON document that are larger than there are."""
    found = []
    for name, value in numbers(document):
        unit = name.rpartition("_")[2]
        limit = limits.get(unit, math.inf) if "_" in name else math.inf
        if name.endswith("_multiplier"):
            limit = rules.CALIBRATION_BOUNDS[1]
        if name.endswith("_wheel_noise"):
            limit = limits["m^0.5"]
        if abs(value) > 1.01 * limit:
            found.append((name, value))
    return found


def judge(folder: Path, seed: int, wheels: str, seen: str) -> None:
    """Every command on one set of drives."""
    data = nonsense(folder, seed, wheels, seen)
    limits = largest(data)
    for verb in (["info"], ["compare"], ["diagnose"], ["calibrate", "fit"]):
        file = folder / "said.json"
        file.unlink(missing_ok=True)
        out = ["--out", folder / "fitted.yaml", "--force"] if "fit" in verb else []
        code, words = said(*verb, "--robot", data.robot, *data.runs, *out, "--json", file)
        words = words.replace(str(folder), "FOLDER")
        assert code in DOCUMENTED, words
        assert "Traceback" not in words, words
        assert not beyond(words, limits), (beyond(words, limits), limits, words)
        if code == 0:
            document = json.loads(file.read_text(), parse_constant=refuse)
            assert not beyond_in(document, limits), (beyond_in(document, limits), limits, words)
        else:
            assert words.splitlines()[-1].startswith(f"werrimbi {verb[0]}: "), words


@pytest.mark.evidence
@pytest.mark.usefixtures("few_effects")
def test_a_bound_that_says_nothing_is_not_told(tmp_path: Path) -> None:
    judge(tmp_path, 103, "steady", "still")


MADE = given(st.integers(0, 10**6), st.sampled_from(KINDS[:-2]), st.sampled_from(KINDS))
HOW: dict[str, Any] = {
    "deadline": None,
    "phases": [Phase.generate],
    "derandomize": True,
    "suppress_health_check": [HealthCheck.function_scoped_fixture],
}


@pytest.mark.usefixtures("few_effects")
@settings(max_examples=2, **HOW)
@MADE
def test_no_command_tells_a_size_that_nothing_has(seed: int, wheels: str, seen: str) -> None:
    with tempfile.TemporaryDirectory() as name:
        judge(Path(name), seed, wheels, seen)


@pytest.mark.evidence
@settings(max_examples=300, **HOW)
@MADE
def test_nor_does_it_with_all_effects(seed: int, wheels: str, seen: str) -> None:
    with tempfile.TemporaryDirectory() as name:
        judge(Path(name), seed, wheels, seen)
