"""Parametric femoral component of a total knee (synthetic; right side; mm).

Frame F: x anterior, y superior, z right (lateral). The origin is the centre of the posterior condylar circle, midway
between the condyles. The outer surface sweeps a coronal profile along a J-shaped sagittal one, so that each condyle
is a chain of torus pieces: sagittal radius of the profile, coronal radius of the condyle. The back face consists of
the five plane cuts that bone is prepared with.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.sheets import quads_of, split_quads
from meshes.solids import thicken

ANTERIOR, DISTAL, POSTERIOR = 28.0, 34.0, 22.0
"""Sagittal radii of the three tangent-continuous arcs [mm]."""
TURNS = np.radians([4.0, -45.0, -120.0, -214.0])
"""Direction of the outward normal where the arcs begin and end; 0 = anterior, -90 deg = distal [rad]."""
FLANGE = 18.0
"""Length of the straight anterior flange above the anterior arc [mm]."""
CORONAL_MEDIAL, CORONAL_LATERAL = 24.5, 23.0
"""Coronal radii of the condyles [mm]."""
CUTS = ((4.0, 7.5), (-45.0, 9.5), (-90.0, 9.0), (-135.0, 8.0), (-180.0, 8.5))
"""Back-face planes: direction of the outward normal [deg] and thickness below the profile there [mm]."""
NOTCH, ARCH = 9.5, 5.0
"""Half width of the intercondylar notch and height of its rounded roof [mm]."""


@dataclass(frozen=True)
class Grid:
    """Cells across one condyle, across the notch, along the flange, along a condyle, and through the thickness."""

    condyle: int = 8
    notch: int = 6
    flange: int = 16
    leg: int = 22
    wall: int = 2

    def refined(self, factor: float) -> Grid:
        """The same layout with `factor` times as many cells in each direction."""
        return Grid(*(max(1, round(factor * n)) for n in (self.condyle, self.notch, self.flange, self.leg, self.wall)))


def smooth_step(x: np.ndarray) -> np.ndarray:
    """0 below 0, 1 above 1, 3x^2 - 2x^3 between."""
    x = np.clip(x, 0.0, 1.0)
    return x * x * (3 - 2 * x)


def arc_ends() -> np.ndarray:
    """Arc length from the flange tip to the ends of the pieces: flange, anterior, distal, posterior arc [mm]."""
    lengths = [FLANGE, *(np.array([ANTERIOR, DISTAL, POSTERIOR]) * -np.diff(TURNS))]
    return np.cumsum(lengths)


def sagittal_profile(s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points and outward unit normals (n, 2) of the J curve at arc length `s` from the flange tip [mm]."""
    ends = arc_ends()
    posterior_centre = np.zeros(2)
    distal_centre = posterior_centre + (POSTERIOR - DISTAL) * direction(TURNS[2])
    anterior_centre = distal_centre + (DISTAL - ANTERIOR) * direction(TURNS[1])
    turn = TURNS[0] - np.clip(s - ends[0], 0, None) / ANTERIOR
    turn = np.where(s > ends[1], TURNS[1] - (s - ends[1]) / DISTAL, turn)
    turn = np.where(s > ends[2], TURNS[2] - (s - ends[2]) / POSTERIOR, turn)
    normal = direction(turn)
    on_arc = [
        c + r * normal for c, r in ((anterior_centre, ANTERIOR), (distal_centre, DISTAL), (posterior_centre, POSTERIOR))
    ]
    point = np.where((s > ends[2])[:, None], on_arc[2], np.where((s > ends[1])[:, None], on_arc[1], on_arc[0]))
    up = np.array([-np.sin(TURNS[0]), np.cos(TURNS[0])])
    return point + np.clip(ends[0] - s, 0, None)[:, None] * up, normal


def direction(angle: float | np.ndarray) -> np.ndarray:
    """Unit vector(s) at `angle` [rad] from x towards y."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def anterior_fraction(s: np.ndarray) -> np.ndarray:
    """0 on the condyles, rising smoothly to 1 at the flange tip."""
    return smooth_step(1 - s / (arc_ends()[1] + 6.0))


def half_width(s: np.ndarray, lateral: np.ndarray) -> np.ndarray:
    """Distance of the outer border from the sagittal midplane [mm]; the flange is wider laterally."""
    return 36.0 - np.where(lateral, 12.0, 16.0) * anterior_fraction(s)


def coronal_drop(s: np.ndarray, z: np.ndarray) -> np.ndarray:
    """How far the outer surface lies below the profile at lateral position z [mm].

    A circular arc on each condyle; between them a parabola of matching slope, the trochlear groove.
    """
    centre = 23.0 - 10.0 * anterior_fraction(s)
    inner = 0.55 * centre
    radius = CORONAL_MEDIAL + (CORONAL_LATERAL - CORONAL_MEDIAL) * smooth_step(0.5 + z / (2 * inner))
    off = np.maximum(np.abs(z), inner) - centre
    arc = radius - np.sqrt(radius**2 - off**2)
    slope = (centre - inner) / np.sqrt(radius**2 - (centre - inner) ** 2)
    groove = np.where(np.abs(z) < inner, slope * (inner**2 - z**2) / (2 * inner), 0.0)
    # Towards the posterior tips the component gets thin: flatten the arc so that a wall remains.
    return (arc + groove) * (1 - 0.4 * smooth_step((s - arc_ends()[3] + 16.0) / 14.0))


def back_depth(point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Depth below the profile, along its normal, at which the bone cuts are met [mm]."""
    depth = np.zeros(len(point))
    for angle, thickness in CUTS:
        across = direction(np.radians(angle))
        support = np.max(sagittal_profile(np.linspace(0, arc_ends()[3], 4001))[0] @ across)
        facing = normal @ across
        meets = facing > 0.05
        depth = np.where(
            meets, np.maximum(depth, (point @ across - support + thickness) / np.where(meets, facing, 1)), depth
        )
    return depth


