"""A channel of a trial beside what the model says: what is read, and how far they are apart."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.law_numbers import MMHG, PER_SI, key_of
from geocontact.analyses.misalignment.page import CONSTRAINT
from geocontact.analyses.misalignment.recordings import SLID, recordings
from geocontact.axis_misalignment.law import NAMES
from geocontact.axis_misalignment.synthetic import ideal
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.data.plausible import LARGEST_MEANT
from geocontact.identify.signals.agreement import Agreement, agreement
from geocontact.identify.signals.angle_bins import angle_bins, edges_over
from geocontact.identify.signals.filters import at_times, even_times
from geocontact.io.text.file_preflight import read_json
from geocontact.trial_checks.twice import same_recordings
from geocontact.view.curves.quantity import Quantity

QUANTITIES = {"force": CONSTRAINT, "displacement": Quantity("displacement of the joint", "mm", 1e3)}
"""What channels are called and shown in."""
SLIDES = 5e-3
"""m; a joint that is locked has less play."""
SAME_MOTION = float(np.radians(2.0))
"""rad, root mean square, that angles of a recording and its model may be apart."""


@dataclass(frozen=True, eq=False)
class Pair:
    """Measured and model at the trial's even times, SI units, and how they agree."""

    trial: str
    channel: str
    time: Float[np.ndarray, " t"]
    beta: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, " t"]
    model: Float[np.ndarray, " t"]
    agreement: Agreement

    def binned(self, width: float) -> Float[np.ndarray, "b 3"]:
        """Means of angle, measured and model over bins of the angle [rad]."""
        there = np.isfinite(self.measured)
        edges = edges_over([self.beta[there]], width)
        values = np.column_stack([self.beta, self.measured, self.model])[there]
        return np.asarray(angle_bins([self.time[there]], [values], edges, np.inf).cells().means)


@dataclass(frozen=True)
class ComparedLaw:
    """Numbers of the law in SI units, and the cuff pressure that they are counted from [Pa]."""

    numbers: Mapping[str, float]
    pressure: float


@dataclass(frozen=True, eq=False)
class Both:
    """Measured recordings, and what they are compared with: as many simulated ones, or a law."""

    measured: Sequence[ElbowRecording]
    model: Sequence[ElbowRecording] | ComparedLaw


def read(o: CompareOptions) -> Both:
    """Everything the options name."""
    measured = recordings("measured", o.recordings, o.map, o.angles, o.unit, o.cutoff)
    if o.fit is None:
        model = recordings("simulated", o.simulated or (), None, o.angles, o.unit, None)
        for path, one, other in zip(o.recordings, measured, model, strict=True):
            if same_recordings({"measured": one.force, "simulated": other.force}):
                reserve(f"{path}: its force is that of the simulated recording, sample by sample: is it a copy?")
        return Both(measured, model)
    law = _law(o.fit)
    add_input("`fit`", o.fit)
    for path, r in zip(o.recordings, measured, strict=True):
        if o.stroke is not None and (r.displacement is None or float(np.ptp(r.displacement)) < SLID):
            reserve(f"{path}: no displacement of its joint was recorded, or it does not slide: was it locked? `stroke`")
        if o.stroke is None and r.displacement is not None and float(np.ptp(r.displacement)) > SLIDES:
            slid = f"its joint slides by {1e3 * float(np.ptp(r.displacement)):.0f} mm"
            reserve(f"{path}: {slid}, and a locked one is simulated: give its `stroke`")
    return Both(measured, law)


def _law(file: Path) -> ComparedLaw:
    """The law in an elbow.json."""
    try:
        content = read_json(file)
        told, centre = content["numbers"], content["pressure_mmHg"] or 0.0
        told = {key_of("c"): 0.0, **told}  # files of version 0.1 have a rigid fixation
        numbers = {name: float(told[key_of(name)]) / PER_SI[name] for name in NAMES}
        if not (np.abs([*numbers.values(), float(centre)]) <= LARGEST_MEANT).all():
            raise ValueError("a number is not finite or too large")
    except InputError:
        raise
    except (ValueError, KeyError, TypeError, RecursionError) as error:
        raise InputError(file, "", f"holds no law of an elbow ({error})", "give elbow.json of elbow fit") from error
    return ComparedLaw(numbers, float(centre) * MMHG)


def compared_pairs(both: Both, o: CompareOptions) -> tuple[Pair, ...]:
    """Every channel that a recording and its model have."""
    measured = both.measured
    models = _simulated(both.model, o, measured) if isinstance(both.model, ComparedLaw) else both.model
    each = zip(o.recordings, measured, models, strict=True)
    return tuple(pair for path, r, model in each for pair in _pairs(path, r, model))


def _simulated(law: ComparedLaw, o: CompareOptions, measured: Sequence[ElbowRecording]) -> list[ElbowRecording]:
    """The identified law along each recording's angle and cuff pressure."""
    found = []
    for path, r in zip(o.recordings, measured, strict=True):
        if law.numbers["s"] != 0.0 and r.pressure is None:
            raise InputError(path, "", "the law's stiffness follows the cuff's pressure, which is not here", "add it")
        pressure = 0.0 if r.pressure is None else r.pressure - law.pressure
        try:
            force, joint = ideal(r.time, r.beta, law.numbers, o.stroke, pressure)
        except ValueError as error:
            raise InputError(path, "", str(error), "the identified law does not reach these angles") from error
        found.append(ElbowRecording(r.name, r.time, r.beta, force, None if o.stroke is None else joint, r.pressure))
    return found


def _pairs(path: Path, measured: ElbowRecording, model: ElbowRecording) -> list[Pair]:
    """Channels that both have, at the measured trial's even times within both."""
    time, step = even_times(measured.time)
    inside = (time >= model.time[0]) & (time <= model.time[-1])
    if inside.sum() < 2:
        spans = f"{measured.time[0]:g} to {measured.time[-1]:g} s, the model {model.time[0]:g} to {model.time[-1]:g} s"
        raise InputError(path, "", f"runs from {spans}", "shift the clock of one of them")
    both = [("force", measured.force, model.force)]
    if measured.displacement is not None and model.displacement is not None:
        both.append(("displacement", measured.displacement, model.displacement))
    beta = at_times(measured.time, measured.beta, time, step)[inside]
    apart = float(np.sqrt(np.nanmean((beta - np.interp(time[inside], model.time, model.beta)) ** 2)))
    if apart > SAME_MOTION:
        what = f"its angle is {np.degrees(apart):.1f} degrees, root mean square, from that of the model's recording"
        raise InputError(path, "", what, "give the simulated recordings in the same order")
    found = []
    for channel, ours, theirs in both:
        here = at_times(measured.time, ours, time, step)[inside]
        there = np.interp(time[inside], model.time, theirs)
        found.append(Pair(measured.name, channel, time[inside], beta, here, there, agreement(there, here, step)))
    return found


def comparison_table(pairs: Sequence[Pair]) -> pd.DataFrame:
    """One row for each trial and channel; lengths in mm."""
    rows = [
        {
            "trial": p.trial,
            "channel": p.channel,
            "unit": q.unit,
            "mae": a.mae * q.per_si,
            "rmse": a.rmsd * q.per_si,
            "bias": a.bias * q.per_si,
            "r2 [-]": a.r2,
            "lag [s]": a.lag,
            "samples": a.samples,
        }
        for p, a, q in ((p, p.agreement, QUANTITIES[p.channel]) for p in pairs)
    ]
    return pd.DataFrame(rows)
