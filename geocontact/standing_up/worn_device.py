"""Bodies and friction of an exoskeleton that is worn: the shipped ones, or those that its own motion identified.

The motors of an exoskeleton whose foot plate stands on the ground see its bodies in sums. A part that hangs at the end
of another one acts on the hinges below as a point mass there (Khalil & Dombre (2002), Modeling, identification and
control of robots, ch. 9.4): with masses m, first moments along the part s = m c_y, inertias I about the hinges and
lengths L

    s₁ + L₁ (m₂ + m₃),  I₁ + L₁² (m₂ + m₃),  s₂ + L₂ m₃,  I₂ + L₂² m₃

and all first moments across, s₃ and I₃ are what acts; masses alone do not. So masses are taken from a scale, and the
rest follows from these sums: the motors' torques are those of the fit whatever the masses are. Weights show first
moments sharply and slow motions inertias badly, so that a part may come out with no inertia about its mass centre;
then it is raised to that of a body with a least radius of gyration, as far as that is within the fit's own error.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from geocontact.data.parameter import Number, Source

SHIFT, HEIGHT = 0.01, 0.25
"""Height of the shipped exoskeleton's knee over the person's, and of its module [m]; invented."""
NONE = (None, None, None)
PARTS = ("exo_shank", "exo_thigh", "exo_module")
"""Bodies from the foot upwards; the hinges exo_ankle, exo_knee and exo_hip turn them."""
TURNED_BY = ("ankle", "knee", "hip")
FRICTION_NAMES = {
    f"{hinge}_{key}": f"exo_{hinge} {kind} friction"
    for hinge in TURNED_BY
    for key, kind in (("viscous", "viscous"), ("coulomb", "Coulomb"))
}
"""Dynamic parameters of friction by the names of a description."""
TURNS = float(np.radians(1.0))
"""Rate at which Coulomb friction is at three quarters of its size [rad/s]: tanh instead of a step."""
GYRATION = 0.1
"""Least radius of gyration, in parts of the length; invented."""
RAISED = 0.2
"""Part of the inertia that acts at a hinge, by which that of a part may be raised; invented."""
Table = Float[np.ndarray, "t 3"]


@dataclass(frozen=True)
class DevicePart:
    """A body of both sides.

    Parameters
    ----------
    mass
        Mass [kg].
    along, across
        Mass centre above its hinge and ahead of it [m].
    inertia
        About z through the mass centre [kg m^2].
    """

    mass: float
    along: float
    across: float
    inertia: float


@dataclass(frozen=True)
class DeviceMasses:
    """Masses of both sides [kg]; the shipped ones are invented."""

    foot_plate: float = 2.0
    shank: float = 3.0
    thigh: float = 4.0
    module: float = 5.0

    @property
    def parts(self) -> tuple[float, float, float]:
        """Masses of `PARTS`."""
        return self.shank, self.thigh, self.module


@dataclass(frozen=True)
class WornDevice:
    """An exoskeleton.

    Parameters
    ----------
    masses
        Masses of its bodies.
    parts
        Bodies in the order of `PARTS` as they were identified.
    viscous, coulomb
        Friction of its hinges, both sides [N m s/rad], [N m].
    raised
        By which the inertia of each part was raised to be that of a body [kg m^2].
    knee_above
        Height of its knee over the person's, where its lengths follow from the person's [m].
    lengths
        Its own lengths of shank and thigh [m]; None for what is set to the person.
    module_height
        Height of the module [m].
    along, across, inertias
        Mass centres above and ahead of the hinge [m], inertias about z through them [kg m^2], in the order of `PARTS`;
        None for those of a uniform rod. Identified parts count before them.
    stated
        Numbers of its description by name, with their sources, that are not the shipped ones.
    """

    masses: DeviceMasses = DeviceMasses()
    parts: tuple[DevicePart, ...] = ()
    viscous: tuple[float, ...] = (0.0, 0.0, 0.0)
    coulomb: tuple[float, ...] = (0.0, 0.0, 0.0)
    raised: tuple[float, ...] = (0.0, 0.0, 0.0)
    knee_above: float = SHIFT
    lengths: tuple[float | None, float | None] = (None, None)
    module_height: float = HEIGHT
    along: tuple[float | None, ...] = NONE
    across: tuple[float | None, ...] = NONE
    inertias: tuple[float | None, ...] = NONE
    stated: Mapping[str, Number] = field(default_factory=dict, hash=False, compare=False)

    @property
    def identified(self) -> bool:
        """Whether its dynamics are those of its own motion."""
        return bool(self.parts)

    @property
    def without_friction(self) -> tuple[str, ...]:
        """Hinges of whose friction nothing is known, which turn without any."""
        known = [
            self.identified
            or viscous != 0.0
            or coulomb != 0.0
            or not {f"{n}_viscous", f"{n}_coulomb"}.isdisjoint(self.stated)
            for n, viscous, coulomb in zip(TURNED_BY, self.viscous, self.coulomb, strict=True)
        ]
        return tuple(f"exo_{name}" for name, there in zip(TURNED_BY, known, strict=True) if not there)

    def bodies(self, lengths: tuple[float, float, float]) -> tuple[DevicePart, ...]:
        """Bodies of these lengths [m]."""
        if self.parts:
            return self.parts
        rods = zip(self.masses.parts, lengths, self.along, self.across, self.inertias, strict=True)
        return tuple(
            DevicePart(
                mass,
                0.5 * length if along is None else along,
                0.0 if across is None else across,
                mass * length**2 / 12.0 if inertia is None else inertia,
            )
            for mass, length, along, across, inertia in rods
        )

    def set_to(self, shank: float, thigh: float) -> tuple[float, float, float]:
        """Lengths of `PARTS` on a person whose shank and thigh have these lengths [m]."""
        own, other = self.lengths
        below = shank + self.knee_above if own is None else own
        if other is not None:
            return below, other, self.module_height
        return below, thigh - self.knee_above if own is None else shank + thigh - below, self.module_height

    def above(self, shank: float, thigh: float) -> tuple[float, float]:
        """Heights of its knee and hip over those of a person whose shank and thigh have these lengths [m]."""
        own, other = self.lengths
        knee = self.knee_above if own is None else own - shank
        return knee, 0.0 if other is None else knee + other - thigh

    def friction(self, rates: Table) -> Table:
        """Friction of each hinge, against its rate [N m]."""
        return np.asarray(np.array(self.viscous) * rates + np.array(self.coulomb) * np.tanh(rates / TURNS))


SHIPPED_DEVICE = WornDevice()
BUILT: Source = "invented"
SHIPPED_NUMBERS: Mapping[str, Number] = {
    **{f"{name}_mass": Number(mass, BUILT, "both sides") for name, mass in vars(DeviceMasses()).items()},
    "knee_above": Number(SHIFT, BUILT, "height of its knee over the person's; shank and thigh are set to the person"),
    "module_height": Number(HEIGHT, BUILT, "a uniform rod, as shank and thigh are"),
    "strap_damping": Number(10.0, "paper", "Serrancoli et al. (2019), held there; of one strap"),
    "strap_turning_damping": Number(0.1, "paper", "Serrancoli et al. (2019), held there; of one strap"),
    **{
        f"{hinge}_{kind}": Number(0.0, BUILT, "the study gives torques of its hinges, friction included")
        for kind in ("viscous", "coulomb")
        for hinge in TURNED_BY
    },
}
"""Numbers of the shipped exoskeleton; the study of Serrancoli et al. (2019) prints the straps' dashpots alone."""


