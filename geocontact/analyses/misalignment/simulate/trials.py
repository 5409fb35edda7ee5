"""The trials that are made: loads on cuff and joint, displacement over offsets, a gap case, numbers that ran."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.misalignment.law_numbers import MMHG
from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.axis_misalignment.explicit import Offsets, displacement
from geocontact.axis_misalignment.law import CuffLoads, cuff_loads
from geocontact.axis_misalignment.synthetic import PAPER, Design, SyntheticElbowTrial, at_rest
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter, Source
from geocontact.data.trial import Trial
from geocontact.io.recordings.elbow_recording import BETA, PRESSURE, TORQUE, read_elbow_recording
from geocontact.io.text.columns import parse_map


def read(o: SimulateOptions) -> tuple[ElbowRecording, ...]:
    """The recordings that the options name; their force does not matter."""
    mapping = {} if o.map is None else parse_map(o.map, (BETA, PRESSURE, TORQUE))
    found = []
    for path in o.recordings:
        r = read_elbow_recording(path, mapping, o.angles, needed=())
        add_input("angle", path, samples=len(r.time))
        if (o.numbers or {}).get("s", 0.0) != 0.0 and r.pressure is None:
            raise InputError(path, "", "s follows the cuff's pressure, which is not here", "add it, or leave s out")
        found.append(r)
    return tuple(found)


@dataclass(frozen=True, eq=False)
class LoadedTrial:
    """A recording, and the loads that go with its force and angle.

    Parameters
    ----------
    numbers
        Of the law in this trial, in SI.
    stroke
        Of the compensation joint [m]; None where it is locked.
    mean_pressure
        At which the stiffness is k [Pa].
    turning
        Stiffness of the cuff against turning [N m/rad].
    """

    recording: ElbowRecording
    loads: CuffLoads
    numbers: Mapping[str, float]
    stroke: tuple[float, float] | None
    mean_pressure: float
    turning: float

    def sensed(self, moment_noise: float | None, alpha_noise: float | None, rng: np.random.Generator) -> LoadedTrial:
        """With sensors of the cuff's moment [N m] and of the arm's angle [rad], white noise of these SD on each."""
        r = self.recording
        columns: dict[str, Any] = {}
        for name, noise, values in (
            ("moment", moment_noise, self.loads.moment),
            ("alpha", alpha_noise, r.beta - self.loads.gamma),
        ):
            if noise is not None:
                columns[name] = values + noise * rng.standard_normal(len(values))
        return replace(self, recording=replace(r, **columns))

    def table(self) -> pd.DataFrame:
        """What was recorded, γ and the cuff's moment; with an actuator's torque what becomes of it."""
        r, loads = self.recording, self.loads
        columns = {"time [s]": r.time, "beta [deg]": np.degrees(r.beta), "force [N]": r.force}
        if r.displacement is not None:
            columns["displacement [mm]"] = r.displacement * 1e3
        if r.pressure is not None:
            columns["pressure [mmHg]"] = r.pressure / MMHG
        if r.moment is not None:
            columns["moment [N m]"] = r.moment
        if r.alpha is not None:
            columns["alpha [deg]"] = np.degrees(r.alpha)
        columns |= {"gamma [deg]": np.degrees(loads.gamma), "cuff_moment [N m]": loads.moment}
        if r.torque is not None:
            columns |= {
                "torque [N m]": r.torque,
                "joint_torque [N m]": loads.joint_torque,
                "constraint_torque [N m]": loads.constraint_torque,
                "force_across [N]": loads.across,
            }
        return pd.DataFrame(columns)


def loaded(
    trial: SyntheticElbowTrial, stroke: tuple[float, float] | None, mean_pressure: float, o: SimulateOptions
) -> LoadedTrial:
    """The trial with the loads of its own force; ValueError as of the model.

    Without an actuator's torque that of 0 is meant: only γ and the moment are shown then.
    """
    r, numbers = trial.recording, trial.numbers
    torque = 0.0 if r.torque is None else r.torque
    pressure = 0.0 if r.pressure is None else r.pressure - mean_pressure
    rigid = numbers if numbers["c"] else {**numbers, "b": 0.0}
    rest = at_rest(r.time, r.beta, rigid, stroke, pressure, torque, o.turning)
    link = numbers["l"], numbers["z"]
    loads = cuff_loads(r.beta, link, replace(rest, force=r.force), turning=o.turning, torque=torque)
    return LoadedTrial(r, loads, numbers, stroke, mean_pressure, o.turning)


ANGLES = np.radians(np.arange(0.0, 136.0, 1.0))
SHARE = 0.6  # of the link: the largest offset that is shown
STEPS = 61


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Total and linear displacement [m] over angles [rad] and offsets [m]."""

    l: float
    z: float
    angle: Float[np.ndarray, " a"]
    offset: Float[np.ndarray, " o"]
    over_x: Float[np.ndarray, "o a"]
    over_y: Float[np.ndarray, "o a"]
    linear_over_x: Float[np.ndarray, "o a"]
    linear_over_y: Float[np.ndarray, "o a"]

    def table(self) -> pd.DataFrame:
        """One row per angle and offset."""
        offset, angle = (grid.ravel() for grid in np.meshgrid(self.offset, self.angle, indexing="ij"))
        columns = {
            "beta [deg]": np.degrees(angle),
            "offset [mm]": offset * 1e3,
            "d_tot over x [mm]": self.over_x.ravel() * 1e3,
            "d_tot over y [mm]": self.over_y.ravel() * 1e3,
            "d_lin over x [mm]": self.linear_over_x.ravel() * 1e3,
            "d_lin over y [mm]": self.linear_over_y.ravel() * 1e3,
        }
        return pd.DataFrame(columns)


