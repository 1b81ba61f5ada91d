# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The table of docs/scans.md: `python -m test.scans.table` (a minute)."""

from __future__ import annotations

import numpy as np

from test.scans.drives import ahead, in_circles, matched, rms
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.lidar import Lidar, Room

PLAIN = Lidar()
FINE = Lidar(noise=3e-3, noise_share=2e-3)
HOKUYO = Lidar(beams=681, noise=0.01, noise_share=0.0)
LONG = 90.0

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
    "arena of 2.6 m": (in_circles(LONG, 0.12), rooms.arena(), PLAIN),
    "corridor with cupboards": (ahead(LONG), rooms.corridor_with_cupboards(), PLAIN),
    "the same corridor, 681 beams, 10 mm": (ahead(LONG), rooms.corridor_with_cupboards(), HOKUYO),
    "bare corridor": (ahead(LONG), rooms.corridor(), PLAIN),
    "empty hall": (ahead(LONG), Room(rooms.box(-60.0, -60.0, 60.0, 60.0)), PLAIN),
}


def main() -> None:
    """Print it."""
    print("| where | error of a leg of 1 m | stated, a pose | NEES | no match |")
    print("| --- | --- | --- | --- | --- |")
    for name, (path, room, lidar) in CASES.items():
        found = matched(path, room, lidar)
        none = found.path.scans - found.path.time.size
        if found.path.time.size == 0:
            print(f"| {name} | no poses | | | {none} of {found.path.scans} |")
            continue
        position, heading = rms(found.legs())
        _, nees = found.steps()
        stated = np.sqrt(np.median(found.path.covariances[:, [0, 2], [0, 2]], axis=0)) * 1e3
        print(
            f"| {name} | {position:.1f} mm, {heading:.1f} mrad | "
            f"{stated[0]:.1f} mm, {stated[1]:.1f} mrad | {nees.mean():.2f} | "
            f"{none} of {found.path.scans} |"
        )


if __name__ == "__main__":
    main()
