"""A model as its mirror image at the plane z = 0 of every frame; its names stay."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.from_markers.sides import MIRROR
from geocontact.data.multibody.joint import JointModel, TransformAxis
from geocontact.data.multibody.model import GROUND, Body, Multibody

PLANE = np.diag(MIRROR)


def mirrored(model: Multibody) -> Multibody:
    """Every coordinate means the same in the image, but for those of joints on the ground.

    Those keep their axes, which are the laboratory's: their turns about x and y and their shift along z change sign.
    """
    bodies = tuple(Body(b.name, b.mass, b.centre * MIRROR, _turned(b.inertia)) for b in model.bodies)
    markers = tuple(replace(m, location=m.location * MIRROR) for m in model.markers)
    gravity = model.gravity * MIRROR
    return replace(model, bodies=bodies, joints=tuple(map(_joint, model.joints)), markers=markers, gravity=gravity)


def _joint(joint: JointModel) -> JointModel:
    joint = replace(joint, parent_offset=_pose(joint.parent_offset), child_offset=_pose(joint.child_offset))
    if joint.parent == GROUND:
        return joint
    axes = tuple(
        TransformAxis(axis.direction * MIRROR * (-1.0 if k < 3 else 1.0), axis.coordinates, axis.function)
        for k, axis in enumerate(joint.axes)
    )
    return replace(joint, axes=axes)


def _pose(pose: RigidTransform) -> RigidTransform:
    turn = Rotation.from_matrix(_turned(pose.rotation.as_matrix()))
    return RigidTransform.from_components(pose.translation * MIRROR, turn)


def _turned(matrix: Float[np.ndarray, "3 3"]) -> Float[np.ndarray, "3 3"]:
    return np.asarray(PLANE @ matrix @ PLANE)
