"""Rules on held-out trials that no evidence overrides.

An effect is named only if it predicts trials that are left out better, and worsens no channel of the held-out ones:
where the amplitude of what it changes, as those trials have it, is above one half (`gap.case.change_amplitude`); 1
where the change is what is missing. Whether it is there is asked of residuals that are whitened by noise and by what
trials differ by, which tell most; whether it does harm of residuals in units of the floor, inputs as they were
measured. What is named, or called unknown, takes at least a stated share of some channel's squared error away; and no
verdict hangs on a few samples or on one trial. Of two effects each must do all that beside the other alone.

A named effect takes its share of the error with the noise of the inputs taken off as well: rates as they were measured
are noisy, and what clips or filters a prediction passes less of that on, whatever is missing.

A channel whose squared error surely grows is predicted worse. Where it grows by less than that share it must be sure
beside what the held-out trials differ by, too: two of them have two deviations, however many blocks they are cut into.

The share is that of an error cleared of what the base parameters differ by in each trial: nobody can predict that, and
what they can take of an effect they have taken when the base model was refitted, so that clearing leaves the effect.
No base parameter is refitted beside something without a name: its share is that of the error as it is.

Held-out trials may be faster, larger or longer: an effect that calibration trials hardly show may show there. Its gain
is to be borne out in proportion to what the model with it changes, not to the number of samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float

from geocontact.chain.effect import Candidate
from geocontact.chain.system import FAR
from geocontact.gap.case.change_amplitude import Amplitude, amplitude
from geocontact.gap.case.noise_sources import measured_columns, noise_spread, quotient_noise
from geocontact.gap.case.placement import GAIN
from geocontact.gap.case.plain_fit import Plain, measured_fit, smoothed_fit
from geocontact.gap.case.problem import Noise, Problem
from geocontact.gap.case.refit import ENOUGH, free, refit
from geocontact.gap.case.whitening import Whitening
from geocontact.gap.levels import DEVIATIONS, LEFT_OVER, SLIGHT, SURE, WORTH_NAMING
from geocontact.gap.selection.evidence import Judged, prior_spread
from geocontact.gap.selection.model_comparison import Contender, finished
from geocontact.gap.selection.surrogate import Surrogate
from geocontact.identify.optimise.least_squares import NO_VALUE


def changes(problem: Problem, base: Contender, one: Contender) -> list[Float[np.ndarray, "_ c"]]:
    """What a model predicts otherwise than the base model, per trial, base parameters refitted.

    0 where either has no value, or no solution.
    """
    no_value = NO_VALUE * problem.calibration.rough

    def silent(residual: Float[np.ndarray, "_ c"]) -> Bool[np.ndarray, "_ c"]:
        return np.asarray((residual == no_value) | (np.abs(residual) > 0.5 * FAR))

    models = zip(base.judged.model.residuals, one.judged.model.residuals, strict=True)
    return [np.where(silent(a) | silent(b), 0.0, a - b) for a, b in models]


def calibration_share(problem: Problem, changed: Sequence[Float[np.ndarray, "_ c"]]) -> float:
    """Part of changes of all trials, squared, in units of the noise floor, that is in the calibration trials.

    That part of all samples where the changes are no more than rounding, or no number.
    """
    count = len(problem.calibration.trials)
    size = np.array([float(np.sum((each / problem.floor) ** 2)) for each in changed])
    if not ENOUGH < size.sum() < np.inf:
        size = np.array([float(each.size) for each in changed])
    return float(size[:count].sum() / size.sum())


@dataclass(frozen=True)
class TrialWeight:
    """What a residual of one trial weighs: (I + B Q Bᵀ)^(-1/2) D⁻¹, D the floor, B Q Bᵀ what trials differ by."""

    present: Bool[np.ndarray, "t c"]
    whitening: Whitening

    @classmethod
    def of(
        cls, present: Bool[np.ndarray, "t c"], floor: Float[np.ndarray, " c"], varied: Float[np.ndarray, "t c q"]
    ) -> TrialWeight:
        """From derivatives with respect to what varies, times its standard deviation."""
        return cls(present, Whitening.of(Plain(present, floor), varied))

    def __call__(self, values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
        """Weighed; 0 where nothing was measured."""
        out = np.zeros(values.shape)
        out[self.present] = self.whitening(values[..., None])[:, 0]
        return out

    def cleared(self, values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
        """What is left of a residual r, in units of the floor, once the trial's own deviation d is taken out.

        The most probable d is that of the least |r - B d|² + dᵀ Q⁻¹ d; what it leaves is r - B d = (I + B Q Bᵀ)⁻¹ r.
        """
        w, out = self.whitening, np.zeros(values.shape)
        white = w.whitener(values[..., None])[:, 0]
        out[self.present] = white - w.directions @ ((1.0 - (1.0 - w.gains) ** 2) * (w.directions.T @ white))
        return out


def taken_away(before: Sequence[Float[np.ndarray, "_ c"]], after: Sequence[Float[np.ndarray, "_ c"]]) -> float:
    """The largest share of a channel's squared error that is gone, below 0 where all grow; 0 where nothing is there."""
    old, new = (np.sum([(part**2).sum(axis=0) for part in parts], axis=0) for parts in (before, after))
    return float(np.max(1.0 - new[old > 0.0] / old[old > 0.0], initial=-np.inf)) if (old > 0.0).any() else 0.0


