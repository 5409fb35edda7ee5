"""A gap case as its analyses read it, with its base model, and the words that they share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.special import stdtrit

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.consent import foreign
from geocontact.chain.system import System
from geocontact.data.diagnosis import NextExperiment
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.plausible import ATTACHMENT, Plausible
from geocontact.data.units import mm
from geocontact.io.cases.case_settings import SETTINGS, read_settings
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.trial_table import cells_file
from geocontact.systems.catalogue import system_of

SAMPLES = 401  # of the longest trial that the page shows
OTHER = {
    "m": ("mm", 1e3),
    "m/s": ("mm/s", 1e3),
    "m^2": ("mm²", 1e6),
    "rad": ("deg", 180.0 / np.pi),
    "rad/s": ("deg/s", 180.0 / np.pi),
}
"""Units that are shown in others."""


def names(some: Sequence[str], last: str = "and") -> str:
    """`a, b and c`."""
    return f" {last} ".join([", ".join(some[:-1]), some[-1]]) if len(some) > 1 else "".join(some)


def percent(share: float) -> str:
    """A share as a whole percentage, with a minus sign."""
    return f"{100.0 * share:.0f}".replace("-", "−") if round(100.0 * share) else "0"


def proposal_words(one: NextExperiment, verdict: str) -> str:
    """What to record next, and what for: to show what is absorbed where nothing was found, else to tell apart."""
    some = names(one.separates)
    why = f"would show {some}" if verdict == "no_gap" else f"would separate {some}"
    often = "" if one.share is None else f", enough in {percent(one.share)} of 100 repetitions"
    return f"next: {one.change}; that {why} by {one.gain_nats:g} nats more{often}"


@dataclass(frozen=True)
class CaseWithModel:
    """A case, the base model that it names, the folder that it was read from, and in words how it was thinned."""

    folder: Path
    case: GapCase
    system: System
    thinned: tuple[str, ...] = ()


def read_case(folder: Path, run_simulator: bool) -> CaseWithModel:
    """Case in a folder; `run_simulator` allows one of the system "command" to run the program that it names."""
    case = read_gap_case(folder, run_programs=run_simulator)
    require_shares(case, folder / "case.toml")
    doubt_numbers(case, folder / "case.toml")
    system = system_of(case)
    add_inputs(folder, case)
    return CaseWithModel(folder, case, system)


def programs_of(folder: Path) -> tuple[str, ...]:
    """The program or the module of others that a case names, in words; nothing where it cannot be read."""
    file = folder / SETTINGS
    try:
        settings = read_settings(file)
    except InputError:
        return ()  # refused where it is read for use
    found = [f"the program {settings.simulate!r} of {file}"] if settings.simulate else []
    return (*found, *([f"the module of {settings.system!r} of {file}"] if foreign(settings.system) else []))


SHARES = {"shoulder": ("level",)}
"""Numbers of a trial that are shares of a whole, by base model."""


ARM = Plausible("a length of an exoskeleton's arm", mm, (-1e9, 1e9), (-2000.0, 2000.0), least=5.0)
LENGTHS = {"elbow": ("l", "z", "l_ex", "z_ex")}
"""Constants of a base model that are lengths in m, by its name."""
STARTS = {("elbow", "k"): ATTACHMENT}
"""Sizes of a base model's parameters, by its name and theirs, where they are known."""
UNITS, SPREAD, ALIKE = (25.4, 57.3, 100.0, 1000.0, 1e6), 1.25, 5.0
"""How many times larger or smaller a channel is in one trial for another unit (inches, degrees, cm, mm or kN, MN), by
how much trials differ beside that, and by how much its other channels and its noise may differ then."""
SMALL = 0.05
"""Share of what a channel changes from sample to sample, below which a stated noise is another unit's."""


def doubt_numbers(case: GapCase, file: Path) -> None:
    """A warning for a stated noise that the trials do not have, and for a constant in another unit.

    White noise of deviation s makes second differences of sqrt(6) s; a movement makes more, never less.
    """
    for name in LENGTHS.get(case.system, ()):
        if name in case.constants and (doubt := ARM.doubt(float(case.constants[name]))):
            reserve(f"{file} [constants] {name}: {doubt}")
    for parameter in case.parameters:
        known_size = STARTS.get((case.system, parameter.name))
        if known_size is not None and (doubt := known_size.doubt(parameter.start)):
            reserve(f"{file} [parameters.{parameter.name}] start: {doubt}")
    _doubt_units(case, file)
    for channel, noise in case.noise.items():
        recorded = [trial.column(channel) for trial in case.calibration if channel in trial.signals.channels]
        known = [each[np.isfinite(each)] for each in recorded]
        known = [each for each in known if len(each) > FEWEST]
        if not known:
            continue
        spread = float(np.sqrt(np.mean([np.var(each) for each in known])))
        rough = float(np.sqrt(np.median([np.mean(np.diff(each, 2) ** 2) for each in known]) / 6.0))
        where = f"{file} [noise] {channel}: is {noise:.3g}"
        if noise > spread > 0.0:
            reserve(f"{where}, more than the channel changes in the trials, {spread:.3g}; is it in the channel's unit?")
        elif noise < SMALL * rough:
            reserve(f"{where}, and the channel changes by {rough:.3g} from sample to sample; is it in its unit?")


