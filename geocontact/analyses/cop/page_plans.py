"""Drawings of a centre of pressure: its path under the foot, and the forces along it (butterfly)."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int
from scipy.spatial import ConvexHull

from geocontact.analyses.cop.foot_loads import FootLoads
from geocontact.view.page.content import Mark, Plan, Track

MM = 1e3
ROUND = np.linspace(0.0, 2.0 * np.pi, 49)
VECTORS = 60  # forces drawn at most
TALL = 0.6  # of the ground's length, how high the largest force is drawn
LEAST = 0.1  # m; a path may be shorter than the drawing
ZONES = 5  # named at most
FOOT = "Seen from above, in the foot's frame: spheres that stand for the sole, their outline, and the path."


def axis_name(axis: int, sign: float = 1.0) -> str:
    """ "x", "−z"."""
    return ("" if sign > 0.0 else "−") + "xyz"[axis]


def foot_plan(r: FootLoads, shown: Int[np.ndarray, " k"]) -> Plan:
    """Spheres, their outline and the path, seen against the ground's normal: the longer way lies across."""
    sole = r.foot.sole
    across, up, sign = _seen(r)

    def flat(points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 2"]:
        return points[:, [across, up]] * (1.0, sign) * MM

    middle, radius = flat(sole.centre), sole.radius * MM
    circles = middle[:, None] + radius[:, None, None] * np.column_stack([np.cos(ROUND), np.sin(ROUND)])
    corners = circles.reshape(-1, 2)
    edge = ConvexHull(corners).vertices
    zones = list(sole.zones.items())
    marks = [Mark(name, _edge(circles[which])) for name, which in zones] if len(zones) <= ZONES else []
    tracks = [Track("centre of pressure", flat(_in_foot(r, r.centre.centre))[shown])]
    if r.plate is not None:
        there = np.full_like(r.centre.centre, np.nan)
        there[r.plate.frames] = r.plate.centre
        tracks.append(Track("force plate", flat(_in_foot(r, there))[shown]))
    outline = corners[[*edge, edge[0]]]
    return Plan(
        "Path under the foot",
        "mm",
        axis_name(across),
        axis_name(up, sign),
        [outline, *circles],
        tracks,
        marks,
        words=FOOT,
    )


def butterfly(r: FootLoads, shown: Int[np.ndarray, " k"]) -> Plan | None:
    """Forces on the foot, each from its centre of pressure, seen across the way that the centre takes (Pedotti).

    None where there is no centre of pressure.
    """
    c = r.centre
    found = np.isfinite(c.centre[:, 0])
    if not found.any():
        return None
    normal = _mean(c.normal[found])
    upward = int(np.argmax(np.abs(normal)))
    along = _along(c.centre[found], upward)
    plane = [along, upward]
    start, force = c.centre[:, plane] * MM, c.wrench.force[:, plane]
    sizes = np.linalg.norm(force, axis=1)
    most = float(sizes[found].max())
    scale = _round_scale(TALL * max(float(np.ptp(start[found][:, 0])), LEAST * MM) / most)  # mm for 1 N
    tip = start + scale * force
    some = np.flatnonzero(found)
    some = some[np.unique(np.linspace(0, len(some) - 1, VECTORS).astype(int))]
    words = f"Each line is the force in one frame, from its centre of pressure: 100 N are {100.0 * scale:g} mm long."
    return Plan(
        "Forces along the path (butterfly diagram)",
        "mm",
        axis_name(along),
        axis_name(upward),
        [np.array([start[k], tip[k]]) for k in some],
        [
            Track("centre of pressure", start[shown]),
            Track("force", np.where(found[:, None], tip, np.nan)[shown], [f"{size:.0f} N" for size in sizes[shown]]),
        ],
        words=words,
    )


def travel(r: FootLoads) -> tuple[float, str]:
    """How far the centre of pressure goes on the ground [m], and along which axis it goes the most."""
    found = np.isfinite(r.centre.centre[:, 0])
    centre = r.centre.centre[found]
    upward = int(np.argmax(np.abs(_mean(r.centre.normal[found]))))
    along = _along(centre, upward)
    return float(np.ptp(centre[:, along])), axis_name(along)


def path_length(centre: Float[np.ndarray, "t 3"]) -> float:
    """Length of the path [m], without the ways across frames that have no centre."""
    return float(np.nansum(np.linalg.norm(np.diff(centre, axis=0), axis=1)))


def _along(centre: Float[np.ndarray, "t 3"], upward: int) -> int:
    """The axis of the ground along which a path is longest."""
    reach = np.ptp(centre, axis=0)
    reach[upward] = -1.0
    return int(np.argmax(reach))


def _in_foot(r: FootLoads, points: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3"]:
    matrices = r.foot.motion.poses.inv().as_matrix().reshape(-1, 4, 4)
    return np.asarray(np.einsum("tij,tj->ti", matrices[:, :3, :3], points) + matrices[:, :3, 3])


def _seen(r: FootLoads) -> tuple[int, int, float]:
    """Axes of the foot to the right and upwards in the drawing, and the sign of the latter, for a view from above."""
    turned = r.foot.motion.poses.rotation.inv().as_matrix().reshape(-1, 3, 3)
    known = np.isfinite(r.centre.normal[:, 0])
    if known.any():
        normal = _mean(np.einsum("tij,tj->ti", turned[known], r.centre.normal[known]))
    else:
        normal = -np.ptp(r.foot.sole.centre, axis=0) + np.ptp(r.foot.sole.centre)  # the thinnest way
    above = int(np.argmax(np.abs(normal)))
    sides = [(above + 1) % 3, (above + 2) % 3]
    reach = np.ptp(r.foot.sole.centre, axis=0)
    across, up = sorted(sides, key=lambda axis: -float(reach[axis]))
    right_handed = 1.0 if (across + 1) % 3 == up else -1.0
    return across, up, right_handed * (1.0 if normal[above] >= 0.0 else -1.0)


def _mean(normals: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " 3"]:
    return np.asarray(normals.mean(axis=0))


def _edge(circles: Float[np.ndarray, "n c 2"]) -> tuple[float, float]:
    """Above the middle of a zone, where its name does not cover the path."""
    points = circles.reshape(-1, 2)
    middle = circles.mean(axis=(0, 1))
    return float(middle[0]), float(points[:, 1].max())


def _round_scale(scale: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above `scale`."""
    power = 10.0 ** np.floor(np.log10(scale))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step <= scale / power * (1.0 + 1e-9)))
