# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The laws that every effect keeps, a user's own too; `check_effect` holds them against one.

Fits, the diagnosis and the node rely on them: that live equals recorded, that no result depends on
how often the counters were read, that an effect which is absent changes nothing.
"""

from werrimbi_odom.effects.contract.check import check_effect

__all__ = ["check_effect"]
