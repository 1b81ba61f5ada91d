# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the tolerances of pieces cost and save: prints the tables of docs/pieces.md.

For each drive, at several tolerances and several travels after which they hold in full: messages
per piece, and the worst error of any eigenvalue of the published covariance against propagation
message by message, after the first half metre.

    python benchmark/piece_tolerance.py
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from unittest.mock import patch

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from test.model.drives import ROBOT, Ticks, figure_eight, random_drive, square
from test.plain_twin import plain_run
from werrimbi_odom.model import end_of_piece
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.trajectory import trajectory

TOLERANCES = ((0.001, 0.003), (0.003, 0.01), (0.01, 0.03), (0.03, 0.1))
SETTLED = (0.01, 3.0, end_of_piece.SETTLED, 30.0, 100.0)
SETTLING = 0.5
"""Travel of the axle's middle and the wheels about it before errors count [m]."""


def worst_error(ticks: Ticks, plain: np.ndarray, tolerance: PieceTolerance) -> tuple[float, float]:
    """Messages per piece, and the worst relative error of an eigenvalue."""
    path = trajectory(ROBOT, *ticks, tolerance=tolerance)
    published = np.linalg.eigvalsh(path.covariance.matrix()[1:])
    rolled = np.abs(np.diff(ticks.left)) * ROBOT.left_tick
    rolled = 0.5 * np.cumsum(rolled + np.abs(np.diff(ticks.right)) * ROBOT.right_tick)
    settled = rolled > SETTLING
    error = np.abs(published[settled] / np.linalg.eigvalsh(plain[settled]) - 1.0)
    return ticks.time.size / len(path.pieces), float(error.max())


def main() -> None:
    """Print the tables in Markdown."""
    drives = {
        "square": [square()],
        "figure eight": [figure_eight()],
        "wandering": [random_drive(seed) for seed in range(5)],
    }
    plain = {
        name: [plain_run(ROBOT, *t[1:], 4)[1] for t in ticks] for name, ticks in drives.items()
    }

    def row(tolerance: PieceTolerance) -> str:
        cells = []
        for name, records in drives.items():
            found = [
                worst_error(ticks, exact, tolerance)
                for ticks, exact in zip(records, plain[name], strict=True)
            ]
            ratio = float(np.mean([each[0] for each in found]))
            cells.append(f"{ratio:.0f}, {max(each[1] for each in found):.2%}")
        return " | ".join(cells) + " |"

    print(heading("path, heading tolerance", drives))
    for path, angle in TOLERANCES:
        print(f"| {1e3 * path:g} mm, {1e3 * angle:g} mrad | {row(PieceTolerance(path, angle))}")
    print()
    print(heading("settled after", drives))
    for tracks in SETTLED:
        with patch.object(end_of_piece, "SETTLED", tracks):
            print(f"| {tracks:g} tracks | {row(PieceTolerance())}")


def heading(first: str, drives: Iterable[str]) -> str:
    """The head of a table."""
    names = [first, *drives]
    return "\n".join(f"| {' | '.join(row)} |" for row in (names, ["---"] * len(names)))


if __name__ == "__main__":
    main()