def surfaces(l: float, z: float) -> Surfaces:
    """Surfaces of a link and an offset of the attachment [m], offsets of either sign."""
    offset = SHARE * l * np.linspace(-1.0, 1.0, STEPS)
    over_x = [_row(Offsets(l, z, float(o), 0.0)) for o in offset]
    over_y = [_row(Offsets(l, z, 0.0, float(o))) for o in offset]
    totals = [np.array([total for total, _ in rows]) for rows in (over_x, over_y)]
    linear = [np.array([lin for _, lin in rows]) for rows in (over_x, over_y)]
    return Surfaces(l, z, ANGLES, offset, *totals, *linear)


def _row(offsets: Offsets) -> tuple[Float[np.ndarray, " a"], Float[np.ndarray, " a"]]:
    found = displacement(ANGLES, offsets)
    return found.total, found.linear


UNITS = {"beta": "deg"}
"""In which the trials are written, where that is not SI."""

CALIBRATED = 2.0 / 3.0  # of the trials
NEAR, STIFFER = 0.05, 4.0  # m, times: how far the bounds are from what was put in


def gap_case(trials: Sequence[ElbowRecording], numbers: Mapping[str, float]) -> GapCase:
    """Two thirds of the trials to fit to, the others held out, two at least; k, x, y free, l and z known.

    The base model has neither damping nor a stiffness that follows the pressure: where they were put in, they are
    what it lacks. The search begins at the numbers that were put in.
    """
    count = min(round(CALIBRATED * len(trials)), len(trials) - 2)
    made = tuple(_trial(each) for each in trials)
    k, offsets = numbers["k"], [(name, numbers[name]) for name in ("x", "y")]
    free = (
        Parameter("k", "N/m", k, k / STIFFER, k * STIFFER),
        *(Parameter(name, "m", value, value - NEAR, value + NEAR) for name, value in offsets),
    )
    known = {name: numbers[name] for name in ("l", "z")}
    return GapCase("elbow", "elbow", made[:count], made[count:], free, known)


def _trial(r: ElbowRecording) -> Trial:
    return Trial(r.name, Signals(r.time, np.column_stack([r.beta, r.force]), ("beta", "force"), ("rad", "N")))


COLUMNS = ["number", "value", "unit", "source", "note"]
LAW = {"k": "N/m", "x": "m", "y": "m", "l": "m", "z": "m", "b": "N s/m", "s": "1/Pa", "c": "m/N"}
"""Units of the law's numbers."""
Row = tuple[str, float, str, Source, str]
Named = tuple[str, float | tuple[float, float], str, Source]
USUAL = Design()


def numbers_table(made: Sequence[LoadedTrial], design: Design | None) -> pd.DataFrame:
    """Numbers of the experiment once, then of every trial: the law as it was there, stroke, pressure, turning."""
    rows = [] if design is None else [*_of_design(design)]
    for each in made:
        rows += _of_trial(each)
    return pd.DataFrame(rows, columns=COLUMNS)


def _of_design(design: Design) -> Iterator[Row]:
    each: list[Named] = [
        ("seconds", design.seconds, "s", "paper"),
        ("rate", design.rate, "Hz", "paper"),
        ("band", design.band, "Hz", "paper"),
        ("reach", design.reach, "rad", "invented"),
        ("noise", design.noise, "N", "invented"),
        ("memory", design.memory, "s", "invented"),
        ("donning", design.donning, "m", "invented"),
        ("bits", design.bits, "-", "paper"),
        ("sines", design.sines, "-", "invented"),
        ("amplitudes", design.amplitudes, "-", "invented"),
    ]
    for name, value, unit, source in each:
        told = source if value == getattr(USUAL, name) else "derived"
        yield from _ends(name, value, unit, told, "" if told == source else "asked for")
    if design.pressures is not None:
        yield from _ends("pressures", design.pressures, "Pa", "derived", "asked for")
    for channel, unit in (("beta", "rad"), ("force", "N"), ("displacement", "m")):
        yield f"full_scale {channel}", design.full_scale[channel], unit, "invented", "of the converter"


def _of_trial(made: LoadedTrial) -> Iterator[Row]:
    name = made.recording.name
    for number, unit in LAW.items():
        value = made.numbers[number]
        paper = value == PAPER[number]
        yield f"{name} {number}", value, unit, "paper" if paper else "derived", "" if paper else "asked for, and donned"
    if made.stroke is not None:
        yield from _ends(f"{name} stroke", made.stroke, "m", "derived", "asked for")
    yield f"{name} mean_pressure", made.mean_pressure, "Pa", "derived", "at which the stiffness is k"
    yield f"{name} turning", made.turning, "N m/rad", "derived", "stiffness of the cuff against turning"


def _ends(name: str, value: int | float | tuple[float, float], unit: str, source: Source, note: str) -> Iterator[Row]:
    """One row, or one for each end of a range."""
    if isinstance(value, tuple):
        for end, at in zip(("least", "most"), value, strict=True):
            yield f"{name} {end}", float(at), unit, source, note
    else:
        yield name, float(value), unit, source, note
