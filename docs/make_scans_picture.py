# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the picture of docs/scans.md: a room as the scans saw it (needs Chrome or Chromium).

The robot and the room are simulated; halfway somebody puts a box over the lidar for three seconds.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from werrimbi_odom.report.save import save_png
from werrimbi_odom.report.style import BLUE, GREY, INK, ORANGE, PAPER
from werrimbi_odom.scans.sweep import Sweep, sweep_of
from werrimbi_odom.scans.three_pass_odometry import ScanMatcher
from werrimbi_odom.simulation import AxlePose, TrueRobot, figure_eight, record
from werrimbi_odom.simulation.lidar import Lidar, scanned
from werrimbi_odom.simulation.rooms import living_room

PICTURE = Path(__file__).parent / "pictures" / "scans.png"
COVERED = (11.0, 14.0)


def main() -> None:
    """Write it."""
    drive = record(TrueRobot(), figure_eight(0.7), seed=1, start=AxlePose(0.0, -0.2, 0.6))
    lidar = Lidar()
    seen = scanned(drive.true_path, living_room(people=True), lidar, 1)
    angles = lidar.increment * np.arange(lidar.beams)
    matcher, sweeps = ScanMatcher(), {}
    for time, ranges in zip(seen.time, seen.ranges, strict=True):
        covered = COVERED[0] < time < COVERED[1]
        ranges = np.full_like(ranges, 0.1) if covered else ranges
        sweep = sweep_of(time, ranges, angles, lidar.beam_interval, lidar.nearest, lidar.farthest)
        sweeps[sweep.time] = sweep
        matcher.take(sweep)
    path = matcher.path()
    pieces = np.unique(path.piece)
    spans = [path.time[path.piece == piece][[0, -1]] for piece in pieces]
    titles = [f"piece {n + 1}: {a:.0f} s to {b:.0f} s" for n, (a, b) in enumerate(spans)]
    figure = make_subplots(1, len(pieces), subplot_titles=titles, horizontal_spacing=0.05)
    for column, (piece, colour) in enumerate(zip(pieces, (BLUE, ORANGE), strict=False), 1):
        rows = np.flatnonzero(path.piece == piece)
        echoes = np.concatenate([_placed(sweeps[path.time[n]], path.poses[n]) for n in rows[::5]])
        x, y, _ = path.poses[rows].T
        marker = {"size": 2, "color": GREY, "opacity": 0.5}
        first = column == 1
        figure.add_scatter(
            x=echoes[:, 0],
            y=echoes[:, 1],
            mode="markers",
            marker=marker,
            name="echoes of every fifth scan",
            showlegend=first,
            row=1,
            col=column,
        )
        line = {"color": colour, "width": 3}
        figure.add_scatter(x=x, y=y, mode="lines", line=line, name="path", row=1, col=column)
        start = {"size": 9, "color": colour, "symbol": "circle"}
        figure.add_scatter(
            x=x[:1], y=y[:1], mode="markers", marker=start, name="begins", row=1, col=column
        )
        anchor = "x" if first else f"x{column}"
        figure.update_yaxes(scaleanchor=anchor, title="y [m]" if first else "", row=1, col=column)
        figure.update_xaxes(title="x [m]", row=1, col=column)
    _style(figure)
    if not save_png(figure, PICTURE):
        sys.exit("no Chrome or Chromium found; e.g. apt install chromium")
    print(PICTURE)


def _placed(sweep: Sweep, pose: np.ndarray) -> np.ndarray:
    cos, sin = np.cos(pose[2]), np.sin(pose[2])
    return np.asarray(sweep.points @ np.array([[cos, sin], [-sin, cos]]) + pose[:2])


def _style(figure: go.Figure) -> None:
    figure.update_layout(
        width=1000,
        height=470,
        paper_bgcolor=PAPER,
        plot_bgcolor=PAPER,
        font={"color": INK},
        margin={"l": 60, "r": 10, "t": 40, "b": 50},
        showlegend=False,
    )


if __name__ == "__main__":
    main()
