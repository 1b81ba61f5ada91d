# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What an estimate computes at its first use is computed once, and only where asked."""

from __future__ import annotations

from werrimbi_odom.model.once import once


class Asked:
    def __init__(self) -> None:
        self.times = 0

    @once
    def answer(self) -> int:
        """What is asked."""
        self.times += 1
        return 42


def test_the_answer_is_worked_out_at_the_first_question_and_kept() -> None:
    asked, other = Asked(), Asked()
    assert asked.times == 0
    assert (asked.answer, asked.answer) == (42, 42)
    assert (asked.times, other.times) == (1, 0)
    assert Asked.answer.__doc__ == "What is asked."
