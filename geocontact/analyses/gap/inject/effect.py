"""The effect that is put in: which, where its parameters are, and in which trials."""

from __future__ import annotations

from collections.abc import Mapping

from threadpoolctl import threadpool_limits

from geocontact.analyses.gap.case_with_model import CaseWithModel
from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.chain.candidate import Candidate
from geocontact.data.errors import InputError
from geocontact.data.gap.case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.admission import admitted
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.inject import Injected, chosen, inject


def planted(given: CaseWithModel, o: InjectOptions) -> tuple[Candidate, Injected]:
    """The case with the effect in it; InputError where the system has no such effect, parameter or trial."""
    with threadpool_limits(limits=1):
        case = admitted(given.case, given.system)
        problem = problem_of(case, given.system)
        try:
            one = chosen(candidates(problem.system), o.effect)
        except ValueError as error:
            raise InputError("", "`effect`", str(error), "see docs/reference/gap_effects.md") from error
        trials = _trials(case, one, o)
        return one, inject(case, problem, one, _values(one, o), o.size, trials)


def _values(one: Candidate, o: InjectOptions) -> Mapping[str, float]:
    known = {p.name: p for p in one.parameters}
    for name, value in o.value.items():
        if name not in known:
            there = ", ".join(known) or "it has none"
            raise InputError("", "`value`", f"{name!r} is no parameter of {one.label}", f"parameters: {there}")
        p = known[name]
        if not p.lower <= value <= p.upper:
            what = f"{name} = {value:g} {p.unit} is outside of {p.lower:.4g} … {p.upper:.4g}"
            raise InputError("", "`value`", what, "its bounds are physical")
    return o.value


def _trials(case: GapCase, one: Candidate, o: InjectOptions) -> frozenset[str] | None:
    if not o.trial:
        return None
    if one.somewhere is None:
        raise InputError("", "`trial`", f"{one.label} is in every trial or in none", "leave it out")
    there = [trial.name for trial in (*case.calibration, *case.evaluation)]
    for name in o.trial:
        if name not in there:
            raise InputError("", "`trial`", f"there is no trial {name!r}", f"trials are {', '.join(there)}")
    return frozenset(o.trial)
