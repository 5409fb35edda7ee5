"""The motion of a walk by coordinates of a model, in place of markers, compared with these where both are given."""

from __future__ import annotations

from dataclasses import dataclass
from os import fspath
from pathlib import Path
from typing import cast

import numpy as np

from geocontact.analyses.frame.collector import add_input, reserve, say
from geocontact.analyses.motion.marker_tasks import MOVING, STANDING
from geocontact.analyses.prosthesis.ranges import PERSON
from geocontact.analyses.prosthesis.recorded_files import LaboratoryFiles
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.below_knee_prosthesis.from_model import (
    SCALED,
    ModelLeg,
    marker_distances,
    model_leg,
    model_markers,
    with_toe,
)
from geocontact.below_knee_prosthesis.recorded_walk import FAR
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import read_table

SAME_MASS = 5e-3
"""Relative difference of two masses of one person that rounding leaves."""


@dataclass(frozen=True, eq=False)
class ModelMotion:
    """A model of the person, and its markers along the coordinates, of the person's own side."""

    model: Multibody
    file: str
    seen: MarkerTrajectories

    def leg(self, standing: MarkerTrajectories, o: ProsthesisSimulateOptions) -> ModelLeg:
        """Joints of the leg in the standing trial; InputError for one that the model was not made of."""
        leg = model_leg(self.model, standing, o.side, self.file)
        off = f"markers of pelvis and thigh while standing are {1e3 * leg.off:.1f} mm (RMS) from those of `model`"
        if leg.off > FAR:
            raise InputError(standing.source, "`static`", off, "give the trial that `model` was scaled to")
        if leg.off > STANDING.rms:
            reserve(f"{off}: was it scaled to another standing trial?")
        return leg


def moved_model(o: ProsthesisSimulateOptions) -> ModelMotion:
    """The model with its markers along the coordinates, between the times that are asked for."""
    file, motion = cast(Path, o.model), cast(Path, o.coordinates)
    model, table = read_multibody(file), read_table(motion)
    add_input("`model`", file, bodies=len(model.bodies), coordinates=len(model.coordinates))
    add_input("`coordinates`", motion, frames=len(table.time))
    if table.time_unit != "s":
        raise InputError(motion, "", "time is in per cent of a cycle", "give coordinates over seconds, as `ik` does")
    seen = model_markers(model, table.time, motion_of(table, model), o.side, fspath(file))
    part = seen if o.time is None else seen.between(*o.time)
    if not len(part):
        what = f"no frame between {o.time[0]:g} and {o.time[1]:g} s" if o.time else "has no frame"
        raise InputError(motion, "`time`", what, f"the motion is from {table.time[0]:g} to {table.time[-1]:g} s")
    return ModelMotion(model, fspath(file), MarkerTrajectories(part.time, part.positions, part.names, fspath(motion)))


def mass_of(o: ProsthesisSimulateOptions, of: ModelMotion | None) -> float:
    """Mass of the person [kg]: as stated, else that of the model; a reservation where both differ."""
    if of is None:
        return cast(float, o.mass)
    mass = of.model.mass
    if o.mass is None:
        if PERSON.refusal(mass) is not None:
            raise InputError(of.file, "`model`", f"its bodies weigh {mass:g} kg: no walking person", SCALED)
        return mass
    if abs(o.mass / mass - 1.0) > SAME_MASS:
        reserve(f"`mass` is {o.mass:g} kg, `model` weighs {mass:.4g} kg: the first counts; scale with the same mass")
    return o.mass


def compared_markers(
    o: ProsthesisSimulateOptions, lab: LaboratoryFiles, of: ModelMotion, standing: MarkerTrajectories
) -> MarkerTrajectories:
    """Recorded markers, else those of the model with the tip of the keel: what plates are checked against.

    How far recorded ones are from the model is said; InputError where they are of another walk or clock. `standing` is
    of the person's own side.
    """
    if o.markers is None:
        return with_toe(of.seen, standing, o.side)
    recorded = lab.markers("markers", o.markers, o.time)
    known = {name: off for name, off in marker_distances(of.seen, recorded).items() if np.isfinite(off).any()}
    if not known:
        what = "has no marker of the model at the times of `coordinates`"
        raise InputError(recorded.source, "", what, "give the trial that `ik` was given, or leave it out")
    rms = float(np.sqrt(np.nanmean(np.concatenate(list(known.values())) ** 2)))
    worst = max(known, key=lambda name: float(np.nanmean(known[name])))
    words = f"recorded markers are {1e3 * rms:.1f} mm (RMS) from the model along `coordinates`, most of all {worst}"
    if rms > FAR:
        raise InputError(recorded.source, "", words, "are both of one trial, one clock and one set of axes?")
    if rms > MOVING.rms:
        reserve(words)
    else:
        say(words)
    return recorded