def device_of(numbers: Mapping[str, Number]) -> WornDevice:
    """The shipped exoskeleton with these numbers in place of its own."""
    at = {name: each.value for name, each in {**SHIPPED_NUMBERS, **numbers}.items()}
    parts = ("shank", "thigh", "module")
    return WornDevice(
        DeviceMasses(**{name: at[f"{name}_mass"] for name in vars(DeviceMasses())}),
        viscous=tuple(at[f"{hinge}_viscous"] for hinge in TURNED_BY),
        coulomb=tuple(at[f"{hinge}_coulomb"] for hinge in TURNED_BY),
        knee_above=at["knee_above"],
        lengths=(at.get("shank_length"), at.get("thigh_length")),
        module_height=at["module_height"],
        along=tuple(at.get(f"{part}_centre") for part in parts),
        across=tuple(at.get(f"{part}_ahead") for part in parts),
        inertias=tuple(at.get(f"{part}_inertia") for part in parts),
        stated={name: each for name, each in numbers.items() if each != SHIPPED_NUMBERS.get(name)},
    )


def identified_device(
    values: Mapping[str, float],
    lengths: tuple[float, float, float],
    masses: DeviceMasses,
    described: WornDevice = SHIPPED_DEVICE,
) -> WornDevice:
    """The exoskeleton of these masses, else as described, whose motors need what a motion without a person showed.

    ValueError where the masses leave a part no inertia, and much less than the least.

    Parameters
    ----------
    values
        Dynamic parameters by the names of `ExoskeletonDynamics`, in SI.
    lengths
        Lengths of the parts that they were found with [m].
    described
        Exoskeleton that has the lengths and sources; friction that it states counts before the identified one.
    """

    def of(kind: str) -> Float[np.ndarray, " 3"]:
        return np.array([values[f"{part} {kind}"] for part in PARTS])

    told, taken = of("mass"), np.array(masses.parts)
    # masses above a part, which hang at its end
    above = np.array([told[1:].sum(), told[2], 0.0]) - np.array([taken[1:].sum(), taken[2], 0.0])
    length = np.array(lengths)
    along = (of("first moment along y") + length * above) / taken
    across = of("first moment along x") / taken
    about = of("inertia") + length**2 * above
    acting = about + length**2 * [taken[1:].sum(), taken[2], 0.0]
    inertia = about - taken * (along**2 + across**2)
    raised = np.maximum(taken * (GYRATION * length) ** 2 - inertia, 0.0)
    for part, own, more, whole in zip(PARTS, inertia, raised, acting, strict=True):
        if more > RAISED * whole:
            raise ValueError(f"{part} has no inertia left about its mass centre ({own:.3g} kg m²)")
    parts = zip(taken, along, across, inertia + raised, strict=True)
    rubbing = {
        name: described.stated[name].value if name in described.stated else values[parameter]
        for name, parameter in FRICTION_NAMES.items()
    }
    viscous, coulomb = (tuple(rubbing[f"{hinge}_{kind}"] for hinge in TURNED_BY) for kind in ("viscous", "coulomb"))
    made = tuple(DevicePart(*(float(each) for each in row)) for row in parts)
    more = tuple(float(each) for each in raised)
    return replace(described, masses=masses, parts=made, viscous=viscous, coulomb=coulomb, raised=more)
