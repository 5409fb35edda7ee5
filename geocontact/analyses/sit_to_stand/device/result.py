"""The exoskeleton's own torque: `geocontact sit-to-stand device`, `gc.sit_to_stand.device`.

>>> import geocontact as gc
>>> unloaded = "meshes/standing_up_exoskeleton/unloaded_"
>>> print(gc.sit_to_stand.device(unloaded + "coordinates.sto", motors=unloaded + "motors.sto"))
15 combinations of 18 parameters identified, 11 parameters by themselves; 0.22 N m are left of the motors' torques (root
mean square)
device.toml: friction of 6 of 6 kinds identified; neither described nor identified: foot_plate_mass, shank_mass,
thigh_mass, module_mass
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.sit_to_stand.device.merged import MergedExoskeleton, merged
from geocontact.analyses.sit_to_stand.device.options import StandingDeviceOptions
from geocontact.analyses.sit_to_stand.show import motion_page
from geocontact.analyses.sit_to_stand.trial_tables import ran_table
from geocontact.analyses.sit_to_stand.worn_exoskeleton import described_exoskeleton, units_of_parameters
from geocontact.data.errors import InputError
from geocontact.data.motion import Course
from geocontact.data.plausible import COULOMB, FIRST_MOMENT, INERTIA, MOTOR, PART, VISCOUS
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_size
from geocontact.identify.signals.filters import ORDER, UNEVEN
from geocontact.io.opensim.coordinates import columns_of, coordinates_of
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.recordings.exoskeleton_description import ExoskeletonFile, exoskeleton_toml
from geocontact.io.text.tables import read_table
from geocontact.standing_up.chain import JOINTS, Subject
from geocontact.standing_up.exoskeleton import EXO_JOINTS, two_chains
from geocontact.standing_up.exoskeleton_torque import (
    ALONE,
    MARGIN,
    UNITS,
    UNTOLD,
    DeviceMotion,
    ExoskeletonDynamics,
    device_alone,
    human_torque,
    identified_from,
)
from geocontact.standing_up.numbers_that_ran import Ran, joint_numbers
from geocontact.standing_up.worn_device import TURNS
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet
from geocontact.view.page.content import Section
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from geocontact.view.page.content import Page

MEANT = [
    "The motors' torque is linear in the parameters, and least squares find them; bodies are those of both legs.",
    "By itself: the motion identifies that parameter.",
    "Not at all: it does not act on the motors, so that 0 is shown.",
    "In sums only: the motion identifies it with others; the shortest answer is shown, torques are those of all.",
    "Angles and torques went through the same filter, so that the fit is not bent by it.",
    "In a trial the torque at a hinge is that of its motor less its friction.",
]
TORQUES, DESCRIPTION = "torques.sto", "device.toml"
FEWEST = 50
"""Samples of a motion."""
POORLY = 0.2
"""Part of the torque's own spread: a residual above it says that the motion is not this model's."""


@dataclass(frozen=True, eq=False)
class DeviceRecordings:
    """The motion without a person, and a trial with one and the moments of both together there; None where not given.

    Parameters
    ----------
    subject
        Its mass plays no part.
    described
        The exoskeleton's description, into which what is identified is merged.
    """

    subject: Subject
    described: ExoskeletonFile
    unloaded: DeviceMotion
    trial: DeviceMotion | None
    together: Float[np.ndarray, "t 3"] | None


def read(o: StandingDeviceOptions) -> DeviceRecordings:
    """Everything the options name; InputError where files are on different clocks or too short."""
    subject, described = Subject(height=o.height), ExoskeletonFile("exoskeleton", {})
    if o.device is not None:
        device, described = described_exoskeleton(o.device)
        subject = replace(subject, device=device)
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
    return DeviceRecordings(subject, described, unloaded, trial, together)


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
    if doubt := MOTOR.doubt(float(np.abs(torque).max())):
        reserve(f"{motors[0]} `{motors[1]}`: {doubt}")
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
        raise InputError(file, "", what, "is it of another trial? name its own file, or put both on one clock")
    return np.column_stack([np.interp(time, table.time, column) for column in values])


def device_curves(
    time: Float[np.ndarray, " t"], motors: Float[np.ndarray, "t 3"], fitted: Float[np.ndarray, "t 3"]
) -> CurveSheet:
    """A panel for each hinge: torque of the motor as recorded, and of the fit."""
    panels = [
        Curves(
            f"Motors of both legs, {name.replace('_', ' ')}",
            "N m",
            [Curve("recorded", motors[:, k], stroke=INK), Curve("fitted", fitted[:, k], stroke=0)],
        )
        for k, name in enumerate(EXO_JOINTS)
    ]
    return CurveSheet(panels, Course("time", "s", time))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingDeviceResult(Result):
    """Parameters and torques."""

    options: StandingDeviceOptions
    given: DeviceRecordings
    dynamics: ExoskeletonDynamics

    @property
    def trial_torque(self) -> Float[np.ndarray, "t 3"]:
        """Torque of the exoskeleton in the trial [N m]; no row without one."""
        trial = self.given.trial
        if trial is None:
            return np.zeros((0, 3))
        return self.dynamics.in_trial(trial, self.options.cutoff)

    @property
    def smooth(self) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, "t 3"], Float[np.ndarray, "t 3"]]:
        """Without a person, without the ends: times [s], torques of the motors and of the fit [N m], both smoothed."""
        of, cutoff = self.given.unloaded, self.options.cutoff
        inner, again = of.inner(cutoff), self.dynamics.unloaded(of.q, of.u, of.a)
        return of.time[inner], of.smooth(of.motors, cutoff)[inner], of.smooth(again, cutoff)[inner]

    @property
    def person_torque(self) -> Float[np.ndarray, "t 3"] | None:
        """Torque of the person in the trial [N m]; None without moments of both."""
        both = self.given.together
        return None if both is None else human_torque(both, self.trial_torque)

    @property
    def merged(self) -> MergedExoskeleton:
        """Description and what the motion identified."""
        return merged(self.given.described, self.dynamics, self.options.level)

    @property
    def parameters(self) -> dict[str, float]:
        """Masses, first moments, inertias and friction of the device [kg, kg m, kg m^2, N m s/rad, N m]."""
        return dict(zip(self.dynamics.names, np.asarray(self.dynamics.values).tolist(), strict=True))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`parameters`, `unloaded`, `numbers`, and `torque` where there is a trial."""
        fit = self.dynamics
        time, motors, again = self.smooth
        columns = {"time [s]": time}
        for k, name in enumerate(EXO_JOINTS):
            columns |= {f"{name} motor [N m]": motors[:, k], f"{name} fitted [N m]": again[:, k]}
        found = {"parameters": self._parameters(), "unloaded": pd.DataFrame(columns)}
        found["numbers"] = ran_table(_numbers(self.given.unloaded, fit, self.options))
        if (trial := self.given.trial) is not None:
            friction, motors = fit.friction(trial.u), trial.smooth(trial.motors, self.options.cutoff)
            columns = {"time [s]": trial.time}
            for k, name in enumerate(EXO_JOINTS):
                columns |= {f"{name} motor [N m]": motors[:, k], f"{name} friction [N m]": friction[:, k]}
                columns[f"{name} torque [N m]"] = self.trial_torque[:, k]
            if (person := self.person_torque) is not None:
                columns |= {f"{name} torque [N m]": person[:, k] for k, name in enumerate(JOINTS)}
            found["torque"] = pd.DataFrame(columns)
        return found

    def _parameters(self) -> pd.DataFrame:
        fit, found = self.dynamics, self.dynamics.values  # noqa: PD011
        lower, upper = fit.intervals(self.options.level)
        return pd.DataFrame(
            {
                "parameter": fit.names,
                "unit": UNITS,
                "value": found,
                "lower": lower,
                "upper": upper,
                "identified": np.where(fit.alone, "by itself", np.where(found == 0.0, "not at all", "in sums only")),
            }
        )

    def curves(self) -> dict[str, CurveSheet]:
        """`device`: the motors' torque and the fit."""
        return {"device": device_curves(*self.smooth)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The fit over time, parameters."""
        curves = self.curves()["device"]
        sections: list[Section] = [
            *(replace(panel, over=curves.over) for panel in curves.panels),
            frame_table("Dynamic parameters", self.table("parameters"), 4),
        ]
        titles = ("Dynamics of the exoskeleton", "identified from a motion without a person")
        return {REPORT: motion_page(titles, self.sentences, sections, MEANT)}

    def write_files(self, folder: Path) -> None:
        """device.toml, torques.sto of a trial as a study reads them; tables, figure, page."""
        if (trial := self.given.trial) is not None:
            person = self.person_torque
            names = (*(() if person is None else JOINTS), *EXO_JOINTS)
            values = self.trial_torque if person is None else np.hstack([person, self.trial_torque])
            write_storage(folder / TORQUES, trial.time, names, values, title="Torques of both legs", degrees=False)
        text = exoskeleton_toml(self.merged.file, units_of_parameters(), self.merged.remarks)
        (folder / DESCRIPTION).write_text(text, encoding="utf-8")
        super().write_files(folder)


def _numbers(of: DeviceMotion, fit: ExoskeletonDynamics, o: StandingDeviceOptions) -> list[Ran]:
    """The exoskeleton as it was fitted, what its motion went through, and from when on a parameter is identified."""
    asked = "as asked for"
    rows = [
        Ran("height", fit.subject.height, "m", "derived", f"of the person whom it is set to, {asked}"),
        *joint_numbers(device_alone(fit.subject), fit.subject.device),
    ]
    rows += [
        Ran(name, float(value), unit, "derived", "found, by itself" if alone else "found, in sums or not at all")
        for name, value, unit, alone in zip(fit.names, fit.values, UNITS, fit.alone, strict=True)
    ]
    return [
        *rows,
        Ran("Coulomb friction rate", TURNS, "rad/s", "invented", "friction is its size times tanh(rate / this)"),
        Ran("filter cutoff", o.cutoff, "Hz", "derived", f"of angles and torques alike, {asked}"),
        Ran("filter order", float(ORDER), "-", "paper", "Butterworth, run forwards and back: Winter (2009), sec. 3.4"),
        Ran("margin", MARGIN / o.cutoff, "s", "invented", "at either end, left out of the fit"),
        Ran("sample step", of.step, "s", "derived", "of the motion without a person"),
        Ran("samples", float(of.inner(o.cutoff).sum()), "-", "derived", "without the ends"),
        Ran("independent samples", of.independent(o.cutoff), "-", "derived", "part of them behind the filter"),
        Ran("least singular value", UNTOLD, "-", "invented", "of the largest: a smaller one identifies nothing"),
        Ran("least part", ALONE, "-", "invented", "of a parameter beyond what is identified, if by itself"),
        Ran("level", o.level, "-", "derived", f"probability of the intervals, {asked}"),
    ]


SIZES = {
    "viscous friction": VISCOUS,
    "Coulomb friction": COULOMB,
    "first moment along x": FIRST_MOMENT,
    "first moment along y": FIRST_MOMENT,
    "inertia": INERTIA,
    "mass": PART,
}
"""What parameters can be, by the end of their names."""


def goodness_of(fit: ExoskeletonDynamics, spread: float, level: float) -> GoodnessOfFit:
    """The fit against the spread of the motors' torques [N m]; each parameter against the sizes of a worn device's."""
    doubts: list[Doubt] = []
    if fit.residual > POORLY * spread:
        what = f"{fit.residual:.2g} N m of the motors' torques are not explained, whose spread is {spread:.2g} N m"
        doubts.append(Doubt(f"{what}: check the names of the hinges, the signs, and that it is not worn", True))
    ends = zip(fit.names, *fit.intervals(level), fit.alone, strict=True)
    tested = []
    for name, lower, upper, alone in ends:
        known = next((size for kind, size in SIZES.items() if name.endswith(kind)), None)
        if alone and known is not None:
            doubts += of_size(name, (float(lower), float(upper)), known)
            tested.append(name)
    return GoodnessOfFit(tuple(doubts), ("torques of the motors", *tested))


def run(given: DeviceRecordings, o: StandingDeviceOptions) -> StandingDeviceResult:
    """Fit, doubt, tell."""
    of = given.unloaded
    dynamics = identified_from(given.subject, of, o.cutoff)
    spread = float(np.std(of.motors, axis=0).max())
    judge(goodness_of(dynamics, spread, o.level))
    still = [name for name, rate in zip(EXO_JOINTS, np.abs(of.u).max(axis=0), strict=True) if rate < np.radians(5.0)]
    if still:
        reserve(f"{', '.join(still)} turned at less than 5 deg/s: its friction is hardly identified")
    result = StandingDeviceResult(options=o, given=given, dynamics=dynamics)
    table = result.table("parameters")
    alone = table[table["identified"] == "by itself"]
    say(
        f"{dynamics.rank} combinations of {len(table)} parameters identified, {len(alone)} parameters by themselves; "
        f"{dynamics.residual:.2g} N m are left of the motors' torques (root mean square)"
    )
    note(
        "device",
        {
            "rank": dynamics.rank,
            "residual_Nm": dynamics.residual,
            "parameters": dict(zip(table["parameter"], table["value"], strict=True)),
        },
    )
    made = result.merged
    for line in made.contradictions:
        reserve(line)
    say(made.sentence)
    if given.trial is not None:
        own = result.trial_torque
        sizes = ", ".join(f"{n} {v:.1f}" for n, v in zip(EXO_JOINTS, np.abs(own).max(axis=0), strict=True))
        say(f"largest torque of the exoskeleton in the trial [N m]: {sizes}")
    return result


device = Job("sit-to-stand device", StandingDeviceOptions, read, run)
