"""The keel: rigid segments on hinges whose stiffness stands for the beam's, the beam itself, and its elastica as
truth.

The study of the variable-stiffness foot prints 16 segments, the first of 66 mm and 15 more of 11.64 mm, for 229 mm in
all. That is 240.6 mm; 229 mm are reached with 14 more. It also prints eight revolute joints that alternate with welds,
which 15 segments (14 joints) do not have either. Taken here: 229 mm in all, 66 mm to the first of eight joints, the
rest in even parts of 20.4 mm.

A hinge cannot stand where the fulcrum happens to be. So the beam's turn per moment, spread over the overhang with
density 1/EI and gathered at the fulcrum for the part behind it, is shared among the hinges by linear interpolation,
which keeps its sum and its mean place (but for what lies in front of the last hinge), and then scaled by one factor so
that the tip gives exactly what the beam's does. Hinges behind the fulcrum get next to nothing: what the beam bows there
is left out (`beam.deflected` tells how much).

Euler and Bernoulli, small deflections, here with constant EI (`sections` has it along the length). The beam of length L
is held at x = 0, may turn but not move at the fulcrum x = l, and hangs over by a = L - l. A force F at x > l bends the
part behind the fulcrum as well, which turns the beam there by M l/(3 EI) with M = F (x - l) where the end at x = 0 is
pinned, by M l/(4 EI) where it is clamped (Young & Budynas, Roark's Formulas for Stress and Strain, table 8.1). So the
tip gives

    F (a² r + a³/(3 EI)),   r = l/(3 EI) pinned, l/(4 EI) clamped

which is F a² L/(3 EI) and F a² (3 l + 4 a)/(12 EI).

EI theta'' = -F cos(theta) along the arc, theta(0) = r EI theta'(0), theta'(a) = 0: an inextensible cantilever under a
force that keeps its direction, upwards on the tip (Bisshopp & Drucker 1945, Large deflection of cantilever beams,
Q Appl Math 3, 272-275), but with the turn r M of the part behind the fulcrum, which is taken as small.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.keel.sections import ONE, Sections, Support


def root_compliance(fulcrum: float, bending: float, support: Support) -> float:
    """Turn of a beam of one section at the fulcrum per moment there, from the part behind it [rad/(N m)].

    Parameters
    ----------
    fulcrum
        l [m].
    bending
        EI [N m²].
    support
        How the posterior end is held.
    """
    return ONE.root_compliance(fulcrum, bending, support)


def tip_compliance(fulcrum: float, length: float, bending: float, support: Support) -> float:
    """Deflection of the tip per force on it [m/N]; `length` is L [m], the others as for `root_compliance`."""
    return ONE.tip_compliance(fulcrum, length, bending, support)


def deflected(
    x: Float[np.ndarray, " n"], fulcrum: float, length: float, bending: float, support: Support
) -> Float[np.ndarray, " n"]:
    """Deflection at places along the beam per force on the tip [m/N], along the force.

    Behind the fulcrum the beam bows to the other side, at most by 0.064 M l²/EI (pinned) or 0.037 M l²/EI (clamped).
    """
    overhang, moment = length - fulcrum, length - fulcrum
    s = np.clip(x, 0.0, fulcrum) / fulcrum
    bow = (s**3 - s) / 6.0 if support == "pinned" else (s**3 - s**2) / 4.0
    u = np.clip(x - fulcrum, 0.0, None)
    front = root_compliance(fulcrum, bending, support) * moment * u + u**2 * (3.0 * overhang - u) / (6.0 * bending)
    return np.where(x < fulcrum, moment * fulcrum**2 / bending * bow, front)


def compression_stiffness(fulcrum: float, length: float, bending: float, series: float, support: Support) -> float:
    """Force per travel of a plate on the tip [N/m], through what gives besides the keel: sole, pylon, fixture.

    Parameters
    ----------
    series
        Its stiffness [N/m]; infinite for the keel alone.
    """
    return 1.0 / (tip_compliance(fulcrum, length, bending, support) + 1.0 / series)


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
        EI and GJ [N m²], where the factor of `sections` is 1.
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
    sections
        Factors on EI and GJ along the keel; mass is spread evenly whatever they are.
    twists
        Whether it turns about its long axis as well, by GJ: one hinge at the first joint, before all others.

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
    sections: Sections = ONE
    twists: bool = False

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
        if self.sections.edges and not self.sections.edges[-1] < self.length:
            raise ValueError(f"sections must end on the keel of {self.length:g} m")

    @property
    def places(self) -> Float[np.ndarray, " n"]:
        """x of the joints [m]."""
        return self.posterior + self.pitch * np.arange(self.joints)

    @property
    def hinges(self) -> int:
        """How many coordinates it has: its joints, and the one about its long axis where it twists."""
        return self.joints + int(self.twists)

    @property
    def pitch(self) -> float:
        """Length of a segment in front of the first joint [m]."""
        return (self.length - self.posterior) / self.joints

    @property
    def segment_mass(self) -> float:
        """Mass of such a segment [kg]."""
        return self.density * self.width * self.thickness * self.pitch

    @property
    def posterior_mass(self) -> float:
        """Mass of the part behind the first joint [kg]."""
        return self.density * self.width * self.thickness * self.posterior

    def compliance(self, fulcrum: float) -> Float[np.ndarray, " n"]:
        """Turn of each joint per moment [rad/(N m)]. Continuous in the fulcrum, with kinks where it passes a joint.

        ValueError for a fulcrum out of range.
        """
        self.require_range(fulcrum)
        at = self.places
        ends = np.unique(np.concatenate([at[at > fulcrum], self.sections.pieces(fulcrum, self.length)]))
        hats = np.stack([np.interp(ends, at, unit) for unit in np.eye(self.joints)])
        weights = np.diff(ends) / self.sections.at(0.5 * (ends[1:] + ends[:-1]))
        spread = 0.5 * (hats[:, 1:] + hats[:, :-1]) @ weights / self.bending
        root = self.sections.root_compliance(fulcrum, self.bending, self.support)
        gathered = np.array([np.interp(fulcrum, at, unit) for unit in np.eye(self.joints)])
        found = np.maximum(spread + root * gathered, HELD / self.joints**2 * self.pitch / self.bending_at_joints)
        arms = (self.length - at) ** 2
        return np.asarray(found * self.tip_compliance(fulcrum) / (found @ arms))

    def tip_compliance(self, fulcrum: float) -> float:
        """Deflection of the tip per force on it, as the beam has it [m/N]."""
        return self.sections.tip_compliance(fulcrum, self.length, self.bending, self.support)

    @property
    def bending_at_joints(self) -> Float[np.ndarray, " n"]:
        """EI at the joints [N m²]."""
        return self.bending * self.sections.at(self.places)

    def stiffness(self, fulcrum: float) -> Float[np.ndarray, " n"]:
        """Stiffness of each joint [N m/rad]."""
        return 1.0 / self.compliance(fulcrum)

    def damping(self, fulcrum: float) -> Float[np.ndarray, " n"]:
        """Damping of each joint [N m s/rad]."""
        return self.retardation * self.stiffness(fulcrum)

    @property
    def rubs(self) -> bool:
        """Whether it has friction of either kind."""
        return self.hysteresis > 0.0 or self.friction > 0.0

    def reach(self, fulcrum: float) -> Float[np.ndarray, " n"]:
        """Turn of each joint over which its friction builds up [rad]."""
        return np.asarray(self.presliding * self.bending_at_joints * self.compliance(fulcrum))

    def torsion(self, fulcrum: float) -> tuple[float, float]:
        """Stiffness [N m/rad] and damping [N m s/rad] of one hinge about the keel's long axis, at the first joint.

        GJ/(L - l) where there is one section: right for a couple on the tip (Saint-Venant), too soft for one nearer by.
        The part behind the fulcrum is taken as held, and that a clamp keeps the section from warping is left out.
        """
        self.require_range(fulcrum)
        stiffness = self.torsional / self.sections.torsional_length(fulcrum, self.length)
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


POINTS, LEAST = 201, 1e-10
"""Points of the shape, and the relative error allowed."""


@dataclass(frozen=True)
class BentKeel:
    """Shape of the overhang.

    Parameters
    ----------
    arc
        Length along the keel from the fulcrum [m].
    turn
        Angle there [rad].
    x, y
        Place in the keel's frame [m].
    """

    arc: Float[np.ndarray, " n"]
    turn: Float[np.ndarray, " n"]
    x: Float[np.ndarray, " n"]
    y: Float[np.ndarray, " n"]


def elastica(keel: Keel, fulcrum: float, force: float) -> BentKeel:
    """Shape of a keel of one section under an upward force on the tip [N]; ArithmeticError where none is found.

    ValueError for several sections.
    """
    from scipy.integrate import solve_bvp  # half a second to import

    if not keel.sections.uniform:
        raise ValueError("the elastica is of a keel of one section")
    overhang = keel.length - fulcrum
    load = force * overhang**2 / keel.bending
    root = root_compliance(fulcrum, keel.bending, keel.support) * keel.bending / overhang

    def slopes(_: Float[np.ndarray, " n"], v: Float[np.ndarray, "four n"]) -> Float[np.ndarray, "four n"]:
        return np.stack([v[1], -load * np.cos(v[0]), np.cos(v[0]), np.sin(v[0])])

    def ends(a: Float[np.ndarray, " four"], b: Float[np.ndarray, " four"]) -> Float[np.ndarray, " four"]:
        return np.array([a[0] - root * a[1], b[1], a[2], a[3]])

    s = np.linspace(0.0, 1.0, POINTS)
    straight = np.stack([load * (root + s - 0.5 * s**2), load * (1.0 - s), s, load * s**2 / 3.0])
    found = solve_bvp(slopes, ends, s, straight, tol=LEAST, max_nodes=100_000)
    if not found.success:
        raise ArithmeticError(f"no shape of the keel is found under {force:g} N: {found.message}")
    turn, _, x, y = found.sol(s)
    return BentKeel(s * overhang, turn, fulcrum + x * overhang, y * overhang)
