# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where a process for long work begins.

No imports but its own: it is started before all else, and imports beside its parent.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from multiprocessing.connection import Connection


def begin(asked: Connection) -> None:
    """See `work.work`."""
    from werrimbi_odom.workbench.work import work

    work(asked)
