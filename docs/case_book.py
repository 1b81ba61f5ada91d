# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Writes docs/robots/: a page for each real robot, followed to its end by the tool's own advice.

    python docs/case_book.py [ROBOT...]

Some minutes a robot. Recordings are those of docs/real_robots.md; a robot that is not there is
passed over, and its page stays.
"""

from __future__ import annotations

import math
import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from follow_advice import CASES, ROBOTS, ROOT, Case, Step, compared, followed, verdict

sys.path.insert(0, str(ROOT))
from test.recorded_robots.robots import ROBOTS as RECORDED
from werrimbi_odom.files.text_files import replacing

PAGES = ROOT / "docs/robots"
SMALLEST = 1e-6
"""Noise of a heading below which its differences tell only how it was rounded [rad]."""
GYRO = ("--reference-kind", "incremental")
BOOK = (
    *CASES,
    Case("lego", "Lego robot", ("drive*",), ()),
    Case("kobuki_sound", "Kobuki, no fault", ("part_0", "part_1"), ("part_2",), GYRO),
    Case(
        "kobuki_left_taped",
        "Kobuki, tape on a quarter of the left tread",
        ("part_[1-4]",),
        ("part_0",),
        GYRO,
    ),
    Case(
        "kobuki_right_taped",
        "Kobuki, tape on the right tread",
        ("part_[1-4]",),
        ("part_0",),
        GYRO,
    ),
    Case("kobuki_both_taped", "Kobuki, tape on both treads", ("part_0",), (), GYRO),
    Case(
        "optitrack_in_june",
        "OptiTrack robot, half a year before",
        ("square*_0[1-4]", "circular*_0[1-4]", "ivanjko*_0[1-6]"),
        ("square*_0[5-6]", "circular*_0[5-6]", "ivanjko*_0[7-9]"),
    ),
    Case("upenn_skid_gyro", "Skid steer by its gyro", ("drive_20",), ("drive_21",), GYRO),
    Case("upenn_skid_icp", "Skid steer by a scan matcher", ("drive_20",), ("drive_21",), GYRO),
)


def page_of(case: Case) -> str:
    """The page of a robot."""
    (recorded,) = (robot for robot in RECORDED if robot.folder == case.robot)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        steps = followed(case, folder)
        judged = [compared(case, step.robot, folder) for step in steps]
        lines = [
            f"# {re.sub(', (median|rms) .*', '', case.told)}: `{case.robot}`",
            "",
            f"{recorded.source.name}, {recorded.source.commit[:12]}; {recorded.source.licence}. "
            f"{'; '.join(recorded.remarks)}.",
            "",
            f"Fitted on {' '.join(case.fitted)}; judged on "
            f"{' '.join(case.judged) or 'parts put aside, and in the tables on all of it'}. "
            "Written by `python docs/case_book.py`.",
            "",
            "## The way",
            "",
            *_table(steps, judged),
            "",
            *_what_is_left(steps[-1], judged[-1]),
            "",
            *_words(case, steps, folder),
        ]
    return "\n".join(lines) + "\n"


def _table(steps: list[Step], judged: list[dict[str, Any]]) -> Iterator[str]:
    """Errors on the drives that took no part, from step to step."""
    length = judged[0]["leg_m"]
    yield f"| added | legs of {length:g} m | rms | median | rms, heading | NEES | inside 95 % |"
    yield "| --- | --- | --- | --- | --- | --- | --- |"
    names = ["nothing", *(f"`{step.added}`" for step in steps[:-1])]
    for name, said in zip(names, judged, strict=True):
        legs = said["legs"]
        place, middle = (_mm(legs[f"{key}_position_m"]) for key in ("rmse", "median"))
        yaw, nees, inside = legs["rmse_yaw_rad"], legs["nees"], legs["coverage_95"]
        heading = "-" if yaw is None else f"{math.degrees(yaw):.2f}°"
        yield (
            f"| {name} | {legs['count']} | {place} | {middle} | {heading} | {nees:.3g} "
            f"| {100.0 * inside:.0f} % |"
        )
    yield ""
    yield "As `compare` of each robot file says: legs are cut by the sizes in that file, and those"
    yield "that stand far out are left out, so their number changes from row to row. `diagnose` and"
    yield "`add` keep to the legs of the file that they were given: figures below differ a little."


def _mm(metres: float | None) -> str:
    return "-" if metres is None else f"{1e3 * metres:.1f} mm"


def _what_is_left(last: Step, judged: dict[str, Any]) -> Iterator[str]:
    """The verdict, and what is left against the reference's own noise; whether it is white."""
    legs, seen = judged["legs"], judged["reference"][0]
    yield "## What is left"
    yield ""
    yield f"- Verdict: *{verdict(last.answer)}*."
    if (left := last.answer["left"]) is not None:
        told = _mm if left["unit"] == "m" else lambda yaw: f"{math.degrees(yaw):.2g}°"
        train, kept = (
            [told(left[side][name]) for name in ("error", "reference_noise")]
            for side in ("train", "holdout")
        )
        yield (
            f"- By `diagnose`, legs without events: {kept[0]} held out, {train[0]} fitted; the "
            f"reference's own noise and the rounding of the counts make {kept[1]} and {train[1]}."
        )
        alike = {name: each["correlation"] for name, each in left["neighbours"].items()}
        yield (
            "- Correlation of the fit's innovations from a short leg to the next: "
            + ", ".join(f"{name} {size:+.2f}" for name, size in alike.items())
            + "."
        )
    if last.refused:
        why = " ".join(last.refused.rpartition("werrimbi add: ")[2].split())
        yield f"- `add` refuses what is named: {why}"
    yield (
        f"- Errors are {math.sqrt(legs['nees']):.2g} times what model and reference promise "
        f"together (root of NEES; {legs['outliers']} outlying legs left out)."
    )
    told = {"estimated": "by its own small differences", "assumed": "assumed", "given": "as given"}
    if seen["measures"] != "heading":
        yield f"- The reference's noise, {told.get(seen['xy_told'], seen['xy_told'])}: " + (
            f"{_mm(seen['sigma_xy'])} each pose."
        )
    if seen["measures"] != "position":
        small = seen["sigma_yaw"] < SMALLEST
        size = "too little to tell" if small else f"{math.degrees(seen['sigma_yaw']):.2g}°"
        how = told.get(seen["yaw_told"], seen["yaw_told"])
        yield f"- The reference's noise of each heading, {how}: {size}."
    correlations = _correlations(judged["each_leg"])
    if correlations:
        yield "- From a leg to the next they " + "; ".join(correlations) + "."


