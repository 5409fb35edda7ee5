"""A person with both legs: what each segment weighs, such that all of them together weigh what the person does."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from scipy.spatial.transform import Rotation

from geocontact.below_knee_prosthesis.both_sides.intact_leg import IntactLeg
from geocontact.below_knee_prosthesis.both_sides.upper_body import share_of_body, turned, upper_body
from geocontact.below_knee_prosthesis.foot_numbers import foot_numbers, socket_numbers
from geocontact.below_knee_prosthesis.keel.on_tree import joint_numbers
from geocontact.below_knee_prosthesis.keel.vsf_foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.model.leg import Inertial, Leg
from geocontact.contact.bushing import SOCKET, Bushing
from geocontact.data.sourced_number import Number


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
        Of the prosthesis.
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
        """Of the person with the prosthesis [kg]."""
        return self.prosthetic.person.mass

    def pelvis_body(self) -> Inertial:
        """Of the pelvis with trunk, head and arms, in its frame: one rigid body that stands upright (`upper_body`).

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
        body = upper_body(self.prosthetic.person.sex, self.mass - below, self.stature)
        return turned(body, self.upright, 0.5 * (self.prosthetic.hip + self.intact.hip))

    def springs(self) -> dict[str, tuple[float, float]]:
        """Stiffness and damping along coordinates of socket and keel, without the side's ending [N m/rad, N/m]."""
        names = [f"socket_{kind}{axis}" for kind in "rt" for axis in "xyz"]
        found = dict(zip(names, zip(self.bushing.stiffness, self.bushing.damping, strict=True), strict=True))
        stiffness, damping = joint_numbers(self.foot.keel, self.fulcrum)
        for k, pair in enumerate(zip(stiffness, damping, strict=True)):
            found[f"keel_{k + 1}"] = (float(pair[0]), float(pair[1]))
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
        above = share_of_body(self.prosthetic.person.sex) * self.mass
        rest = f"what the legs leave, trunk, head and arms included; de Leva has {above:.1f} kg of those"
        own["stature"] = Number(self.stature, "derived", "given, or from thigh and shank: 0.491 of it")
        own["pelvis mass"] = Number(mass, "derived", rest)
        stands = "de Leva 1996; upright, arms hanging; heights after Drillis & Contini 1966"
        for k, axis in enumerate("xyz"):
            own[f"pelvis centre_{axis}"] = Number(float(centre[k]), "derived", stands)
        for k, l in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)):
            own[f"pelvis I{'xyz'[k]}{'xyz'[l]}"] = Number(float(inertia[k, l]), "derived", stands)
        return own
