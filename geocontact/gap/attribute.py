"""Which effect: mistakes in the data first, then candidates inside the simulator, pairs, and what is unexplained."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.gap_case import GapCase
from geocontact.gap.case.noise_sources import with_rounding
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Problem
from geocontact.gap.data_errors import DataError, corrected, data_error_of, hidden_mistakes, recognised, undone
from geocontact.gap.levels import LEADING, SURE
from geocontact.gap.selection.evidence import Judged, settled
from geocontact.gap.selection.held_out_rules import TOO_LITTLE, HeldOutRules, calibration_share, changes
from geocontact.gap.selection.model_comparison import Contender, Ends, base_contender, pairs, settled_in, singles
from geocontact.gap.selection.residual_anomalies import (
    ClippedChannel,
    ResidualAnomaly,
    clipped_channels,
    recorder_remarks,
    residual_anomalies,
)
from geocontact.gap.selection.surrogate import Surrogate, surrogate
from geocontact.gap.selection.tails import Tails, tails
from geocontact.gap.selection.verdict import (
    Answer,
    answer,
    borne_out,
    contradicted,
    most_of,
    ranking,
    with_mistake,
    with_refused,
)
from geocontact.identify.noise.student import StudentNoise

CLIPPED = "saturation"  # what a flat top speaks for

Offer = Callable[[System], Sequence[Candidate]]
Listener = Callable[[str], None]
"""Is called with what is being done, as each stage of a diagnosis begins."""


def no_listener(_: str) -> None:
    """Does not listen."""


@dataclass(frozen=True)
class Attribution:
    """Everything that was found out about which effect it is.

    Parameters
    ----------
    problem
        Base model of the case as it came.
    data_error
        The mistake in the data that everything below takes as undone, if there is one.
    clean
        The case with it undone; `problem` itself where there is none.
    base
        The base model (with the mistake undone).
    contenders
        Models with effects, those with one first.
    remaining
        What the surrogate for anything unknown finds on the base ("none") and on the best contender, by label.
    odd
        Oscillations in the residual of the leader, each with its share of the base model's error.
    recorder
        What the recordings show of their recorder.
    objections
        Why models that gain may not be named, by label.
    flat
        Channels whose recordings end at a level.
    answer
        The verdict, its probabilities as computed: what is stated allows for lapses (`selection.verdict`).
    heavy
        Channels whose noise has heavy tails, in which samples and stretches have weights.
    stated
        Standard deviation of the noise of channels, in their units, as the case states it.
    offered
        Effects that were weighed.
    """

    problem: Problem
    data_error: DataError | None
    clean: Problem
    base: Contender
    contenders: tuple[Contender, ...]
    remaining: dict[str, Surrogate]
    odd: tuple[ResidualAnomaly, ...]
    recorder: tuple[ResidualAnomaly, ...]
    objections: dict[str, str]
    flat: tuple[ClippedChannel, ...]
    answer: Answer
    heavy: Mapping[str, StudentNoise] = field(default_factory=dict)
    stated: Mapping[str, float] = field(default_factory=dict)
    offered: tuple[str, ...] = ()


def attribute(case: GapCase, system: System, offer: Offer, at: Listener = no_listener) -> Attribution:
    """Which effect a case lacks; `offer` gives the candidates for a system once its scale is known.

    A mistake in the data is undone before anything else is judged: a gross one is found beforehand; one that refitted
    parameters hide wins against the effects, and the contest is held again without it.
    """
    at("the base model and the noise")
    problem = problem_of(case, system)
    data_error = data_error_of(problem, offer(problem.system))
    if data_error is None:
        found = _attributed(problem, None, problem, offer, case, at)
        mistaken = [one for one in found.answer.chosen.candidates if one.somewhere is not None]
        if not found.answer.effects or not mistaken:
            return found
        data_error = recognised(problem, mistaken[0], found.answer.chosen.judged.model)
    at(f"the {data_error.candidate.name} undone")
    case = corrected(case, data_error)
    return _attributed(problem, data_error, problem_of(case, system), offer, case, at)


def _attributed(
    problem: Problem, data_error: DataError | None, clean: Problem, offer: Offer, case: GapCase, at: Listener
) -> Attribution:
    """The contest of the effects, a mistake undone; `case` is what `clean` was made of.

    Where what nobody accounts for has heavy tails, it is held again with their weights.
    """
    ends = Ends()
    held = _contest(clean, data_error, Tails.none(clean), ends, offer, case, at)
    heavy = tails(clean, held.leader.judged, held.rest.predicted)
    if heavy.channels:
        at("the same with heavy tails of the noise")
        weighed = replace(heavy.weighed(clean), noise=held.base.judged.noise)
        del held  # its models are large
        problem, clean = weighed if clean is problem else problem, weighed
        held = _contest(clean, data_error, heavy, ends, offer, case, at)
    return replace(_answered(problem, data_error, clean, held, at), heavy=heavy.channels, stated=with_rounding(case))


@dataclass(frozen=True)
class Contest:
    """Models of a case, judged under one weight of each sample.

    Parameters
    ----------
    entered
        Candidates that took part alone.
    base, contenders
        The base model, and models with effects.
    first
        The base model under the noise that the contest began with.
    rest
        What the surrogate finds on the leader.
    flat
        Channels whose recordings end at a level.
    """

    entered: tuple[Candidate, ...]
    base: Contender
    contenders: tuple[Contender, ...]
    first: Judged
    rest: Surrogate
    flat: tuple[ClippedChannel, ...]

    @property
    def leader(self) -> Contender:
        """The model with the largest evidence, whether that may be named or not."""
        return max((self.base, *self.contenders), key=lambda one: one.nats)


def _contest(
    clean: Problem, data_error: DataError | None, heavy: Tails, ends: Ends, offer: Offer, case: GapCase, at: Listener
) -> Contest:
    """Every effect alone, pairs, and what the best of them leaves over."""
    candidates = offer(clean.system)
    base = base_contender(clean)
    first = base.judged
    hidden = hidden_mistakes(clean, base.judged, candidates) if data_error is None else ()
    entered = (*(one for one in candidates if one.parameters), *hidden)
    flat = clipped_channels(clean)
    at("every effect alone")
    single = _with_clipped(clean, base, singles(clean, base, entered, ends), candidates, flat)
    contenders = [*single]
    if single[0].nats - base.nats > SURE:
        at("two effects together")
        contenders += _credited(pairs(clean, _different(single)[:LEADING], candidates, ends), flat)
    base, *contenders = compared(clean, [base, *contenders])
    most = max(c.nats for c in contenders)
    contenders = [
        undone(clean, case, c, heavy)
        if c.candidates[0] in hidden and len(c.candidates) == 1 and c.nats > most - 2.0 * SURE
        else c
        for c in contenders
    ]
    at("whatever else it may be")
    leader = max((base, *contenders), key=lambda one: one.nats)
    return Contest(entered, base, tuple(contenders), first, surrogate(clean, leader.judged), tuple(flat))


def _answered(
    problem: Problem, data_error: DataError | None, clean: Problem, contest: Contest, at: Listener
) -> Attribution:
    """The verdict on a contest: what may be named, and what stays unexplained."""
    base, contenders, leader = contest.base, contest.contenders, contest.leader.judged
    shares = {c.label: calibration_share(clean, changes(clean, base, c)) for c in contenders}
    at("whether held-out trials are predicted better")
    rules = HeldOutRules.of(clean, base.judged)
    gaining = [c for c in contenders if c.nats > base.nats]
    alone = [c for c in contenders if len(c.candidates) == 1]
    objections = {c.label: why for c in gaining if (why := rules.objection(c, alone))}
    objections |= rules.outdone([c for c in gaining if c.label not in objections])
    variants = Counter(one.name for one in contest.entered)
    held = ranking(base, contenders, shares, variants, objections)
    odd = tuple(each for each in residual_anomalies(clean, held.leader.judged, base.judged) if each.nats > SURE)
    recorder = tuple(each for each in recorder_remarks(clean, held.leader.judged) if each.nats > SURE)
    best = held.best
    at("residuals")
    rest = contest.rest if best.judged is leader else surrogate(clean, best.judged)
    missing = contest.rest if leader is contest.first else surrogate(clean, contest.first)
    left = _believed(rules, best, rest) if best is base or rules.adds(rest, best) else 0.0
    ruled_out = {c.label for c in gaining if rules.ruled_out(c)}
    possible = ranking(base, gaining, shares, variants, ruled_out)
    harmful = ranking(base, gaining, shares, variants, {c.label for c in gaining if c.label not in ruled_out})
    little = {label for label, why in objections.items() if why == TOO_LITTLE}
    unnamed, known = _believed(rules, base, missing), most_of(possible, little)
    said = answer(held, unnamed, max((each.part for each in odd), default=0.0), left, known)
    said = with_refused(contradicted(said, held, harmful), possible)
    remaining = {"none": missing, best.label: rest}
    if data_error is not None:
        said = with_mistake(said, data_error.candidate.name)
    return Attribution(
        problem,
        data_error,
        clean,
        base,
        contenders,
        remaining,
        odd,
        recorder,
        objections,
        contest.flat,
        said,
        offered=tuple(dict.fromkeys(one.name for one in contest.entered)),
    )


def _believed(rules: HeldOutRules, over: Contender, found: Surrogate) -> float:
    """What a surrogate gains over a model, its choice paid for [nats]; nothing unless held-out trials are predicted
    better.

    As far as the calibration trials bear it out.
    """
    if not rules.unnamed(found, over.judged.model.residuals):
        return 0.0
    share = calibration_share(rules.problem, found.predicted)
    return borne_out(found.gain, found.calibration, share) - found.price


def compared(problem: Problem, contenders: Sequence[Contender]) -> list[Contender]:
    """Everyone under the noise of everyone who leads, and of the base, which comes first."""
    ranked = sorted(contenders[1:], key=lambda c: -c.nats)
    leading = {c.label: settled_in(problem, c) for c in ranked[:LEADING]}
    noises = [contenders[0].judged.noise, *(c.judged.noise for c in leading.values())]
    everyone = [leading.get(c.label, c) for c in contenders]
    return [replace(c, judged=settled(problem, c.judged, noises)) for c in everyone]


def _with_clipped(
    problem: Problem,
    base: Contender,
    contenders: Sequence[Contender],
    candidates: Sequence[Candidate],
    flat: Sequence[ClippedChannel],
) -> list[Contender]:
    """The singles and the saturation of each channel that ends at a level, best first."""
    channels, there = {one.channel for one in flat}, {c.label for c in contenders}
    clipped = [one for one in candidates if one.name == CLIPPED and one.channel in channels]
    others = [one for one in clipped if one.label not in there]
    return _credited([*contenders, *(singles(problem, base, others) if others else ())], flat)


def _credited(contenders: Sequence[Contender], flat: Sequence[ClippedChannel]) -> list[Contender]:
    """What a flat top tells counts for the saturation of its channel; best first."""
    by_channel = {one.channel: one.nats for one in flat}
    beside = [
        sum((by_channel.get(one.channel, 0.0) for one in c.candidates if one.name == CLIPPED), 0.0) for c in contenders
    ]
    found = [replace(c, beside=nats) for c, nats in zip(contenders, beside, strict=True)]
    return sorted(found, key=lambda c: -c.nats)


def _different(contenders: Sequence[Contender]) -> list[Contender]:
    """The best two variants of each effect at most, best first."""
    seen: dict[tuple[str, ...], int] = {}
    kept = []
    for one in contenders:
        seen[one.names] = seen.get(one.names, 0) + 1
        if seen[one.names] <= 2:
            kept.append(one)
    return kept
