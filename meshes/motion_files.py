"""The synthetic gait cycle as a table of poses and as an OpenSim motion with its model."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from meshes.gait import Gait


def pose_table(gait: Gait) -> str:
    """Poses of the femoral component in the insert."""
    return poses_text(gait.time, gait.translation, gait.rotation())


def poses_text(time: np.ndarray, translation: np.ndarray, rotation: Rotation) -> str:
    """CSV: time [s], position [mm] and unit quaternion (scalar first)."""
    quaternion = rotation.as_quat(canonical=True, scalar_first=True)
    rows = ["time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"]
    for t, p, q in zip(time, translation, quaternion, strict=True):
        numbers = [f"{t:.4f}", *(f"{x:.4f}" for x in p + 0.0), *(f"{x:.12f}" for x in q + 0.0)]
        rows.append(", ".join(numbers))
    return "\n".join(rows) + "\n"


def opensim_motion(gait: Gait) -> str:
    """OpenSim `.mot` with the coordinates of `opensim_model`: degrees and metres.

    The joint's child is the insert, so the translation is that of the insert in the femoral component: -R_TF^T p.
    """
    inverse = -gait.rotation().inv().apply(gait.translation) / 1000 + 0.0
    labels = ["time", *(f"knee_{n}" for n in ("flexion", "adduction", "rotation", "tx", "ty", "tz"))]
    rows = ["synthetic_gait", "version=1", f"nRows={len(gait.time)}", f"nColumns={len(labels)}", "inDegrees=yes"]
    rows += ["endheader", "\t".join(labels)]
    for t, angles, p in zip(gait.time, gait.angles, inverse, strict=True):
        rows.append("\t".join([f"{t:.4f}", *(f"{x:.6f}" for x in angles + 0.0), *(f"{x:.13f}" for x in p)]))
    return "\n".join(rows) + "\n"


AXES = (("rotation1", "flexion", "0 0 1"), ("rotation2", "adduction", "1 0 0"), ("rotation3", "rotation", "0 1 0"))
SHIFTS = (("translation1", "tx", "1 0 0"), ("translation2", "ty", "0 1 0"), ("translation3", "tz", "0 0 1"))


def transform_axis(name: str, coordinate: str, axis: str, slope: int) -> str:
    """One axis of the joint's SpatialTransform, a linear function of its coordinate."""
    return f"""            <TransformAxis name="{name}">
              <coordinates>knee_{coordinate}</coordinates>
              <axis>{axis}</axis>
              <LinearFunction name="function"><coefficients> {slope} 0</coefficients></LinearFunction>
            </TransformAxis>"""


def body(name: str, mesh: str) -> str:
    """A body with its mesh, scaled from mm to m."""
    return f"""        <Body name="{name}">
          <attached_geometry>
            <Mesh name="{name}_geometry">
              <socket_frame>..</socket_frame>
              <scale_factors>0.001 0.001 0.001</scale_factors>
              <mesh_file>{mesh}</mesh_file>
            </Mesh>
          </attached_geometry>
          <mass>0.2</mass>
          <mass_center>0 0 0</mass_center>
          <inertia>0.0001 0.0001 0.0001 0 0 0</inertia>
        </Body>"""


def coordinate(name: str, kind: str) -> str:
    """A coordinate with a range wide enough for the cycle (rad or m)."""
    reach = "-2.1 2.1" if kind == "rotational" else "-0.2 0.2"
    return f"""            <Coordinate name="knee_{name}"><range>{reach}</range></Coordinate>"""


def opensim_model(insert_file: str, femoral_file: str) -> str:
    """OpenSim 4 model: CustomJoint knee_r from the femoral component (parent) to the tibial insert (child).

    R_FT = Rz(-flexion) Rx(-adduction) Ry(-rotation), the inverse of R_TF of the gait table.
    """
    axes = [transform_axis(name, c, axis, -1) for name, c, axis in AXES]
    axes += [transform_axis(name, c, axis, 1) for name, c, axis in SHIFTS]
    coordinates = [coordinate(c, "rotational") for _, c, _ in AXES] + [coordinate(c, "shift") for _, c, _ in SHIFTS]
    lines = [
        '<?xml version="1.0" encoding="UTF-8" ?>',
        '<OpenSimDocument Version="40000">',
        '  <Model name="synthetic_knee">',
        "    <credits>Synthetic sample knee of geocontact: generated shapes, no patient, no product.</credits>",
        "    <length_units>meters</length_units>",
        "    <force_units>N</force_units>",
        "    <gravity>0 -9.80665 0</gravity>",
        "    <BodySet>",
        "      <objects>",
        body("femoral_component", femoral_file),
        body("tibial_insert", insert_file),
        "      </objects>",
        "    </BodySet>",
        "    <JointSet>",
        "      <objects>",
        '        <WeldJoint name="ground_femoral_component">',
        "          <socket_parent_frame>/ground</socket_parent_frame>",
        "          <socket_child_frame>/bodyset/femoral_component</socket_child_frame>",
        "        </WeldJoint>",
        '        <CustomJoint name="knee_r">',
        "          <socket_parent_frame>/bodyset/femoral_component</socket_parent_frame>",
        "          <socket_child_frame>/bodyset/tibial_insert</socket_child_frame>",
        "          <coordinates>",
        *coordinates,
        "          </coordinates>",
        "          <SpatialTransform>",
        *axes,
        "          </SpatialTransform>",
        "        </CustomJoint>",
        "      </objects>",
        "    </JointSet>",
        "  </Model>",
        "</OpenSimDocument>",
    ]
    return "\n".join(lines) + "\n"
