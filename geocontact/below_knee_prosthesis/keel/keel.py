"""The keel in pieces: rigid segments on hinges whose stiffness stands for the beam's, as a function of the fulcrum.

The study of the variable-stiffness foot prints 16 segments, the first of 66 mm and 15 more of 11.64 mm, for 229 mm in
all. That is 240.6 mm; 229 mm are reached with 14 more. It also prints eight revolute joints that alternate with welds,
which 15 segments (14 joints) do not have either. Taken here: 229 mm in all, 66 mm to the first of eight joints, the
rest in even parts of 20.4 mm.

A hinge cannot stand where the fulcrum happens to be. So the beam's turn per moment, spread over the overhang with
density 1/EI and gathered at the fulcrum for the part behind it, is shared among the hinges by linear interpolation,
which keeps its sum and its mean place (but for what lies in front of the last hinge), and then scaled by one factor so
that the tip gives exactly what the beam's does. Hinges behind the fulcrum get next to nothing: what the beam bows there
is left out (`beam.deflected` tells how much).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.keel.beam import Support, root_compliance, tip_compliance

HELD = 0.064
"""Over the joints' number squared: least turn per moment of a hinge over that of the beam's piece it stands for.

Instead of 0, behind the fulcrum; a thousandth at eight joints.
"""


@dataclass(frozen=True)
class Keel:
    """A keel along x from its posterior end, in its own frame K: x forward, y up, z to the right.

    Parameters
    ----------
    length
        L [m].
    posterior
        From the end to the first joint [m], which is rigid.
    joints
        How many.
    bending, torsional
        EI and GJ [N m²].
    retardation
        Damping over stiffness of the material, strain rates [s]: sigma = E (eps + retardation eps').
    width, thickness, density
        Of the keel [m, kg/m³].
    support
        How the posterior end is held.
    range
        Lowest and highest fulcrum [m].
    hysteresis
        Friction at any rate, a share of the elastic moment [-]; the loss factor is 2/pi of it.
    friction
        Friction at any rate and any bend: the curvature that it holds [1/m].
    presliding
        Curvature over which both turn [1/m].

    ValueError for a length, stiffness or mass that is not positive, or a range that is not on the keel.
    """

    length: float
    posterior: float
    joints: int
    bending: float
    torsional: float
    retardation: float
    width: float
    thickness: float
    density: float
    support: Support
    range: tuple[float, float]
    hysteresis: float = 0.0
    friction: float = 0.0
    presliding: float = 0.05

    def __post_init__(self) -> None:
        positive = (self.posterior, self.bending, self.torsional, self.width, self.thickness, self.density, self.joints)
        if not (np.isfinite(positive).all() and min(positive) > 0.0 and 0.0 <= self.retardation < np.inf):
            raise ValueError("a keel needs positive lengths, stiffnesses and density, and no negative damping")
        if not (0.0 <= self.hysteresis < 1.0 and 0.0 <= self.friction < np.inf and 0.0 < self.presliding < np.inf):
            raise ValueError(
                "a keel's hysteresis is a share from 0 to below 1, and friction builds up over a curvature"
            )
        if not self.posterior < self.length or not 0.0 < self.range[0] < self.range[1] < self.length:
            raise ValueError(f"first joint and fulcrums must be on the keel of {self.length:g} m")

    @property
    def places(self) -> Float[np.ndarray, " n"]:
        """x of the joints [m]."""
        return self.posterior + self.pitch * np.arange(self.joints)

    @property
    def pitch(self) -> float:
        """Length of a segment in front of the first joint [m]."""
        return (self.length - self.posterior) / self.joints

    @property
    def segment_mass(self) -> float:
        """Of such a segment [kg]."""
        return self.density * self.width * self.thickness * self.pitch

    @property
    def posterior_mass(self) -> float:
        """Of the part behind the first joint [kg]."""
        return self.density * self.width * self.thickness * self.posterior

    def compliance(self, fulcrum: float) -> Float[np.ndarray, " n"]:
        """Turn of each joint per moment [rad/(N m)]. Continuous in the fulcrum, with kinks where it passes a joint.

        ValueError for a fulcrum out of range.
        """
        self.require_range(fulcrum)
        at = self.places
        ends = np.unique(np.concatenate([at[at > fulcrum], [fulcrum, self.length]]))
        hats = np.stack([np.interp(ends, at, unit) for unit in np.eye(self.joints)])
        spread = 0.5 * (hats[:, 1:] + hats[:, :-1]) @ np.diff(ends) / self.bending
        root = root_compliance(fulcrum, self.bending, self.support)
        gathered = np.array([np.interp(fulcrum, at, unit) for unit in np.eye(self.joints)])
        found = np.maximum(spread + root * gathered, HELD / self.joints**2 * self.pitch / self.bending)
        arms = (self.length - at) ** 2
        return np.asarray(found * tip_compliance(fulcrum, self.length, self.bending, self.support) / (found @ arms))

    def stiffness(self, fulcrum: float) -> Float[np.ndarray, " n"]:
        """Of each joint [N m/rad]."""
        return 1.0 / self.compliance(fulcrum)

    def damping(self, fulcrum: float) -> Float[np.ndarray, " n"]:
        """Of each joint [N m s/rad]."""
        return self.retardation * self.stiffness(fulcrum)

    @property
    def rubs(self) -> bool:
        """Whether it has friction of either kind."""
        return self.hysteresis > 0.0 or self.friction > 0.0

    def reach(self, fulcrum: float) -> Float[np.ndarray, " n"]:
        """Turn of each joint over which its friction builds up [rad]."""
        return self.presliding * self.bending * self.compliance(fulcrum)

    def torsion(self, fulcrum: float) -> tuple[float, float]:
        """Stiffness [N m/rad] and damping [N m s/rad] of one hinge about the keel's long axis, at the first joint.

        GJ/(L - l): right for a couple on the tip (Saint-Venant), too soft for one nearer by. The part behind the
        fulcrum is taken as held, and that a clamp keeps the section from warping is left out.
        """
        self.require_range(fulcrum)
        stiffness = self.torsional / (self.length - fulcrum)
        return stiffness, self.retardation * stiffness

    def segment_of(self, x: Float[np.ndarray, " m"]) -> list[int]:
        """Segment that carries a place along the undeformed keel: 0 behind the first joint, then 1 to n."""
        return [int(each) for each in np.searchsorted(self.places, x, side="right")]

    def require_range(self, fulcrum: float) -> None:
        """ValueError for a fulcrum out of range."""
        low, high = self.range
        if not low <= fulcrum <= high:
            raise ValueError(f"fulcrum {fulcrum:g} m is out of its range, {low:g} to {high:g} m")


def torsional_stiffness(modulus: float, width: float, thickness: float) -> float:
    """GJ of a rectangle [N m²], J = w t³/3 (1 - 0.63 t/w) (Timoshenko & Goodier, Theory of Elasticity, art. 109).

    Good to 1 % where the width is twice the thickness or more; ValueError where it is less.
    """
    if width < 2.0 * thickness:
        raise ValueError(f"a section of {width:g} by {thickness:g} m is not flat enough")
    return modulus * width * thickness**3 / 3.0 * (1.0 - 0.63 * thickness / width)
