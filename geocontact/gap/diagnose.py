"""From a case to its diagnosis: attribute, locate, shrink, and what the data cannot tell."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist

import numpy as np
from threadpoolctl import threadpool_limits

from geocontact.chain.system import System
from geocontact.data.diagnosis import (
    CellsHeld,
    ChannelGap,
    DataErrorFound,
    Diagnosis,
    Estimate,
    Partial,
    Unmodelled,
    Where,
)
from geocontact.data.diagnosis_evidence import HeldOut, Ranked
from geocontact.data.gap_case import GapCase
from geocontact.data.gap_cells import Cell, SurfaceGap
from geocontact.effects.catalogue import candidates
from geocontact.gap.attribute import Attribution, Listener, attribute, no_listener
from geocontact.gap.budget_verdict import (
    by_budget,
    grows,
    named_beside,
    partial,
    sure_beside,
    totals,
    with_gap,
    withdrawn,
)
from geocontact.gap.case.admission import admitted
from geocontact.gap.case.refit import free
from geocontact.gap.detected import detected
from geocontact.gap.experiment.proposal import first_of, next_experiment
from geocontact.gap.held_out_growth import confirmed, errors_of
from geocontact.gap.identifiability.non_identifiable import non_identifiable
from geocontact.gap.identifiability.separability import one_law
from geocontact.gap.levels import LEFT_OVER
from geocontact.gap.localise.gap_map import gap_map, windows
from geocontact.gap.localise.on_surface import on_surface
from geocontact.gap.localise.regions import regions
from geocontact.gap.reduction.error_budget import ChannelBudget, error_budget
from geocontact.gap.reduction.error_reduction import (
    TrialGain,
    error_reduction_of,
    held_out,
    leave_one_out,
)
from geocontact.gap.reduction.raw_input_errors import RawInputErrors
from geocontact.gap.remarks import remarks
from geocontact.gap.selection.evidence import Judged, prior_spread
from geocontact.gap.selection.model_comparison import base_contender
from geocontact.gap.selection.verdict import Answer, with_lapses
from geocontact.gap.unmodelled import ZERO, imitated, unmodelled
from geocontact.identify.intervals.quantile_intervals import ENDS

TOLD = 0.5  # of the prior's spread that the fit's may be, for a parameter that the trials tell


@dataclass(frozen=True)
class Findings:
    """A diagnosis with all that it rests on, for figures and further questions.

    Parameters
    ----------
    cells
        The gap map.
    held_out
        Held-out trials measured, by the base model, and with what was named.
    ranking
        Every model that was tried, by its gain.
    trials
        How much better each is predicted from all others with what was named; none where nothing was.
    surface
        Where on a mat the gaps lie of channels that have one; none where there are no cells.
    """

    diagnosis: Diagnosis
    attribution: Attribution
    cells: tuple[Cell, ...]
    held_out: tuple[HeldOut, ...]
    ranking: tuple[Ranked, ...]
    trials: tuple[TrialGain, ...] = ()
    surface: tuple[SurfaceGap, ...] = ()


def diagnose(case: GapCase, system: System, version: str = "", at: Listener = no_listener) -> Findings:
    """Where the base model of a case misses the measurement, why, and how far the gap shrinks, on one core.

    Parameters
    ----------
    case
        Trials and base parameters, SI units.
    system
        Its base model (`systems.catalogue.system_of`).
    version
        Of the package, for the record.
    at
        Is called in words with what is being done, as each stage begins: for progress.
    """
    with threadpool_limits(limits=1):  # matrices are small: threads would only wait for each other
        return _diagnosed(case, system, version, at)


def _diagnosed(case: GapCase, system: System, version: str, at: Listener) -> Findings:
    began = time.perf_counter()
    case = admitted(case, system)
    return findings(case, attribute(case, system, candidates, at), began, version, at)


def findings(
    case: GapCase, found: Attribution, began: float, version: str = "", at: Listener = no_listener
) -> Findings:
    """What follows from an answer: where, how far, what these trials cannot tell, what to record next.

    Parameters
    ----------
    case
        That was attributed.
    found
        The answer and what it rests on.
    began
        `time.perf_counter` when the diagnosis did.
    version, at
        As in `diagnose`.
    """
    found, errors = confirmed(case, found, at)
    at("what the error consists of")
    found, errors, budget, part, beside = settled(found, errors)
    said, problem = found.answer, found.problem
    named, chosen = is_named(said), said.chosen.judged
    offered = candidates(found.clean.system)
    at("what would be invisible")
    hidden = non_identifiable(found.clean, offered, said.effects)
    at("what is one law with it")
    law = one_law(found)
    at("the experiment to run next")
    then = next_experiment(found, first_of(offered, [each.name for each in hidden]))
    at("where it misses, and how far that shrinks")
    cells = gap_map(found.clean, found.base.judged)
    as_came = cells if found.data_error is None else gap_map(problem, base_contender(problem).judged)
    curves = held_out(problem, errors, named)
    gap = _gaps(found, errors, named, curves, budget)
    after = chosen if named else None
    where, surface = ((), ()) if said.verdict == "no_gap" else _places(case, found, after, as_came)
    diagnosis = Diagnosis(
        case=case.name,
        system=case.system,
        verdict=said.verdict,
        effects=said.effects,
        probabilities=said.probabilities,
        ambiguity=said.ambiguity,
        absorbed=tuple(each.name for each in hidden),
        where=where,
        gap=gap,
        parameters=estimates(chosen, errors.fitted),
        seconds=time.perf_counter() - began,
        version=version,
        faults=_faults(found),
        remarks=remarks(found, part is None, errors, budget),
        next_experiment=then,
        partial=part,
        behind=behind(found) if said.effects else {},
        one_law=law.classes,
        apart=law.apart,
        budget={name: one.parts for name, one in budget.items()},
        detected=detected(found),
        unmodelled=beside,
        regions=regions(found.clean, found.base.judged),
    )
    trials = leave_one_out(found.clean, found.base.judged, chosen) if named else ()
    return Findings(diagnosis, found, cells, curves, ranking(found, said.probabilities), trials, surface)


def settled(
    found: Attribution, errors: RawInputErrors
) -> tuple[Attribution, RawInputErrors, dict[str, ChannelBudget], Partial | None, tuple[Unmodelled, ...]]:
    """The answer of `budgeted`, or of one withdrawn that only imitates what is described beside it without a model."""
    found, errors, budget, part = budgeted(found, errors)
    beside = unmodelled(found, errors, budget)
    if found.answer.effects and imitated(beside, errors, found.problem):
        found, part = withdrawn(found), None
        errors = errors_of(found)
        budget = _budget(found, errors)
        found = replace(found, answer=by_budget(found, budget, errors))
        beside = unmodelled(found, errors, budget)
    if any(one.kind != ZERO for one in beside):
        found = replace(found, answer=with_gap(found.answer))
    found = replace(found, answer=with_lapses(found.answer, found.offered))
    return found, errors, budget, part, beside


def _places(
    case: GapCase, found: Attribution, after: Judged | None, as_came: tuple[Cell, ...]
) -> tuple[tuple[Where, ...], tuple[SurfaceGap, ...]]:
    """Windows of each channel's gap, with the cells of a mat that hold it, and where on the mat they are."""
    surface = on_surface(found.problem, after, found.data_error, case.cells)
    held = {one.channel: CellsHeld(one.holding, len(one.ids), *one.held, one.p_value) for one in surface}
    named = found.answer.effects
    stage = {one.name: one.stage for one in candidates(found.clean.system)}.get(named[0], "") if named else ""
    seen = windows(found.problem, found.clean, found.base.judged, after, found.data_error, as_came)
    return tuple(Where(w.channel, w.phase, w.share, w.p_value, stage, held.get(w.channel)) for w in seen), surface


