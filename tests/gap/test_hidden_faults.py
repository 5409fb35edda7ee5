"""Mistakes that refitted parameters hide take part in the contest. The case is synthetic."""

from __future__ import annotations

from geocontact.effects.catalogue import candidates
from geocontact.gap.benchmark.drawing import Lot, drawn
from geocontact.gap.contest import base_contender
from geocontact.gap.faults import fault_of
from geocontact.gap.hidden_faults import hidden_mistakes
from geocontact.gap.problem import problem_of
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere


def exchanged_sides() -> tuple[tuple[str, ...], bool, list[str]]:
    """What was planted at a knee, whether that is gross, and which mistakes take part."""
    planted = drawn(Lot("knee", "fault", 20261133, 3))
    problem = problem_of(planted.case, system_of(planted.case))
    offered = candidates(problem.system)
    gross = fault_of(problem, offered) is not None
    hidden = hidden_mistakes(problem, base_contender(problem).judged, offered)
    return planted.label.effects, gross, [one.label for one in hidden]


def test_exchanged_channels_take_part_where_nothing_is_gross(elsewhere: Elsewhere) -> None:
    planted, gross, hidden = elsewhere(exchanged_sides)
    assert planted == ("side_swap",) and not gross
    assert "side_swap.force_medial_force_lateral" in hidden
