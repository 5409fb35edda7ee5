"""What no effect of the table is, described without a model: a zero that wanders, lost samples, a load by its place.

No candidate can predict these on a trial that was held out, since every trial has its own, or since nothing is known of
the law. So they are described from what the answer leaves of all trials, with numbers, and name no effect.

*Wandering zero*: each trial has a constant of its own in a channel. Constants scatter surely more than usual deviations
of placement, base parameters, zeros and gains make them (chi-square, Cochran 1954), one by more than `DEVIATIONS` times
as much. What imitates a zero, such as how a device sits, cannot be separated from one. It is variation from trial to
trial, so the verdict stays.

*Lost samples*: in some trials a channel runs a whole number of samples ahead of its prediction from a place on, or
behind it where the inputs lost them. Place and number of each trial are those of the least squared error over all
places and numbers; beyond no delay and any constant one by `SURE` nats and the logarithm of what was tried, samples
counted as far as they are independent (Bartlett 1935, J. R. Stat. Soc. 98, 536). Base parameters move to first order
meanwhile.

*Unrecorded load*: a window of the phase, in all states or in one (a quarter of an input's range, on the way up or
down), in which a residual repeats from trial to trial (`gap.reduction.repeats`): a load, or the form of the model.
Signs of blocks turned at random make the p-value hold for all windows, states and channels that were looked at (Nichols
& Holmes 2002), where blocks without what repeats are correlated, of sums that scatter as these make them (Bartlett
1935); so do zeros. Where nothing else is missing it is described from odds of 400 to 1 on.

Either is described only where it makes `WORTH_NAMING` of the channel's squared error. The first two must make all but
`LEFT_OVER` of what is missed beyond noise: by the base model where they take more than what is named, which then may
only imitate them and is withdrawn; else by the answer, as the third is.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.special import ndtr, stdtrit

from geocontact.chain.differentiated_inputs import recorded
from geocontact.data.diagnosis import Unmodelled
from geocontact.effects.measurement.time_shift import LONGEST
from geocontact.gap.attribute import Attribution
from geocontact.gap.case.change_amplitude import BLOCKS, block_edges
from geocontact.gap.case.problem import Problem
from geocontact.gap.levels import (
    DEVIATIONS,
    FEW,
    LEADING,
    LEFT_OVER,
    PHASES,
    SLIGHT,
    SURE,
    TURNS,
    WORTH_NAMING,
)
from geocontact.gap.localise.gap_map import family_wise
from geocontact.gap.reduction.error_budget import ChannelBudget, deviations
from geocontact.gap.reduction.raw_input_errors import RawInputErrors
from geocontact.gap.reduction.repeats import axes_of, shared
from geocontact.gap.slips import Slip, share_of_time, slip_of
from geocontact.identify.intervals.quantile_intervals import CONFIDENCE
from geocontact.identify.intervals.tails import chi_square_nats
from geocontact.identify.optimise.bounded_gauss_newton import CLOSE

ZERO, LOST = "wandering_zero", "lost_samples"
Columns = Sequence[Float[np.ndarray, " _"]]
Presence = Sequence[Bool[np.ndarray, " _"]]


@dataclass(frozen=True, eq=False)
class AnswerResiduals:
    """What an answer leaves of all trials, calibration first.

    Parameters
    ----------
    residuals, present
        Measured less predicted, in the channels' units, and which samples were measured.
    varied
        What a usual deviation of each trial changes.
    floor
        Noise of each channel.
    """

    residuals: Sequence[Float[np.ndarray, "_ c"]]
    present: Sequence[Bool[np.ndarray, "_ c"]]
    varied: Sequence[Float[np.ndarray, "_ c q"]]
    floor: Float[np.ndarray, " c"]

    def cleared(self) -> list[Float[np.ndarray, "_ c"]]:
        """Residuals without the deviation of each trial."""
        own = deviations(self.residuals, self.varied, self.present, self.floor)
        return [r - b @ d for r, b, d in zip(self.residuals, self.varied, own, strict=True)]


def unmodelled(
    found: Attribution, errors: RawInputErrors, budget: Mapping[str, ChannelBudget]
) -> tuple[Unmodelled, ...]:
    """What is described of each channel, the largest share first; nothing where all is explained."""
    said, problem = found.answer, found.problem
    if said.verdict == "explained" or found.data_error is not None:
        return ()
    present = problem.recorded.present
    bare = replace(found, answer=replace(said, chosen=found.base))
    base = rest_of(bare, errors.before)
    rest = rest_of(found, errors.after) if said.effects else base
    cleared = rest.cleared()
    made: list[Unmodelled] = []
    for c, name in enumerate(problem.system.outputs):
        square = square_of(base.residuals, present, c)
        if name not in budget or square <= 0.0:
            continue
        noise = sum(int(there[:, c].sum()) for there in present) * noise_of(errors, found, c, budget[name])
        own = faults(bare, base, c, square, noise)
        taken = 1.0 - square_of(rest.residuals, present, c) / square
        if said.effects and not any(one.share > taken for one in own):
            own = faults(found, rest, c, square, noise)
        loads = () if own else loads_by_place(found, cleared, c, square)
        # a verdict of no gap stands against what chance makes in one of 400 such cases
        made += own or [one for one in loads if said.verdict != "no_gap" or one.p_value <= np.exp(-SURE)]
    return tuple(sorted(made, key=lambda one: -one.share))


def rest_of(found: Attribution, residuals: Sequence[Float[np.ndarray, "_ c"]]) -> AnswerResiduals:
    """These residuals, with what a usual deviation changes in the model of the answer."""
    judged = found.answer.chosen.judged
    low = found.clean.with_lower_noise(judged.noise)
    varied = [each * low.varies for each in found.clean.varied(judged.model.jacobian)]
    return AnswerResiduals(residuals, found.problem.recorded.present, varied, found.problem.floor)


def faults(found: Attribution, rest: AnswerResiduals, c: int, square: float, noise: float) -> list[Unmodelled]:
    """A zero and lost samples that make what is left beyond noise; `square` is that of the base model."""
    beyond = square_of(rest.residuals, rest.present, c) - noise
    least = max(WORTH_NAMING * square, (1.0 - LEFT_OVER) * beyond)
    both = (wandering_zero(found, rest, c), lost_samples(found, rest, c))
    return [replace(one, share=one.share / square) for one in both if one is not None and one.share >= least]


def imitated(beside: Sequence[Unmodelled], errors: RawInputErrors, problem: Problem) -> bool:
    """Whether a fault takes more of its channel's squared error than the model of the answer, which may imitate it."""
    present, names = problem.recorded.present, problem.system.outputs
    for one in beside:
        c = names.index(one.channel)
        left = square_of(errors.after, present, c) / square_of(errors.before, present, c)
        if one.kind in (ZERO, LOST) and one.share > 1.0 - left:
            return True
    return False


