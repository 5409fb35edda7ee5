"""A person with a below-knee prosthesis made to measure: `geocontact prosthesis scale`, `gc.prosthesis.scale`.

>>> import geocontact as gc
>>> stood = "meshes/amputee_P1/"
>>> person = {"mass": 77.3, "height": 1.81}
>>> result = gc.prosthesis.scale(stood + "standing.trc", functional=stood + "functional.trc", **person)
>>> print(result)
both legs of 77.3 kg in 17 bodies with 36 coordinates, pelvis with all above it 46.9 kg, residual limb 1.78
kg
5 of 5 joint centres from the functional trial
markers of the functional trial 3.7 mm from the model, root mean square, and 11.7 mm at most, LKNE at 37.8 s
(OpenSim advises less than 20 and 40 mm)
warning: 8 of 91 numbers of the segments are invented, see numbers.csv
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import judge, note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.motion.marker_tasks import FAR, MOVING, MarkerErrors
from geocontact.analyses.motion.skeleton import MARKER, scene_of, skeleton
from geocontact.analyses.person import person_segments
from geocontact.analyses.prosthesis.foot_file import foot_of, fulcrum_at
from geocontact.analyses.prosthesis.number_units import with_units
from geocontact.analyses.prosthesis.recorded_files import LaboratoryFiles, residual_of
from geocontact.analyses.prosthesis.scale.options import ProsthesisScaleOptions
from geocontact.analyses.prosthesis.stance_files import numbers_table
from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.amputee_tree import amputee_tree
from geocontact.below_knee_prosthesis.both_sides.standing import (
    NO_JOINTS,
    FunctionalJoints,
    standing_amputee,
    standing_joints,
)
from geocontact.below_knee_prosthesis.both_sides.standing_model import (
    JointFound,
    as_standing,
    doubts_of_legs,
    joint_centres,
    largest_motion,
    model_poses,
    sole_spheres,
    standing_pose,
)
from geocontact.below_knee_prosthesis.from_markers import as_right, of_side
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.below_knee_prosthesis.recorded_walk import with_residual
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.data.parameter import Number
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit
from geocontact.io.opensim.osim_writer import ContactBall, write_osim
from geocontact.view.page.content import IntervalRow, Intervals, Page, Section, Words
from geocontact.view.page.scene import Linkage
from geocontact.view.page.tables import frame_table

TRUNK = (
    "Trunk, head and arms are one rigid body with the pelvis, upright as while standing, arms hanging (de Leva): it "
    "leans with the pelvis only, and its arms do not swing. Moments on pelvis and hips are those of such a trunk."
)
SKIN = (
    "Markers lie on skin. Centres from a functional trial are off by what skin moves, more if the joint moves little: "
    "the residual of a joint shows the first, not the second."
)
HELD_PARTS = (
    "amputee_ik.osim holds socket and keel, unseen by markers; in amputee.osim they are free, with springs "
    "of the fulcrum that was asked for."
)


def amputee_page(
    title: str, model: Multibody, pose: Poses, tables: Mapping[str, pd.DataFrame], sentences: Sequence[str]
) -> Page:
    """The standing pose with its markers, segments, joints, numbers."""
    values = np.asarray(pose.values)
    places = Linkage("markers", model.marker_places(values), np.zeros((0, 2), dtype=np.int64), "seen", MARKER, 0.0)
    sections: list[Section] = [
        scene_of(model, [skeleton(model, values), places]),
        frame_table("Segments", tables["segments"]),
        frame_table("Joints while standing", tables["joints"]),
        *_distances(tables),
        frame_table("Numbers of the segments in SI, and where they are from", with_units(tables["numbers"])),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [TRUNK, SKIN, HELD_PARTS, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle="Both legs of a person with a below-knee prosthesis, standing",
        time=np.zeros(1),
        time_label="",
        headline=headline(sentences),
        facts=[
            ("Mass", f"{model.mass:.4g} kg"),
            ("Coordinates", f"{len(model.coordinates)}"),
        ],
        sections=tuple(sections),
        plays=False,
    )


def _distances(tables: Mapping[str, pd.DataFrame]) -> list[Section]:
    """Distances of the markers of the functional trial from the model, farthest first."""
    if "markers" not in tables:
        return []
    table = tables["markers"].sort_values("off, rms [mm]", ascending=False)
    rows = [IntervalRow(name, float(off)) for name, off in table.itertuples(index=False)]
    return [Intervals("Markers of the functional trial off the model, root mean square", "mm", rows, bars=True)]


MOVED = 0.02
"""m that a marker may move while standing without a word."""


@dataclass(frozen=True, eq=False)
class Stood:
    """Markers of a person who stands, as of a right prosthesis, and what is known beside them."""

    seen: MarkerTrajectories
    moving: MarkerTrajectories | None
    joints: FunctionalJoints
    person: Person
    foot: VariableStiffnessFoot
    fulcrum: float


def read(o: ProsthesisScaleOptions) -> Stood:
    """Everything the options name."""
    foot = foot_of(o.foot)
    fulcrum = fulcrum_at(foot, o.setting, o.fulcrum)
    lab = LaboratoryFiles(o.side, o.axes, o.markers_map, o.c3d_unit)
    standing = lab.markers("static", o.static)
    moved = None if o.functional is None else lab.markers("`functional`", o.functional)
    lab.check(standing, moved, cast(float, o.mass), height=o.height, age=o.age)
    seen, moving = lab.right(standing), None if moved is None else lab.right(moved)
    name, far = largest_motion(seen)
    if far > MOVED:
        what = f"{name} moves {1e3 * far:.0f} mm away from its median: is this standing still?"
        reserve(f"{seen.source}: {what}")
    joints = NO_JOINTS if moving is None else standing_joints(seen, moving)
    keel = foot.keel.posterior_mass + foot.keel.joints * foot.keel.segment_mass
    mass = cast(float, o.mass)
    segments = person_segments(o.sex, o.age, mass, o.height, {}, ("", ""))
    person = Person(mass, segments, o.residual)
    if o.prosthesis_mass is not None:
        if o.prosthesis_mass <= keel:
            what = f"{o.prosthesis_mass:g} kg are less than the keel alone, {keel:.2f} kg"
            raise InputError("", "`prosthesis_mass`", what, "give that of socket, pylon and foot")
        person = Person(mass, segments, o.residual, o.prosthesis_mass - keel)
    return Stood(seen, moving, joints, person, foot, fulcrum)


FREE, HELD = "amputee.osim", "amputee_ik.osim"
NOTE = (
    "Made by geocontact prosthesis scale. Springs of socket and keel are those of one fulcrum; the spheres of both "
    "soles have no force law here. Trunk, head and arms are one rigid body with the pelvis (masses and moments of "
    "inertia: {segments}), upright as while standing, arms hanging: they lean and turn with the pelvis alone, "
    "so that moments on pelvis and hips leave out what a trunk does by itself."
)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisScaleResult(Result):
    """A person with a prosthesis, made to measure.

    Parameters
    ----------
    amputee
        Both legs, as of a right prosthesis.
    model
        Of the person's own side, every coordinate free but two of each knee.
    held
        The same with socket and keel held, for what markers tell.
    pose
        While standing [rad, m].
    moved
        In the functional trial, and how far its markers are from the model [m]; None without such a trial.
    """

    options: ProsthesisScaleOptions
    amputee: Amputee
    model: Multibody
    held: Multibody
    pose: Poses
    moved: Poses | None
    joints: tuple[JointFound, ...]
    numbers: Mapping[str, Number]

    @property
    def masses(self) -> dict[str, float]:
        """Mass of each segment [kg]."""
        return {body.name: body.mass for body in self.model.bodies}

    @property
    def joint_centres(self) -> dict[str, Float[np.ndarray, " 3"]]:
        """Centre of each joint in the laboratory while standing [m]."""
        return {each.name: each.place for each in self.joints}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`segments`, `joints`, `numbers`, and `markers` of the functional trial where there is one."""
        rows = [(b.name, b.mass, *(1e3 * b.centre), *np.diag(b.inertia)) for b in self.model.bodies]
        axes = ("xx", "yy", "zz")
        names = ["segment", "mass [kg]", *(f"centre_{a} [mm]" for a in "xyz"), *(f"I{a} [kg m^2]" for a in axes)]
        found = [(j.name, j.how, *(1e3 * j.place), np.nan if j.rms is None else 1e3 * j.rms) for j in self.joints]
        joints = ["joint", "how", "x [mm]", "y [mm]", "z [mm]", "off itself [mm]"]
        tables = {
            "segments": pd.DataFrame(rows, columns=names),
            "joints": pd.DataFrame(found, columns=joints),
            "numbers": numbers_table(self.numbers),
        }
        if self.moved is not None:
            off = 1e3 * np.sqrt(np.nanmean(self.moved.distances**2, axis=0))
            tables["markers"] = pd.DataFrame({"marker": list(self.moved.markers), "off, rms [mm]": off})
        return tables

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The standing pose with its markers, segments, joints, numbers."""
        title = f"Model of {self.options.static.name}"
        return {REPORT: amputee_page(title, self.held, self.pose, self.tables(), self.sentences)}

    def write_files(self, folder: Path) -> None:
        """Both models for OpenSim besides."""
        end = f"_{self.options.side[0]}"
        springs = {f"{name}{end}": pair for name, pair in self.amputee.springs().items()}
        note = NOTE.format(segments=self.amputee.prosthetic.person.segments.source)
        write_osim(folder / FREE, self.model, springs=springs, balls=self._balls(), note=note)
        write_osim(folder / HELD, self.held, note=note)
        super().write_files(folder)

    def _balls(self) -> list[ContactBall]:
        """Spheres of both soles on the bodies that carry them; OpenSim has none for foam."""
        side, found = self.options.side, list[ContactBall]()
        for body, spheres in sole_spheres(self.amputee, side):
            if spheres.thickness is not None:
                continue
            for centre, radius, zone in zip(spheres.centre, spheres.radius, spheres.zone, strict=True):
                found.append(ContactBall(f"{zone}_{len(found) + 1}", body, of_side(centre, side), float(radius)))
        return found


def run(stood: Stood, o: ProsthesisScaleOptions) -> ProsthesisScaleResult:
    """The model, its joints and its standing pose."""
    below = stood.foot.record.below
    made = standing_amputee(stood.seen, stood.person, stood.foot, stood.fulcrum, below, stood.joints, o.height)
    length = residual_of(stood.seen, o.residual_length, o.residual_markers, o.side)
    if length is not None:
        made = replace(made, prosthetic=with_residual(made.prosthetic, length))
    mass = made.pelvis_body()[0]
    if not mass > 0.0:
        what = f"the legs leave {mass:.1f} kg of {made.mass:g} kg for all above them"
        raise InputError("", "`mass`", what, "check `mass` and `prosthesis_mass`")
    held = amputee_tree(made, o.side, held=True)
    pose = standing_pose(held, stood.seen, o.side)
    moved = None if stood.moving is None else model_poses(held, as_right(stood.moving, o.side))
    joints = joint_centres(held, pose, stood.joints, o.side)
    numbers = made.numbers()
    for line in doubts_of_legs(made, stood.joints, o.height, stood.seen.source):
        reserve(line)
    if stood.foot.sole.foam is not None:
        reserve(f"{FREE} has no contact under the prosthetic foot: OpenSim has spheres, and its sole is of foam")
    invented = sum(number.source == "invented" for number in numbers.values())
    reserve(f"{invented} of {len(numbers)} numbers of the segments are invented, see numbers.csv")
    functional = [joint.how == "functional" for joint in joints]
    say(
        f"both legs of {made.mass:g} kg in {len(held.bodies)} bodies with {len(held.coordinates)} coordinates, "
        f"pelvis with all above it {mass:.1f} kg, residual limb {made.prosthetic.residual_body()[0]:.2f} kg"
    )
    say(f"{sum(functional)} of {len(functional)} joint centres from the functional trial")
    if moved is not None:
        errors = MarkerErrors.of(moved)
        judge(goodness_of(errors))
        say(f"markers of the functional trial {errors.words(MOVING)}")
    note(
        "scale",
        plain(
            {
                "mass_kg": held.mass,
                "pelvis_kg": mass,
                "residual_kg": made.prosthetic.residual_body()[0],
                "density_kg_per_m3": made.intact.density,
                "joints_off_themselves_mm": {joint.name: 1e3 * joint.rms for joint in joints if joint.rms is not None},
                "functional_rms_mm": None if moved is None else 1e3 * float(np.sqrt(np.nanmean(moved.distances**2))),
            }
        ),
    )
    return ProsthesisScaleResult(
        options=o,
        amputee=made,
        model=as_standing(amputee_tree(made, o.side), pose),
        held=as_standing(held, pose),
        pose=pose,
        moved=moved,
        joints=joints,
        numbers=numbers,
    )


def goodness_of(errors: MarkerErrors) -> GoodnessOfFit:
    """Markers of the functional trial beside what is advised; no subject who stood model is `FAR` off."""
    doubts = []
    if not errors.within(MOVING):
        asked = "is the functional trial of another person, or in another unit?" if errors.rms > FAR else ""
        what = f"markers of the functional trial are {errors.words(MOVING)}"
        doubts.append(Doubt(f"{what}: {asked}" if asked else what, errors.rms > FAR, errors.rms / MOVING.rms))
    return GoodnessOfFit(tuple(doubts), ("markers of the functional trial",))


scale = Job("prosthesis scale", ProsthesisScaleOptions, read, run)
