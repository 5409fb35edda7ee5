"""Long recordings: quick ones are averaged over blocks of time; of longer ones, outputs are used in short stretches.

Samples that show nothing but noise beside their neighbours are averaged, inputs and outputs alike (`block_means`). Of
what is too long all the same outputs are used in stretches that lie evenly over every trial.

Cost grows with the samples of the outputs, what they tell hardly does: noise of a prediction falls with their square
root, and a limit of detection below what trial-to-trial variation leaves open does nobody good. Within a stretch every
sample stays: lags, the memory of noise, levels at which a sensor clips and held samples are as they were recorded.

Base models of geocontact see the inputs of every stretch from `lead` before it on, over which lags settle, to `ahead`
behind it, those of the trial's beginning, and those of its liveliest part. In between are means, of the more samples
the longer before a stretch, which what forgets more slowly goes by (`_halves`), and the `turning_points` that play and
friction remember. All keep their times; a clock that runs at another rate is sought as far as the inputs reach, which
is said. Of other simulators nothing is known, and their inputs stay whole.

Stretches begin at a low-discrepancy sequence within equal parts of a trial (multiples of the golden section, Kuipers &
Niederreiter 1974, Uniform Distribution of Sequences, ch. 2), so that no period of a movement is met in one phase only;
from trial to trial it goes on. A trial of hardly more than a stretch stays whole. Where inputs stay for many
more samples than a stretch has, as at 200 Hz, stretches are fewer and longer: inputs cost as much to simulate.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.frame.consent import foreign
from geocontact.analyses.gap.block_means import averaged
from geocontact.analyses.gap.case import CaseWithModel, read_case
from geocontact.chain.differentiated_inputs import REACH
from geocontact.chain.system import System
from geocontact.data.gap_case import COMMAND, LISTED_SYSTEMS, GapCase
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.effects.measurement.clock_slip import fastest as fastest_clock
from geocontact.effects.measurement.time_shift import LONGEST
from geocontact.gap.case.noise_sources import typical_step
from geocontact.gap.inputs.spectrum import switches
from geocontact.gap.levels import FEWEST, SLIGHT
from geocontact.systems.catalogue import system_of

ROWS = 8_400
"""Measured samples of all outputs and trials that a diagnosis uses."""
STRETCH = 60
"""Measured samples of a stretch: several memories of quick noise, a lag of a quarter of a second at 100 Hz and more."""
AROUND = 2.2
"""Samples of inputs around a stretch at the most, per sample of its own: where they are more, it is longer."""
SPREAD = 5
"""Stretches of a trial at the least, whatever lies around them: they still meet its phases and what drifts in it."""
RATES = 14
"""Samples that rates of rates reach to either side where sampling is coarse (`chain.differentiated_inputs`)."""
SETTLES = 1.2
"""Time before a stretch from which every sample of the inputs stays, however quick the recording is [s]."""
BEGINNING = 600
"""Samples of the inputs that stay at the beginning of a trial and where it moves most: long enough for spectra."""
RARER = 1.25
"""How many times as far apart means in between lie as those behind them, the last one `FEWEST` samples."""
EXACT = 1e-9
"""Rounding of times [s]."""
GOLDEN = 0.5 * (5.0**0.5 - 1.0)


def read_thinned(folder: Path, run_simulator: bool) -> CaseWithModel:
    """The case in a folder with its base model, thinned where it is long, which is said (`analyses.gap.case`)."""
    given = read_case(folder, run_simulator)
    case, said = thinned_and_said(given.case, given.system)
    for line in said:
        reserve(line)
    return replace(given, case=case, system=system_of(case), thinned=said) if said else given


def thinned_and_said(case: GapCase, system: System) -> tuple[GapCase, tuple[str, ...]]:
    """The case as it is used, and in words what was averaged and left out; nothing of one that is short."""
    outputs = system.outputs
    rows = measured_rows(case, outputs)
    if rows <= ROWS:
        return case, ()
    said = []
    case, size = averaged(case, outputs, system.inputs)
    if size > 1:
        means, lasting = measured_rows(case, outputs), 1e3 * typical_step(case)
        said.append(
            f"{rows} samples of the outputs are averaged to {means}, over blocks of {size} ({lasting:.3g} ms), within "
            "which all channels move evenly; all figures are of means"
        )
        rows = means
    own = _own(case.system)
    around = sum(reaches(case)) if own else 0.0
    fewer = thinned(case, outputs, around)
    used = measured_rows(fewer, outputs)
    if used < rows:
        where = f"in stretches of {_lengths(case, outputs, around)} that lie evenly over every trial"
        said.append(f"of {rows} samples of the outputs {used} are used, {where}; all figures are of these")
        case = with_inputs_around(fewer, outputs, system.inputs) if own else fewer
        seen, whole = (sum(map(len, (*each.calibration, *each.evaluation))) for each in (case, fewer))
        if seen < whole:
            lead, _ = reaches(fewer)
            fastest = fastest_clock(system.scaled(case.calibration).scale)
            said.append(
                f"of {whole} samples of the inputs {seen} are used, those from {lead:.3g} s before each stretch on; "
                f"rates of clocks are sought up to {fastest:.2g}"
            )
    return case, tuple(said)


def thinned(case: GapCase, outputs: Sequence[str], around: float = 0.0) -> GapCase:
    """The case with at most about `ROWS` samples of its outputs; the same object where it has no more.

    `around` is how much time of inputs stays around each stretch [s].
    """
    rows = measured_rows(case, outputs)
    if rows <= ROWS:
        return case
    share = ROWS / rows

    def fewer(number: int, trial: Trial) -> Trial:
        used = stretches(len(trial), share, _length(trial, _measured_share(trial, outputs), share, around), number)
        values = trial.signals.values.copy()
        columns = [trial.signals.channels.index(name) for name in outputs]
        for column in columns:
            values[~used, column] = np.nan
        return replace(trial, signals=replace(trial.signals, values=values))

    fitted = len(case.calibration)
    trials = tuple(fewer(k, one) for k, one in enumerate((*case.calibration, *case.evaluation)))
    return replace(case, calibration=trials[:fitted], evaluation=trials[fitted:])


def _measured_share(trial: Trial, outputs: Sequence[str]) -> float:
    """Share of a trial's samples in which the output was measured that was measured most often."""
    return max(1.0, *(float(np.isfinite(trial.column(name)).sum()) for name in outputs)) / len(trial)


