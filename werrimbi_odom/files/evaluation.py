# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How a model is evaluated on drives: one bundle for comparing, diagnosing, adding and fitting."""

from __future__ import annotations

from dataclasses import dataclass

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.model.encoder import EncoderLimits


@dataclass(frozen=True, slots=True, kw_only=True)
class EvaluationOptions:
    """Over which legs the relative pose error is taken, and what is known of the reference."""

    reference_kind: ReferenceKind = "absolute"
    """What the reference's noise is like: each pose's own, adding up, or that of a local map."""
    leg: float = 1.0
    """Length of a leg [m]; a quarter turn on the spot is one too."""
    limits: EncoderLimits | None = None
    """Which jumps of the counters are believed; None: as without any limit (`EncoderLimits()`)."""
    sigma_xy: float | None = None
    """The reference's noise in x and in y where it is known [m]; else as the record states it; else
    it is estimated from differences of the reference itself, so that no error of the model hides in
    it."""
    sigma_yaw: float | None = None
    """The same in heading [rad]."""

    @property
    def sigmas_known(self) -> tuple[bool, bool]:
        """Whether the reference's noise is known, of position and of heading."""
        return self.sigma_xy is not None, self.sigma_yaw is not None
