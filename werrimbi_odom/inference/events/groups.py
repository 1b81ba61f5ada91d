# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Steps that are one event, and what they come to together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.events.steps import PoseStep, Steps
from werrimbi_odom.model.pose import Floats


def groups_of(steps: Steps) -> list[list[int]]:
    """Groups of step indices that are one event each, in order of time."""
    runs = steps.runs
    groups: list[list[int]] = []
    before: PoseStep | None = None
    for index in sorted(range(len(steps.found)), key=lambda index: steps.found[index].leg):
        step = steps.found[index]
        if (
            before is not None
            and runs.run_of_leg[before.leg] == runs.run_of_leg[step.leg]
            and (
                runs.ends_at[step.leg] - runs.ends_at[before.leg] <= rules.EVENT_JOIN
                or (before.shape, step) == ("spike", PoseStep("robot", before.leg + 1))
            )
        ):
            groups[-1].append(index)
        else:
            groups.append([index])
        before = step
    return groups


def returned_by(went: Floats) -> bool:
    """Whether steps of the reference (k, 3), in the noise, cancel one another: it came back."""
    left = float(np.linalg.norm(went.sum(axis=0)))
    return left < rules.JUMP_LASTS * float(np.linalg.norm(went, axis=1).max())


def net_of(
    steps: Steps, group: list[int], scatter: float, *, beside: bool
) -> tuple[Floats, Floats]:
    """Total of a group of steps (3,), in the axes of the first step, and its covariance.

    All steps are fitted together, if `beside` with a slow drift about the event as well. A prior of
    1 m and 1 rad keeps undetermined coordinates finite.
    """
    legs = [steps.found[index].leg for index in group]
    taken = set(group)
    if any(steps.found[index].shape == "robot" for index in group):
        own = steps.about(legs)
        # What a spike there says, steps of their own size in its two legs say as well.
        taken |= {
            index
            for index, step in enumerate(steps.found)
            if step.shape == "spike" and min(legs) - 1 <= step.leg <= max(legs)
        }
    else:
        own = steps.columns[:, _columns(group)]
    others = [index for index in range(len(steps.found)) if index not in taken]
    parts = [own, steps.columns[:, _columns(others)]]
    columns = np.concatenate([*parts, steps.creeping(legs[0])] if beside else parts, axis=-1)
    square = columns.T @ columns / scatter
    covariance = np.linalg.inv(square + np.eye(square.shape[0]))
    solution = covariance @ (columns.T @ steps.white) / scatter
    summed = np.zeros((3, columns.shape[1]))
    summed[:, : own.shape[1]] = np.tile(np.eye(3), own.shape[1] // 3)
    return summed @ solution, summed @ covariance @ summed.T


def _columns(steps: Sequence[int]) -> list[int]:
    return [3 * step + axis for step in steps for axis in range(3)]
