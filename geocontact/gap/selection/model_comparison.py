"""Every candidate inside the simulator, refitted together with the base; the best of them with noise of their own.

No real effect has exactly the form of a candidate. What a candidate adds to the prediction, as far as the base
parameters cannot make up for it, is multiplied by monomials of inputs, rates and time, channel by channel, and weights
of these are integrated out (a discrepancy as of Kennedy & O'Hagan, 2001, J. R. Stat. Soc. B 63:425, but proportional to
the effect). All weights together are worth a set share of the effect's own energy, so a wrong effect is not bent into a
right one for nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import recorded
from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.gap.case.noise_sources import usual_range
from geocontact.gap.case.problem import Noise, Problem, evaluated, filled
from geocontact.gap.case.refit import ENOUGH, ROUNDS, Refit, free, refit
from geocontact.gap.case.whitening import Whitening
from geocontact.gap.levels import FEW, LEADING, TURNS
from geocontact.gap.selection.evidence import Judged, judged, without_discrepancy
from geocontact.identify.optimise.bounded_gauss_newton import CLOSE

BENT = 0.15  # root mean square of the bending, as a share of the effect's
POWERS = ((1, 0), (2, 0), (0, 1), (0, 2), (1, 1))  # of an input's position and of its rate
TIMES = (1, 2, 3, 4, 5)  # of time within a trial: two turns of a slow drift


def discrepancy_basis(
    problem: Problem, candidates: tuple[Candidate, ...], model: Refit
) -> list[Float[np.ndarray, "_ c m"]]:
    """Discrepancy basis of each effect of a model in all trials, calibration first; weights have the standard deviation
    1. It is made of the samples that were measured, and 0 elsewhere.
    """
    everything = [*problem.calibration.trials, *problem.evaluation.trials]
    floor, base = problem.floor, problem.fitted
    slopes = [j[rows, :, :base] / floor[:, None] for j, rows in zip(model.jacobian, problem.samples, strict=True)]
    jacobian = np.concatenate([each.reshape(len(each) * len(floor), base) for each in slopes])
    monomials = _monomials(problem)
    made: list[list[np.ndarray]] = [[] for _ in everything]
    system = problem.system
    for one in candidates:
        after = one.apply(system)
        if one.somewhere is None:
            for parts, columns in zip(
                made, _of_one_effect(problem, model, system, after, jacobian, monomials), strict=True
            ):
                parts.append(columns)
        system = after
    channels = len(floor)
    return [
        np.concatenate(parts, axis=-1) if parts else np.zeros((len(t), channels, 0))
        for parts, t in zip(made, everything, strict=True)
    ]


def _of_one_effect(
    problem: Problem,
    model: Refit,
    before: System,
    after: System,
    jacobian: Float[np.ndarray, "n q"],
    monomials: list[Float[np.ndarray, "_ m"]],
) -> list[Float[np.ndarray, "_ c k"]]:
    added = []
    for measured in (problem.calibration, problem.evaluation):
        pairs = zip(measured.residuals(before, model.values), measured.residuals(after, model.values), strict=True)
        added += [(a - b) / problem.floor for a, b in pairs]
    whole = np.concatenate([each[rows].ravel() for each, rows in zip(added, problem.samples, strict=True)])
    whole = whole - jacobian @ np.linalg.lstsq(jacobian, whole, rcond=None)[0]
    channels = len(problem.floor)
    net = whole.reshape(-1, channels)
    kept = orthonormal(net, np.concatenate(monomials))
    size = BENT * float(np.linalg.norm(whole)) / np.sqrt(max(kept.shape[-1], 1))
    out = kept * size * problem.floor[:, None]
    parts = np.split(out, np.cumsum([len(b) for b in monomials])[:-1])
    return [filled(part, rows, len(a)) for part, rows, a in zip(parts, problem.samples, added, strict=True)]


def orthonormal(net: Float[np.ndarray, "k c"], monomials: Float[np.ndarray, "k m"]) -> Float[np.ndarray, "k c r"]:
    """Orthonormal columns that span each channel times the monomials; none that is too small beside the largest.

    Columns of one channel are 0 in all others, so that each channel has singular values of its own.
    """
    found = [np.linalg.svd(own[:, None] * monomials, full_matrices=False)[:2] for own in net.T]
    largest = max(*(singular[0] for _, singular in found), 1e-300)
    bases = [left[:, singular > CLOSE * largest] for left, singular in found]
    ends = np.cumsum([0, *(each.shape[1] for each in bases)])
    out = np.zeros((*net.shape, ends[-1]))
    for c, each in enumerate(bases):
        out[:, c, ends[c] : ends[c + 1]] = each
    return out


def _monomials(problem: Problem) -> list[Float[np.ndarray, "_ m"]]:
    """Monomials of every input's position and rate, each over its range, and of time within the trial, of `samples`."""
    trials = [*problem.calibration.trials, *problem.evaluation.trials]
    movements = [recorded(t.signals, problem.system.inputs, problem.system.motion.reach) for t in trials]
    columns = [[np.ones(len(t))] for t in trials]
    for row in range(len(problem.system.inputs)):
        p = _within([m.position[row] for m in movements])
        v = _within([m.rate[row] for m in movements])
        for made, a, b in zip(columns, p, v, strict=True):
            made += [a**i * b**j for i, j in POWERS]
    for made, t in zip(columns, trials, strict=True):
        phase = 2.0 * (t.time - t.time[0]) / (t.time[-1] - t.time[0]) - 1.0
        made += [phase**k for k in TIMES]
    return [np.stack(made, axis=1)[rows] for made, rows in zip(columns, problem.samples, strict=True)]


