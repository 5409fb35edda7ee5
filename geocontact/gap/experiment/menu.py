"""Changes to trials that a laboratory can make: the menu that the next experiment is chosen from.

Each changes a trial that exists: another course of time along the same movement (faster, slower, in steps with holds),
a smaller movement, nothing or a known weight on the sensor, two sensors exchanged, another setting of a covariate. So
every change can be simulated with any model of the case.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs, recorded
from geocontact.chain.links import LAST, Modifier
from geocontact.chain.system import System
from geocontact.data.motion import Signals
from geocontact.data.trial import Trial
from geocontact.gap.inputs.spectrum import long_runs
from geocontact.gap.levels import FEWEST

ANGLE = "rad"
FASTER = (4.0, 2.0)  # times as fast as before
LEAST_FASTER = 1.25  # below which a movement does not count as faster
FASTEST = 2.0  # Hz, up to which nine tenths of the power of a voluntary movement's rate may lie
SAMPLED = 0.1  # cycles per sample up to which it may, so that the recording still shows it
HOLDS, HELD = 5, 2.0  # plateaus of a movement in steps, and how long each lasts [s]
HALF = 0.5  # of the speed, of the size, of the largest load that was measured, of the least setting of a covariate
STILL = 10.0  # s, at rest with nothing or a weight on the sensor
IN_SPACE = ("position", "travel")  # roles of inputs that bring bodies together which push each other

Staging = Callable[[System], System]


@dataclass(frozen=True)
class Experiment:
    """One trial to be recorded: what to do, in words, the inputs that it would have, what becomes of the model.

    Parameters
    ----------
    name
        Of the change ("faster").
    words
        What a laboratory does, with numbers.
    trial
        Inputs only.
    staged
        Turns a model of the case into one of this trial; the same unless something else loads the sensor.
    """

    name: str
    words: str
    trial: Trial
    staged: Staging = lambda system: system


def menu(system: System, trials: Sequence[Trial]) -> tuple[Experiment, ...]:
    """Every change that makes sense for a system, made to the trial of middling length, or to its liveliest piece."""
    template = liveliest_piece(system, sorted(trials, key=len)[len(trials) // 2])
    return (
        *paces(system, template),
        *_steps_and_holds(system, template),
        *_smaller(system, template),
        *_on_the_bench(system, template),
        *_swapped(system, template),
        *_settings(template, trials),
    )


def liveliest_piece(system: System, trial: Trial) -> Trial:
    """What moves most of the long pieces of a thinned trial; the trial where it is whole.

    Movement is the sum of the inputs' standard deviations over their half-ranges.
    """
    if not trial.pieces:
        return trial

    def moves(rows: slice) -> float:
        return sum(float(np.nanstd(trial.column(name)[rows])) / _span(system, name) for name in system.inputs)

    signals, rows = trial.signals, max(long_runs(trial), key=moves)
    return replace(trial, signals=replace(signals, time=signals.time[rows], values=signals.values[rows]), pieces=())


def band(system: System, trial: Trial) -> tuple[str, float, float]:
    """The input that moves most, and the frequencies below which a tenth and nine tenths of its rate's power lie [Hz].

    Inputs are compared by their standard deviations over the half-range that the case has of them.
    """
    movement = recorded(trial.signals, system.inputs, system.motion.reach)
    names = system.driving or system.inputs
    most = max(names, key=lambda name: float(np.std(movement.position[movement.row(name)])) / _span(system, name))
    step = float(np.median(np.diff(trial.time)))
    even = np.arange(trial.time[0], trial.time[-1], step)
    rate = np.interp(even, trial.time, movement.rate[movement.row(most)])
    long = 2 * len(rate)  # zeros behind it: frequencies in between
    power = np.abs(np.fft.rfft(rate * np.hanning(len(rate)), long)) ** 2
    grown = np.cumsum(power) / max(float(power.sum()), 1e-300)
    frequency = np.fft.rfftfreq(long, step)
    low, high = (float(frequency[np.searchsorted(grown, share)]) for share in (0.1, 1.0 - 0.1))
    return most, low, high


def _span(system: System, name: str) -> float:
    return system.scale.span.get(name, 1.0)


def fastest(system: System, trial: Trial) -> float:
    """How many times as fast the movement may be made."""
    _, __, high = band(system, trial)
    step = float(np.median(np.diff(trial.time)))
    return min(FASTEST, SAMPLED / step) / max(high, 1e-9)


def paces(system: System, trial: Trial) -> tuple[Experiment, ...]:
    """The same movement faster and slower."""
    name, low, high = band(system, trial)
    most = fastest(system, trial)
    factors = dict.fromkeys(round(min(factor, most), 2) for factor in FASTER)
    found = []
    for factor in [*(f for f in factors if f >= LEAST_FASTER), HALF]:
        pace = f"{factor:.2g} times as fast" if factor > 1.0 else "half as fast"
        words = f"sweep {name} at {factor * low:.2g}–{factor * high:.2g} Hz, {pace} as in these trials"
        length = (trial.time[-1] - trial.time[0]) / max(factor, 1.0)
        time = _grid(trial, length)
        kind = "faster" if factor > 1.0 else "slower"
        found.append(Experiment(kind, words, along(trial, system.inputs, time, trial.time[0] + factor * time)))
    return tuple(found)


def _steps_and_holds(system: System, trial: Trial) -> tuple[Experiment, ...]:
    name, _, __ = band(system, trial)
    pace = max(min(fastest(system, trial), FASTER[0]), 1.0)
    whole = float(trial.time[-1] - trial.time[0])
    leg = whole / HOLDS / pace
    time = _grid(trial, HOLDS * (leg + HELD))
    within = np.clip((time % (leg + HELD)) / leg, 0.0, 1.0)
    smooth = within**3 * (10.0 - 15.0 * within + 6.0 * within**2)  # minimum jerk
    place = (np.floor(time / (leg + HELD)) + smooth) / HOLDS
    made = along(trial, system.inputs, time, trial.time[0] + np.clip(place, 0.0, 1.0) * whole)
    unit = system.unit(name)
    levels = made.column(name)[[int(np.searchsorted(time, (k + 1) * (leg + HELD))) - 1 for k in range(HOLDS)]]
    at = ", ".join(f"{level:.2g}" for level in levels)
    words = f"the same movement in {HOLDS} quick steps, held {HELD:g} s after each: {name} at {at} {unit}"
    return (Experiment("step and hold", words, made),)


def _smaller(system: System, template: Trial) -> tuple[Experiment, ...]:
    """None where the movement makes contact by its size, as that of a foot over the ground does."""
    if system.traits.pushes_only and any(system.role(name) in IN_SPACE for name in system.driving):
        return ()
    made = along(template, system.inputs, template.time - template.time[0], template.time)
    values = made.signals.values
    flag = ((values == 0.0) | (values == 1.0)).all(axis=0)  # an event is no movement
    middle = values.mean(axis=0)
    values = np.where(flag, values, middle + HALF * (values - middle))
    words = "the same movement, half as large about its middle"
    return (Experiment("smaller", words, replace(made, signals=replace(made.signals, values=values))),)


def _on_the_bench(system: System, template: Trial) -> tuple[Experiment, ...]:
    """Nothing on the sensors, those of angles at their zero, and a known weight on each that measures a load.

    A weight lies still for the whole recording: when one is put on or taken off is known to nobody exactly.
    """
    loads = [c for c, name in enumerate(system.outputs) if system.role(name) == "load"]
    if not loads:
        return ()
    length = min(STILL, float(template.time[-1] - template.time[0]))
    grid = _grid(template, length)
    still = along(template, system.inputs, grid, np.full(len(grid), template.time[0]))
    angles = [c for c, name in enumerate(system.outputs) if system.unit(name) == ANGLE]
    held = "".join(f", {system.outputs[c]} held at 0" for c in angles)
    rest = f"open the interface and record {length:.2g} s with nothing on the sensor{held}"
    return (
        Experiment("unloaded zero", rest, still, bench([*loads, *angles], {})),
        *(_weighed(system, still, loads, c, length) for c in loads),
    )


def _weighed(system: System, still: Trial, loads: Sequence[int], on: int, length: float) -> Experiment:
    """A known weight on one sensor."""
    name = system.outputs[on]
    weight = HALF * system.scale.of(name)
    which = f"the sensor of {name}" if len(loads) > 1 else "the sensor"
    words = f"take {which} off and put a known load of {weight:.2g} {system.unit(name)} on it, {length:.2g} s in all"
    return Experiment("static weight", words, still, bench(loads, {on: weight}))


def bench(loads: Sequence[int], weights: Mapping[int, float]) -> Staging:
    """Models whose channels (columns) carry known weights, nothing where none is given; others have no value."""

    def change(outputs: Float[np.ndarray, "t c"], _: DifferentiatedInputs, __: object) -> Float[np.ndarray, "t c"]:
        made = np.full(outputs.shape, np.nan)
        made[:, list(loads)] = [weights.get(c, 0.0) for c in loads]
        return made

    return lambda system: replace(system, balance=system.balance.having(Modifier("bench", LAST, change)))


def _swapped(system: System, trial: Trial) -> tuple[Experiment, ...]:
    """Sensors of loads, two by two; each keeps its name and carries the other's load.

    None where there is a centre of pressure: one plate measures it and all the loads.
    """
    if any(system.role(name) == "centre" for name in system.outputs):
        return ()
    made = along(trial, system.inputs, trial.time - trial.time[0], trial.time)
    found = []
    alike = [(c, name) for c, name in enumerate(system.outputs) if system.role(name) == "load"]
    for (a, first), (b, second) in combinations(alike, 2):
        found.append(Experiment("swapped sensors", f"exchange the sensors of {first} and {second}", made, swap(a, b)))
    return tuple(found)


def swap(a: int, b: int) -> Staging:
    """Models whose channels a and b carry each other's load."""

    def change(outputs: Float[np.ndarray, "t c"], _: DifferentiatedInputs, __: object) -> Float[np.ndarray, "t c"]:
        made = outputs.copy()
        made[:, [a, b]] = outputs[:, [b, a]]
        return made

    return lambda system: replace(system, balance=system.balance.having(Modifier("swapped", LAST, change)))


