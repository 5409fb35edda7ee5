"""A synthetic walk of both legs: the invented course of the prosthetic stance, and the intact leg beside it."""

from __future__ import annotations

import numpy as np

from geocontact.below_knee_prosthesis.both_sides.amputee import Amputee
from geocontact.below_knee_prosthesis.both_sides.walk import FREE, GivenWalk, moving_tree, walk_by_angles
from geocontact.below_knee_prosthesis.leg_tree import PELVIS, RECORDED
from meshes.gait_course import course
from meshes.intact_walk import ANGLES, intact_walk


def amputee_walk(truth: Amputee, stance: float) -> tuple[GivenWalk, tuple[float, float]]:
    """Coordinates and the ground's load on the intact foot, and the times [s] between which they are meant to be used.

    Parameters
    ----------
    stance
        How long the prosthetic one lasts [s], from 0 on.
    """
    driven = course(truth.prosthetic, truth.foot, truth.fulcrum, stance)
    motion, push = driven.motion, driven.push
    model = moving_tree(truth)
    names = tuple(c.name for c in model.coordinates)
    values = np.zeros((len(motion.time), len(names)))
    for name in RECORDED:
        values[:, names.index(name if name in PELVIS else f"{name}_r")] = motion.of(name)
    walked = intact_walk(truth.intact, model.poses(values)["pelvis"], motion.time, stance)
    values[:, [names.index(name) for name in ANGLES]] = walked.angles
    force = push.at(motion.time)
    ground = np.hstack([force, np.cross(walked.centre, force)])
    return GivenWalk(motion.time, names, values, ground), driven.span


SHARED = 3.0
"""Spheres that the load of the intact foot is thought to be on, for how deep it sinks."""


def amputee_walk_on_spheres(truth: Amputee, stance: float, *, machine_code: bool = True) -> GivenWalk:
    """The same with nothing given under the intact foot: it is placed so deep that its spheres carry about that load.

    The pelvis is first moved by the given load, and the intact leg then placed against where that brought it.
    """
    given, _ = amputee_walk(truth, stance)
    inside = slice(2, -2)
    time = given.time[inside]
    moved = walk_by_angles(truth, given, time, machine_code=machine_code)
    values = given.values[inside].copy()
    for name in FREE:
        values[:, given.names.index(name)] = moved.of(name)
    model = moving_tree(truth)
    sunk = given.ground[inside, 1] / (SHARED * float(truth.intact.laws()[0].stiffness[0]))
    walked = intact_walk(truth.intact, model.poses(values)["pelvis"], time, stance, sunk)
    values[:, [given.names.index(name) for name in ANGLES]] = walked.angles
    return GivenWalk(time, given.names, values, np.zeros((len(time), 6)))
