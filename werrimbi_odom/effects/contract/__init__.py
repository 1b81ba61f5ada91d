# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Properties ("laws") that every effect must have; `check_effect` tests one effect for them.

Fits, the diagnosis and the node rely on them: live and recorded drives give equal results, results
do not depend on the message rate, an effect at its null values is the identity.

Begin with `check`; `wheel_and_body_laws` has the properties of effects on wheels and body.
"""

from werrimbi_odom.effects.contract.check import check_effect

__all__ = ["check_effect"]
