"""Every candidate inside the simulator, refitted together with the base; the best of them with noise of their own."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.candidate import Candidate
from geocontact.gap.case.problem import Noise, Problem, evaluated
from geocontact.gap.case.refit import Refit, free, refit
from geocontact.gap.case.whitening import Whitening
from geocontact.gap.selection.evidence import Judged, judged, without_discrepancy
from geocontact.gap.selection.model_discrepancy import discrepancy_basis

SECOND = 18  # candidates that are fitted again under the noise that suits the best
FINALISTS = 6
FORERUNNERS = 3  # leading under low noise
MATE_TRIALS = 6  # second effects that are fitted on top of a first
PAIRS = 6  # of two effects each that get noise of their own
ROUNDS, ENOUGH = 4, 0.05  # times that noise and parameters of a leader are fitted in turn; nats from which it goes on
FEW = 5  # free parameters up to which a joint fit also sets out from the case's own start


@dataclass(frozen=True)
class Contender:
    """The base model with some candidates, judged; none of them for the base itself.

    `beside` is what speaks for it besides its evidence [nats].
    """

    candidates: tuple[Candidate, ...]
    judged: Judged
    beside: float = 0.0

    @property
    def nats(self) -> float:
        """Evidence, and what speaks for it besides; only differences mean anything."""
        return self.judged.nats + self.beside

    @property
    def names(self) -> tuple[str, ...]:
        """Effects of the vocabulary, each once, in alphabetical order."""
        return tuple(sorted({one.name for one in self.candidates}))

    @property
    def cut_short(self) -> bool:
        """Whether an amplitude wants to be more than is physical: the case lacks something else."""
        return any(one.cut_short(self.judged.model.values) for one in self.candidates)

    @property
    def mistaken(self) -> bool:
        """Whether a mistake in the data is among the candidates."""
        return any(one.somewhere is not None for one in self.candidates)

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
    one = judged(problem, everywhere, noise, discrepancy_basis(problem, candidates, everywhere))
    return Contender(candidates, one)


def settled_in(problem: Problem, one: Contender) -> Contender:
    """A contender after its parameters and its noise have come to terms.

    Each is fitted in turn, the noise to what the discrepancies of the effects leave, until nothing is gained any more.
    """
    for _ in range(ROUNDS):
        model = replace(one.judged.model, residuals=without_discrepancy(one.judged))
        other = replace(one, judged=finished(problem, one.candidates, model, one.judged.noise).judged)
        if other.judged.nats < one.judged.nats + ENOUGH:
            return one if other.judged.nats < one.judged.nats else other
        one = other
    return one


def singles(problem: Problem, base: Contender, candidates: Sequence[Candidate]) -> list[Contender]:
    """The most likely candidates, best first.

    Noise fitted to the base model explains away what it misses, so all are fitted under lower noise first, then under
    the noise that suits the best of them; the leading ones of both rounds get noise of their own. What does not promise
    to be among those that go on is not fitted to the end.
    """
    reference = base.judged.model
    noise = problem.with_lower_noise(base.judged.noise)
    rounds: list[dict[str, Refit]] = []
    entered = candidates
    for kept in (SECOND, FINALISTS):
        whitenings = problem.fitting(noise, reference)
        found: dict[str, Refit] = {}
        for one in entered:
            if rounds:
                starts: list[Mapping[str, float]] = [rounds[-1][one.label].values]
            else:
                starts = [{**base.judged.model.values, **start} for start in one.starts]
                if len(free(problem.system)) < FEW and one.parameters:
                    starts.append(one.starts[0])
            useful = to_undercut(found.values(), kept)
            found[one.label] = refit(one.apply(problem.system), problem.calibration, whitenings, starts, useful=useful)
        rounds.append(found)
        entered = sorted(entered, key=lambda one: found[one.label].cost)[:kept]
        reference = min(found.values(), key=lambda model: model.cost)
        noise = problem.weighed(reference, base.judged.noise)
    first, second = rounds
    ahead = sorted(candidates, key=lambda one: first[one.label].cost)[:FORERUNNERS]
    chosen = [*((one, second) for one in entered), *((one, first) for one in ahead)]
    done: dict[str, Contender] = {}
    for one, fits in chosen:
        own = finished(problem, (one,), fits[one.label], noise)
        if one.label not in done or own.judged.nats > done[one.label].judged.nats:
            done[one.label] = own
    return sorted(done.values(), key=lambda c: -c.judged.nats)


def pairs(problem: Problem, firsts: Sequence[Contender], candidates: Sequence[Candidate]) -> list[Contender]:
    """Leading contenders with a second candidate, the best pair of each two effects, best first.

    Noise that was fitted to one effect explains away what the other does, so all pairs are fitted under noise no higher
    than was stated, the same for all, and the search for their own noise sets out from there; one linear step tells
    which to fit, and those that do not promise to be among the `PAIRS` best are not fitted to the end.
    """
    low_noise = problem.with_lower_noise(firsts[0].judged.noise)
    best: dict[tuple[str, ...], tuple[tuple[Candidate, ...], Refit]] = {}
    for first in firsts:
        model = first.judged.model
        whitenings = problem.fitting(low_noise, model)
        for one in promising(problem, first, whitenings, candidates):
            starts = [{**model.values, **start} for start in one.starts]
            useful = to_undercut([pair for _, pair in best.values()], PAIRS)
            both = refit(one.apply(model.system), problem.calibration, whitenings, starts, useful=useful)
            names = tuple(sorted((*first.names, one.name)))
            if names not in best or both.cost < best[names][1].cost:
                best[names] = ((*first.candidates, one), both)
    leading = sorted(best.values(), key=lambda pair: pair[1].cost)[:PAIRS]
    done = [finished(problem, together, model, low_noise) for together, model in leading]
    return sorted(done, key=lambda c: -c.judged.nats)


def to_undercut(models: Iterable[Refit], kept: int) -> float:
    """Cost that the next model must come below to be among the `kept` best; infinite while there are fewer."""
    costs = sorted(model.cost for model in models)
    return costs[kept - 1] if len(costs) >= kept else float("inf")


def promising(
    problem: Problem, first: Contender, whitenings: Sequence[Whitening], candidates: Sequence[Candidate]
) -> list[Candidate]:
    """Second candidates whose first step explains most of what a contender leaves, base and first refitted."""
    model = first.judged.model
    before = model.residuals[: len(whitenings)]
    fitted = np.linalg.qr(_whitened(whitenings, model.jacobian[: len(whitenings)]))[0]

    def net(parts: Sequence[Float[np.ndarray, "_ c"]]) -> Float[np.ndarray, " n"]:
        whole = _whitened(whitenings, [part[..., None] for part in parts])[:, 0]
        return np.asarray(whole - fitted @ (fitted.T @ whole))

    left = net(before)
    promise: dict[str, tuple[float, Candidate]] = {}
    for one in candidates:
        if not one.parameters or one.name in first.names:
            continue
        system = one.apply(model.system)
        for start in one.starts:
            after = problem.calibration.residuals(system, {**model.values, **start})
            step = net([a - b for a, b in zip(before, after, strict=True)])
            power = float(step @ step)
            gain = 0.5 * max(float(step @ left), 0.0) ** 2 / power if power > 0.0 else 0.0
            if one.label not in promise or gain > promise[one.label][0]:
                promise[one.label] = (gain, one)
    ranked = sorted(promise.values(), key=lambda each: -each[0])
    return [one for _, one in ranked[:MATE_TRIALS]]


def _whitened(whitenings: Sequence[Whitening], parts: Sequence[Float[np.ndarray, "_ c p"]]) -> Float[np.ndarray, "n p"]:
    return np.concatenate([w(part) for w, part in zip(whitenings, parts, strict=True)])
