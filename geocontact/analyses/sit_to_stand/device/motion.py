"""Angles of the exoskeleton's hinges and torques of its motors, smoothed alike, with their rates."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.sit_to_stand.device.options import StandingDeviceOptions
from geocontact.data.errors import InputError
from geocontact.identify.signals.filters import UNEVEN, zero_lag
from geocontact.io.opensim.coordinates import columns_of, coordinates_of
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import JOINTS, Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS, two_chains

FEWEST = 50
"""Samples."""
MARGIN = 1.0
"""Periods of the cut-off at either end that are not used: there the filter's own course is in the accelerations."""
Table = Float[np.ndarray, "t 3"]


@dataclass(frozen=True, eq=False)
class DeviceMotion:
    """Over time: angles, smoothed, their rates and accelerations, and the motors' torques as recorded."""

    time: Float[np.ndarray, " t"]
    q: Table
    u: Table
    a: Table
    motors: Table

    @staticmethod
    def smoothed(time: Float[np.ndarray, " t"], q: Table, motors: Table, cutoff: float) -> DeviceMotion:
        """The motion from angles as recorded; ValueError where they cannot be filtered."""
        step = float(np.ptp(time)) / (len(time) - 1)
        smooth = zero_lag(q, step, cutoff)
        u = np.gradient(smooth, step, axis=0)
        return DeviceMotion(time, smooth, u, np.gradient(u, step, axis=0), motors)

    @property
    def step(self) -> float:
        """Between two samples [s]."""
        return float(np.ptp(self.time)) / (len(self.time) - 1)

    def smooth(self, values: Float[np.ndarray, "t ..."], cutoff: float) -> Float[np.ndarray, "t ..."]:
        """Values at the times, without what lies above the cut-off [Hz]."""
        return zero_lag(values, self.step, cutoff)

    def independent(self, cutoff: float) -> float:
        """Part of the samples that is independent behind the filter.

        What passes a filter at fc is correlated: of white noise 2 fc dt of the variance is left, in as many independent
        samples, so that the variance of the unfiltered torque is that of the residual over 2 fc dt.
        """
        return min(2.0 * cutoff * self.step, 1.0)

    def inner(self, cutoff: float) -> Bool[np.ndarray, " t"]:
        """Where the ends do not show."""
        margin = MARGIN / cutoff
        return np.asarray((self.time >= self.time[0] + margin) & (self.time <= self.time[-1] - margin))


@dataclass(frozen=True, eq=False)
class DeviceRecordings:
    """The motion without a person, and a trial with one and the moments of both together there; None where not given.

    Parameters
    ----------
    subject
        Its mass plays no part.
    """

    subject: Subject
    unloaded: DeviceMotion
    trial: DeviceMotion | None
    together: Table | None


def read(o: StandingDeviceOptions) -> DeviceRecordings:
    """Everything the options name; InputError where files are on different clocks or too short."""
    subject = Subject(height=o.height)
    unloaded = _motion((o.unloaded, "unloaded"), (o.motors, "motors"), subject, o.cutoff)
    used = int(unloaded.inner(o.cutoff).sum())
    if used < FEWEST:
        what = f"{used} samples are left without {MARGIN / o.cutoff:.2g} s at either end"
        raise InputError(o.unloaded, "", what, f"{FEWEST} are needed: record for longer")
    trial = together = None
    if o.trial is not None and o.trial_motors is not None:
        trial = _motion((o.trial, "trial"), (o.trial_motors, "trial_motors"), subject, o.cutoff)
        if o.together is not None:
            together = _columns((o.together, "together"), [f"{n}_moment [N m]" for n in JOINTS], trial.time)
    return DeviceRecordings(subject, unloaded, trial, together)


def _motion(angles: tuple[Path, str], motors: tuple[Path, str], subject: Subject, cutoff: float) -> DeviceMotion:
    file, role = angles
    table = read_table(file)
    add_input(f"`{role}`", file, frames=len(table.time))
    joints = [joint for joint in two_chains(subject).joints if joint.name in EXO_JOINTS]
    known = columns_of(table, joints)
    lacking = [name for name in EXO_JOINTS if name not in known]
    if lacking:
        raise InputError(file, "", f"no column for {', '.join(lacking)}", "all three hinges must be recorded")
    found = coordinates_of(table, joints, known, None)
    time, raw = table.time, np.column_stack([found[name] for name in EXO_JOINTS])
    step = float(np.ptp(time)) / max(len(time) - 1, 1)
    if len(time) < FEWEST or np.abs(np.diff(time) - step).max() > UNEVEN * step:
        what = f"{len(time)} frames that are not {step:g} s apart everywhere"
        raise InputError(file, "", what, f"give at least {FEWEST} evenly spaced ones")
    torque = _columns(motors, list(EXO_JOINTS), time)
    try:
        return DeviceMotion.smoothed(time, raw, torque, cutoff)
    except ValueError as error:
        raise InputError(file, "", str(error), "give another `cutoff`") from error


def _columns(given: tuple[Path, str], names: list[str], time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 3"]:
    """At times that the file must cover."""
    file, role = given
    table = read_table(file)
    add_input(f"`{role}`", file, frames=len(table.time))
    bare = [name if name in table.channels else name.partition(" [")[0] for name in names]
    values = [table.needed(name) for name in bare]
    begin, end = table.time[[0, -1]]
    step = float(np.ptp(time)) / (len(time) - 1)
    if begin > time[0] + step or end < time[-1] - step:
        what = f"runs from {begin:g} to {end:g} s, the angles from {time[0]:g} to {time[-1]:g} s"
        raise InputError(file, "", what, "put both on one clock")
    return np.column_stack([np.interp(time, table.time, column) for column in values])