def _length(trial: Trial, measured: float, share: float, around: float) -> int:
    """Samples of a stretch: `STRETCH` measured ones, more where more than `AROUND` times as many inputs lie around.

    A trial of which a `share` is used has `SPREAD` such longer stretches at the least.
    """
    wanted = min(around / (AROUND * float(np.median(np.diff(trial.time)))), share * len(trial) / SPREAD)
    return round(max(STRETCH / measured, wanted))


def _lengths(case: GapCase, outputs: Sequence[str], around: float) -> str:
    """Measured samples of the shortest and of the longest stretch, in words."""
    share, trials = ROWS / measured_rows(case, outputs), (*case.calibration, *case.evaluation)
    measured = [_measured_share(trial, outputs) for trial in trials]
    own = [round(part * _length(trial, part, share, around)) for trial, part in zip(trials, measured, strict=True)]
    return f"{min(own)}" if min(own) == max(own) else f"{min(own)} to {max(own)}"


def _own(system: str) -> bool:
    """Whether a base model is one of geocontact, whose memory is known."""
    return system != COMMAND and not foreign(system) and (":" in system or system in LISTED_SYSTEMS)


def reaches(case: GapCase) -> tuple[float, float]:
    """Time before and behind each stretch for which inputs stay [s], from the longest lags that effects may have.

    Those are so many steps of the coarsest trial; rates reach on from there. A clock that is fast or slow shifts the
    end of a trial that is longer than the fitted ones by more.
    """
    trials = (*case.calibration, *case.evaluation)
    step = max(float(np.median(np.diff(trial.time))) for trial in trials)
    fitted, longest = (max(float(np.ptp(one.time)) for one in side) for side in (case.calibration, trials))
    ahead = LONGEST * step * longest / fitted + max(RATES * step, 2.0 * REACH)
    return max(SETTLES, ahead), ahead


