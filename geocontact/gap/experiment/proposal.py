"""The experiment to run next: the change to the trials that tells apart most surely what they cannot tell apart.

For every change on the menu (`gap.experiment.menu`) the answers still in question are simulated on new trials, with the
parameters that were fitted to the old ones. The least that one leaves of another (`gap.experiment.proposal`),
either way round, is what a change is worth: first order tells which changes promise most, and the first of these that
keeps what is needed when competing models are refitted to old and new trials together is proposed. Where nothing was
found, changes are judged by what they make visible of effects that base parameters reproduce.

Where A is true and B is fitted instead, B leaves

    ½ rᵀ (I + D S² Dᵀ)⁻¹ r,   r = A's prediction minus B's, whitened, D B's derivatives, S their prior spread

to first order. B may do better than that by going further than derivatives reach; `remaining_nats` fits it to what A
predicts, within bounds, its prior around where it started: min ½ |r(φ)|² + ½ |(φ - φ₀)/S|².
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.chain.effect import Candidate
from geocontact.chain.system import System
from geocontact.data.diagnosis import NextExperiment
from geocontact.gap.attribute import Attribution
from geocontact.gap.case.noise_sources import noise_spread, quotient_noise, signal_size
from geocontact.gap.case.placement import placement
from geocontact.gap.case.problem import Problem
from geocontact.gap.case.refit import ROUNDS, Measured, RefitSearch, Whiten, derivatives
from geocontact.gap.case.whitening import Whitening, propagated_input_noise
from geocontact.gap.experiment.menu import Experiment, menu
from geocontact.gap.experiment.promise import outlooks_of, share_told_apart
from geocontact.gap.inputs.spectrum import measured_inputs
from geocontact.gap.levels import APART, LEADING
from geocontact.gap.selection.evidence import Judged, prior_spread
from geocontact.gap.selection.model_comparison import Contender
from geocontact.identify.noise.covariance import Layout
from geocontact.identify.optimise.bounded_gauss_newton import CLOSE


@dataclass(frozen=True)
class Hypothesis:
    """A model that may be true: the names that it stands for, what it is and how it was fitted.

    `residuals`, `jacobian` are those of the trials that exist.
    """

    name: str
    system: System
    values: dict[str, float]
    residuals: list[Float[np.ndarray, "_ c"]]
    jacobian: list[Float[np.ndarray, "_ c p"]]

    @property
    def spread(self) -> Float[np.ndarray, " p"]:
        """Prior standard deviation of its parameters."""
        return prior_spread(self.system, self.values)


@dataclass(frozen=True)
class ModelPair:
    """Somebody who is true, and somebody who is fitted instead."""

    true: Hypothesis
    confounder: Hypothesis


@dataclass(frozen=True)
class Rows:
    """Whitened difference of a pair on some trials, and the confounder's directions in units of their prior spread."""

    moved: Float[np.ndarray, " n"]
    directions: Float[np.ndarray, "n p"]

    def with_(self, other: Rows, times: int) -> Rows:
        """These rows, and others that are recorded so many times."""
        root = float(np.sqrt(times))
        moved = np.concatenate([self.moved, root * other.moved])
        return Rows(moved, np.concatenate([self.directions, root * other.directions]))

    @property
    def nats(self) -> float:
        """What the confounder leaves."""
        part = self.directions.T @ self.moved
        inner = np.eye(len(part)) + self.directions.T @ self.directions
        return 0.5 * float(self.moved @ self.moved - part @ np.linalg.solve(inner, part))


def competing_models(found: Attribution) -> list[Contender]:
    """The best model of each answer still in question, what is named first; mistakes in the data do not count.

    None where nothing is missing, though something gains that may not be named.
    """
    said = found.answer
    if said.verdict == "no_gap":
        return []
    competitors = [said.chosen] if said.chosen.candidates and said.verdict != "unknown" else []
    for name in said.ambiguity:
        if any(name in one.names for one in competitors):
            continue
        models = [c for c in found.contenders if name in c.names and len(c.names) <= max(len(said.effects), 1)]
        if models:
            competitors.append(max(models, key=lambda c: c.judged.nats))
    return [one for one in competitors if not one.mistaken]


