# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What --json writes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any


def write_json(path: Path, figures: Mapping[str, Any]) -> None:
    """Write figures for programs; what is not finite is null.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    from werrimbi_odom.files.replacing import replacing
    from werrimbi_odom.report.numbers import plain

    with replacing(path) as file:
        json.dump(plain(figures), file, indent=2, allow_nan=False)
        file.write("\n")