def square_of(residuals: Sequence[Float[np.ndarray, "_ c"]], present: Sequence[np.ndarray], c: int) -> float:
    """Sum of squares of a channel."""
    return sum(float((r[there[:, c], c] ** 2).sum()) for r, there in zip(residuals, present, strict=True))


def noise_of(errors: RawInputErrors, found: Attribution, c: int, budget: ChannelBudget) -> float:
    """Mean square of the noise of a channel, of the sensor and of inputs, as its budget has it."""
    count, present = len(found.problem.calibration.trials), found.problem.recorded.present
    held = zip(errors.before[count:], present[count:], strict=True)
    before = np.concatenate([r[there[:, c], c] for r, there in held])
    share = budget.parts["sensor"].share + budget.parts["inputs"].share
    return float(np.mean(before**2)) * share


def wandering_zero(found: Attribution, rest: AnswerResiduals, c: int) -> Unmodelled | None:
    """A constant of each trial's own in a channel; `share` is still the sum of squares that it takes."""
    name, unit = found.problem.system.outputs[c], found.problem.system.unit(found.problem.system.outputs[c])
    sizes, usual, counts, blocks = [], [], [], []
    for residual, moved, there in zip(rest.residuals, rest.varied, rest.present, strict=True):
        own = residual[there[:, c], c]
        if len(own) < BLOCKS:
            return None
        sizes.append(float(own.mean()))
        blocks.append(np.add.reduceat(own - sizes[-1], block_edges(len(own))) / len(own))
        usual.append(float(np.linalg.norm(moved[there[:, c], c].mean(axis=0))))
        counts.append(len(own))
    mean_of = swollen(memory(np.array(blocks)), BLOCKS) / BLOCKS  # variance of a mean, of that of a block
    spread = np.linalg.norm(blocks, axis=1) * np.sqrt(BLOCKS * mean_of / max(1.0 - mean_of, SLIGHT))
    off, n = np.array(sizes) - np.average(sizes, weights=counts), np.array(counts)
    made = np.maximum(np.hypot(spread, usual), 1e-300)
    nats = chi_square_nats(float(((off / made) ** 2).sum()), max(len(off) - 1, 1))
    if nats < SURE or (np.abs(off) / made).max() < DEVIATIONS:
        return None
    trials = dict(sorted(zip((t.name for t in found.problem.recorded.trials), map(float, off), strict=True)))
    low, high = min(trials.values()), max(trials.values())
    words = f"zero of {name} differs from trial to trial, {low:.3g} to {high:.3g} {unit}"
    taken = float((n * off**2).sum())
    return Unmodelled(ZERO, name, taken, float(np.exp(-nats)), words, None, trials)