def _settings(template: Trial, trials: Sequence[Trial]) -> tuple[Experiment, ...]:
    """Covariates at another value: half the least that trials had besides none, the largest, or none at all.

    What the model does not use changes nothing and is never chosen.
    """
    found = []
    for name, own in template.covariates.items():
        known = sorted({other.covariates.get(name, own) for other in trials}, key=abs)
        some = [value for value in known if value != 0.0]
        if not some:
            continue
        for value in dict.fromkeys((HALF * some[0], some[-1], 0.0)):
            if value != own and (value != 0.0 or known[0] == 0.0):
                changed = replace(template, covariates={**template.covariates, name: value})
                found.append(Experiment("other setting", f"the same movement with {name} at {value:.3g}", changed))
    return tuple(found)


def _grid(trial: Trial, length: float) -> Float[np.ndarray, " n"]:
    step = float(np.median(np.diff(trial.time)))
    return step * np.arange(max(round(length / step), FEWEST))


def along(trial: Trial, inputs: Sequence[str], time: Float[np.ndarray, " n"], source: Float[np.ndarray, " n"]) -> Trial:
    """The inputs of a trial taken at other moments `source`, in the order of `time`."""
    from scipy.interpolate import PchipInterpolator

    columns = []
    for name in inputs:
        values = trial.column(name)
        there = np.isfinite(values)
        inside = np.clip(source, trial.time[there][0], trial.time[there][-1])
        columns.append(PchipInterpolator(trial.time[there], values[there])(inside))
    units = tuple(trial.signals.units[trial.signals.channels.index(name)] for name in inputs)
    signals = Signals(np.asarray(time), np.stack(columns, axis=1), tuple(inputs), units)
    return Trial("next", signals, trial.covariates, trial.labels)
