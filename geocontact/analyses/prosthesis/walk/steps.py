"""Files of a walk of both legs, the person in them, and the motion by angles or by torques."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, listener, reserve
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.analyses.person import person_segments
from geocontact.analyses.prosthesis.foot_file import foot_of, fulcrum_at
from geocontact.analyses.prosthesis.recorded_files import LaboratoryFiles, foot_with_law, offset_of_law, residual_of
from geocontact.analyses.prosthesis.walk.options import ProsthesisWalkOptions
from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.recorded_steps import (
    PlayedBack,
    RecordedSteps,
    played_back,
    recorded_steps,
    single_support,
)
from geocontact.below_knee_prosthesis.both_sides.standing import NO_JOINTS, standing_amputee, standing_joints
from geocontact.below_knee_prosthesis.both_sides.standing_model import doubts_of_legs
from geocontact.below_knee_prosthesis.both_sides.walk import (
    WholeMotion,
    accelerations_by_angles,
    driven_stepper,
    driving_forces,
    walk_by_angles,
    walk_by_forces,
)
from geocontact.below_knee_prosthesis.evaluation import PlateStance, longest_stance
from geocontact.below_knee_prosthesis.leg import Person
from geocontact.below_knee_prosthesis.plate_checks import require_covering
from geocontact.below_knee_prosthesis.recorded_walk import AFTER, BEFORE, INSIDE, with_residual
from geocontact.data.errors import InputError
from geocontact.dynamics.recorded_inputs import recorded_inputs
from geocontact.io.mocap.force_plates import plate_named
from geocontact.trial_checks.recorded import TrialInputs
from geocontact.trial_checks.table import MOVED_CHECKS

EVERY, TOLERANCE = 1e-3, 1e-6
"""s between samples of the motion, and the error that a step may have."""


@dataclass(frozen=True, eq=False)
class RecordedPerson:
    """A person with both legs and a recorded walk, as of a right prosthesis.

    Parameters
    ----------
    other, plate
        Under the intact and under the prosthetic foot.
    """

    amputee: Amputee
    steps: RecordedSteps
    other: PlateStance
    plate: PlateStance

    @property
    def span(self) -> tuple[float, float]:
        """From before the stance of the prosthesis to after it, as far as the markers go [s]."""
        time = self.steps.given.time
        seen = longest_stance(self.plate.time, self.plate.force[:, 1])
        if seen is None:  # `read` requires one
            raise ValueError("the plate under the prosthesis carries no stance")
        start, stop = max(float(time[INSIDE]), seen[0] - BEFORE), min(float(time[-1 - INSIDE]), seen[1] + AFTER)
        return start, stop


@dataclass(frozen=True, eq=False)
class MovedLegs:
    """A walk by angles, the forces along its coordinates, and the walk that these make.

    Parameters
    ----------
    forces
        Along each coordinate [N m, N].
    again, beside
        By torques over single support, and its differences; None where that was not asked for.
    """

    walk: WholeMotion
    forces: Float[np.ndarray, "t n"]
    again: WholeMotion | None
    beside: PlayedBack | None


def read(o: ProsthesisWalkOptions) -> RecordedPerson:
    """Everything the options name."""
    with listener().preparing():
        foot = foot_of(o.foot)
        fulcrum = fulcrum_at(foot, o.setting, o.fulcrum)
        foot = foot_with_law(foot, o.law)
    lab = LaboratoryFiles(o.side, o.axes, o.markers_map, o.c3d_unit)
    still, walking = lab.markers("`static`", o.static), lab.markers("markers", o.markers, o.time)
    functional = None if o.functional is None else lab.markers("`functional`", o.functional)
    plates = lab.plates(o.plates)
    add_input("`plates`", o.plates, plates=len(plates))
    own = lab.plate_under_foot(o.plates, o.plate, o.mass)
    other = plate_named(plates, o.other_plate, o.plates, "`other_plate`")
    lab.check(still, walking, o.mass, o.plates, own, other, height=o.height, age=o.age)
    if functional is not None:
        check_trial(TrialInputs(functional, still), only=MOVED_CHECKS)
    standing, seen = lab.right(still), lab.right(walking)
    joints = NO_JOINTS if functional is None else standing_joints(standing, lab.right(functional))
    segments = person_segments(o.sex, o.age, o.mass, o.height, {}, ("", ""))
    person = Person(o.mass, segments, o.residual)
    made = standing_amputee(standing, person, foot, fulcrum, foot.record.below, joints, o.height)
    length = residual_of(standing, o.residual_length, o.residual_markers, o.side)
    leg = made.prosthetic if length is None else with_residual(made.prosthetic, length)
    made = replace(made, prosthetic=leg.with_foot(offset_of_law(o.law, o.static)))
    for line in doubts_of_legs(made, joints, o.height, standing.source):
        reserve(line)
    beside, plate = lab.stance(other, o.plates), lab.stance(own, o.plates)
    span = longest_stance(plate.time, plate.force[:, 1])
    if span is None or not (seen.time[0] < span[0] and span[1] < seen.time[-1]):
        what = f"the markers, {seen.time[0]:.2f} to {seen.time[-1]:.2f} s, do not cover a whole stance on {own.name}"
        raise InputError(o.markers, "`plate`", what, "markers must begin before touch-down and end after it")
    cutoff = None if o.cutoff == 0.0 else o.cutoff
    steps = recorded_steps(made, seen, beside, cutoff=cutoff, gap_limit=o.gap_limit)
    if o.intact == "plate":
        require_covering(beside, steps.given.time, "both need one clock; cut with `time`")
    return RecordedPerson(made, steps, beside, plate)


def moved_legs(person: RecordedPerson, o: ProsthesisWalkOptions) -> MovedLegs:
    """The walk by angles, its forces, and what these make; InputError where a motion cannot go on."""
    try:
        with listener().stages("walking"):
            return _moved(person, o)
    except ArithmeticError as error:
        remedy = "check `mass`, `side`, `axes`, floor and the names of the markers"
        raise InputError(o.markers, "", str(error), remedy) from error


def _moved(person: RecordedPerson, o: ProsthesisWalkOptions) -> MovedLegs:
    made, given, spheres = person.amputee, person.steps.given, o.intact == "spheres"
    if spheres:
        given = replace(given, ground=np.zeros_like(given.ground))
    start, stop = person.span
    time = start + EVERY * np.arange(int((stop - start) / EVERY) + 1)
    walk = walk_by_angles(
        made, given, time, intact_on_spheres=spheres, tolerance=TOLERANCE, machine_code=o.machine_code
    )
    ground = recorded_inputs(given.time, given.ground).at(walk.time)
    fast = accelerations_by_angles(made, given, walk, intact_on_spheres=spheres)
    forces = driving_forces(made, walk, fast, ground, intact_on_spheres=spheres)
    if o.by == "angles":
        return MovedLegs(walk, forces, None, None)
    alone = single_support(person.plate, person.other)
    if alone is None:
        what = "the prosthetic foot is never loaded alone: no single support to walk by torques"
        raise InputError(o.plates, "`by`", what, "check `other_plate`, or leave `by` out")
    part = walk.part(*alone)
    on = (walk.time >= part.time[0] - 1e-9) & (walk.time <= part.time[-1] + 1e-9)
    stepper = driven_stepper(made, intact_on_spheres=spheres, machine_code=o.machine_code)
    again = walk_by_forces(
        made, stepper, part, part.time, ground[on], forces[on], intact_on_spheres=spheres, tolerance=TOLERANCE
    )
    return MovedLegs(walk, forces, again, played_back(part, again, made.mass))
