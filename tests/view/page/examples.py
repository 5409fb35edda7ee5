"""Pages made in milliseconds: a ball over a plate, and curves alone."""

from __future__ import annotations

import hashlib

import numpy as np
from scipy.spatial.transform import RigidTransform

from geocontact.view.page.content import (
    Curve,
    Curves,
    Length,
    Page,
    Plan,
    Readout,
    Row,
    Scene,
    SceneBody,
    Strip,
    Table,
    Track,
    Words,
)

DIRECTIONS = {
    "anterior (+x)": (1.0, 0.0, 0.0),
    "medial (−z)": (0.0, 0.0, -1.0),
    "superior (+y)": (0.0, 1.0, 0.0),
    "inferior (−y)": (0.0, -1.0, 0.0),
}
CONTEXT = Words(
    "What this is",
    [
        "Question: how large is the area of the insert within 4 mm of the femoral component over one gait cycle?",
        "Context of use: comparison of designs and motions in research. Not a clinical device.",
        "Numerical error: bounds of every area are certified for the triangulated surfaces and shaded in the curves.",
    ],
)


def plate(n: int = 24, half: float = 0.03) -> tuple[np.ndarray, np.ndarray]:
    """A flat square in y = 0 [m]: vertices and faces."""
    x, z = np.meshgrid(np.linspace(-half, half, n), np.linspace(-half, half, n), indexing="ij")
    vertices = np.column_stack([x.ravel(), np.zeros(n * n), z.ravel()])
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.vstack(
        [
            np.column_stack([corner, corner + 1, corner + n]),
            np.column_stack([corner + 1, corner + n + 1, corner + n]),
        ]
    )
    return vertices, faces


def ball(radius: float = 0.02, n: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """A sphere of latitudes and longitudes about the origin [m]: vertices and faces."""
    theta, phi = np.linspace(0.05, np.pi - 0.05, n), np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    t, p = (angles.ravel() for angles in np.meshgrid(theta, phi, indexing="ij"))
    vertices = radius * np.column_stack([np.sin(t) * np.cos(p), np.cos(t), np.sin(t) * np.sin(p)])
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n - 1), np.arange(n), indexing="ij"))
    a, b, c, d = i * n + j, i * n + (j + 1) % n, (i + 1) * n + j, (i + 1) * n + (j + 1) % n
    return vertices, np.vstack([np.column_stack([a, b, c]), np.column_stack([b, d, c])])


def small_page(frames: int = 9, name: str = "ball") -> Page:
    """A ball that dips into a plate and rolls along; distances and areas in closed form."""
    time = np.linspace(0.0, 1.0, frames) if frames > 1 else np.zeros(1)
    radius, part = 0.02, np.linspace(0.0, 1.0, frames)
    height = radius + 1e-3 - 2e-3 * np.sin(np.pi * part)
    centres = np.column_stack([0.02 * part - 0.01, height, np.zeros(frames)])
    plate_vertices, plate_faces = plate()
    ball_vertices, ball_faces = ball(radius)
    on_plate = np.array([np.linalg.norm(plate_vertices - centre, axis=1) - radius for centre in centres])
    on_plate[on_plate > 6e-3] = np.inf
    on_ball = np.array([ball_vertices[:, 1] + centre[1] for centre in centres])
    thresholds = np.array([0.5, 1.0, 2.0, 3.0, 4.0])
    area = np.pi * np.clip((radius + thresholds * 1e-3) ** 2 - height[:, None] ** 2, 0.0, None) * 1e6
    gappy = area[:, 2].copy()
    way = Track("middle", 1e3 * centres[:, [2, 0]])
    gappy[frames // 3 : frames // 3 + 1] = np.nan
    return Page(
        title=f"Area of plate near {name}",
        subtitle="closed forms; made for tests",
        time=time,
        time_label="time [s]",
        headline=[f"Up to {area[:, -1].max():.0f} mm² of the plate lie within 4 mm of {name}."],
        facts=[("largest area", f"{area[:, -1].max():.1f} mm²"), ("frame", str(int(area[:, -1].argmax()) + 1))],
        start_frame=int(area[:, -1].argmax()),
        sections=[
            Scene(
                [
                    SceneBody("plate", plate_vertices, plate_faces, distance=on_plate),
                    SceneBody(name, ball_vertices, ball_faces, RigidTransform.from_translation(centres), on_ball),
                ],
                thresholds=[1e-3, 4e-3],
                span=(-1e-3, 6e-3),
                value_name="signed distance",
                directions=DIRECTIONS,
            ),
            Readout(
                [
                    Row("area within 4 mm", "mm²", [f"{a:.6f}" for a in area[:, -1]]),
                    Row("smallest distance", "mm", [f"{(h - radius) * 1e3:.9f}" for h in height]),
                ]
            ),
            Curves(
                "Area of the plate",
                "mm²",
                [
                    Curve("within 4 mm", area[:, -1], area[:, -1] * 0.97, area[:, -1] * 1.03),
                    Curve("within 2 mm", gappy),
                ],
            ),
            Strip("Area against threshold", thresholds, area, "mm²", 4.0),
            Table("Inputs", ["file", "sha256"], [["ball.stl", hashlib.sha256(b"ball").hexdigest()]]),
            CONTEXT,
            Plan(
                "Path of the middle",
                "mm",
                "z",
                "x",
                [1e3 * plate_vertices[[0, 23, -1, -24, 0]][:, [2, 0]]],
                [way],
                lengths=[Length("d", "10 mm (95 % 9 … 11)", (0.0, 0.0), (6.0, 8.0))],
            ),
        ],
    )


def curves_page(frames: int = 1000) -> Page:
    """No scene: a force with a gap, and numbers."""
    cycle = np.linspace(0.0, 100.0, frames) if frames > 1 else np.zeros(1)
    force = np.arange(float(frames))
    return Page(
        "Curves alone",
        "for systems without bodies",
        cycle,
        "cycle [%]",
        sections=[
            Readout([Row("force", "N", [f"{value:.3f}" for value in force])]),
            Curves("Force", "N", [Curve("force", force), Curve("nowhere", np.full(frames, np.nan))]),
            CONTEXT,
        ],
    )