def _within(values: list[Float[np.ndarray, " _"]]) -> list[Float[np.ndarray, " _"]]:
    """-1 … 1 over the range that 98 % of the samples are in."""
    low, high = usual_range(np.concatenate(values))
    return [np.clip(2.0 * (v - low) / max(high - low, 1e-300) - 1.0, -1.0, 1.0) for v in values]


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


@dataclass(frozen=True)
class Ends:
    """Where searches of one case ended under other weights of its samples, by label.

    Weights move an end a little: searches set out there instead of far away, those that ended lowest first.
    """

    fits: dict[str, Refit] = field(default_factory=dict)
    noises: dict[str, Noise] = field(default_factory=dict)

    def noise_of(self, label: str) -> tuple[Noise, ...]:
        """What suited a model, if it got that far."""
        return (self.noises[label],) if label in self.noises else ()

    def of(self, one: Candidate, label: str) -> list[Refit]:
        """Where a model with this candidate last ended; mistakes in some trials are found anew."""
        return [self.fits[label]] if one.somewhere is None and label in self.fits else []

    def in_order(self, candidates: Sequence[Candidate]) -> list[Candidate]:
        """The candidates, those first that ended lowest."""
        return sorted(candidates, key=lambda one: self.fits[one.label].cost if one.label in self.fits else np.inf)


def base_contender(problem: Problem) -> Contender:
    """The base model with the noise that suits it."""
    noise = problem.weighed(problem.plain, problem.noise)
    plain = problem.plain
    whitenings = problem.fitting(noise, plain)
    fitted = refit(problem.system, problem.calibration, whitenings, [plain.values], known=[plain])
    return finished(problem, (), fitted, noise)


