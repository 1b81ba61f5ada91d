# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Commands that a diagnosis prints as its next step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class NextSteps:
    """Commands for the same robot and drives, ready to type."""

    add: Callable[[Sequence[str]], str] = lambda names: (
        f"werrimbi add {','.join(names)} --robot R RUN... --out NEW.yaml"
    )
    """Command to add effects of these names."""
    again: Callable[[Sequence[str]], str] = lambda names: "werrimbi diagnose --robot R RUN..."
    """Command to diagnose the drives of these names alone; "" for none."""
    on_map: str = (
        "werrimbi calibrate fit --robot R --reference-kind local_map RUN... --out NEW.yaml"
    )
    """Command to fit the wheels' noise beside a reference that wanders."""
    draft: str = "werrimbi draft --robot R RUN... --out my_effect"
    diagnose: str = "werrimbi diagnose"