def is_named(said: Answer) -> bool:
    """Whether errors are those of a model with effects: what is named, or the most probable where too many remain."""
    return bool(said.effects) or said.verdict == "unresolved"


def budgeted(
    found: Attribution, errors: RawInputErrors
) -> tuple[Attribution, RawInputErrors, dict[str, ChannelBudget], Partial | None]:
    """The answer as its budget has it, its errors, the budget, and what explains a part of a gap that stays unknown."""
    budget = _budget(found, errors)
    before, found = found, replace(found, answer=by_budget(found, budget, errors))
    if found.answer.chosen is not before.answer.chosen:
        errors = errors_of(found)
        budget = _budget(found, errors)
    best = partial(found) if found.answer.verdict == "unknown" else None
    if best is None:
        return found, errors, budget, None
    if sure_beside(found, best[0]):
        closer = replace(found, answer=named_beside(found.answer, best[0], True))
        of_closer = errors_of(closer)
        own = _budget(closer, of_closer)
        takes, missed, unexplained = totals(own, of_closer, found.problem)
        if unexplained <= LEFT_OVER * (takes + unexplained) and not grows(own):
            closer = replace(found, answer=named_beside(found.answer, best[0], False))
        if takes > missed:
            return closer, of_closer, own, None
    return found, errors, budget, best[1]


