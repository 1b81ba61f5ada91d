# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The table of docs/scans.md, written there: `python -m test.scans.table` (3 to 6 minutes)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from test.scans.drives import ahead, brisk, in_circles, of_sweeps, rms
from test.scans.pitching import before_stairs_up, room_beside_stairs
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.lidar import Lidar, Room, scanned

PLAIN = Lidar()
FINE = Lidar(noise=3e-3, noise_share=2e-3)
HOKUYO = Lidar(beams=681, noise=0.01, noise_share=0.0)
LONG = 90.0
BRISK = brisk(LONG, seed=4)

CASES = {
    "room of 6 x 5 m": (in_circles(LONG), rooms.living_room(), PLAIN),
    "the same, all beams at once": (in_circles(LONG), rooms.living_room(), Lidar(rotates=False)),
    "the same, 3 mm + 0.2 %": (in_circles(LONG), rooms.living_room(), FINE),
    "the same, 15 mm + 1 %": (
        in_circles(LONG),
        rooms.living_room(),
        Lidar(noise=0.015, noise_share=0.01),
    ),
    "the same, 681 beams, 10 mm": (in_circles(LONG), rooms.living_room(), HOKUYO),
    "the same, 681 beams, 5 mm": (
        in_circles(LONG),
        rooms.living_room(),
        replace(HOKUYO, noise=0.005),
    ),
    "the same, 681 beams, 15 mm": (
        in_circles(LONG),
        rooms.living_room(),
        replace(HOKUYO, noise=0.015),
    ),
    "the same, 360 beams, 15 mm + 1 %, five turns a second": (
        in_circles(LONG),
        rooms.living_room(),
        Lidar(beams=360, noise=0.015, noise_share=0.01, rate_hz=5.0),
    ),
    "the same, 400 beams, 15 mm + 2 %, seven turns a second": (
        in_circles(LONG),
        rooms.living_room(),
        Lidar(beams=400, noise=0.015, noise_share=0.02, rate_hz=7.0),
    ),
    "the same, ranges 20 mm too long": (in_circles(LONG), rooms.living_room(), Lidar(bias=0.02)),
    "the same, half of the edges' echoes mixed": (
        in_circles(LONG),
        rooms.living_room(),
        Lidar(mixed=0.5),
    ),
    "the same, a fifth of the echoes lost": (
        in_circles(LONG),
        rooms.living_room(),
        Lidar(lost=0.2),
    ),
    "the same, three people walking": (in_circles(LONG), rooms.living_room(True), PLAIN),
    "the same, 2 m of a wall are glass": (in_circles(LONG), rooms.living_room_with_glass(), PLAIN),
    "the same, stairs down for 2 m of a wall": (in_circles(LONG), room_beside_stairs(), PLAIN),
    "the same, stairs up there, pitch of 1.5°": (in_circles(LONG), room_beside_stairs(), PLAIN),
    "the same, 10 mm too long, a tenth lost, a quarter mixed, people": (
        in_circles(LONG),
        rooms.living_room(True),
        Lidar(bias=0.01, lost=0.1, mixed=0.25),
    ),
    "another room, up to 0.8 m/s and 2 rad/s": (
        BRISK,
        rooms.around(BRISK.x_m, BRISK.y_m, 4),
        PLAIN,
    ),
    "arena of 2.6 m": (in_circles(LONG, 0.12), rooms.arena(), PLAIN),
    "corridor with cupboards": (ahead(LONG), rooms.corridor_with_cupboards(), PLAIN),
    "the same corridor, 681 beams, 10 mm": (ahead(LONG), rooms.corridor_with_cupboards(), HOKUYO),
    "bare corridor": (ahead(LONG), rooms.corridor(), PLAIN),
    "empty hall": (ahead(LONG), Room(rooms.box(-60.0, -60.0, 60.0, 60.0)), PLAIN),
}
SCANNED = {"the same, stairs up there, pitch of 1.5°": before_stairs_up}
"""How a case is scanned, if the lidar does not stay level."""

ROOMS = tuple(name for name in CASES if name not in ("bare corridor", "empty hall"))
DOCS = Path(__file__).parents[2] / "docs" / "scans.md"
HEAD = "| where | error of a leg of 1 m | stated, a pose | NEES, steps | NEES, legs | no match |"


@dataclass(frozen=True)
class Row:
    """What was seen of a case; figures of none where there are no poses."""

    none: int
    scans: int
    leg: tuple[float, float] = (math.nan, math.nan)
    """[mm, mrad]"""
    stated: tuple[float, float] = (math.nan, math.nan)
    nees: float = math.nan
    """Of steps from scan to scan, over 3."""
    nees_of_legs: float = math.nan
    """Of 1 m, over 3."""


def row(name: str) -> Row:
    """Match the scans of a case."""
    path, room, lidar = CASES[name]
    found = of_sweeps(SCANNED.get(name, scanned)(path, room, lidar, 0), lidar)
    none = found.path.scans - found.path.time.size
    if found.path.time.size == 0:
        return Row(none, found.path.scans)
    variances = np.median(np.diagonal(found.path.covariances, axis1=1, axis2=2), axis=0)
    stated = 1e3 * np.sqrt([variances[:2].mean(), variances[2]])
    (_, steps), (errors, legs) = found.steps(), found.legs()
    size = stated[0], stated[1]
    nees = float(steps.mean()), float(legs.mean())
    return Row(none, found.path.scans, rms(errors), size, *nees)


def line(name: str) -> str:
    """Of the table."""
    seen = row(name)
    none = f"{seen.none} of {seen.scans}"
    if seen.none == seen.scans:
        return f"| {name} | no poses | | | | {none} |"
    told = " | ".join(f"{mm:.1f} mm, {mrad:.1f} mrad" for mm, mrad in (seen.leg, seen.stated))
    return f"| {name} | {told} | {seen.nees:.2f} | {seen.nees_of_legs:.2f} | {none} |"


def main() -> None:
    """Print it, and put it in the place of the one in the docs."""
    lines = [HEAD, "| --- | --- | --- | --- | --- | --- |"]
    print("\n".join(lines))
    for name in CASES:
        lines.append(line(name))
        print(lines[-1], flush=True)
    put_into_page(DOCS, lines)


def put_into_page(page: Path, lines: Sequence[str]) -> None:
    """Put a table in the place of the one with the same head."""
    before, old = page.read_text(encoding="utf-8").split(lines[0])
    after = old.partition("\n\n")[2]
    page.write_text(before + "\n".join(lines) + "\n\n" + after, encoding="utf-8")


if __name__ == "__main__":
    main()
