# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From recorded counters to those of the wheels."""

from __future__ import annotations

from typing import Any, NamedTuple


class Wiring(NamedTuple):
    """Which counter belongs to which wheel, and its sign."""

    swapped: bool = False
    """The counter recorded as left is that of the right wheel."""
    left_sign: float = 1.0
    """Sign of the left wheel's counter, after the exchange."""
    right_sign: float = 1.0
    """The same for the right wheel."""

    def wheels(self, left: Any, right: Any) -> tuple[Any, Any]:
        """Counts of the true left and right wheel from those recorded as left and right."""
        if self.swapped:
            left, right = right, left
        # Not multiplied by 1.0: that would round counters beyond 2^53.
        return (left if self.left_sign > 0.0 else -left, right if self.right_sign > 0.0 else -right)
