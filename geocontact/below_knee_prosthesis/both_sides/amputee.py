"""A person with both legs: mass of each segment, all of them together the body mass, with trunk, head and arms as one
rigid body.

Masses, mass centres and radii of gyration are those of the person's segments, by default de Leva's (1996), lengths
those of his mean person over the stature. He does not say where head and shoulders are above the hips: those are shares
of the stature as well (Drillis & Contini 1966, Body segment parameters, Office of Vocational Rehabilitation, report
1166-03, as Winter 2009 prints it, fig. 4.1).
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.below_knee_prosthesis.foot_numbers import foot_numbers, socket_numbers
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.on_tree import coordinates, joint_numbers
from geocontact.below_knee_prosthesis.leg import Inertial, Leg, Vector, combined
from geocontact.contact.bushing import SOCKET, Bushing
from geocontact.data.body_segments import BodySegment, BodySegments
from geocontact.data.parameter import Number

LEGS = 0.491
"""Thigh and shank over the stature (Drillis & Contini 1966)."""
HIPS, SHOULDERS, APART = 0.530, 0.818, 0.259
"""Heights of hips and shoulders, and how far the shoulders are apart, over the stature (the same)."""
ARM = ("upper_arm", "forearm", "hand")


def upper_body(segments: BodySegments, mass: float, stature: float) -> Inertial:
    """All above the hips in a frame with its origin half-way between them, x forward, y up while standing.

    Parameters
    ----------
    segments
        Of the person.
    mass
        Of all of it together [kg]; its parts share it as the segments do.
    stature
        [m].
    """
    parts = tuple(_parts(segments, stature))
    own = sum(part[0] for part in parts)
    whole, centre, inertia = combined(parts)
    return mass / own * whole, centre, mass / own * inertia


def share_of_body(segments: BodySegments) -> float:
    """Mass of the upper body over that of the whole."""
    return float(sum(part[0] for part in _parts(segments, segments.stature)))


def turned(body: Inertial, turn: Rotation, place: Vector) -> Inertial:
    """The same in another frame: `turn` brings components into it, `place` is where the own frame's origin is [m]."""
    mass, centre, inertia = body
    matrix = turn.as_matrix()
    return mass, place + matrix @ centre, matrix @ inertia @ matrix.T


def _parts(of: BodySegments, stature: float) -> Iterator[Inertial]:
    """Parts of a body of 1 kg, all on the vertical line above the hips but the arms, which hang beside it."""
    scale = stature / of.stature
    top = (1.0 - HIPS) * stature
    trunk = scale * of["trunk"].length
    for name, start in (("trunk", trunk), ("head", top)):
        yield _hanging(of[name], scale, np.array([0.0, start, 0.0]))
    for side in (1.0, -1.0):
        start = (SHOULDERS - HIPS) * stature
        for name in ARM:
            yield _hanging(of[name], scale, np.array([0.0, start, 0.5 * side * APART * stature]))
            start -= scale * of[name].length


def _hanging(of: BodySegment, scale: float, start: Vector) -> Inertial:
    """A segment straight down from its proximal end; sagittal is x here, long y, transverse z."""
    long = scale * of.length
    sagittal, transverse, along = of.moments(of.mass, long)
    return of.mass, start - np.array([0.0, of.centre * long, 0.0]), np.diag([sagittal, along, transverse])


@dataclass(frozen=True, eq=False)
class Amputee:
    """Pelvis, a right prosthetic and a left intact leg.

    Parameters
    ----------
    prosthetic, intact
        Both legs of one person.
    stature
        Of the person [m].
    upright
        Turns components in the frame of a person who stands upright (y up, x where the pelvis points) into components
        in the pelvis' frame.
    foot, fulcrum, bushing
        Side of the prosthesis.
    """

    prosthetic: Leg
    intact: IntactLeg
    stature: float
    upright: Rotation
    foot: VariableStiffnessFoot
    fulcrum: float
    bushing: Bushing = SOCKET

    @property
    def mass(self) -> float:
        """Mass of the person with the prosthesis [kg]."""
        return self.prosthetic.person.mass

    def pelvis_body(self) -> Inertial:
        """Body of the pelvis with trunk, head and arms, in its frame: one rigid body that stands upright
        (`upper_body`).

        It has the mass that the legs leave. The study adds that mass to an even ellipsoid of the pelvis' size: for a
        man of 77 kg 0.1 to 0.2 kg m² in place of 0.9 to 3.1, with a centre that lies 0.26 m lower.
        """
        keel = self.foot.keel
        legs = (
            self.prosthetic.thigh_body(),
            self.prosthetic.residual_body(),
            self.prosthetic.prosthesis_body(),
            self.intact.thigh_body(),
            self.intact.shank_body(),
            *self.intact.foot_bodies(),
        )
        below = keel.posterior_mass + keel.joints * keel.segment_mass + sum(each[0] for each in legs)
        body = upper_body(self.prosthetic.person.segments, self.mass - below, self.stature)
        return turned(body, self.upright, 0.5 * (self.prosthetic.hip + self.intact.hip))

    def springs(self) -> dict[str, tuple[float, float]]:
        """Stiffness and damping along coordinates of socket and keel, without the side's ending [N m/rad, N/m]."""
        names = [f"socket_{kind}{axis}" for kind in "rt" for axis in "xyz"]
        found = dict(zip(names, zip(self.bushing.stiffness, self.bushing.damping, strict=True), strict=True))
        stiffness, damping = joint_numbers(self.foot.keel, self.fulcrum)
        for name, k, b in zip(coordinates(self.foot.keel), stiffness, damping, strict=True):
            found[name] = (float(k), float(b))
        return found

    def numbers(self) -> Mapping[str, Number]:
        """Every number of segments and springs in SI, and where it is from; the sole has no force law here."""
        own = {f"prosthetic {name}": number for name, number in self.prosthetic.numbers().items()}
        own["mass"] = own.pop("prosthetic mass")
        own |= {f"intact {name}": number for name, number in self.intact.numbers().items()}
        own |= socket_numbers(self.bushing)
        foot = foot_numbers(self.foot, self.fulcrum)
        own |= {name: number for name, number in foot.items() if not name.startswith("sole ")}
        mass, centre, inertia = self.pelvis_body()
        above = share_of_body(self.prosthetic.person.segments) * self.mass
        body = self.prosthetic.person.segments
        has = f"{body.source.removesuffix(' 1996')} has {above:.1f} kg of those"
        rest = f"what the legs leave, trunk, head and arms included; {has}"
        own["stature"] = Number(self.stature, "derived", "given, or from thigh and shank: 0.491 of it")
        own["pelvis mass"] = Number(mass, "derived", rest)
        stands = f"{body.shape_source}; upright, arms hanging; heights after Drillis & Contini 1966"
        for k, axis in enumerate("xyz"):
            own[f"pelvis centre_{axis}"] = Number(float(centre[k]), "derived", stands)
        for k, l in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
            own[f"pelvis I{'xyz'[k]}{'xyz'[l]}"] = Number(float(inertia[k, l]), "derived", stands)
        return own
