"""Trunk, head and hanging arms of a person who stands upright, as one rigid body.

Masses, mass centres and radii of gyration are de Leva's (1996), lengths those of his mean person over the stature. He
does not say where head and shoulders are above the hips: those are shares of the stature as well (Drillis & Contini
1966, Body segment parameters, Office of Vocational Rehabilitation, report 1166-03, as Winter 2009 prints it, fig. 4.1).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.model.leg import Inertial, Vector, combined
from geocontact.data.body_segments import SEGMENTS, STATURE, Sex

LEGS = 0.491
"""Thigh and shank over the stature (Drillis & Contini 1966)."""
HIPS, SHOULDERS, APART = 0.530, 0.818, 0.259
"""Heights of hips and shoulders, and how far the shoulders are apart, over the stature (the same)."""
ARM = ("upper_arm", "forearm", "hand")


def upper_body(sex: Sex, mass: float, stature: float) -> Inertial:
    """All above the hips in a frame with its origin half-way between them, x forward, y up while standing.

    Parameters
    ----------
    mass
        Of all of it together [kg]; its parts share it as de Leva's do.
    stature
        [m].
    """
    parts = tuple(_parts(sex, stature))
    own = sum(part[0] for part in parts)
    whole, centre, inertia = combined(parts)
    return mass / own * whole, centre, mass / own * inertia


def share_of_body(sex: Sex) -> float:
    """Mass of the upper body over that of the whole, by de Leva."""
    return float(sum(part[0] for part in _parts(sex, STATURE[sex])))


def turned(body: Inertial, turn: Rotation, place: Vector) -> Inertial:
    """The same in another frame: `turn` brings components into it, `place` is where the own frame's origin is [m]."""
    mass, centre, inertia = body
    matrix = turn.as_matrix()
    return mass, place + matrix @ centre, matrix @ inertia @ matrix.T


def _parts(sex: Sex, stature: float) -> Iterator[Inertial]:
    """Of a body of 1 kg, all on the vertical line above the hips but the arms, which hang beside it."""
    of, scale = SEGMENTS[sex], stature / STATURE[sex]
    top = (1.0 - HIPS) * stature
    trunk = scale * of["trunk"].length
    for name, start in (("trunk", trunk), ("head", top)):
        yield _hanging(sex, name, scale, np.array([0.0, start, 0.0]))
    for side in (1.0, -1.0):
        start = (SHOULDERS - HIPS) * stature
        for name in ARM:
            yield _hanging(sex, name, scale, np.array([0.0, start, 0.5 * side * APART * stature]))
            start -= scale * of[name].length


def _hanging(sex: Sex, name: str, scale: float, start: Vector) -> Inertial:
    """A segment straight down from its proximal end; sagittal is x here, long y, transverse z."""
    of = SEGMENTS[sex][name]
    long = scale * of.length
    sagittal, transverse, along = of.moments(of.mass, long)
    return of.mass, start - np.array([0.0, of.centre * long, 0.0]), np.diag([sagittal, along, transverse])
