# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From the counters as they are recorded to those of the wheels."""

from __future__ import annotations

from typing import Any, NamedTuple


class Wiring(NamedTuple):
    """Which counter belongs to which wheel, and which way it counts."""

    swapped: bool = False
    """What is recorded as left is the right wheel."""
    left_sign: float = 1.0
    """With which the left wheel's counter is read, after the exchange."""
    right_sign: float = 1.0
    """The same for the right wheel."""

    def wheels(self, left: Any, right: Any) -> tuple[Any, Any]:
        """Counts of the true left and right wheel from what is recorded as left and right."""
        if self.swapped:
            left, right = right, left
        # No product with 1.0: it would round counters beyond 2^53.
        return (
            left if self.left_sign > 0.0 else -left,
            right if self.right_sign > 0.0 else -right,
        )
