"""OpenSim's ScapulothoracicJoint: the scapula glides on an ellipsoid, and wings about an axis in its plane.

Seth et al. (2016), A biomechanical model of the scapulothoracic joint, PLoS ONE 11(1):e0141028; OpenSim 4.6,
ScapulothoracicJoint.cpp; Simbody 3.8, RigidBodyNodeSpec_Ellipsoid.h. Two joints with a body without mass between: three
body-fixed turns x, y, z whose frame's origin is the turned z, a point of the unit sphere, times the radii; then a pin.
The ellipsoid's normal there is not the turned z, but for a sphere.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.multibody.joint import JointModel, TransformAxis
from geocontact.data.multibody.joint_function import Affine, SineProduct

TAG = "ScapulothoracicJoint"
QUARTER = RigidTransform.from_rotation(Rotation.from_rotvec([0.0, 0.0, 0.5 * np.pi]))
"""The ellipsoid's frame stands a quarter turn about z from the joint's: abduction and elevation are positive so."""
_STILL, _ITSELF = Affine(np.zeros(0), 0.0), Affine(np.ones(1), 0.0)
_COSINE = 0.5 * np.pi


def between(name: str) -> str:
    """Name of the body without mass."""
    return f"{name}_on_ellipsoid"


def scapulothoracic(
    joint: JointModel, radii: Float[np.ndarray, " 3"], origin: Float[np.ndarray, " 2"], direction: float
) -> tuple[JointModel, JointModel]:
    """Both joints.

    Parameters
    ----------
    joint
        Bodies, offsets and the four coordinates abduction, elevation, upward rotation, winging; its axes do not matter.
    radii
        Of the ellipsoid along x, y, z of the joint's frame on the thorax [m].
    origin
        Of the winging axis in the scapula's plane, x and y of the gliding frame [m].
    direction
        Of that axis, from y towards -x [rad].
    """
    first, second, third, fourth = joint.coordinates
    semi = np.array([radii[1], radii[0], radii[2]])  # of the frame a quarter turn away
    about = np.array([-np.sin(direction), np.cos(direction), 0.0])
    axis = RigidTransform.from_translation([*origin, 0.0])
    middle = between(joint.name)
    return (
        replace(
            joint,
            child=middle,
            coordinates=(first, second, third),
            axes=_glide((first.name, second.name, third.name), semi),
            parent_offset=joint.parent_offset * QUARTER,
            child_offset=QUARTER,
        ),
        replace(
            joint,
            name=f"{joint.name}_winging",
            parent=middle,
            coordinates=(fourth,),
            axes=_pin(fourth.name, about),
            parent_offset=axis,
            child_offset=joint.child_offset * axis,
        ),
    )


def _glide(names: tuple[str, str, str], semi: Float[np.ndarray, " 3"]) -> tuple[TransformAxis, ...]:
    """Turns about x, y, z, and the shift by the turned z times `semi`."""
    turns = (TransformAxis(each, (name,), _ITSELF) for each, name in zip(np.eye(3), names, strict=True))
    x, y, z = np.eye(3)
    return (
        *turns,
        TransformAxis(x, names[1:2], SineProduct(float(semi[0]), (0.0,))),
        TransformAxis(y, names[:2], SineProduct(-float(semi[1]), (0.0, _COSINE))),
        TransformAxis(z, names[:2], SineProduct(float(semi[2]), (_COSINE, _COSINE))),
    )


def _pin(name: str, about: Float[np.ndarray, " 3"]) -> tuple[TransformAxis, ...]:
    still = [TransformAxis(each, (), _STILL) for each in (*np.eye(3), *np.eye(3))]
    return (TransformAxis(about, (name,), _ITSELF), *still[1:])