def fitted(one: Contender) -> Hypothesis:
    """A contender as it was fitted to the trials that exist."""
    model = one.judged.model
    return Hypothesis("+".join(one.names), model.system, model.values, model.residuals, model.jacobian)


def on_trials(whitenings: Sequence[Whiten], pair: ModelPair) -> Rows:
    """A pair on the trials that exist, under some noise."""
    columns = [
        np.concatenate([(b - a)[..., None], j * pair.confounder.spread], axis=-1)
        for a, b, j in zip(pair.true.residuals, pair.confounder.residuals, pair.confounder.jacobian, strict=True)
    ]
    white = np.concatenate([w(part) for w, part in zip(whitenings, columns, strict=True)])
    return Rows(white[:, 0], white[:, 1:])


@dataclass(frozen=True)
class SimulatedTrials:
    """Trials without noise that the true model would give, and the confounder as it is in them; each so many times."""

    confounder: System
    measured: Measured
    whitenings: Sequence[Whiten]
    times: int = 1


def remaining_nats(confounder: Hypothesis, recordings: Sequence[SimulatedTrials]) -> float:
    """What a confounder leaves where it is refitted to these recordings together, within bounds [nats]."""
    from scipy.optimize import least_squares

    searches = [RefitSearch(one.confounder, one.measured, one.whitenings) for one in recordings]
    roots = [float(np.sqrt(one.times)) for one in recordings]
    first = searches[0]
    start = np.array([confounder.values[p.name] for p in first.parameters]) / first.scale
    weight = np.divide(first.scale, confounder.spread, out=np.zeros(len(start)), where=confounder.spread > 0.0)

    def whitened(parts: list[list[Float[np.ndarray, "_ c p"]]]) -> Float[np.ndarray, "n p"]:
        rows = [
            root * whiten(part)
            for root, one, own in zip(roots, recordings, parts, strict=True)
            for whiten, part in zip(one.whitenings, own, strict=True)
        ]
        return np.concatenate(rows)

    def residual(z: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        off = whitened([[r[..., None] for r in one.residuals(z.tobytes())] for one in searches])[:, 0]
        return np.concatenate([off, weight * (z - start)])

    def slope(z: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
        moved = -whitened([one.slopes(z.tobytes()) for one in searches]) * first.scale
        return np.concatenate([moved, np.diag(weight)])

    inside = np.clip(start, first.lower + 1e-6, first.upper - 1e-6)
    bounds = (first.lower, first.upper)
    return float(least_squares(residual, inside, slope, bounds, max_nfev=ROUNDS, ftol=CLOSE).cost)


TRIALS = 3  # of the new kind
TELLS = 3.0  # times the smallest separation that a change must promise
CHECKED = 4  # changes, the most promising ones, that are simulated with competing models refitted


@dataclass(frozen=True)
class Proposal:
    """What is said, the experiment, the pairs that it was chosen for, and the model whose noise they are weighed by."""

    said: NextExperiment
    experiment: Experiment
    pairs: tuple[ModelPair, ...]
    lead: Judged


def next_experiment(found: Attribution, confounded: Sequence[Candidate] = ()) -> NextExperiment | None:
    """The change that tells most; None where nothing is in question, or where nothing on the menu tells enough."""
    one = proposed(found, confounded)
    return None if one is None else one.said


def first_of(offered: Sequence[Candidate], names: Sequence[str]) -> list[Candidate]:
    """The first candidate with a parameter of each of these effects, of those that have one."""
    firsts = [[one for one in offered if one.name == name and one.parameters][:1] for name in names]
    return [one for some in firsts for one in some]


def proposed(found: Attribution, confounded: Sequence[Candidate] = ()) -> Proposal | None:
    """The same with what it was chosen by.

    Parameters
    ----------
    found
        What was attributed.
    confounded
        Candidates that the base parameters reproduce, asked about where nothing was found.
    """
    competitors = competing_models(found)[:LEADING]
    problem = found.clean
    if len(competitors) > 1:
        known = [fitted(one) for one in competitors]
        pairs = [ModelPair(a, b) for a in known for b in known if a is not b]
        return _most_promising(found, problem, competitors[0].judged, pairs)
    if found.answer.verdict == "no_gap" and confounded:
        base = fitted(found.base)
        pairs = [ModelPair(_confounded(problem, found.base.judged, one), base) for one in confounded]
        return _unveiling(problem, found.base.judged, pairs)
    return None


def _confounded(problem: Problem, base: Judged, one: Candidate) -> Hypothesis:
    """An effect where a search for it sets out, on top of the fitted base."""
    system, values = one.apply(problem.system), {**base.model.values, **one.starts[0]}
    residuals = [
        *problem.calibration.residuals(system, values),
        *problem.evaluation.residuals(system, values),
    ]
    return Hypothesis(one.name, system, values, residuals, base.model.jacobian)


def _most_promising(found: Attribution, problem: Problem, lead: Judged, pairs: list[ModelPair]) -> Proposal | None:
    """The most promising change that raises the smallest separation enough once competing models are refitted."""
    whitenings = problem.whitenings(lead.noise, lead.model)
    before = [on_trials(whitenings, pair) for pair in pairs]
    least = min(rows.nats for rows in before)
    needed = max(TELLS * least, APART)
    promised = [
        (min(rows.with_(more, TRIALS).nats for rows, more in zip(before, one.rows, strict=True)), one)
        for one in _new(problem, lead, pairs)
    ]
    promising = sorted((each for each in promised if each[0] > needed), key=lambda each: -each[0])
    for _, one in promising[:CHECKED]:
        left = [_remaining(problem, lead, one, pair) for pair in pairs]
        if min(left) > needed:
            names = [
                name for name in found.answer.ambiguity if any(name in pair.true.name.split("+") for pair in pairs)
            ]
            gains = [after - rows.nats for after, rows in zip(left, before, strict=True)]
            said = _next_experiment(one.experiment, names, min(left) - least, _share(found, problem, pairs, gains))
            return Proposal(said, one.experiment, tuple(pairs), lead)
    return None


def _share(found: Attribution, problem: Problem, pairs: Sequence[ModelPair], gains: Sequence[float]) -> float:
    """Share of repetitions after which all but the true explanation are out (`gap.experiment.promise`)."""
    by_name = {"+".join(one.names): one.nats for one in sorted(found.contenders, key=lambda one: one.nats)}
    names = tuple(dict.fromkeys(pair.true.name for pair in pairs))
    odds = found.answer.probabilities
    weights = {name: min(odds.get(each, 0.0) for each in name.split("+")) for name in names}
    left = {(pair.true.name, pair.confounder.name): gain for pair, gain in zip(pairs, gains, strict=True)}
    trials = len(problem.recorded.trials)
    most = (max(by_name[name] for name in names) - found.base.nats) * (trials + TRIALS) / trials
    return share_told_apart(outlooks_of(names, by_name, weights, left), most)


def _remaining(problem: Problem, lead: Judged, one: Rehearsed, pair: ModelPair) -> float:
    """What a confounder leaves of the truth where it is refitted to old trials and to new ones [nats]."""
    old = (problem.calibration, problem.evaluation)
    outputs = [each for measured in old for each in measured.outputs]
    known = Measured(
        tuple(trial for measured in old for trial in measured.trials),
        tuple(o - r for o, r in zip(outputs, pair.true.residuals, strict=True)),
        problem.calibration.rough,
    )
    moved = one.experiment
    truth = np.where(one.present, moved.staged(pair.true.system).simulate(moved.trial, pair.true.values), np.nan)
    new = Measured((moved.trial,), (truth,), problem.calibration.rough)
    return remaining_nats(
        pair.confounder,
        [
            SimulatedTrials(pair.confounder.system, known, problem.whitenings(lead.noise, lead.model)),
            SimulatedTrials(moved.staged(pair.confounder.system), new, [one.whiten], TRIALS),
        ],
    )


def _unveiling(problem: Problem, base: Judged, pairs: list[ModelPair]) -> Proposal | None:
    """The change that makes most effects visible that were reproduced, and of several the one that shows them best."""
    whitenings = problem.whitenings(base.noise, base.model)
    before = [on_trials(whitenings, pair) for pair in pairs]
    best: tuple[int, float, Experiment, list[str]] | None = None
    for one in _new(problem, base, pairs):
        shown = []
        for pair, rows, more in zip(pairs, before, one.rows, strict=True):
            after = rows.with_(more, TRIALS).nats
            if after > max(TELLS * rows.nats, APART):
                shown.append((after - rows.nats, pair.true.name))
        names = list(dict.fromkeys(name for _, name in shown))
        if shown and (best is None or (len(names), min(shown)[0]) > best[:2]):
            best = (len(names), min(shown)[0], one.experiment, names)
    if best is None:
        return None
    shown_by = tuple(pair for pair in pairs if pair.true.name in best[3])
    return Proposal(_next_experiment(best[2], best[3], best[1]), best[2], shown_by, base)


def _next_experiment(one: Experiment, names: Sequence[str], gain: float, share: float | None = None) -> NextExperiment:
    rounded = None if share is None else round(share, 2)
    return NextExperiment(tuple(names), f"record {TRIALS} trials: {one.words}", float(f"{gain:.3g}"), rounded)


@dataclass(frozen=True)
class Rehearsed:
    """One trial of an experiment as models predict it: its whitening, where it has values, and every pair on it."""

    experiment: Experiment
    whiten: Whitening
    present: np.ndarray
    rows: list[Rows]


def _new(problem: Problem, lead: Judged, pairs: list[ModelPair]) -> list[Rehearsed]:
    """Every pair on one trial of every change."""
    changes = menu(problem.system, problem.calibration.trials)
    return [_rehearsed(problem, lead, one, pairs) for one in changes]


def _rehearsed(problem: Problem, lead: Judged, one: Experiment, pairs: list[ModelPair]) -> Rehearsed:
    trial, rough = one.trial, problem.calibration.rough
    hypotheses = {id(each): each for pair in pairs for each in (pair.true, pair.confounder)}
    predicted = {key: one.staged(each.system).simulate(trial, each.values) for key, each in hypotheses.items()}
    present = np.isfinite(sum(predicted.values()))
    zero = Measured((trial,), (np.where(present, 0.0, np.nan),), rough)
    slopes = {
        id(pair.confounder): derivatives(one.staged(pair.confounder.system), zero, pair.confounder.values)[0]
        for pair in {id(pair.confounder): pair for pair in pairs}.values()
    }
    staged = one.staged(problem.system)
    base = {name: lead.model.values[name] for name in problem.plain.values}
    expected = [staged.simulate(trial, base)]
    shape = quotient_noise(staged, problem.recorded.outputs, rough)  # what is predicted has no noise
    spread, signal = noise_spread(staged, expected, shape)[0], signal_size(expected)[0]
    heard = propagated_input_noise(staged, trial, base, problem.passed, problem.left)
    layout = Layout.of(trial.time, present, heard, spread, signal)
    movable = measured_inputs(problem.recorded.trials, staged.inputs)
    placed = placement(staged, (trial,), base, movable, rough)[0]
    varied = np.concatenate([derivatives(staged, zero, base)[0], placed], axis=-1) * lead.noise.varies
    whiten = Whitening.of(layout.whitener(lead.noise.levels), varied)
    found = []
    for pair in pairs:
        off = np.where(present, predicted[id(pair.true)] - predicted[id(pair.confounder)], 0.0)
        white = whiten(np.concatenate([off[..., None], slopes[id(pair.confounder)] * pair.confounder.spread], axis=-1))
        found.append(Rows(white[:, 0], white[:, 1:]))
    return Rehearsed(one, whiten, present, found)
