"""Numbers of the contact forces of an OpenSim model, sphere by sphere, and the half-space that the spheres press on.

Two surfaces act together as in Simbody's `HuntCrossleyForce` (Sherman, Seth & Delp 2011, Procedia IUTAM 2, 241-261):
with K and L as the 2/3 powers of the moduli of sphere and ground and s = L / (K + L), the modulus is (K s)^1.5, the
dissipation c_sphere s + c_ground (1 - s), each coefficient of friction the harmonic mean 2ab / (a + b); the force acts
at s times the depth above the sphere's lowest point. `SmoothSphereHalfSpaceForce` has one modulus for both: s = 1/2.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike, fspath
from posixpath import basename
from xml.etree.ElementTree import Element

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.errors import InputError
from geocontact.data.multibody.model import GROUND
from geocontact.io.opensim.osim_contact import HUNT_CROSSLEY, SMOOTH, fixed_to
from geocontact.io.opensim.osim_xml import Frames, is_true, label, numbers_of, offset, read_model, socket_of, text_of
from geocontact.io.text.tables import listed

Numbers = dict[str, float]
OUTWARDS = (-1.0, 0.0, 0.0)
"""Normal of a `ContactHalfSpace` in its own frame."""
FRICTION = ("static", "dynamic", "viscous")
SMOOTHING = {"hertz_smoothing": 300.0, "hunt_crossley_smoothing": 50.0, "constant_contact_force": 1e-5}
"""Numbers of the smooth force and OpenSim's defaults."""
TRANSITION = 0.01
"""m/s; OpenSim's default."""


@dataclass(frozen=True)
class ContactForces:
    """Contact forces of n spheres on one half-space.

    Parameters
    ----------
    smooth
        `SmoothSphereHalfSpaceForce`; else `HuntCrossleyForce`.
    numbers
        By name, one for each sphere: modulus [Pa], dissipation [s/m], transition [m/s], static, dynamic [-],
        viscous [s/m], share [-], and those of `SMOOTHING`.
    half_space
        Its name; "" where the spheres' forces name several, or none that is fixed to the ground.
    point, normal
        Of its plane in the ground [m, -].
    """

    smooth: Bool[np.ndarray, " n"]
    numbers: dict[str, Float[np.ndarray, " n"]]
    half_space: str
    point: Float[np.ndarray, " 3"]
    normal: Float[np.ndarray, " 3"]


def read_contact_forces(path: str | PathLike[str], spheres: Sequence[str]) -> ContactForces | None:
    """Forces of the spheres by their names; None where one of them has none.

    Forces that are switched off are none. InputError for a sphere with two, and for numbers that no force can have.
    """
    file = fspath(path)
    model = read_model(path)
    balls = {e.get("name", "") for e in model.findall("ContactGeometrySet/objects/ContactSphere")}
    found: dict[str, tuple[bool, Numbers, str]] = {}
    for kind, read in ((SMOOTH, _smooth), (HUNT_CROSSLEY, _hunt_crossley)):
        for force in model.findall(f"ForceSet/objects/{kind}"):
            if _switched_off(file, force):
                continue
            for name, numbers, ground in read(file, force, balls):
                if name in found and name in spheres:
                    raise InputError(file, label(force), f"sphere {name} has a force already", "keep one of them")
                found[name] = kind == SMOOTH, numbers, ground
    if not set(spheres) <= set(found):
        return None
    each = [found[name] for name in spheres]
    keys = each[0][1].keys()
    by_name = {key: np.array([one[key] for _, one, _ in each]) for key in keys}
    under = {ground for *_, ground in each}
    plane = _plane(file, model, under.pop()) if len(under) == 1 else None
    name, pose = plane or ("", RigidTransform.identity())
    return ContactForces(
        np.array([smooth for smooth, *_ in each]), by_name, name, pose.translation, pose.rotation.apply(OUTWARDS)
    )


def _switched_off(file: str, force: Element) -> bool:
    written = force.find("appliesForce")
    return is_true(file, force, "isDisabled") or (written is not None and not is_true(file, force, "appliesForce"))


def _smooth(file: str, force: Element, spheres: set[str]) -> list[tuple[str, Numbers, str]]:
    name = basename(socket_of(force, "sphere"))
    if name not in spheres:
        raise InputError(file, label(force), f"its sphere {name!r} is not in the model", "correct the model")
    numbers = {
        "modulus": _number(file, force, "stiffness", None, above=True) / 2.0**1.5,
        "dissipation": _number(file, force, "dissipation", 0.0),
        "transition": _number(file, force, "transition_velocity", TRANSITION, above=True),
        "share": 0.5,
    }
    numbers |= {kind: _number(file, force, f"{kind}_friction", 0.0) for kind in FRICTION}
    numbers |= {key: _number(file, force, key, default, above=True) for key, default in SMOOTHING.items()}
    return [(name, numbers, basename(socket_of(force, "half_space")))]


def _hunt_crossley(file: str, force: Element, spheres: set[str]) -> list[tuple[str, Numbers, str]]:
    sides = {
        basename(name): side
        for side in force.iter()
        if side.tag.endswith("ContactParameters")
        for name in text_of(side, "geometry").split()
    }
    balls = [name for name in sides if name in spheres]
    others = [name for name in sides if name not in spheres]
    if not balls:
        return []
    if len(others) != 1:
        what = f"presses the spheres on {listed(tuple(others)) or 'nothing'}"
        raise InputError(file, label(force), what, "give it one ground")
    transition = _number(file, force, "transition_velocity", TRANSITION, above=True)
    return [
        (name, _pair(file, sides[name], sides[others[0]]) | {"transition": transition}, others[0]) for name in balls
    ]


def _pair(file: str, sphere: Element, ground: Element) -> Numbers:
    """Numbers of both surfaces together."""
    mine, theirs = (_number(file, side, "stiffness", None, above=True) ** (2.0 / 3.0) for side in (sphere, ground))
    share = theirs / (mine + theirs)
    found = {"modulus": (mine * share) ** 1.5, "share": share, **SMOOTHING}
    own, other = (_number(file, side, "dissipation", 0.0) for side in (sphere, ground))
    found["dissipation"] = own * share + other * (1.0 - share)
    for kind in FRICTION:
        a, b = (_number(file, side, f"{kind}_friction", 0.0) for side in (sphere, ground))
        found[kind] = 2.0 * a * b / (a + b) if a + b > 0.0 else 0.0
    return found


def _number(file: str, element: Element, child: str, default: float | None, above: bool = False) -> float:
    value = float(numbers_of(file, element, child, 1, None if default is None else (default,))[0])
    if value < 0.0 or (above and value == 0.0):
        what = f"{value:g} is not above 0" if above else f"{value:g} is negative"
        raise InputError(file, f"{label(element)} <{child}>", what, "correct the model")
    return value


def _plane(file: str, model: Element, name: str) -> tuple[str, RigidTransform] | None:
    """Pose of a half-space in the ground; None where the model has none of the name that is fixed to the ground."""
    for element in model.findall("ContactGeometrySet/objects/ContactHalfSpace"):
        if element.get("name") == name:
            body, pose = fixed_to(file, Frames(file, model), element)
            own = (numbers_of(file, element, key, 3, (0.0, 0.0, 0.0)) for key in ("orientation", "location"))
            return (name, pose * offset(*own)) if body == GROUND else None
    return None