def on_body(sz: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Outer and back-face points (n, 3) [mm] of unfolded positions (arc length, z)."""
    s, z = sz.T
    point, normal = sagittal_profile(s)
    outer = point - coronal_drop(s, z)[:, None] * normal
    inner = point - back_depth(point, normal)[:, None] * normal
    return np.column_stack([outer, z]), np.column_stack([inner, z])


def unfolded_layout(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Positions (arc length, z) [mm] and quads of the trouser-shaped development: flange above, two legs below."""
    across = 2 * grid.condyle + grid.notch
    index = np.arange((grid.flange + 1) * (across + 1)).reshape(grid.flange + 1, across + 1)
    positions = [flange_rows(grid).reshape(-1, 2)]
    quads = [quads_of(index)]
    for side, columns in ((-1, slice(0, grid.condyle + 1)), (1, slice(across - grid.condyle, None))):
        start = sum(len(p) for p in positions)
        fresh = start + np.arange(grid.leg * (grid.condyle + 1)).reshape(grid.leg, -1)
        positions.append(leg_rows(grid, side)[1:].reshape(-1, 2))
        quads.append(quads_of(np.vstack([index[-1:, columns], fresh])))
    return np.vstack(positions), np.vstack(quads)


def notch_start() -> float:
    """Arc length where the notch has its full width [mm]: where the profile faces 62 deg below anterior."""
    return float(arc_ends()[1] + DISTAL * np.radians(62.0 - 45.0))


def flange_rows(grid: Grid) -> np.ndarray:
    """Positions (row, column, 2) from the flange tip to the roof of the notch."""
    down = np.linspace(0, 1, grid.flange + 1)[:, None]
    s = down * notch_start() * np.ones((1, 2 * grid.condyle + grid.notch + 1))
    middle = np.linspace(-1, 1, grid.notch + 1)
    lateral = np.linspace(0, 1, grid.condyle + 1)
    width = {side: half_width(s[:, :1], np.array(side > 0)) for side in (-1, 1)}
    inner = {side: NOTCH / 36.0 * width[side] for side in (-1, 1)}
    z = np.hstack(
        [
            -inner[-1] - (width[-1] - inner[-1]) * lateral[::-1],
            np.where(middle < 0, inner[-1], inner[1])[:, 1:-1] * middle[1:-1],
            inner[1] + (width[1] - inner[1]) * lateral,
        ]
    )
    # The tip of the flange is rounded, the roof of the notch an arch; both fade over the rows between.
    tip = 7.0 * (z / np.where(z > 0, width[1], width[-1])) ** 2
    roof = -ARCH * np.clip(1 - (z / NOTCH) ** 2, 0, None) * down**2
    return np.stack([s + (1 - down) ** 2 * tip + roof, z], axis=-1)


def leg_rows(grid: Grid, side: int) -> np.ndarray:
    """Positions (row, column, 2) of one condyle (side -1 medial, +1 lateral), columns from left to right."""
    down = np.linspace(0, 1, grid.leg + 1)[:, None]
    over = np.linspace(0, 1, grid.condyle + 1)
    s = notch_start() + down * (arc_ends()[3] - notch_start()) * np.ones_like(over)
    width = half_width(s, np.array(side > 0))
    z = side * (NOTCH + (width - NOTCH) * over)
    s = s - down**4 * 3.5 * (2 * over - 1) ** 2
    rows = np.stack([s, z], axis=-1)
    return rows if side > 0 else rows[:, ::-1]


def femoral_component(grid: Grid) -> tuple[np.ndarray, np.ndarray]:
    """Vertices [mm, frame F] and faces of the closed right femoral component."""
    layout, quads = unfolded_layout(grid)
    outer, inner = on_body(layout)
    return thicken(outer, inner, split_quads(outer, quads), grid.wall)
