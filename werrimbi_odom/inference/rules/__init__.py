# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every number that decides a verdict, with its derivation or the reason for its choice.

If a number is derived, its docstring says from what. If it was chosen, it says so, and why.
Numerical tolerances (a rank, a step of a derivative, the size of a block) decide nothing and stay
where they are used. The margins of right and wrong verdicts to these numbers are plotted in
docs/evidence.md.
"""

from werrimbi_odom.inference.rules.calibrations import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.changes import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.comparison import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.drafting import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.events import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.gaps import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.held_or_carried import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.jumps import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.manoeuvres import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.priors import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.records import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.reference_checks import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.reporting import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.search import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.set_up import *  # noqa: F401, F403
from werrimbi_odom.inference.rules.significance import *  # noqa: F401, F403
