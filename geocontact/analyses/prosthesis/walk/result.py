"""Both legs in motion: `geocontact prosthesis walk`, `gc.prosthesis.walk`.

>>> import geocontact as gc
>>> stood = "meshes/amputee_P1/"
>>> person = {"static": stood + "standing.trc", "functional": stood + "functional.trc", "mass": 77.3, "height": 1.81}
>>> plates = {"plates": stood + "plates.mot", "plate": "own_force", "other_plate": "other_force"}
>>> result = gc.prosthesis.walk(stood + "walking.trc", **person, **plates)
>>> print(result.sentences[0])
both legs from … to … s along recorded angles: force of the prosthetic foot within …% BW of its plate (R² …)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.motion.joint_angles import joint_angles_table, warn_of_gimbal_lock
from geocontact.analyses.motion.marker_tasks import FAR, MOVING, MarkerErrors
from geocontact.analyses.prosthesis.quantity_words import ASKED, NAMES
from geocontact.analyses.prosthesis.walk.options import ProsthesisWalkOptions
from geocontact.analyses.prosthesis.walk.show import spoken, walk_curves, walk_page
from geocontact.analyses.prosthesis.walk.steps import MovedLegs, RecordedPerson, moved_legs, read
from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.joint_work import (
    JointMoment,
    JointWork,
    joint_moments,
    joint_work,
    metabolic_proxy,
)
from geocontact.below_knee_prosthesis.both_sides.recorded_steps import PlayedBack, centre_on_floor, load_errors
from geocontact.below_knee_prosthesis.both_sides.walk import WholeMotion, without_locked
from geocontact.below_knee_prosthesis.from_markers import of_side
from geocontact.below_knee_prosthesis.leg import Side
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.own_side import LENGTHS, TURNED
from geocontact.data.multibody.model import Multibody
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_low_r2
from geocontact.identify.signals.agreement import Agreement
from geocontact.io.opensim.storage_writer import write_storage

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

LEFT = {"r": "l", "l": "r"}


def names_of_side(names: tuple[str, ...], side: Side) -> tuple[str, ...]:
    """Coordinates of a right prosthesis by the names of the person's own side."""
    if side == "right":
        return names
    return tuple(f"{name[:-1]}{LEFT[name[-1]]}" if name[-2:] in ("_r", "_l") else name for name in names)


def coordinates_of_side(walk: WholeMotion, side: Side) -> Float[np.ndarray, "t n"]:
    """Coordinates over time as those of the person's own side [rad, m]."""
    return np.where(np.isin(walk.names, TURNED), -walk.q, walk.q) if side == "left" else walk.q