def with_inputs_around(case: GapCase, outputs: Sequence[str], inputs: Sequence[str]) -> GapCase:
    """The case without the rows of inputs that lie far from all samples of these outputs.

    Further columns of the trials, which the model does not use, decide nothing.
    """
    lead, ahead = reaches(case)

    def fewer(trial: Trial) -> Trial:
        signals = trial.signals
        moved = [k for k, name in enumerate(signals.channels) if name in inputs and not switches([trial], name)]
        measured = np.isfinite(np.stack([trial.column(name) for name in outputs])).any(axis=0)
        whole, sparse = rows_around(trial.time, measured, lead, ahead, liveliest(signals.values[:, moved]))
        edges = np.flatnonzero(np.diff(whole.astype(int), prepend=0, append=0)).reshape(-1, 2)
        pieces = tuple((float(signals.time[a]), float(signals.time[b - 1])) for a, b in edges if b - a > 1)
        return replace(trial, signals=_with_means(signals, moved, whole, sparse), pieces=pieces)

    first, later = (tuple(fewer(one) for one in side) for side in (case.calibration, case.evaluation))
    return replace(case, calibration=first, evaluation=later)


def _with_means(
    signals: Signals, moved: Sequence[int], whole: Bool[np.ndarray, " t"], sparse: Bool[np.ndarray, " t"]
) -> Signals:
    """Whole rows, turning points between them, and in place of sparse rows means of halves of what lies around them.

    A cell does not reach over a turning point. One in which an input was not measured is left out.
    """
    turns = np.zeros_like(whole)
    for first, last in np.flatnonzero(np.diff(whole.astype(int), prepend=1, append=1)).reshape(-1, 2):
        for k in moved:
            x = signals.values[:, k]
            turns[first + turning_points(x[first : last + 1], SLIGHT * float(np.nanmax(x) - np.nanmin(x)))] = True
    turns &= ~whole
    sparse = sparse & ~turns
    fixed = np.flatnonzero(whole | turns)
    for a, b in pairwise(map(int, fixed)):  # a mean between two turning points that have none
        if b - a > FEWEST and not sparse[a:b].any():
            sparse[(a + b) // 2] = True
    used = whole | turns
    rows = np.flatnonzero(used | sparse)
    edges = np.where(
        used[rows[:-1]], rows[:-1] + 1, np.where(used[rows[1:]], rows[1:], (rows[1:] + rows[:-1] + 1) // 2)
    )
    time, values = signals.time.copy(), signals.values.copy()
    ranges = np.array([float(np.nanmax(x) - np.nanmin(x)) for x in signals.values[:, moved].T])
    for k in map(int, np.flatnonzero(sparse[rows])):
        inside = np.arange(edges[k - 1], edges[k])
        for place, at, mean in _halves(signals.time[inside], signals.values[inside][:, moved], ranges):
            row = int(inside[place])
            time[row], values[row, moved], used[row] = at, mean, True
    return replace(signals, time=time[used], values=values[used])


def _halves(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t i"], ranges: Float[np.ndarray, " i"]
) -> list[tuple[int, float, Float[np.ndarray, " i"]]]:
    """Rows, times and means of the lower and the upper half of a cell's samples, the earlier one first.

    Halves of what moves most, of its range in the trial: a spring that is not straight is bent over both of them, as
    over the samples. One mean of a short cell, none where an input was not measured or none moves in the trial.
    """
    there, count = np.isfinite(values), len(time)
    if not len(ranges) or not there.any(axis=0).all():
        return []
    spread = np.nanmax(values, axis=0) - np.nanmin(values, axis=0)
    order = np.argsort(values[:, int(np.argmax(spread / ranges))], kind="stable")
    parts = [order[: count // 2], order[count // 2 :]] if count >= FEWEST else [order]
    if not all(there[part].any(axis=0).all() for part in parts):
        parts = [order]
    parts.sort(key=lambda part: float(time[part].mean()))
    places = [(2 * k + 1) * count // (2 * len(parts)) for k in range(len(parts))]
    spans = np.array_split(time, len(parts))
    return [
        (place, float(own.mean()), np.nanmean(values[part], axis=0))
        for place, own, part in zip(places, spans, parts, strict=True)
    ]


def turning_points(values: Float[np.ndarray, " t"], least: float) -> Int[np.ndarray, " k"]:
    """Where a course has the maxima and minima that hysteresis without rates remembers at its last value.

    Later and larger ones wipe earlier ones out (Mayergoyz 1986, Phys. Rev. Lett. 56:1518): seen from the end, those
    that exceed all that came after them, in turn up and down. Ranges below `least` count as noise.
    """
    there = np.flatnonzero(np.isfinite(values))[::-1]
    if len(there) < 2:
        return np.zeros(0, dtype=int)
    seen = values[there]
    high, low = np.maximum.accumulate(seen), np.minimum.accumulate(seen)
    way = np.sign(np.diff(high)) - np.sign(-np.diff(low))
    at = 1 + np.flatnonzero((way != 0.0) & (high - low > least)[1:])
    last = np.append(np.diff(way[at - 1]) != 0.0, True)[: len(at)]
    return np.asarray(there[at[last]])


def liveliest(values: Float[np.ndarray, "t i"]) -> slice:
    """The `BEGINNING` rows in which inputs move most, for spectra; none where the first ones move half as much."""
    spread = np.maximum(np.nanstd(values, axis=0), 1e-300)
    level = np.nan_to_num((values - np.nanmean(values, axis=0)) / spread)
    sums = np.insert(np.cumsum(np.stack([level, level**2]), axis=1), 0, 0.0, axis=1)
    mean, square = (sums[:, BEGINNING:] - sums[:, :-BEGINNING]) / BEGINNING
    moves = np.sqrt(np.maximum(square - mean**2, 0.0)).sum(axis=1)
    if not len(moves) or 2.0 * moves[0] >= moves.max():
        return slice(0, 0)
    first = int(np.argmax(moves))
    return slice(first, first + BEGINNING)


def rows_around(
    time: Float[np.ndarray, " t"],
    measured: Bool[np.ndarray, " t"],
    lead: float,
    ahead: float,
    lively: slice = slice(0, 0),
) -> tuple[Bool[np.ndarray, " t"], Bool[np.ndarray, " t"]]:
    """Rows that stay, and in whose place a mean does.

    The first are those at most `lead` before or `ahead` behind a measured one [s], the first `BEGINNING`, the `lively`
    ones, and the last.
    """
    edges = np.flatnonzero(np.diff(measured.astype(int), prepend=0, append=0))
    kept, sparse = np.zeros((2, len(measured)), dtype=bool)
    kept[:BEGINNING] = kept[-1:] = kept[lively] = True
    for first, last in edges.reshape(-1, 2):
        begin, end = np.searchsorted(time, [time[first] - lead - EXACT, time[last - 1] + ahead + EXACT])
        kept[begin:end] = True
    away = np.flatnonzero(np.diff(kept.astype(int), prepend=1, append=1))
    for first, last in away.reshape(-1, 2):
        if last - first < 2 * FEWEST:
            kept[first:last] = True
        back = np.cumsum(FEWEST * RARER ** np.arange(np.log1p(last - first) / np.log(RARER))).astype(int)
        sparse[last - back[back <= last - first + 1 - FEWEST]] = True
    return kept, sparse & ~kept


def measured_rows(case: GapCase, outputs: Sequence[str]) -> int:
    """How many samples of these channels were measured, in all trials."""
    trials = (*case.calibration, *case.evaluation)
    return sum(int(np.isfinite(trial.column(name)).sum()) for trial in trials for name in outputs)


def stretches(count: int, share: float, length: int = STRETCH, before: int = 0) -> Bool[np.ndarray, " t"]:
    """Which of `count` samples are used, a share of them; all where the stretches would touch.

    Parameters
    ----------
    length
        Samples of a stretch.
    before
        Trials of as many stretches that came before.
    """
    number = max(1, round(share * count / length))
    part = count / number
    if part <= length:
        return np.ones(count, dtype=bool)
    used = np.zeros(count, dtype=bool)
    for k in range(number):
        first = round(part * k + (part - length) * ((before * number + k + 1) * GOLDEN % 1.0))
        used[first : first + length] = True
    return used