def _doubt_units(case: GapCase, file: Path) -> None:
    """A warning for a trial of which one channel has another size than in the others, and no other channel.

    Another unit makes noise as many times larger as movement; a channel that is in use in one trial only does not.
    """
    sizes: dict[str, dict[str, float]] = {}
    rough: dict[str, dict[str, float]] = {}
    for trial in (*case.calibration, *case.evaluation):
        for channel in trial.signals.channels:
            known = trial.column(channel)[np.isfinite(trial.column(channel))]
            if len(known) > FEWEST and np.std(known) > 0.0:
                sizes.setdefault(channel, {})[trial.name] = float(np.std(known))
                rough.setdefault(channel, {})[trial.name] = float(np.median(np.abs(np.diff(known, 2))))
    times, rougher = _beside_others(sizes), _beside_others(rough)
    for (own, channel), ratio in times.items():
        others = [each for (name, other), each in times.items() if name == own and other != channel]
        larger, noisier = max(ratio, 1.0 / ratio), rougher[own, channel] / ratio
        unit = any(1.0 / SPREAD < larger / factor < SPREAD for factor in UNITS)
        unit &= not noisier > 0.0 or 1.0 / ALIKE < noisier < ALIKE
        if unit and others and all(1.0 / ALIKE < each < ALIKE for each in others):
            what = f"trial {own}: {channel} changes by {ratio:.3g} times what it does in the other trials"
            reserve(f"{file}: {what}, and nothing else of it differs so: is it in another unit?")


def _beside_others(sizes: Mapping[str, Mapping[str, float]]) -> dict[tuple[str, str], float]:
    """By trial and channel, a size in parts of the median of the other trials', of channels that enough trials have.

    0 where that of the others is none.
    """
    return {
        (trial, channel): size / usual if usual > 0.0 else 0.0
        for channel, of in sizes.items()
        if len(of) > FEW
        for trial, size in of.items()
        for usual in [float(np.median([each for name, each in of.items() if name != trial]))]
    }


FEWEST = 10
"""Samples of a channel."""
GAIN, CHANCE, FEW = 0.15, 0.01, 3
"""Logarithm of a gain that a trial has beside the others, which donning, placement and what a model lacks do not reach
in the practice cases; chance that any trial of a case reaches what is named, if gains are normal; least others."""
BETTER = 0.5
"""Share of a trial's error that stays with its own gain, from which on something else than a gain is wrong."""


def odd_gains(
    channel: str,
    measured: Mapping[str, Float[np.ndarray, " _"]],
    predicted: Mapping[str, Float[np.ndarray, " _"]],
    channels: int = 1,
) -> list[str]:
    """Trials of which a channel is a multiple of what a model predicts, as it is in no other trial, in words.

    The gain of a trial minimises the squared distance of its samples from as many times the prediction. Both are by
    the name of the trial, in the channel's unit, NaN where nothing was measured.

    A gain is named beyond the prediction interval of one more value after those of the others (Hahn and Meeker,
    Statistical Intervals, 1991), over all trials and `channels` (Bonferroni). With four trials
    and one channel that is 23 times the spread of the other three, with six trials 7 times that of five: a trial among
    few is named where the others agree.
    """
    gains, known = {}, {}
    for name, values in measured.items():
        there = np.isfinite(values) & np.isfinite(predicted[name])
        own, model = values[there], predicted[name][there]
        if there.sum() > FEWEST and model.any() and (gain := float(own @ model / (model @ model))) > 0.0:
            gains[name], known[name] = float(np.log(gain)), (own, model)
    said = []
    for name, gain in gains.items():
        others = np.array([each for other, each in gains.items() if other != name])
        if len(others) < FEW:
            continue
        usual, m = float(np.mean(others)), len(others)
        wide = float(stdtrit(m - 1, 1.0 - CHANCE / (2 * len(gains) * channels)) * np.std(others, ddof=1))
        own, model = known[name]
        with_own, with_usual = (float(np.linalg.norm(own - np.exp(each) * model)) for each in (gain, usual))
        if abs(gain - usual) > max(GAIN, wide * np.sqrt(1.0 + 1.0 / m)) and with_own < BETTER * with_usual:
            low, high = np.exp([others.min() - usual, others.max() - usual])
            times = f"{np.exp(gain - usual):.2f} times as large beside the model as in the others"
            what = f"trial {name}: {channel} is {times} ({low:.2f} to {high:.2f})"
            said.append(f"{what}; is its calibration, amplifier or unit another one?")
    return said


def require_shares(case: GapCase, file: Path) -> None:
    """InputError where a number of a trial that is a share, such as the level of the support, is not between 0 and 1.

    `file` is what states it.
    """
    for trial in (*case.calibration, *case.evaluation):
        for name in SHARES.get(case.system, ()):
            value = trial.covariates.get(name, 0.0)
            if not 0.0 <= value <= 1.0:
                meant = f"is {value / 100.0:g} ({value:g} %) meant?" if 1.0 < value <= 100.0 else "write 0.5 for 50 %"
                raise InputError(file, f"[trial.{trial.name}] {name}", f"{value:g} is no share between 0 and 1", meant)


def add_inputs(folder: Path, case: GapCase) -> None:
    """What was read: case.toml, the tables that lie beside it, the trials, and the meshes."""
    add_input("case", folder / "case.toml", system=case.system)
    for side, trials in (("calibration", case.calibration), ("evaluation", case.evaluation)):
        for trial in trials:
            add_input(side, folder / "trials" / f"{trial.name}.csv", samples=len(trial))
    for file in sorted(folder.glob("*.csv")):
        add_input("table", file)
    for site, cells in case.cells.items():
        for name in cells.trials:
            add_input(f"cells {site}", cells_file(folder, name, site), cells=len(cells.ids))
    for name, one in case.meshes.items():
        add_input(f"mesh {name}", one.mesh.name, sha256=one.mesh.sha256, unit=one.mesh.unit)
