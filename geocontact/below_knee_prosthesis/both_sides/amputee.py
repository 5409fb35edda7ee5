"""A person with both legs: what each segment weighs, such that all of them together weigh what the person does."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.below_knee_prosthesis.keel.on_tree import joint_numbers
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.model.frustum import Frustum
from geocontact.below_knee_prosthesis.model.leg import Inertial, Leg
from geocontact.contact.bushing import SOCKET, Bushing
from geocontact.data.body_segments import SEGMENTS
from geocontact.data.sourced_number import Number


@dataclass(frozen=True, eq=False)
class Amputee:
    """Pelvis, a right prosthetic and a left intact leg.

    Parameters
    ----------
    prosthetic, intact
        Both legs of one person.
    pelvis
        Depth from the back to the front spines and distance of the front spines [m].
    foot, fulcrum, bushing
        Of the prosthesis.
    """

    prosthetic: Leg
    intact: IntactLeg
    pelvis: tuple[float, float]
    foot: VariableStiffnessFoot
    fulcrum: float
    bushing: Bushing = SOCKET

    @property
    def mass(self) -> float:
        """Of the person with the prosthesis [kg]."""
        return self.prosthetic.person.mass

    def residual_body(self) -> Inertial:
        """Of the residual limb in the shank's frame: of the intact shank's density and taper, cut off."""
        leg, whole = self.prosthetic, self.intact.shank_frustum
        own = Frustum(leg.shank, leg.knee_radius, whole.distal / whole.proximal * leg.knee_radius)
        return own.cut(leg.person.residual * leg.shank).body(self.intact.density)

    def pelvis_body(self) -> Inertial:
        """Of the pelvis with all that is above it, in its frame: an even ellipsoid.

        As wide as the front spines are apart, as deep as front and back spines, and down to the hips' centres; the
        study says width and depth. It adds the mass of head, arms and trunk to that of the pelvis, as here: moments on
        the pelvis are those of a trunk that lies in it.
        """
        keel = self.foot.keel
        legs = (
            self.prosthetic.thigh_body(),
            self.residual_body(),
            self.prosthetic.prosthesis_body(),
            self.intact.thigh_body(),
            self.intact.shank_body(),
            *self.intact.foot_bodies(),
        )
        below = keel.posterior_mass + keel.joints * keel.segment_mass + sum(each[0] for each in legs)
        mass = self.mass - below
        squares = self.radii**2
        return mass, np.array([-0.5 * self.pelvis[0], 0.0, 0.0]), 0.2 * mass * np.diag(squares.sum() - squares)

    @property
    def radii(self) -> Float[np.ndarray, " 3"]:
        """Of the ellipsoid along x, y and z [m]."""
        depth, width = self.pelvis
        down = -0.5 * (self.prosthetic.hip[1] + self.intact.hip[1])
        return np.array([0.5 * depth, float(down), 0.5 * width])

    def springs(self) -> dict[str, tuple[float, float]]:
        """Stiffness and damping along coordinates of socket and keel, without the side's ending [N m/rad, N/m]."""
        names = [f"socket_{kind}{axis}" for kind in "rt" for axis in "xyz"]
        found = dict(zip(names, zip(self.bushing.stiffness, self.bushing.damping, strict=True), strict=True))
        stiffness, damping = joint_numbers(self.foot.keel, self.fulcrum)
        for k, pair in enumerate(zip(stiffness, damping, strict=True)):
            found[f"keel_{k + 1}"] = (float(pair[0]), float(pair[1]))
        return found

    def numbers(self) -> Mapping[str, Number]:
        """Every number of the segments in SI, and where it is from."""
        own = {f"prosthetic {name}": number for name, number in self.prosthetic.numbers().items()}
        own.pop("prosthetic ankle_over_knee_radius")  # the intact shank tells it here
        own["mass"] = own.pop("prosthetic mass")
        note = "frustum cut off, density and taper of the intact shank"
        own["prosthetic residual_mass"] = Number(self.residual_body()[0], "derived", note)
        own |= {f"intact {name}": number for name, number in self.intact.numbers().items()}
        mass = self.pelvis_body()[0]
        trunk = SEGMENTS[self.prosthetic.person.sex]
        above = trunk["head"].mass + trunk["trunk"].mass
        above += 2.0 * sum(trunk[name].mass for name in ("upper_arm", "forearm", "hand"))
        rest = f"what the legs leave, trunk, head and arms included; de Leva has {above * self.mass:.1f} kg of those"
        own["pelvis mass"] = Number(mass, "derived", rest)
        for axis, radius in zip("xyz", self.radii, strict=True):
            own[f"pelvis radius_{axis}"] = Number(float(radius), "derived", "of the ellipsoid: spines; y: hip centres")
        return own