def _budget(found: Attribution, errors: RawInputErrors) -> dict[str, ChannelBudget]:
    said = found.answer
    return error_budget(
        found.problem, found.clean, errors, said.chosen.judged, is_named(said), found.stated, found.data_error
    )


def _gaps(
    found: Attribution,
    errors: RawInputErrors,
    named: bool,
    curves: Sequence[HeldOut],
    budget: Mapping[str, ChannelBudget],
) -> dict[str, ChannelGap]:
    """Size of each channel's gap, and how far it shrinks; the floor is what the first parts of the budget make."""
    problem, chosen = found.problem, found.answer.chosen.judged
    shrunk = error_reduction_of(errors, problem, chosen, named, found.data_error)
    return {
        name: ChannelGap(
            s.rmse_before,
            s.rmse_after,
            min(s.floor, s.rmse_before * budget[name].floor ** 0.5) if name in budget else s.floor,
            s.reduction,
            (s.low, s.high),
            s.unexplained,
            problem.system.unit(name),
            sum(bool(np.isfinite(trial.measured[:, problem.system.outputs.index(name)]).any()) for trial in curves),
        )
        for name, s in shrunk.items()
    }


def ranking(found: Attribution, probabilities: Mapping[str, float]) -> tuple[Ranked, ...]:
    """Every model that was tried, the base, and the surrogate of anything unknown; the largest gain first."""
    zero, unknown = found.base.judged, found.remaining["none"]
    rows = [
        Ranked("none", "none", 0.0, 0.0, probabilities.get("none", 0.0)),
        Ranked("unknown", "unknown", unknown.nats, unknown.calibration, probabilities.get("unknown", 0.0)),
    ]
    for one in sorted(found.contenders, key=lambda c: -c.nats):
        gain, calibration = one.nats - zero.nats, one.judged.calibration - zero.calibration
        first = len(one.names) == 1 and not any(row.effects == one.names[0] for row in rows)
        probability = probabilities.get(one.names[0], 0.0) if first else None
        rows.append(Ranked(one.label, " + ".join(one.names), gain, calibration, probability))
    return tuple(sorted(rows, key=lambda row: -row.gain))


def behind(found: Attribution) -> dict[str, float]:
    """By how many nats each effect that is in question and not named is behind what is.

    The evidence of its best model alone, over all trials, before prices; 0 where that is no less.
    """
    said = found.answer
    rivals = [name for name in said.ambiguity if name not in said.effects]
    best = {name: max((c.nats for c in found.contenders if c.names == (name,)), default=None) for name in rivals}
    return {name: max(said.chosen.nats - nats, 0.0) for name, nats in best.items() if nats is not None}


def estimates(judged: Judged, told: dict[str, float]) -> dict[str, Estimate]:
    """Every free parameter of the fit that is reported and drawn (`gap.case.plain_fit`), with its interval.

    Parameters
    ----------
    judged
        The model as it was judged: the curvature of its evidence on the calibration trials tells how well its own fit,
        weighed by noise and variation, knows a parameter. That fit is the more exact one where the form of the model is
        right, and then the square by which least squares differ from it adds to its variance (Hausman 1978,
        Econometrica 46:1251). Where the form is not right, the interval holds both.
    told
        The values that are reported.

    Curvature tells nothing of a parameter that ended on a bound: it gets the whole of what is physical, and is not
    called identified.
    """
    system, values = judged.model.system, judged.model.values
    spread = prior_spread(system, values)
    held = (spread == 0.0) | (prior_spread(system, told) == 0.0)
    scaled = judged.model.whitened_jacobian[: judged.fitted_rows] * spread
    covariance = spread[:, None] * np.linalg.inv(np.eye(len(spread)) + scaled.T @ scaled) * spread
    found, reach = {}, NormalDist().inv_cdf(ENDS[1])
    for k, p in enumerate(free(system)):
        sd = float(np.hypot(np.sqrt(covariance[k, k]), told[p.name] - values[p.name])) if not held[k] else np.inf
        low, high = (min(max(told[p.name] + s * reach * sd, p.lower), p.upper) for s in (-1.0, 1.0))
        identified = not held[k] and sd < TOLD * spread[k]
        found[p.name] = Estimate(told[p.name], (low, high), p.unit, bool(identified))
    return found


def _faults(found: Attribution) -> tuple[DataErrorFound, ...]:
    if found.data_error is None:
        return ()
    one = found.data_error.candidate
    return (DataErrorFound(one.name, one.channel, one.factor, found.data_error.trials),)
