# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Writing a recording in the project's run format: ticks.csv and reference.csv in a folder."""

from __future__ import annotations

from pathlib import Path

from .recording import Recording


def write_run(recording: Recording, folder: str | Path) -> Path:
    """Write `recording` as a run folder, made with its parents; the truth is left out.

    Parameters
    ----------
    recording : Recording
    folder : path

    Returns
    -------
    Path of the folder
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    names = "".join(f",{name}" for name in recording.channels)
    lines = [f"t_s,left_ticks,right_ticks{names}\n"]
    ticks = zip(
        recording.t_s,
        recording.left_ticks,
        recording.right_ticks,
        *recording.channels.values(),
        strict=True,
    )
    for t, left, right, *channels in ticks:
        extra = "".join(f",{value:.6g}" for value in channels)
        lines.append(f"{t:.6f},{left},{right}{extra}\n")
    (folder / "ticks.csv").write_text("".join(lines), encoding="utf-8")

    lines = ["t_s,x_m,y_m,yaw_rad\n"]
    poses = zip(
        recording.reference_t_s,
        recording.reference_x_m,
        recording.reference_y_m,
        recording.reference_yaw_rad,
        strict=True,
    )
    lines += [f"{t:.6f},{x:.6f},{y:.6f},{yaw:.6f}\n" for t, x, y, yaw in poses]
    (folder / "reference.csv").write_text("".join(lines), encoding="utf-8")
    return folder
