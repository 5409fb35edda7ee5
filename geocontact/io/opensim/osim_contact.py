"""Contact spheres and contact forces of an OpenSim model.

Stiffness after Simbody's HuntCrossleyForce (Sherman, Seth & Delp 2011, Procedia IUTAM 2, 241-261): surfaces of moduli K
and L against each other have k = (K^(2/3) L^(2/3) / (K^(2/3) + L^(2/3)))^(3/2), and a sphere of radius R presses with
4/3 k sqrt(R) d^1.5. `SmoothSphereHalfSpaceForce` has one modulus K for both.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from os import PathLike, fspath
from posixpath import basename
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.opensim.osim_writer import add_numbers, offset_frame
from geocontact.io.opensim.osim_xml import Frames, label, numbers_of, read_model, socket_of, text_of
from geocontact.io.recordings.spheres import SphereTable
from geocontact.io.text.tables import listed

Vector = Float[np.ndarray, " 3"]


def smooth_sphere_force(ball: str, stiffness: float, dissipation: float, friction: Sequence[float]) -> Element:
    """`SmoothSphereHalfSpaceForce` between a ball of the model and its floor, smoothed as OpenSim does by itself.

    Parameters
    ----------
    stiffness, dissipation
        Modulus [Pa] and Hunt-Crossley's factor [s/m].
    friction
        Transition velocity [m/s], static, dynamic and viscous coefficient.
    """
    element = Element("SmoothSphereHalfSpaceForce", {"name": f"{ball}_on_floor"})
    SubElement(element, "socket_sphere").text = f"/contactgeometryset/{ball}"
    SubElement(element, "socket_half_space").text = "/contactgeometryset/floor"
    named = ("transition_velocity", "static_friction", "dynamic_friction", "viscous_friction")
    numbers = {"stiffness": stiffness, "dissipation": dissipation} | dict(zip(named, friction, strict=True))
    for name, value in numbers.items():
        add_numbers(element, name, [value])
    return element


def bushing_force_between(
    name: str,
    ends: Sequence[tuple[str, Vector]],
    stiffness: tuple[Vector, Vector],
    damping: tuple[Vector, Vector],
) -> Element:
    """`BushingForce` between points of two bodies whose axes are those of the bodies.

    Parameters
    ----------
    ends
        Body and place in its frame [m], twice; forces are along the first one's axes.
    stiffness, damping
        In turning [N m/rad, N m s/rad] and along the axes [N/m, N s/m].
    """
    element = Element("BushingForce", {"name": name})
    frames = [f"{name}_{body}" for body, _ in ends]
    for k, frame in enumerate(frames, 1):
        SubElement(element, f"socket_frame{k}").text = frame
    held = SubElement(element, "frames")
    for frame, (body, place) in zip(frames, ends, strict=True):
        held.append(offset_frame(frame, body, RigidTransform.from_translation(place)))
    for kind, (turning, along) in (("stiffness", stiffness), ("damping", damping)):
        add_numbers(element, f"rotational_{kind}", turning)
        add_numbers(element, f"translational_{kind}", along)
    return element


def torque_along(coordinate: str) -> Element:
    """`CoordinateActuator` whose control is the torque itself [N m]."""
    element = Element("CoordinateActuator", {"name": f"{coordinate}_torque"})
    SubElement(element, "coordinate").text = coordinate
    add_numbers(element, "optimal_force", [1.0])
    return element


EXPONENT = 1.5
HUNT_CROSSLEY, SMOOTH = "HuntCrossleyForce", "SmoothSphereHalfSpaceForce"


def read_contact_spheres(path: str | PathLike[str], body: str | None, own_law: bool = False) -> SphereTable:
    """Spheres that are fixed to the body, in its frame [m], each a zone of its name.

    Without a stiffness where no force of the model has all of them. Dissipation and friction of the forces are of
    another law than that of a foot on spheres: a warning says that they are left. With `own_law` there is neither
    stiffness nor warning: `osim_contact_law` has the forces.
    InputError where the body is not named or has no contact sphere.
    """
    file = fspath(path)
    model = read_model(path)
    frames = Frames(file, model)
    found = [(e, *_place(file, frames, e)) for e in model.findall("ContactGeometrySet/objects/ContactSphere")]
    bodies = tuple(dict.fromkeys(each[1] for each in found))
    if body not in bodies:
        if not found:
            raise InputError(file, "", "holds no contact sphere", "give a table of spheres")
        what = f"no contact sphere on {body}" if body else "the foot is not named"
        raise InputError(file, "`body`", what, f"spheres are on {listed(bodies)}")
    own = [(e, place) for e, name, place in found if name == body]
    radius = np.array([_above_zero(file, e, "radius") for e, _ in own])
    names = tuple(e.get("name", "") for e, _ in own)
    moduli = {} if own_law else _moduli(file, model)
    known = [moduli.get(name) for name in names]
    stiffness = None
    if not own_law and all(each is not None for each in known):
        stiffness = 4.0 / 3.0 * np.array(known, float) * np.sqrt(radius)
        what = "dissipation and friction of its contact forces are of another law and not taken: `damping`, `friction`"
        warnings.warn(InputWarning(f"{file}: {what}"), stacklevel=3)
    exponent = None if stiffness is None else EXPONENT
    return SphereTable(np.array([place for _, place in own]), radius, names, stiffness, None, exponent)


def fixed_to(file: str, frames: Frames, geometry: Element) -> tuple[str, RigidTransform]:
    """Body that a contact geometry is fixed to (OpenSim 3: its name; OpenSim 4: a frame), and that frame's pose in it.

    The geometry's own location and orientation are in that frame.
    """
    named = socket_of(geometry, "frame") or text_of(geometry, "body_name")
    if not named:
        raise InputError(file, label(geometry), "names no frame", "correct the model")
    return frames.in_body(frames.resolve("/contactgeometryset", named))


def _place(file: str, frames: Frames, sphere: Element) -> tuple[str, Float[np.ndarray, " 3"]]:
    """Body that a sphere is fixed to, and its centre there [m]."""
    body, pose = fixed_to(file, frames, sphere)
    return body, pose.apply(numbers_of(file, sphere, "location", 3, (0.0, 0.0, 0.0)))


def _moduli(file: str, model: Element) -> dict[str, float]:
    """k of two surfaces together [Pa], by the name of the sphere."""
    found: dict[str, float] = {}
    spheres = {e.get("name", "") for e in model.findall("ContactGeometrySet/objects/ContactSphere")}
    for force in model.findall(f"ForceSet/objects/{SMOOTH}"):
        one = _above_zero(file, force, "stiffness")
        found[basename(socket_of(force, "sphere"))] = _together(one, one)
    for force in model.findall(f"ForceSet/objects/{HUNT_CROSSLEY}"):
        each = {
            basename(name): _above_zero(file, side, "stiffness")
            for side in force.iter()
            if side.tag.endswith("ContactParameters")
            for name in text_of(side, "geometry").split()
        }
        others = [value for name, value in each.items() if name not in spheres]
        for name in spheres & set(each):
            found[name] = _together(each[name], others[0] if others else each[name])
    return found


def _above_zero(file: str, element: Element, child: str) -> float:
    value = float(numbers_of(file, element, child, 1)[0])
    if value <= 0.0:
        raise InputError(file, f"{label(element)} <{child}>", f"{value:g} is not above 0", "correct the model")
    return value


def _together(one: float, other: float) -> float:
    a, b = one ** (2.0 / 3.0), other ** (2.0 / 3.0)
    return float((a * b / (a + b)) ** 1.5)
