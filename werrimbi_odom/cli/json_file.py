# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What --json writes."""

from __future__ import annotations

import json
import math
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

    with replacing(path) as file:
        json.dump(plain(figures), file, indent=2, allow_nan=False)
        file.write("\n")


def plain(value: Any) -> Any:
    """Values that JSON has; null for what is not finite."""
    if isinstance(value, Mapping):
        return {key: plain(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part) for part in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
