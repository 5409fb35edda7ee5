"""Long recordings: quick ones are averaged over blocks of time; of longer ones, outputs are used in short stretches.

Samples that show nothing but noise beside their neighbours are averaged, inputs and outputs alike (`block_means`). Of
what is too long all the same outputs are used in stretches that lie evenly over every trial.

Cost grows with the samples of the outputs, what they tell hardly does: noise of a prediction falls with their square
root, and a limit of detection below what trial-to-trial variation leaves open does nobody good. Within a stretch every
sample stays: lags, the memory of noise, levels at which a sensor clips and held samples are as they were recorded.

Base models of geocontact see the inputs of every stretch from `LEAD` samples before it on, over which lags, friction
and play settle, to `AHEAD` samples behind it, and those of the trial's beginning. In between are means, of the more
samples the longer before a stretch, which what forgets more slowly goes by. All keep their times, so that drifts and
clocks are those of the whole trial. Of other simulators nothing is known, and their inputs stay whole.

Stretches begin at a low-discrepancy sequence within equal parts of a trial (multiples of the golden section, Kuipers &
Niederreiter 1974, Uniform Distribution of Sequences, ch. 2), so that no period of a movement is met in one phase only;
from trial to trial it goes on. A trial of hardly more than a stretch stays whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Bool

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.frame.consent import foreign
from geocontact.analyses.gap.block_means import averaged
from geocontact.analyses.gap.case import CaseWithModel, read_case
from geocontact.chain.system import System
from geocontact.data.gap_case import COMMAND, LISTED_SYSTEMS, GapCase
from geocontact.data.trial import Trial
from geocontact.gap.case.noise_sources import typical_step
from geocontact.gap.inputs.spectrum import switches
from geocontact.gap.levels import FEWEST
from geocontact.systems.catalogue import system_of

ROWS = 8_400
"""Measured samples of all outputs and trials that a diagnosis uses."""
STRETCH = 60
"""Measured samples of a stretch: several memories of quick noise, a lag of a quarter of a second at 100 Hz and more."""
LEAD, AHEAD = 60, FEWEST
"""Samples of the inputs before a stretch and behind it: the longest lag of an effect is 50, rates reach 14 ahead."""
BEGINNING = 600
"""Samples of the inputs that stay at the beginning of a trial: what starts there, and long enough for spectra."""
RARER = 1.25
"""How many times as far apart means in between lie as those behind them, the last one `FEWEST` samples."""
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
    fewer = thinned(case, outputs)
    used = measured_rows(fewer, outputs)
    if used < rows:
        where = f"in stretches of {STRETCH} that lie evenly over every trial"
        said.append(f"of {rows} samples of the outputs {used} are used, {where}; all figures are of these")
        case = with_inputs_around(fewer, outputs) if _own(case.system) else fewer
        seen, whole = (sum(map(len, (*each.calibration, *each.evaluation))) for each in (case, fewer))
        if seen < whole:
            said.append(f"of {whole} samples of the inputs {seen} are used, those from {LEAD} before each stretch on")
    return case, tuple(said)


def thinned(case: GapCase, outputs: Sequence[str]) -> GapCase:
    """The case with at most about `ROWS` samples of its outputs; the same object where it has no more."""
    rows = measured_rows(case, outputs)
    if rows <= ROWS:
        return case
    share = ROWS / rows

    def fewer(number: int, trial: Trial) -> Trial:
        most = max(int(np.isfinite(trial.column(name)).sum()) for name in outputs)
        used = stretches(len(trial), share, round(STRETCH * len(trial) / max(most, 1)), number)
        values = trial.signals.values.copy()
        columns = [trial.signals.channels.index(name) for name in outputs]
        for column in columns:
            values[~used, column] = np.nan
        return replace(trial, signals=replace(trial.signals, values=values))

    fitted = len(case.calibration)
    trials = tuple(fewer(k, one) for k, one in enumerate((*case.calibration, *case.evaluation)))
    return replace(case, calibration=trials[:fitted], evaluation=trials[fitted:])


def _own(system: str) -> bool:
    """Whether a base model is one of geocontact, whose memory is known."""
    return system != COMMAND and not foreign(system) and (":" in system or system in LISTED_SYSTEMS)


def with_inputs_around(case: GapCase, outputs: Sequence[str]) -> GapCase:
    """The case without the rows of inputs that lie far from all samples of these outputs."""

    def fewer(trial: Trial) -> Trial:
        measured = np.isfinite(np.stack([trial.column(name) for name in outputs])).any(axis=0)
        whole, sparse = rows_around(measured)
        rows, signals = np.flatnonzero(whole | sparse), trial.signals
        time, values = signals.time[rows], signals.values[rows]
        middle = (rows[1:] + rows[:-1] + 1) // 2
        moved = [k for k, name in enumerate(signals.channels) if name not in outputs and not switches([trial], name)]
        for k in np.flatnonzero(sparse[rows]):
            around = slice(middle[k - 1], middle[k])
            time[k], values[k, moved] = signals.time[around].mean(), signals.values[around][:, moved].mean(axis=0)
        return replace(trial, signals=replace(signals, time=time, values=values))

    first, later = (tuple(fewer(one) for one in side) for side in (case.calibration, case.evaluation))
    return replace(case, calibration=first, evaluation=later)


def rows_around(measured: Bool[np.ndarray, " t"]) -> tuple[Bool[np.ndarray, " t"], Bool[np.ndarray, " t"]]:
    """Rows that stay, and in whose place a mean does.

    The first are those at most `LEAD` before or `AHEAD` behind a measured one, the first `BEGINNING`, and the last.
    """
    edges = np.flatnonzero(np.diff(measured.astype(int), prepend=0, append=0))
    kept, sparse = np.zeros((2, len(measured)), dtype=bool)
    kept[:BEGINNING] = kept[-1:] = True
    for first, last in edges.reshape(-1, 2):
        kept[max(first - LEAD, 0) : last + AHEAD] = True
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
