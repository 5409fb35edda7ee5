"""Forces of an OpenSim model: smooth spheres on the floor, bushings, torques along coordinates."""

from __future__ import annotations

from collections.abc import Sequence
from xml.etree.ElementTree import Element, SubElement

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.io.opensim.osim_writer import add_numbers, offset_frame

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
