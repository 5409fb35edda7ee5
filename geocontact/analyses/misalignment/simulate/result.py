"""Synthetic recordings of an exoskeleton at an elbow: `geocontact elbow simulate`, `gc.misalignment.simulate`.

>>> import geocontact as gc
>>> result = gc.misalignment.simulate(seconds=5.0, trials=1, seed=3)
>>> print(result)
locked_1, synthetic: -10.0 … 8.1 N over 8 … 92°, 5 s
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import write_json
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.misalignment.law_numbers import with_units
from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.analyses.misalignment.simulate.show import simulation_page, surface_figure
from geocontact.analyses.misalignment.simulate.trials import (
    UNITS,
    USUAL,
    LoadedTrial,
    Surfaces,
    gap_case,
    loaded,
    numbers_table,
    read,
    surfaces,
)
from geocontact.axis_misalignment.explicit import Offsets, require_no_pole, require_reach
from geocontact.axis_misalignment.synthetic import PAPER, Design, SyntheticElbowTrial, ideal, synthetic
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.io.cases.gap_case_writer import write_gap_case

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


CASE = "case"
SYNTHETIC = {"synthetic": True, "words": "made by geocontact elbow simulate; no person was measured"}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SimulateResult(Result):
    """Synthetic trials; nobody was measured.

    Parameters
    ----------
    numbers
        True numbers of the law, in SI.
    made
        Each trial with the moment on the cuff and what becomes of the actuator's torque.
    surfaces
        Displacement over the angle and each offset, with the same link.
    design
        How trials were made; None along recorded angles.
    """

    options: SimulateOptions
    numbers: Mapping[str, float]
    made: tuple[LoadedTrial, ...]
    surfaces: Surfaces
    design: Design | None

    @property
    def trials(self) -> tuple[ElbowRecording, ...]:
        """Angle, force and what else a recording has."""
        return tuple(each.recording for each in self.made)

    @property
    def truth(self) -> dict[str, Any]:
        """True numbers with their units in the keys."""
        told: dict[str, Any] = {"synthetic": True, "numbers": with_units(self.numbers)}
        stroke = self.options.stroke
        return told if stroke is None else {**told, "stroke_mm": [end * 1e3 for end in stroke]}

    @property
    def angle(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Angle of the exoskeleton's hinge over time by trial [rad]."""
        return {each.name: each.beta for each in self.trials}

    @property
    def force(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Force on the attachment along the limb over time by trial [N]."""
        return {each.name: each.force for each in self.trials}

    def tables(self) -> dict[str, pd.DataFrame]:
        """One table per trial, by its name, `surfaces`, and `numbers` with all that ran."""
        own = {each.recording.name: each.table() for each in self.made}
        return {**own, "surfaces": self.surfaces.table(), "numbers": numbers_table(self.made, self.design)}

    def figures(self) -> dict[str, Figure]:
        """`surfaces`: displacement over the angle and each offset."""
        return {"surfaces": surface_figure(self.surfaces)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The first trial over time, the true numbers, the surfaces."""
        return {REPORT: simulation_page(self.made, self.numbers, drawings["surfaces"])}

    def refers_to(self, table: str) -> Mapping[str, object] | None:
        """What a trial is: nobody was measured."""
        return SYNTHETIC if table in {each.name for each in self.trials} else None

    def write_files(self, folder: Path) -> None:
        """truth.json besides; the gap case where it is asked for."""
        if self.options.case:
            locked = [each for each in self.trials if each.displacement is None]
            write_gap_case(gap_case(locked, self.numbers), folder / CASE, UNITS)
        write_json(folder / "truth.json", self.truth)
        super().write_files(folder)


TRIALS, SEED = 6, 0
GRID = 181  # angles at which a pole is looked for
MOSTLY = 0.5  # share of the variance of a noise from which it is an offset rather than noise


def run(recordings: Sequence[ElbowRecording], o: SimulateOptions) -> SimulateResult:
    """Trials with the numbers asked for, or the paper's, and surfaces of the displacement."""
    numbers = {**PAPER, **(o.numbers or {})}
    design = None if recordings else _design(o)
    made = [_along(each, numbers, o) for each in recordings] if design is None else _made(numbers, design, o)
    for trial in made:
        each = trial.recording
        low, high = np.degrees([each.beta.min(), each.beta.max()])
        span = f"{each.force.min():.1f} … {each.force.max():.1f} N over {low:.0f} … {high:.0f}°"
        say(f"{each.name}, synthetic: {span}, {each.time[-1] - each.time[0]:g} s{_trial_line(trial, o)}")
    maps = surfaces(numbers["l"], numbers["z"])
    result = SimulateResult(options=o, numbers=numbers, made=tuple(made), surfaces=maps, design=design)
    note("truth", result.truth)
    return result


def _made(numbers: Mapping[str, float], design: Design, o: SimulateOptions) -> list[LoadedTrial]:
    """Recordings after the paper's experiment."""
    _refuse_numbers(numbers, np.linspace(*design.reach, GRID))
    rng = np.random.default_rng(SEED if o.seed is None else o.seed)
    count = TRIALS if o.trials is None else o.trials
    mean = 0.0 if design.pressures is None else float(np.mean(design.pressures))
    sensors = np.random.default_rng([SEED if o.seed is None else o.seed, 1])
    kinds = [("locked", None)] if o.stroke is None else [("locked", None), ("free", o.stroke)]
    try:
        made = [
            loaded(synthetic(f"{kind}_{k + 1}", numbers, design, rng, ends, mean, o.torque, o.turning), ends, mean, o)
            for kind, ends in kinds
            for k in range(count)
        ]
        return [each.sensed(o.moment_noise, o.alpha_noise, sensors) for each in made]
    except ValueError as error:
        raise _beyond(error, numbers, "`donning`", "give a smaller one") from error


def _design(o: SimulateOptions) -> Design:
    """What was asked for, and the usual where nothing was."""
    band = USUAL.band if o.band is None else o.band
    rate = USUAL.rate if o.rate is None else o.rate
    if band[1] > 0.5 * rate:
        what = f"{band[1]:g} Hz reaches above half of {rate:g} Hz"
        raise InputError("", "`band`", what, "give a higher `rate`")
    design = Design(
        seconds=USUAL.seconds if o.seconds is None else o.seconds,
        rate=rate,
        band=band,
        reach=USUAL.reach if o.range is None else o.range,
        noise=USUAL.noise if o.noise is None else o.noise,
        memory=USUAL.memory if o.memory is None else o.memory,
        donning=USUAL.donning if o.donning is None else o.donning,
        bits=USUAL.bits if o.bits is None else o.bits,
        pressures=o.pressure,
    )
    share = as_offset(design.memory, design.seconds)
    if design.noise > 0.0 and share > MOSTLY:
        what = (
            f"`memory`: {design.memory:g} s beside trials of {design.seconds:g} s: {share:.0%} of the variance of what"
        )
        reserve(f"{what} the person adds is one offset of the force in each trial; is `memory` in s, `seconds` enough?")
    return design


def as_offset(memory: float, seconds: float) -> float:
    """Share of the variance of an Ornstein-Uhlenbeck process that is in its mean over a trial, both in s.

    The mean of exp(-|t - t'| / memory) over all pairs of times of the trial.
    """
    if memory <= 0.0:
        return 0.0
    times = seconds / memory
    return float(2.0 * (times + np.expm1(-times)) / times**2)


def _along(r: ElbowRecording, numbers: Mapping[str, float], o: SimulateOptions) -> LoadedTrial:
    """Ideal force along recorded angles; k holds at the recording's mean cuff pressure."""
    _refuse_numbers(numbers, r.beta)
    mean = 0.0 if r.pressure is None else float(r.pressure.mean())
    torque = r.torque if o.torque is None else np.full(len(r.time), o.torque)
    pressure = 0.0 if r.pressure is None else r.pressure - mean
    try:
        force, joint = ideal(r.time, r.beta, numbers, o.stroke, pressure, 0.0 if torque is None else torque, o.turning)
        shown = None if o.stroke is None else joint
        one = ElbowRecording(f"simulated_{r.name}", r.time, r.beta, force, shown, r.pressure, torque)
        return loaded(SyntheticElbowTrial(one, numbers), o.stroke, mean, o)
    except ValueError as error:
        raise _beyond(error, numbers, "`numbers`", "give other ones") from error


def _beyond(error: ValueError, numbers: Mapping[str, float], option: str, remedy: str) -> InputError:
    """What the model says, and what to do about it."""
    if numbers["c"] == 0.0:
        return InputError("", option, str(error), remedy)
    return InputError("", "`numbers`", str(error), "give a smaller c, or less `torque`")


def _trial_line(trial: LoadedTrial, o: SimulateOptions) -> str:
    """Moment on the cuff, and torque of the joint where the actuator's is known; nothing of what was not asked for."""
    loads, driven = trial.loads, trial.recording.torque is not None
    told = ""
    if driven or o.turning != 0.0:
        told += f"; moment on the cuff {loads.moment.min():.2f} … {loads.moment.max():.2f} N m"
    if driven:
        told += f", torque of the joint {loads.joint_torque.min():.2f} … {loads.joint_torque.max():.2f} N m"
    return told


def _refuse_numbers(numbers: Mapping[str, float], beta: Float[np.ndarray, " n"]) -> None:
    """A pole, a fold, a stiffness that is none."""
    if numbers["k"] <= 0.0:
        raise InputError("", "`numbers`", f"k = {numbers['k']:g} N/m is not positive", "give for example k=222")
    offsets = Offsets(l=numbers["l"], z=numbers["z"], x=numbers["x"], y=numbers["y"])
    try:
        require_reach(offsets)
        require_no_pole(beta, offsets)
    except ValueError as error:
        raise InputError("", "`numbers`", str(error), "give smaller offsets or a longer link") from error


simulate = Job("elbow simulate", SimulateOptions, read, run)
