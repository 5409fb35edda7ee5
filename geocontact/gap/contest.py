"""Every candidate inside the simulator, refitted together with the base; the best of them with noise of their own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from geocontact.chain.candidate import Candidate
from geocontact.gap.evidence import Judged, bent_off, judged
from geocontact.gap.form import forms
from geocontact.gap.problem import Noise, Problem, evaluated
from geocontact.gap.refit import Refit, free, refit

SECOND = 18  # candidates that are fitted again under the noise that suits the best
FINALISTS = 6
FORERUNNERS = 3  # leading under quiet noise
MATE_TRIALS = 4  # second effects that are fitted on top of a first
MATES = 2  # of these that get noise of their own
ROUNDS, ENOUGH = 4, 0.05  # times that noise and parameters of a leader are fitted in turn; nats from which it goes on
FEW = 5  # free parameters up to which a joint fit also sets out from the case's own start


@dataclass(frozen=True)
class Contender:
    """The base model with some candidates, judged; none of them for the base itself."""

    candidates: tuple[Candidate, ...]
    judged: Judged

    @property
    def names(self) -> tuple[str, ...]:
        """Effects of the vocabulary, each once, in alphabetical order."""
        return tuple(sorted({one.name for one in self.candidates}))

    @property
    def label(self) -> str:
        """Candidates in one word."""
        return " + ".join(one.label for one in self.candidates) or "none"


def base_contender(problem: Problem) -> Contender:
    """The base model with the noise that suits it."""
    noise = problem.weighed(problem.plain)
    fitted = refit(problem.system, problem.calibration, problem.fitting(noise, problem.plain), [problem.plain.values])
    return finished(problem, (), fitted, noise)


def finished(problem: Problem, candidates: tuple[Candidate, ...], model: Refit, before: Noise) -> Contender:
    """A model fitted under somebody else's noise, refitted under its own."""
    noise = problem.weighed(model, before)
    again = refit(model.system, problem.calibration, problem.fitting(noise, model), [model.values], rounds=6)
    everywhere = evaluated(problem, again)
    one = judged(problem, everywhere, noise, forms(problem, candidates, everywhere))
    return Contender(candidates, one)


def settled_in(problem: Problem, one: Contender) -> Contender:
    """A contender after its parameters and its noise have come to terms.

    Each is fitted in turn, the noise to what the bends of the effects leave, until nothing is gained any more.
    """
    for _ in range(ROUNDS):
        model = replace(one.judged.model, residuals=bent_off(one.judged))
        other = finished(problem, one.candidates, model, one.judged.noise)
        if other.judged.nats < one.judged.nats + ENOUGH:
            return one if other.judged.nats < one.judged.nats else other
        one = other
    return one


def singles(problem: Problem, base: Contender, candidates: Sequence[Candidate]) -> list[Contender]:
    """The most likely candidates, best first.

    Noise fitted to the base model explains away what it misses, so all are fitted under quieter noise first, then under
    the noise that suits the best of them; the leading ones of both rounds get noise of their own.
    """
    reference = base.judged.model
    noise = problem.quieter(base.judged.noise)
    rounds: list[dict[str, Refit]] = []
    entered = candidates
    for _ in range(2):
        weighings = problem.fitting(noise, reference)
        found: dict[str, Refit] = {}
        for one in entered:
            if rounds:
                starts: list[Mapping[str, float]] = [rounds[-1][one.label].values]
            else:
                starts = [{**base.judged.model.values, **start} for start in one.starts]
                if len(free(problem.system)) < FEW and one.parameters:
                    starts.append(one.starts[0])
            found[one.label] = refit(one.apply(problem.system), problem.calibration, weighings, starts)
        rounds.append(found)
        entered = sorted(entered, key=lambda one: found[one.label].cost)[:SECOND]
        reference = min(found.values(), key=lambda model: model.cost)
        noise = problem.weighed(reference, base.judged.noise)
    first, second = rounds
    leading = [one.label for one in sorted(entered, key=lambda one: second[one.label].cost)[:FINALISTS]]
    others = [one.label for one in sorted(candidates, key=lambda one: first[one.label].cost)[:FORERUNNERS]]
    contenders = [
        finished(problem, (one,), (second if one.label in leading else first)[one.label], noise)
        for one in candidates
        if one.label in leading or one.label in others
    ]
    return sorted(contenders, key=lambda c: -c.judged.nats)


def mates(problem: Problem, first: Contender, candidates: Sequence[Candidate]) -> list[Contender]:
    """Pairs of a contender with a second candidate, best first; which to fit is told by one step of each."""
    model, noise = first.judged.model, first.judged.noise
    weighings = problem.fitting(noise, model)
    rows = sum(len(w.directions) for w in weighings)
    fitted = np.linalg.qr(model.whitened_jacobian[:rows])[0]
    left = model.whitened[:rows] - fitted @ (fitted.T @ model.whitened[:rows])
    before = model.residuals[: len(weighings)]
    promise: list[tuple[float, Candidate, Mapping[str, float]]] = []
    for one in candidates:
        if not one.parameters or one.name in first.names:
            continue
        system = one.apply(model.system)
        for start in one.starts:
            after = problem.calibration.residuals(system, {**model.values, **start})
            step = np.concatenate(
                [w((a - b)[..., None])[:, 0] for w, a, b in zip(weighings, before, after, strict=True)]
            )
            step = step - fitted @ (fitted.T @ step)
            power = float(step @ step)
            along = float(step @ left)
            promise.append((0.5 * max(along, 0.0) ** 2 / power if power > 0.0 else 0.0, one, start))
    promise.sort(key=lambda each: -each[0])
    chosen: dict[str, Candidate] = {}
    for _, one, _ in promise:
        if len(chosen) < MATE_TRIALS:
            chosen.setdefault(one.label, one)
    pairs = []
    for one in chosen.values():
        starts = [{**model.values, **start} for start in one.starts]
        pairs.append((one, refit(one.apply(model.system), problem.calibration, weighings, starts)))
    pairs.sort(key=lambda pair: pair[1].cost)
    done = [finished(problem, (*first.candidates, one), pair, noise) for one, pair in pairs[:MATES]]
    return sorted(done, key=lambda c: -c.judged.nats)