def _correlations(legs: dict[str, Any]) -> list[str]:
    """Of errors of neighbouring legs, over what is promised for each; white noise has none."""
    said = []
    for channel in ("along", "sideways", "heading"):
        unit = "rad" if channel == "heading" else "m"
        error = np.array(legs[f"error_{channel}_{unit}"], dtype=float)
        sigma = np.array(legs[f"sigma_{channel}_{unit}"], dtype=float)
        run = np.array(legs["run"])
        sound = ~np.array(legs["outlier"], dtype=bool) & np.isfinite(error) & (sigma > 0.0)
        pairs = sound[:-1] & sound[1:] & (run[:-1] == run[1:])
        if pairs.sum() < 10:
            continue
        white = error / np.where(sigma > 0.0, sigma, 1.0)
        one, other = (part - part.mean() for part in (white[:-1][pairs], white[1:][pairs]))
        found = float(np.sum(one * other) / math.sqrt(np.sum(one**2) * np.sum(other**2)))
        limit = 1.96 / math.sqrt(float(pairs.sum()))
        word = "correlate" if abs(found) > limit else "are white"
        said.append(f"{word} {channel} ({found:+.2f}, chance to ±{limit:.2f})")
    return said


def _words(case: Case, steps: list[Step], folder: Path) -> Iterator[str]:
    """All that `diagnose` said before its tables."""
    for number, step in enumerate(steps):
        yield "## As its file says" if number == 0 else f"## With `{steps[number - 1].added}`"
        yield ""
        yield "```"
        words = step.words.partition("\n\n")[0]
        written = [
            (f"{folder}/{row}", f"{case.robot}/robot{'_better' * (row + 1)}")
            for row in range(len(steps))
        ]
        for place, name in ((str(ROBOTS / case.robot), case.robot), *written):
            words = words.replace(place, name)
        yield words.strip()
        yield "```"
        yield ""


def index() -> str:
    """The list of all pages that there are, made from them."""
    lines = [
        "# Case book",
        "",
        "Robots of [real_robots.md](../real_robots.md), those whose recordings were there when",
        "`python docs/case_book.py` wrote this. Each is followed by the commands that `werrimbi",
        "diagnose` prints until it prints no `add`; where `add` refuses an effect, by what it",
        "prints instead (where `diagnose` says *unknown* it prints a `draft`, which was not run).",
        "They are judged on drives that took no part in any fit, where there are such.",
        "*Left* is what the errors are times what model and reference promise together (root of",
        "NEES): 1 is nothing but noise; of few legs, or with wheels' noise as the file has it, it",
        "may be more where `diagnose`, which fits that noise, finds nothing. *Over the",
        "reference's*: the held-out error over what the reference's own noise and the rounding",
        "of the counts make of the same legs, where `diagnose` tells both.",
        "",
        "| robot | added | then | left | over the reference's |",
        "| --- | --- | --- | --- | --- |",
    ]
    for case in BOOK:
        place = PAGES / f"{case.robot}.md"
        if place.exists():
            text = place.read_text(encoding="utf-8")
            title = text.partition(":")[0].removeprefix("# ")
            added = [name for name in re.findall(r"^\| (\S+) \|", text, re.M) if "`" in name]
            (said,) = re.findall(r"^- Verdict: \*(.*)\*", text, re.M)
            (left,) = re.findall(r"^- Errors are (\S+) times", text, re.M)
            words = ", then ".join(added) or "nothing"
            both = re.search(r"legs without events: (\S+?)[m° ].* make (\S+?)[m° ]", text)
            over = f"{float(both[1]) / float(both[2]):.2g}" if both else "-"
            lines.append(f"| [{title}]({case.robot}.md) | {words} | {said} | {left} | {over} |")
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write the pages of the robots asked for; of all, where none is."""
    PAGES.mkdir(exist_ok=True)
    for case in BOOK:
        if sys.argv[1:] and case.robot not in sys.argv[1:]:
            continue
        if not (ROBOTS / case.robot).exists():
            print(f"{case.robot}: not there; `make recordings` fetches it")
            continue
        page = page_of(case)
        with replacing(PAGES / f"{case.robot}.md") as file:
            file.write(page)
        print(f"{case.robot}: written", flush=True)
    with replacing(PAGES / "README.md") as file:
        file.write(index())


if __name__ == "__main__":
    main()