def finished(
    problem: Problem,
    candidates: tuple[Candidate, ...],
    model: Refit,
    before: Noise,
    *others: Noise,
    left: list[Float[np.ndarray, "_ c"]] | None = None,
) -> Contender:
    """A model fitted under somebody else's noise, refitted under its own.

    The search for that sets out from the likeliest of those that are known, `others` beside the one it was fitted with.
    It is the noise of the model's residuals, or of what is `left` of them.
    """
    noise = problem.weighed(model if left is None else replace(model, residuals=left), before, others)
    whitenings = problem.fitting(noise, model)
    again = refit(model.system, problem.calibration, whitenings, [model.values], ROUNDS // 2, known=[model])
    everywhere = evaluated(problem, again)
    one = judged(problem, everywhere, noise, discrepancy_basis(problem, candidates, everywhere))
    return Contender(candidates, one)


def settled_in(problem: Problem, one: Contender) -> Contender:
    """A contender after its parameters and its noise have come to terms.

    Each is fitted in turn, the noise to what the discrepancies of the effects leave, until nothing is gained any more.
    """
    for _ in range(TURNS):
        own = one.judged
        again = finished(problem, one.candidates, own.model, own.noise, left=without_discrepancy(own))
        other = replace(one, judged=again.judged)
        if other.judged.nats < one.judged.nats + ENOUGH:
            return one if other.judged.nats < one.judged.nats else other
        one = other
    return one


def singles(
    problem: Problem, base: Contender, candidates: Sequence[Candidate], ends: Ends | None = None
) -> list[Contender]:
    """The most likely candidates, best first; `ends` are those of earlier searches, and become those of these.

    Noise fitted to the base model explains away what it misses, so all are fitted under lower noise first, then under
    the noise that suits the best of them; the leading ones of both rounds get noise of their own. What does not promise
    to be among those that go on is not fitted to the end.
    """
    ends = Ends() if ends is None else ends
    first, second, entered, noise = _two_rounds(problem, base, candidates, ends)
    ahead = sorted(candidates, key=lambda one: first[one.label].cost)[:LEADING]
    chosen = [*((one, second) for one in entered), *((one, first) for one in ahead)]
    done: dict[str, Contender] = {}
    for one, fits in chosen:
        known = ends.noise_of(one.label) or (base.judged.noise, *(each.judged.noise for each in done.values()))
        own = finished(problem, (one,), fits[one.label], noise, *known)
        if one.label not in done or own.judged.nats > done[one.label].judged.nats:
            done[one.label] = own
    ends.noises.update({label: one.judged.noise for label, one in done.items()})
    return sorted(done.values(), key=lambda c: -c.judged.nats)


def _two_rounds(
    problem: Problem, base: Contender, candidates: Sequence[Candidate], ends: Ends
) -> tuple[dict[str, Refit], dict[str, Refit], list[Candidate], Noise]:
    """Fits of both rounds of `singles` by label, who is ahead after the second, and the noise that suits its best."""
    reference = base.judged.model
    noise = problem.with_lower_noise(base.judged.noise)
    rounds: list[dict[str, Refit]] = []
    entered = ends.in_order(candidates)
    for kept in (2 * LEADING**2, 2 * LEADING):
        whitenings = problem.fitting(noise, reference)
        found: dict[str, Refit] = {}
        for one in entered:
            known = [rounds[-1][one.label]] if rounds else ends.of(one, one.label)
            starts = [each.values for each in known] or _from_base(problem, base, one)
            useful, system = to_undercut(found.values(), kept), one.apply(problem.system)
            found[one.label] = refit(system, problem.calibration, whitenings, starts, useful=useful, known=known)
        if not rounds:
            ends.fits.update(found)
        rounds.append(found)
        entered = sorted(entered, key=lambda one: found[one.label].cost)[:kept]
        reference = min(found.values(), key=lambda model: model.cost)
        noise = problem.weighed(reference, base.judged.noise)
    first, second = rounds
    return first, second, entered, noise


def _from_base(problem: Problem, base: Contender, one: Candidate) -> list[Mapping[str, float]]:
    """Where the search for a candidate sets out: the fitted base, with few parameters the case's own start as well."""
    starts: list[Mapping[str, float]] = [{**base.judged.model.values, **start} for start in one.starts]
    return [*starts, one.starts[0]] if len(free(problem.system)) <= FEW and one.parameters else starts


def pairs(
    problem: Problem, firsts: Sequence[Contender], candidates: Sequence[Candidate], ends: Ends | None = None
) -> list[Contender]:
    """Leading contenders with a second candidate, the best pair of each two effects, best first.

    `ends` are those of earlier searches, and become those of these.

    Noise that was fitted to one effect explains away what the other does, so all pairs are fitted under noise no higher
    than was stated, the same for all, and the search for their own noise sets out from there; one linear step tells
    which to fit, and those that do not promise to be among the best are not fitted to the end.
    """
    low_noise = problem.with_lower_noise(firsts[0].judged.noise)
    ends = Ends() if ends is None else ends
    best: dict[tuple[str, ...], tuple[tuple[Candidate, ...], Refit]] = {}
    for first in firsts:
        model = first.judged.model
        whitenings = problem.fitting(low_noise, model)
        for one in promising(problem, first, whitenings, candidates):
            label = f"{first.label} + {one.label}"
            ended = ends.of(one, label)
            known = [] if first.mistaken else ended  # the trials that have a mistake may be others
            starts = [each.values for each in ended] or [{**model.values, **start} for start in one.starts]
            useful, system = to_undercut([pair for _, pair in best.values()], 2 * LEADING), one.apply(model.system)
            both = refit(system, problem.calibration, whitenings, starts, useful=useful, known=known)
            ends.fits[label] = both
            names = tuple(sorted((*first.names, one.name)))
            if names not in best or both.cost < best[names][1].cost:
                best[names] = ((*first.candidates, one), both)
    leading = sorted(best.values(), key=lambda pair: pair[1].cost)[: 2 * LEADING]
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
    return [one for _, one in ranked[: 2 * LEADING]]


def _whitened(whitenings: Sequence[Whitening], parts: Sequence[Float[np.ndarray, "_ c p"]]) -> Float[np.ndarray, "n p"]:
    return np.concatenate([w(part) for w, part in zip(whitenings, parts, strict=True)])