def memory(blocks: Float[np.ndarray, "i k"]) -> float:
    """Correlation of neighbouring blocks of trials, without its bias where each has its own mean (Kendall 1954)."""
    count = blocks.shape[1]
    square = max(float((blocks**2).sum()) / count, 1e-300)
    seen = float((blocks[:, 1:] * blocks[:, :-1]).sum()) / (count - 1) / square
    of_mean = 1.0 + seen  # beside twice the correlation, of the quotient
    return float(np.clip(seen + (2.0 * seen + of_mean) / count, 0.0, 1.0 - SLIGHT))


def swollen(alike: float, count: int) -> float:
    """Variance of the sum of so many blocks over that of independent ones, their correlation a power of the lag."""
    lags = np.arange(1, count)
    return 1.0 + 2.0 * float(((1.0 - lags / count) * alike**lags).sum())


def lost_samples(found: Attribution, rest: AnswerResiduals, c: int) -> Unmodelled | None:
    """Samples that a channel or the inputs lost, in each trial its own; `share` is still a sum of squares.

    No more than `LONGEST` are found in a trial in pieces, whose inputs are known so far around its outputs.
    """
    problem, jacobian = found.problem, found.answer.chosen.judged.model.jacobian
    trials, name = problem.recorded.trials, problem.system.outputs[c]
    steps = [np.diff(trial.time[run]) for trial in trials for run in trial.runs]
    if any(float(np.ptp(each)) > SLIGHT * float(np.median(each)) for each in steps):
        return None
    paused = any(trial.pieces for trial in trials)
    most = (1 if paused else FEW) * int(LONGEST)  # samples, that a trial may lose
    measured = [
        np.where(there[:, c], y[:, c], np.nan) for y, there in zip(problem.recorded.outputs, rest.present, strict=True)
    ]
    predicted = [y - r[:, c] for y, r in zip(measured, rest.residuals, strict=True)]
    if paused:  # what came before and behind a piece was not measured
        model = found.answer.chosen.judged.model
        beside = [model.system.simulate(trial, model.values)[:, c] for trial in trials]
        predicted = [np.where(np.isfinite(p), p, q) for p, q in zip(predicted, beside, strict=True)]
    known = [np.where(np.isfinite(p), p, 0.0) for p in predicted]
    shift = np.zeros(jacobian[0].shape[-1])
    slips: list[Slip | None] = []
    for _ in range(TURNS):
        moved = [p + j[:, c] @ shift for p, j in zip(predicted, jacobian, strict=True)]
        slips = [slip_of(y, p, max(min(len(y) // BLOCKS, most), 1)) for y, p in zip(measured, moved, strict=True)]
        if not any(slips):
            return None
        rows, columns = [], []
        for y, p, j, one in zip(measured, known, jacobian, slips, strict=True):
            at = np.arange(len(y))
            if one is not None:
                at = np.clip(at + np.where(at > one.place, one.samples, 0), 0, len(y) - 1)
            there = np.isfinite(y)
            rows.append((y - p[at])[there])
            columns.append(j[at, c][there])
        shift = np.linalg.lstsq(np.concatenate(columns), np.concatenate(rows), rcond=CLOSE)[0]
    slips = [one if one is not None and one.nats > SURE else None for one in slips]
    if not any(slips):
        return None
    kept = [(trial, one, y) for trial, one, y in zip(trials, slips, measured, strict=True) if one is not None]
    told = {trial.name: float(one.samples) for trial, one, _ in kept}
    places = {trial.name: share_of_time(trial, np.isfinite(y), one.place) for trial, one, y in kept}
    each = ", ".join(f"{abs(told[k]):.0f} in {k} at {places[k]:.0%}" for k in sorted(told))
    late = all(samples < 0.0 for samples in told.values())
    words = f"samples lost in {'the inputs beside ' if late else ''}{name}: {each}"
    taken = min(sum(one.unmoved - one.after for _, one, _ in kept), square_of(rest.residuals, rest.present, c))
    sure = max(float(np.exp(-one.nats)) for _, one, _ in kept)
    return Unmodelled(LOST, name, taken, sure, words, None, told)


@dataclass(frozen=True, eq=False)
class Regions:
    """Windows of the phase in states: sums of the residual by trial and block, counts by trial, and which is which.

    `windows` are first and last part of the phase, `states` name an input ("" for all), a quarter, and a direction: 0
    down, 1 up, -1 both.
    """

    sums: Float[np.ndarray, "i k r"]
    counts: Float[np.ndarray, "i r"]
    windows: tuple[tuple[int, int], ...]
    states: tuple[tuple[str, int, int], ...]

    def of(self, place: int) -> tuple[tuple[int, int], tuple[str, int, int]]:
        """Window and state of a region."""
        window, state = divmod(place, len(self.states))
        return self.windows[window], self.states[state]

    def p_values(self) -> Float[np.ndarray, " r"]:
        """p of each region, as noise of the residual's memory makes it; see `memory`."""
        phases = slice(0, PHASES * len(self.states), len(self.states))  # each alone, in all states
        seen = np.maximum(self.counts[:, phases].sum(axis=1), 1.0)
        alone = self.sums[:, :, phases].sum(axis=-1) / seen[:, None]
        alike = memory(alone - alone.mean(axis=0))
        widths = [int(np.ceil((end - begin) * BLOCKS / PHASES)) for begin, end in self.windows]
        swells = np.repeat([swollen(alike, width) for width in widths], len(self.states))
        count, square = len(self.sums), (self.sums**2).sum(axis=(0, 1))
        noise = ((self.sums - self.sums.mean(axis=0)) ** 2).sum(axis=(0, 1)) * count / max(count - 1, 1)
        freedom = np.maximum((count - 1) * np.repeat(widths, len(self.states)) / swells, 1.0)
        few = -stdtrit(freedom, ndtr(-DEVIATIONS)) / DEVIATIONS  # noise is known from as few that are independent
        spread = np.maximum(few * np.sqrt(swells * noise / np.maximum(square, 1e-300)), 1.0)
        (chance,) = family_wise([self.sums.reshape(-1, self.sums.shape[-1])], spread)
        return chance


def regions(residuals: Columns, present: Presence, axes: Mapping[str, Sequence[Int[np.ndarray, " _"]]]) -> Regions:
    """All windows in all states, of one channel; `axes` as of `repeats.axes_of`."""
    states = [("", 0, -1), *_states([name for name in axes if name != "phase"])]
    shape = len(residuals), BLOCKS, PHASES, len(states)
    sums, counts = np.zeros(shape), np.zeros((shape[0], *shape[2:]))
    for i, (residual, there, phase) in enumerate(zip(residuals, present, axes["phase"], strict=True)):
        rows = np.flatnonzero(there)
        block = rows * BLOCKS // len(residual)
        for s, (name, quarter, way) in enumerate(states):
            own = rows
            if name:
                which = axes[name][i][rows]
                own = rows[(which // 2 == quarter) & ((which % 2 == way) | (way < 0))]
            at = block if own is rows else own * BLOCKS // len(residual)
            np.add.at(sums[i, :, :, s], (at, phase[own]), residual[own])
            np.add.at(counts[i, :, s], phase[own], 1.0)
    windows = tuple((a, a + n) for n in range(1, PHASES // 2 + 1) for a in range(PHASES - n + 1))
    through, seen = (np.insert(np.cumsum(each, axis=-2), 0, 0.0, axis=-2) for each in (sums, counts))
    begin, end = np.array(windows).T
    together = (through[:, :, end] - through[:, :, begin]).reshape(shape[0], BLOCKS, -1)
    return Regions(together, (seen[:, end] - seen[:, begin]).reshape(shape[0], -1), windows, tuple(states))


def _states(names: Sequence[str]) -> Iterator[tuple[str, int, int]]:
    for name in names:
        for quarter in range(FEW):
            yield from ((name, quarter, way) for way in (-1, 0, 1))


def loads_by_place(
    found: Attribution, cleared: Sequence[Float[np.ndarray, "_ c"]], c: int, square: float
) -> Iterator[Unmodelled]:
    """Loads that repeat in a window of the phase in a state, those first that make most of the channel's error."""
    problem = found.problem
    system, trials, name = problem.system, problem.recorded.trials, problem.system.outputs[c]
    if system.role(name) != "load":
        return
    axes, present = axes_of(trials, system), [there[:, c] for there in problem.recorded.present]
    all_of = regions([r[:, c] for r in cleared], present, axes)
    size = shared(all_of.sums.sum(axis=1)[None], all_of.counts)[0] / square
    p_values = np.minimum(1.0, len(system.outputs) * all_of.p_values())
    able = (p_values <= 1.0 - CONFIDENCE) & (size >= WORTH_NAMING) & (all_of.counts > 0.0).all(axis=0)
    for _ in range(LEADING):
        if not able.any():
            return
        best = int(np.argmax(np.where(able, size, -np.inf)))
        (begin, end), (axis, quarter, way) = all_of.of(best)
        mean = float(all_of.sums[:, :, best].sum() / all_of.counts[:, best].sum())
        where = [f"phase {100 * begin / PHASES:.0f}–{100 * end / PHASES:.0f} %"]
        if axis:
            movements = [recorded(t.signals, system.inputs, system.motion.reach) for t in trials]
            row = system.inputs.index(axis)
            own = np.concatenate(
                [m.position[row][w // 2 == quarter] for m, w in zip(movements, axes[axis], strict=True)]
            )
            where.append(
                f"{axis} {own.min():.3g} to {own.max():.3g} {system.unit(axis)}{('', ', falling', ', rising')[way + 1]}"
            )
        size_there = f"{mean:+.3g} {system.unit(name)}"
        words = f"a load that was not recorded, or the model's form, in {name}, {', '.join(where)}: {size_there}"
        phase = (begin / PHASES, end / PHASES)
        yield Unmodelled("unrecorded_load", name, float(size[best]), float(p_values[best]), words, phase, {})
        clear = np.array([b <= begin or a >= end for a, b in all_of.windows])
        able &= np.repeat(clear, len(all_of.states))