def model_of_side(amputee: Amputee, walk: WholeMotion, side: Side) -> tuple[Multibody, Float[np.ndarray, "t n"]]:
    """The person with the prosthesis on their own side, and the coordinates over time in the model's order."""
    model = without_locked(amputee_tree(amputee, side))
    names = names_of_side(walk.names, side)
    return model, coordinates_of_side(walk, side)[:, [names.index(c.name) for c in model.coordinates]]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisWalkResult(Result):
    """Both legs over a stance of the prosthesis.

    Parameters
    ----------
    person
        Who walked, and the plates.
    moved
        The motion by angles, the forces along its coordinates, and the motion by torques where that was asked for.
    errors
        Agreement with the plates, by foot and quantity.
    peaks
        Moments along each coordinate of a joint.
    work
        Of each joint.
    """

    options: ProsthesisWalkOptions
    person: RecordedPerson
    moved: MovedLegs
    errors: Mapping[tuple[str, str], Agreement]
    peaks: Mapping[str, JointMoment]
    work: Mapping[str, JointWork]

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the samples [s]."""
        return self.moved.walk.time

    @property
    def force(self) -> Float[np.ndarray, "t 3"]:
        """Force of the ground on the prosthetic foot, in the frame of the laboratory [N]."""
        return np.asarray(of_side(self.moved.walk.force, self.options.side))

    @property
    def moments(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Moment along each coordinate of a joint over time [N m], by the name of the person's own side."""
        names = names_of_side(self.moved.walk.names, self.options.side)
        table = dict(zip(names, self.moved.forces.T, strict=True))
        return {name: column for name, column in table.items() if not name.startswith(("pelvis", "socket", "keel"))}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`walk` over time, `moments`, `work`, `angles` of joints, `errors` beside the plates, `played_back`."""
        walk, side = self.moved.walk, self.options.side
        columns: dict[str, object] = {"time [s]": walk.time}
        for foot, wrench in (("prosthesis", walk.own), ("intact", walk.intact)):
            if foot == "intact" and self.options.intact == "plate":
                continue
            force, centre = of_side(wrench[:, :3], side), of_side(centre_on_floor(wrench), side)
            columns |= {f"{foot} force_{axis} [N]": force[:, k] for k, axis in enumerate("xyz")}
            columns |= {f"{foot} cop_{axis} [mm]": 1e3 * centre[:, k] for k, axis in ((0, "x"), (2, "z"))}
        columns |= {f"{name} moment [N m]": column for name, column in self.moments.items()}
        residuals = pelvis_residuals(walk, self.moved.forces, side)
        columns |= {f"{name} residual [{_unit(name)}]": column for name, column in residuals.items()}
        rows = [
            {"foot": foot, "quantity": name, "unit": UNITS.get(name, "-"), "r2 [-]": each.r2, "rmse": each.rmsd}
            for (foot, name), each in self.errors.items()
        ]
        found = {"walk": pd.DataFrame(columns), "moments": moments_table(self.peaks)}
        found |= {"work": work_table(self.work), "errors": pd.DataFrame(rows)}
        model, values = model_of_side(self.person.amputee, walk, side)
        found["angles"] = joint_angles_table(model, walk.time, values, self.options.joint_angles)
        if self.moved.beside is not None:
            found["played_back"] = played_table(self.moved.beside)
        return found

    def curves(self) -> dict[str, CurveSheet]:
        """`walk`: force of the prosthetic foot beside its plate's, moments of hips, knees and ankle."""
        person, walk = self.person, self.moved.walk
        weight = person.amputee.mass * GRAVITY
        return {"walk": walk_curves(walk.time, walk.force, person.plate, weight, self.moments)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The moving skeleton, curves, tables."""
        side, walk = self.options.side, self.moved.walk
        model, values = model_of_side(self.person.amputee, walk, side)
        title = f"Walk of {self.options.markers.name}"
        return {REPORT: walk_page(title, model, values, self.curves()["walk"], self.tables(), self.sentences)}

    def write_files(self, folder: Path) -> None:
        """Coordinates for OpenSim besides."""
        walk, side = self.moved.walk, self.options.side
        names, values = names_of_side(walk.names, side), coordinates_of_side(walk, side)
        lengths = np.array([name.startswith(("pelvis_t", "socket_t")) and name != "pelvis_tilt" for name in names])
        table = np.where(lengths, values, np.degrees(values))
        title = "Coordinates of both legs"
        write_storage(folder / "coordinates.sto", walk.time, list(names), table, title=title, degrees=True)
        super().write_files(folder)


UNITS = {"cop_x": "m", "cop_z": "m"}
"""Units of quantities that are no shares of body weight."""


def _unit(name: str) -> str:
    return "N" if name in LENGTHS else "N m"


def pelvis_residuals(
    walk: WholeMotion, forces: Float[np.ndarray, "t n"], side: Side
) -> dict[str, Float[np.ndarray, " t"]]:
    """What holds the pelvis beside joints, ground and gravity, along its coordinates over time [N, N m]: the sum of all
    that the model has not, of trunk, arms and errors of the recording.
    """
    signs = {name: -1.0 if side == "left" and name in TURNED else 1.0 for name in walk.names}
    columns = zip(walk.names, forces.T, strict=True)
    return {name: signs[name] * column for name, column in columns if name.startswith("pelvis")}


def moments_table(peaks: Mapping[str, JointMoment]) -> pd.DataFrame:
    """Peak and mean size of the moment along each coordinate of a joint."""
    rows = [(name, one.peak, one.mean) for name, one in peaks.items()]
    return pd.DataFrame(rows, columns=["coordinate", "peak moment [N m]", "mean moment [N m]"])


def work_table(work: Mapping[str, JointWork]) -> pd.DataFrame:
    """Work of each joint, and the proxy of what that costs."""
    rows = [
        {
            "joint": name,
            "positive work [J]": one.positive,
            "negative work [J]": one.negative,
            "metabolic proxy [J]": metabolic_proxy({name: one}),
        }
        for name, one in work.items()
    ]
    return pd.DataFrame(rows)


def played_table(beside: PlayedBack) -> pd.DataFrame:
    """Largest differences up to each time."""
    return pd.DataFrame(
        {
            "since the start [s]": beside.since,
            "turn [deg]": beside.turn,
            "shift [mm]": beside.shift,
            "force [-]": beside.force,
        }
    )


def run(person: RecordedPerson, o: ProsthesisWalkOptions) -> ProsthesisWalkResult:
    """The motion, its forces beside the plates, moments and work of the joints."""
    if o.functional is None:
        reserve("hips from a regression; a `functional` trial determines them better")
    reserve(
        "the socket's motion is in its markers and again in its bushing; `prosthesis simulate` takes it out of them"
    )
    markers = MarkerErrors.of(person.steps.poses)
    moved = moved_legs(person, o)
    walk, mass = moved.walk, person.amputee.mass
    errors = {("prosthesis", name): each for name, each in load_errors(walk.time, walk.own, person.plate, mass).items()}
    if o.intact == "spheres":
        own = load_errors(walk.time, walk.intact, person.other, mass)
        errors |= {("intact", name): each for name, each in own.items()}
    names = names_of_side(walk.names, o.side)
    peaks = joint_moments(walk.time, names, moved.forces)
    work = joint_work(walk.time, names, walk.u, moved.forces)
    judge(goodness_of(errors, markers))
    model, values = model_of_side(person.amputee, walk, o.side)
    warn_of_gimbal_lock(model, walk.time, values, o.joint_angles)
    _summarise(errors, peaks, work, moved, mass)
    note("markers", plain({"rms_m": markers.rms, "largest_m": markers.largest}))
    return ProsthesisWalkResult(options=o, person=person, moved=moved, errors=errors, peaks=peaks, work=work)


TESTED = {"resultant": NAMES["resultant"], "cop_x": NAMES["cop_ground"]}
"""Quantities that a foot is tested by, in words."""

OTHER_FOOT = 0.1
"""Root mean square of what a foot's force misses its plate by, in body weights; the shipped trial has 0.05 with its own
setting, and 0.12 and 0.14 with the two beside it."""


def _named(foot: str, quantity: str) -> str:
    return TESTED[quantity] if foot == "prosthesis" else f"{TESTED[quantity]} of the intact foot"


def goodness_of(errors: Mapping[tuple[str, str], Agreement], markers: MarkerErrors) -> GoodnessOfFit:
    """Force and centre of pressure of every foot on spheres against its plate, markers against the model."""
    own = {_named(*key): each for key, each in errors.items() if key[1] in TESTED}
    doubts = [
        Doubt(f"{one.what}: {ASKED}", one.contradicts, one.size)
        for name, each in own.items()
        for one in of_low_r2(name, each.r2)
    ]
    own_foot = errors.get(("prosthesis", "resultant"))
    if own_foot is not None and own_foot.rmsd > OTHER_FOOT and not doubts:
        what = f"force of the prosthetic foot is {own_foot.rmsd:.1%} BW from its plate (root mean square)"
        doubts.append(Doubt(f"{what}: is it this foot, in this setting, on a sole of this law?", False, own_foot.rmsd))
    if not markers.within(MOVING):
        doubts.append(Doubt(f"markers are {markers.words(MOVING)}", markers.rms > FAR, markers.rms / MOVING.rms))
    return GoodnessOfFit(tuple(doubts), (*own, "markers"))


def _summarise(
    errors: Mapping[tuple[str, str], Agreement],
    peaks: Mapping[str, JointMoment],
    work: Mapping[str, JointWork],
    moved: MovedLegs,
    mass: float,
) -> None:
    """Sentences and results of a walk."""
    found = errors["prosthesis", "resultant"]
    walk = moved.walk
    say(
        f"both legs from {walk.time[0]:.2f} to {walk.time[-1]:.2f} s along recorded angles: force of the prosthetic "
        f"foot within {found.rmsd:.1%} BW of its plate (R² {found.r2:.2f})"
    )
    if ("intact", "vertical") in errors:
        intact = errors["intact", "vertical"]
        say(f"intact foot on spheres: vertical force within {intact.rmsd:.1%} BW of its plate (R² {intact.r2:.2f})")
    largest = max(peaks, key=lambda name: peaks[name].peak)
    proxy = metabolic_proxy(work) / mass
    say(
        f"largest joint moment {peaks[largest].peak:.0f} N m ({spoken(largest)}); metabolic proxy "
        f"{proxy:.2f} J/kg over these {walk.time[-1] - walk.time[0]:.2f} s (work of the joints, no measurement)"
    )
    residuals = pelvis_residuals(walk, moved.forces, "right")
    force, moment = (
        max(float(np.abs(column).max()) for name, column in residuals.items() if _unit(name) == unit)
        for unit in ("N", "N m")
    )
    say(f"residuals on the pelvis up to {force / (mass * GRAVITY):.1%} BW and {moment:.0f} N m")
    note("pelvis_residuals", plain({"force_BW": force / (mass * GRAVITY), "moment_N_m": moment}))
    note("moments", plain({name: {"peak_N_m": one.peak, "mean_N_m": one.mean} for name, one in peaks.items()}))
    note("metabolic_proxy_J_per_kg", plain(proxy))
    beside = moved.beside
    if beside is not None:
        say(
            f"by its torques and the pelvis' residuals, every coordinate free, single support stays within 0.5 degrees "
            f"and 2 % BW for {beside.held:.2f} of {beside.since[-1]:.2f} s; differences grow by {beside.growth:.0f}/s"
        )
        note("played_back", plain({"held_s": beside.held, "of_s": beside.since[-1], "growth_per_s": beside.growth}))


walk = Job("prosthesis walk", ProsthesisWalkOptions, read, run)
