"""A channel of a trial beside what the model says: what is read, and how far they are apart."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.compare.options import CompareOptions
from geocontact.analyses.misalignment.labels import CONSTRAINT
from geocontact.analyses.misalignment.law_numbers import MMHG, PER_SI, key_of
from geocontact.analyses.misalignment.recordings import recordings
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.law import NAMES
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.data.plausible import LARGEST_MEANT
from geocontact.identify.signals.agreement import Agreement
from geocontact.identify.signals.angle_bins import angle_bins, edges_over
from geocontact.view.curves.quantity import Quantity

QUANTITIES = {"force": CONSTRAINT, "displacement": Quantity("displacement of the joint", "mm", 1e3)}
"""What channels are called and shown in."""


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


def read(o: CompareOptions, record: Record) -> Both:
    """Everything the options name."""
    measured = recordings(record, "measured", o.recordings, o.map, o.angles, o.unit, o.cutoff)
    if o.fit is None:
        return Both(measured, recordings(record, "simulated", o.simulated or (), None, o.angles, o.unit, None))
    law = _law(o.fit)
    record.add_input("`fit`", o.fit)
    return Both(measured, law)


def _law(file: Path) -> ComparedLaw:
    """The law in an elbow.json."""
    try:
        content = json.loads(file.read_text(encoding="utf-8"))
        told, centre = content["numbers"], content["pressure_mmHg"] or 0.0
        told = {key_of("c"): 0.0, **told}  # files of version 0.1 have a rigid fixation
        numbers = {name: float(told[key_of(name)]) / PER_SI[name] for name in NAMES}
        if not (np.abs([*numbers.values(), float(centre)]) <= LARGEST_MEANT).all():
            raise ValueError("a number is not finite or too large")
    except (OSError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise InputError(file, "", f"holds no law of an elbow ({error})", "give elbow.json of elbow fit") from error
    return ComparedLaw(numbers, float(centre) * MMHG)