ONLY_NOISE = f"with the noise of the inputs taken off it takes less than {WORTH_NAMING:.0%} of the squared error away"
TOO_LITTLE = f"in no channel it takes {WORTH_NAMING:.0%} of the squared error away"


@dataclass(frozen=True)
class HeldOutRules:
    """The base model on the held-out trials, and what a model with an effect must do there to be named.

    Parameters
    ----------
    problem
        The case.
    base
        The base model as it was judged.
    before
        Its residuals on the held-out trials, refitted to the calibration trials, inputs as they were measured.
    calm
        The same with the noise of the inputs taken off.
    weights
        Of all trials.
    fitted, calmed
        Residuals of models on the held-out trials, by label, once they were computed: inputs as they were measured, and
        with their noise taken off.
    """

    problem: Problem
    base: Judged
    before: list[Float[np.ndarray, "_ c"]]
    calm: list[Float[np.ndarray, "_ c"]]
    weights: tuple[TrialWeight, ...]
    fitted: dict[str, list[Float[np.ndarray, "_ c"]]] = field(default_factory=dict)
    calmed: dict[str, list[Float[np.ndarray, "_ c"]]] = field(default_factory=dict)

    @classmethod
    def of(cls, problem: Problem, base: Judged) -> HeldOutRules:
        """The base model refitted by plain least squares, every channel divided by its floor."""
        before = measured_fit(problem, problem.plain, problem.floor)[1][len(problem.calibration.trials) :]
        varies = base.noise.varies
        weights = tuple(
            TrialWeight.of(there, problem.floor, varied * varies)
            for there, varied in zip(problem.recorded.present, problem.varied(base.model.jacobian), strict=True)
        )
        return cls(problem, base, before, smoothed_fit(problem, problem.plain, problem.floor), weights)

    def objection(self, one: Contender, alone: Sequence[Contender]) -> str:
        """Why a model may not be named, in words; "" where nothing speaks against it.

        Mistakes in the data are not judged: trials that have them are not predicted. `alone` are models with one
        effect.
        """
        if any(each.somewhere is not None for each in one.candidates):
            return ""
        return self.over_base(one) or self._beside(one, alone)

    def outdone(self, free: Sequence[Contender]) -> dict[str, str]:
        """Objections to models that another with as many effects outdoes, by label.

        It surely leaves less of the squared error on held-out trials, by `LEFT_OVER`, with inputs as they were measured
        and with their noise taken off: models that predict about the same are not separable by it, and a filter passes
        less of that noise on, whatever is missing.
        """
        found = {}
        for many in (1, 2):
            alike = [one for one in free if len(one.candidates) == many and one.candidates[0].somewhere is None]
            if not alike:
                continue
            best = min(alike, key=lambda one: sum(float((part**2).sum()) for part in self._scaled(self._after(one))))
            for one in alike:
                if all(self._surely_less(own(best), own(one)) for own in (self._after, self._calm)):
                    found[one.label] = f"{best.label} predicts held-out trials better"
        return found

    def _scaled(self, parts: Sequence[Float[np.ndarray, "_ c"]]) -> list[Float[np.ndarray, "_ c"]]:
        """Residuals of the held-out trials in units of the floor; of a quotient in those of its noise, which is high at
        small divisors: a few samples there would decide.
        """
        return [part / (self.problem.floor * own) for part, own in zip(parts, self._spread, strict=True)]

    @cached_property
    def _spread(self) -> list[Float[np.ndarray, "_ c"]]:
        """How many times its level the noise of each sample of the held-out trials is."""
        problem, outputs = self.problem, self.problem.recorded.outputs
        noise = quotient_noise(problem.system, outputs, problem.recorded.rough)
        return noise_spread(problem.system, outputs, noise)[len(problem.calibration.trials) :]

    def _surely_less(self, best: Sequence[Float[np.ndarray, "_ c"]], other: Sequence[Float[np.ndarray, "_ c"]]) -> bool:
        """Whether one model surely leaves less of the squared error than another, by `LEFT_OVER`."""
        before, after = self._scaled(other), self._scaled(best)
        whole = amplitude(before, [a - b for a, b in zip(before, after, strict=True)])
        return whole is not None and whole.better and whole.grown < -LEFT_OVER

    def adds(self, found: Surrogate, one: Contender) -> bool:
        """Whether a surrogate on top of a model changes enough on held-out trials, beside what the model's effects do.

        In squares, in units of the floor.
        """
        count, floor = len(self.problem.calibration.trials), self.problem.floor
        whole = changes(self.problem, replace(one, judged=self.base), one)[count:]
        own, more = (sum(float(((p / floor) ** 2).sum()) for p in parts) for parts in (whole, found.predicted[count:]))
        return more > LEFT_OVER * own

    def over_base(self, one: Contender) -> str:
        """Why a model may not be named in place of the base; "" where nothing speaks against it."""
        bare = self._of_recording(one) or self._of_change(one.judged) or self.harm(one) or self._of_share(one)
        return bare or self._of_noise(one) or self._of_few(one.judged)

    def _beside(self, one: Contender, alone: Sequence[Contender]) -> str:
        """Why one of two effects may not be named beside the other: the same rules, that one alone for a base."""
        if len(one.candidates) == 1:
            return ""
        for other in one.candidates:
            first = next((each for each in alone if each.candidates == (other,)), None)
            first = first or with_one(self.problem, one, other)
            why = replace(self, base=first.judged, before=self._after(first), calm=self._calm(first)).over_base(one)
            if why:
                return f"compared with {first.label} alone, {why}"
        return ""

    def _of_recording(self, one: Contender) -> str:
        """A level that a recording passes by more than its noise and gain tell is none that it was cut off at."""
        for each in one.candidates:
            if not each.ceiling:
                continue
            c = self.problem.system.outputs.index(each.channel)
            level = one.judged.model.values[each.ceiling]
            passed = level + DEVIATIONS * (GAIN * level + self.problem.recorded.rough[c])
            seen = np.abs(np.concatenate(measured_columns(self.problem, c)))
            if (seen > passed).mean() > SLIGHT:
                return f"{(seen > passed).mean():.0%} of the samples of {each.channel} lie beyond {level:.4g}"
        return ""

    def _of_change(self, one: Judged) -> str:
        before, rest = (left_out_residuals(self.problem, each, one.noise) for each in (self.base, one))
        whitenings = self.problem.whitenings(one.noise, self.base.model)
        change = [b - a for b, a in zip(before, rest, strict=True)]
        whole = amplitude(*(whitened_samples(whitenings, one.noise, parts) for parts in (before, change)))
        if whole is None or not whole.better:
            return f"trials left out are not surely predicted better{'' if whole is None else f' ({whole.words})'}"
        return ""

    def _after(self, one: Contender) -> list[Float[np.ndarray, "_ c"]]:
        """Residuals of a model on the held-out trials; fitted once."""
        if one.label not in self.fitted:
            count = len(self.problem.calibration.trials)
            self.fitted[one.label] = measured_fit(self.problem, one.judged.model, self.problem.floor)[1][count:]
        return self.fitted[one.label]

    def harm(self, one: Contender) -> str:
        """In words how a model predicts held-out trials worse than the base model; "" where it does not."""
        together, *channels = self._amplitudes(one)
        if together is not None and together.grown > 0.0:
            return f"the error on held-out trials grows ({together.words})"
        for own, name in zip(channels, self.problem.system.outputs, strict=True):
            if own is not None and own.worse:
                return f"{name} is predicted worse ({own.words})"
        return ""

    def ruled_out(self, one: Contender) -> bool:
        """Whether a model surely predicts held-out trials worse, not by chance; mistakes in the data are not judged."""
        return not one.mistaken and any(own is not None and own.worse for own in self._amplitudes(one))

    def _amplitudes(self, one: Contender) -> list[Amplitude | None]:
        """Amplitude of what a model changes on held-out trials, in units of the floor: of all channels together, of
        each.
        """
        floor, held = self.problem.floor, self.weights[len(self.problem.calibration.trials) :]
        old, new = ([part / floor for part in parts] for parts in (self.before, self._after(one)))
        change = [b - a for b, a in zip(old, new, strict=True)]
        own = [b - weight.cleared(part) for b, weight, part in zip(old, held, self.before, strict=True)]
        found = []
        for columns in (slice(None), *(slice(c, c + 1) for c in range(len(floor)))):
            parts = [[each[:, columns] for each in some] for some in (old, change, own)]
            sure = amplitude(*parts[:2])
            little = sure is not None and sure.grown <= WORTH_NAMING
            found.append(amplitude(*parts) if little else sure)
        return found

    def _of_share(self, one: Contender) -> str:
        before, after = self._cleared(self.before), self._cleared(self._after(one))
        return TOO_LITTLE if taken_away(before, after) < WORTH_NAMING else ""

    def _of_noise(self, one: Contender) -> str:
        before, after = self._cleared(self.calm), self._cleared(self._calm(one))
        return ONLY_NOISE if taken_away(before, after) < WORTH_NAMING else ""

    def _calm(self, one: Contender) -> list[Float[np.ndarray, "_ c"]]:
        """Residuals of a model on the held-out trials with the noise of the inputs taken off; fitted once."""
        if one.label not in self.calmed:
            self.calmed[one.label] = smoothed_fit(self.problem, one.judged.model, self.problem.floor)
        return self.calmed[one.label]

    def _cleared(self, parts: Sequence[Float[np.ndarray, "_ c"]]) -> list[Float[np.ndarray, "_ c"]]:
        """Residuals on held-out trials without what the base parameters differ by in each trial."""
        problem, one = self.problem, self.base
        count, fitted = len(problem.calibration.trials), problem.fitted
        own = [jacobian[..., :fitted] * one.noise.varies[:fitted] for jacobian in one.model.jacobian[count:]]
        present = problem.recorded.present[count:]
        weights = [TrialWeight.of(there, problem.floor, varied) for there, varied in zip(present, own, strict=True)]
        return [weight.cleared(part) for weight, part in zip(weights, parts, strict=True)]

    def _of_few(self, one: Judged) -> str:
        without, with_it = (_innovations(self.problem, each, one.noise) for each in (self.base, one))
        by_sample = [0.5 * (b**2 - a**2) for b, a in zip(without, with_it, strict=True)]
        by_trial = [float(each.sum()) for each in by_sample]
        if sum(by_trial) - max(by_trial) <= 0.0:
            return "without one trial nothing speaks for it"
        if trimmed(np.concatenate(by_sample)) <= SURE:
            return f"without {SLIGHT:.0%} of the samples nothing speaks for it"
        return ""

    def unnamed(self, found: Surrogate, before: Sequence[Float[np.ndarray, "_ c"]]) -> bool:
        """Whether something without a name predicts held-out trials better, as the calibration trials tell it.

        `before` are the residuals that the surrogate was fitted to, all trials.
        """
        count = len(self.problem.calibration.trials)
        change = found.by_calibration[count:]
        pairs = zip(self.weights[count:], before[count:], change, strict=True)
        both = [(weight(b), weight(m)) for weight, b, m in pairs]
        whole = amplitude([b for b, _ in both], [m for _, m in both])
        after = [b - m for b, m in zip(before[count:], change, strict=True)]
        return whole is not None and whole.better and taken_away(before[count:], after) >= WORTH_NAMING


