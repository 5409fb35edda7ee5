"""Phases of overhead work, with and without a tool."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.work_phases import PHASES, work_phases
from tests.shoulder_exoskeleton.arms import raised

TIME = np.linspace(0.0, 6.0, 601)


def words(found: np.ndarray) -> list[str]:
    """Phases in the order in which they come, each once."""
    changes = np.flatnonzero(np.diff(found)) + 1
    return [PHASES[k] for k in found[[0, *changes]]]


def test_the_tool_bounds_the_screw_in() -> None:
    tool = (TIME > 2.5) & (TIME < 2.8) | (TIME > 3.1) & (TIME < 3.4)
    found = work_phases(raised(TIME), tool)
    assert words(found) == ["rest", "lift", "screw-in", "lower", "rest"]
    working = TIME[found == PHASES.index("screw-in")]
    assert working[0] == pytest.approx(2.51) and working[-1] == pytest.approx(3.39)


def test_without_a_tool_the_arm_works_while_it_is_high() -> None:
    found, angle = work_phases(raised(TIME)), raised(TIME)
    assert words(found) == ["rest", "lift", "screw-in", "lower", "rest"]
    assert angle[found == PHASES.index("screw-in")].min() > 0.2 + 0.9 * 1.8
    assert angle[found == PHASES.index("rest")].max() <= 0.2 + 0.1 * 1.8 + 1e-9


def test_what_cannot_be_told_is() -> None:
    with pytest.raises(ValueError, match="never runs while the arm is raised"):
        work_phases(raised(TIME), TIME < 0.1)
    assert not work_phases(np.full(50, 0.3)).any()
