"""A known effect put into measured trials, so that its owner sees what a diagnosis of them makes of it, and a judgement
of what it made.

What was measured stays: noise, deviations of trials and whatever else the model misses. A sensor's effect acts on the
measured outputs themselves; a mistake in the data is made in the columns; anything else is added as the difference
between the base model with and without it, y + S(u; θ, φ) - S(u; θ), at the base parameters that fit best. Missing
samples stay missing, except that a delay moves them with the others; what comes over from a channel that was not
measured is the model's. Samples for which one of the two models has no value (a centre of pressure without load) stay
as measured.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.diagnosis import Diagnosis, Estimate
from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.case.plain_fit import Plain
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import derivatives
from geocontact.gap.data_errors import mistaken
from geocontact.gap.identifiability.signatures import reach_of, rest_of
from geocontact.gap.levels import SURE

DOUBLINGS = 10
"""Doublings of the amplitude, from the faintest that is tried to the largest."""
HALVINGS = 20
"""Halvings of the interval in which the amplitude is looked for."""
IMITATED = 0.05
"""Gap, in noise floors, up to which base parameters are said to imitate an effect."""
Status = Literal["found", "there_before", "too_small", "possible", "imitated", "not_found"]


@dataclass(frozen=True)
class Injected:
    """A case with an effect put in.

    Parameters
    ----------
    case
        Outputs changed, and for a mistake in an input that input.
    values
        Of the effect's parameters, SI.
    size
        Root mean square of the gap that no base parameter reproduces, calibration trials, each channel in units of its
        floor; NaN for a mistake in the data.
    nats
        Evidence for it that all trials can hold at the most: half the sum of squares of the same gap, each channel in
        units of its noise alone, trials that are held out as large as the others; NaN for a mistake in the data.
    """

    case: GapCase
    values: Mapping[str, float]
    size: float
    nats: float


def inject(
    case: GapCase,
    problem: Problem,
    one: Candidate,
    values: Mapping[str, float],
    size: float,
    trials: frozenset[str] | None = None,
) -> Injected:
    """The case with the effect put in.

    Parameters
    ----------
    problem
        Of the same case: its base model at the fit.
    values
        Of parameters of the effect; those that are not given are where a search would set out, the amplitude so that
        the gap has `size`, or as large as its bounds admit.
    size
        Of `Injected.size`.
    trials
        For a mistake in the data: the trials that have it, all where None.
    """
    if one.somewhere is not None:
        some = frozenset(t.name for t in (*case.calibration, *case.evaluation)) if trials is None else trials
        return Injected(
            _changed(case, lambda trial: mistaken(trial, one) if trial.name in some else trial), {}, np.nan, np.nan
        )
    system = problem.system
    changed = one.apply(system)
    given = {p.name: p.start for p in one.parameters} | dict(values)
    amplitude = one.parameters[0]
    if amplitude.name not in values:
        given[amplitude.name] = _amplitude(problem, changed, one, given, size)
    case = _changed(case, lambda trial: _with(trial, system, changed, problem.plain.values, given))
    samples = sum(int(there.sum()) for there in problem.recorded.present)
    nats = 0.5 * samples * visible(problem, changed, given, problem.recorded.rough) ** 2
    return Injected(case, given, visible(problem, changed, given, problem.floor), nats)


def visible(problem: Problem, changed: System, values: Mapping[str, float], scale: Float[np.ndarray, " c"]) -> float:
    """`Injected.size` of the base model changed so, to first order in what base parameters can reproduce.

    `scale` is what each channel is divided by, in its unit.
    """
    measured, base = problem.calibration, problem.plain.values
    whiten = [Plain(there, scale) for there in measured.present]
    before = measured.residuals(problem.system, base)
    after = measured.residuals(changed, {**base, **values})
    moved = np.concatenate([w((a - b)[..., None])[:, 0] for w, a, b in zip(whiten, after, before, strict=True)])
    slopes = derivatives(problem.system, measured, base, before)
    basis = np.linalg.qr(np.concatenate([w(j) for w, j in zip(whiten, slopes, strict=True)]))[0]
    return float(np.sqrt(np.mean((moved - basis @ (basis.T @ moved)) ** 2)))


def chosen(offered: Sequence[Candidate], label: str) -> Candidate:
    """The candidate of that label, or of that name where it has one variant; ValueError with what there is."""
    exact = [one for one in offered if one.label == label]
    named = [one for one in offered if one.name == label]
    if len(exact) == 1 or len(named) == 1:
        return (exact or named)[0]
    if named:
        raise ValueError(f"{label} has variants; choose one of {', '.join(one.label for one in named)}")
    names = dict.fromkeys(one.name for one in offered)
    raise ValueError(f"{label!r} is not an effect of this system; there are {', '.join(names)}")


def _amplitude(problem: Problem, changed: System, one: Candidate, values: Mapping[str, float], size: float) -> float:
    """Where the gap has that size first, from where the effect is faintest on; the far end where it never has."""
    p = one.parameters[0]
    rest, reach = rest_of(one), reach_of(one, values)
    if not np.isfinite(reach):
        reach = 1e3 * (p.start - rest)

    def reached(share: float) -> bool:
        return visible(problem, changed, {**values, p.name: rest + share * reach}, problem.floor) >= size

    low = 0.0
    for share in 2.0 ** np.arange(-DOUBLINGS, 1.0):  # a clipped signal is flat again in the end: sizes rise and fall
        if reached(share):
            high = float(share)
            break
        low = float(share)
    else:
        return float(rest + reach)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if reached(middle) else (middle, high)
    return float(rest + high * reach)


def _changed(case: GapCase, change: Callable[[Trial], Trial]) -> GapCase:
    return replace(
        case,
        calibration=tuple(change(trial) for trial in case.calibration),
        evaluation=tuple(change(trial) for trial in case.evaluation),
    )


def _with(
    trial: Trial, system: System, changed: System, base: Mapping[str, float], given: Mapping[str, float]
) -> Trial:
    columns = [trial.signals.channels.index(name) for name in system.outputs]
    values = trial.signals.values.copy()
    measured = values[:, columns]
    by = np.nan_to_num(changed.simulate(trial, {**base, **given}) - system.simulate(trial, base))
    values[:, columns] = measured + by
    if all(getattr(changed, link) is getattr(system, link) for link in ("motion", "geometry", "law", "balance")):
        own = tuple(one for one in changed.sensor.modifiers if one not in system.sensor.modifiers)
        numbers = {**trial.covariates, **system.known, **base, **given}
        movement = system.motion.seen(trial, numbers)
        read = replace(changed.sensor, modifiers=own).read(measured, movement, numbers)
        kept = np.isfinite(read) | all(one.apart for one in own)
        values[:, columns] = np.where(kept, read, measured + by)
    return replace(trial, signals=replace(trial.signals, values=values))


@dataclass(frozen=True)
class Judgement:
    """Whether an injected effect was found.

    Parameters
    ----------
    status
        "found": named, and not before, or its parameter surely changed, and by what was injected. "there_before":
        named with and without it, and the parameter did not surely change, or not by what was injected. "too_small":
        all trials together cannot hold the evidence (`gap.levels.SURE`) from which an effect is named. "possible":
        among the effects in question only. "imitated": not found, base parameters reproduce it. "not_found": anything
        else.
    before
        Whether the case before was said to lack the effect.
    change, change_ci95
        Of the effect's first parameter, with the effect less without it, in the parameter's unit, with its 95 %
        interval; the effect counts as resting where it was not named before. None where it has no parameter, or is not
        named with it.
    holds
        Whether that interval holds what was injected; None where there is none.
    """

    status: Status
    before: bool
    change: float | None = None
    change_ci95: tuple[float, float] | None = None
    holds: bool | None = None

    def as_dict(self) -> dict[str, object]:
        """Keys of planted.json."""
        return {
            "status": self.status,
            "found": self.status == "found",
            "named_before": self.before,
            "change": self.change,
            "change_ci95": None if self.change_ci95 is None else list(self.change_ci95),
            "change_holds_planted": self.holds,
        }


def judged(one: Candidate, made: Injected, before: Diagnosis, after: Diagnosis) -> Judgement:
    """What came of an injected effect.

    Parameters
    ----------
    one, made
        The effect, and its parameters and gap.
    before, after
        Diagnoses of the same trials without it and with it.
    """
    was, is_named = one.name in before.effects, one.name in after.effects
    if not is_named and one.name not in after.ambiguity and imitated(one.name, made.size, after.absorbed):
        return Judgement("imitated", was)
    if made.nats < SURE:
        return Judgement("too_small", was)
    if not is_named:
        return Judgement("possible" if one.name in after.ambiguity else "not_found", was)
    moved = _change(one, before, after)
    if moved is None:
        return Judgement("there_before" if was else "found", was)
    change, low, high = moved
    holds = low <= made.values[one.parameters[0].name] - rest_of(one) <= high
    shown = holds and not low <= 0.0 <= high
    return Judgement("there_before" if was and not shown else "found", was, change, (low, high), holds)


def imitated(name: str, size: float, absorbed: tuple[str, ...]) -> bool:
    """Whether base parameters take what was injected: other variants of its name may be absorbed where it is not.

    Parameters
    ----------
    name, size
        Of the effect, and of its gap [noise floors].
    absorbed
        Effects that the diagnosis says base parameters imitate.
    """
    return name in absorbed and not size > IMITATED


def _change(one: Candidate, before: Diagnosis, after: Diagnosis) -> tuple[float, float, float] | None:
    """Change of the first parameter and its interval; None where the effect has none, or another variant is named.

    Variances of the two fits add, as if their noise were independent: it is the same noise, so the interval is wide.
    """
    if not one.parameters or one.parameters[0].name not in after.parameters:
        return None
    name = one.parameters[0].name
    new, old = after.parameters[name], before.parameters.get(name)
    first = old.value if old is not None else rest_of(one)
    change = new.value - first
    widths = [_sides(new), (0.0, 0.0) if old is None else _sides(old)]
    down = float(np.hypot(widths[0][0], widths[1][1]))
    up = float(np.hypot(widths[0][1], widths[1][0]))
    return change, change - down, change + up


def _sides(found: Estimate) -> tuple[float, float]:
    return found.value - found.ci95[0], found.ci95[1] - found.value