def with_one(problem: Problem, pair: Contender, one: Candidate) -> Contender:
    """The model with one of the effects of a pair alone, refitted, with noise of its own."""
    system, noise, model = one.apply(problem.system), pair.judged.noise, pair.judged.model
    start = {p.name: model.values[p.name] for p in free(system)}
    alone = refit(system, problem.calibration, problem.fitting(noise, model), [start])
    return finished(problem, (one,), alone, noise)


def whitened_samples(
    whitenings: Sequence[Whitening], noise: Noise, parts: Sequence[Float[np.ndarray, "_ c"]]
) -> list[Float[np.ndarray, "_ c"]]:
    """Whitened values where they were measured, in their place in time; 0 elsewhere."""
    found = []
    for whitening, whitener, part in zip(whitenings, noise.whiteners, parts, strict=True):
        flat = np.zeros(part.size)
        flat[np.concatenate(whitener.rows)] = whitening(part[..., None])[:, 0]
        found.append(flat.reshape(part.shape))
    return found


def left_out_residuals(problem: Problem, one: Judged, noise: Noise) -> list[Float[np.ndarray, "_ c"]]:
    """Residuals of every trial, predicted from all others: one Gauss-Newton step without it
    (`gap.reduction.error_reduction`).
    """
    whitenings = problem.whitenings(noise, one.model)
    spread = prior_spread(one.model.system, one.model.values)
    both = [
        whiten(np.concatenate([residual[..., None], jacobian * spread], axis=-1))
        for whiten, residual, jacobian in zip(whitenings, one.model.residuals, one.model.jacobian, strict=True)
    ]
    grams = [each[:, 1:].T @ each[:, 1:] for each in both]
    pulls = [each[:, 1:].T @ each[:, 0] for each in both]
    found = []
    for residual, jacobian, gram, pull in zip(one.model.residuals, one.model.jacobian, grams, pulls, strict=True):
        others = np.eye(len(spread)) + sum(grams) - gram
        found.append(residual - jacobian @ (spread * np.linalg.solve(others, sum(pulls) - pull)))
    return found


def trimmed(gains: Float[np.ndarray, " n"]) -> float:
    """Sum of what samples gain, `SLIGHT` of them left out at either end."""
    ends = int(np.ceil(SLIGHT * len(gains)))
    return float(np.sort(gains)[ends : len(gains) - ends].sum())


def _innovations(problem: Problem, one: Judged, noise: Noise) -> list[Float[np.ndarray, " _"]]:
    """Whitened residuals of each trial under a noise, parameters where all trials put them to first order."""
    whitenings = problem.whitenings(noise, one.model)
    spread = prior_spread(one.model.system, one.model.values)
    model = one.model.weighed(whitenings)
    scaled = model.whitened_jacobian * spread
    shift = np.linalg.solve(np.eye(len(spread)) + scaled.T @ scaled, scaled.T @ model.whitened)
    return np.split(model.whitened - scaled @ shift, np.cumsum([len(w.directions) for w in whitenings])[:-1])
