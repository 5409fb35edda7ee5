"""Frames of a pressure mat as one wrench, one centre and one area per frame: offset removed, errors stated, in a
moving frame.

To first order, for cells with pressures p, areas A and unit forces u (m^2, against the normal) at x:

- each cell by itself off by the share e: covariance e^2 sum p^2 (u, x × u)(u, x × u)^T;
- all cells off by the same share g: g^2 (F, M)(F, M)^T;
- the mat moved by d and turned by θ about its middle c: F changes by θ × F, the moment about o by
  θ × M_c + (c - o) × (θ × F) + d × F, with M_c the moment about c. Components of d and of θ are independent where only
  their size is stated; where residuals tell their covariance, that is used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.frame_blocks import parts, worked
from geocontact.data.wrench import Wrench
from geocontact.geometry.register.quality import PoseCovariance
from geocontact.loads.mat_map import MatMap
from geocontact.loads.resultant import weighted_centre

FEWEST = 3  # frames of a window
COVARIANCE = 200  # values of a frame whose covariance is worked out


@dataclass(frozen=True, eq=False)
class Unloaded:
    """Reading of each cell without load, straight in time: offset + drift (t - middle).

    Parameters
    ----------
    offset
        At `middle` [Pa].
    drift
        [Pa/s]; 0 where there is one window only.
    middle
        [s].
    """

    offset: Float[np.ndarray, "r c"]
    drift: Float[np.ndarray, "r c"]
    middle: float

    def at(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t r c"]:
        """Readings without load [Pa]."""
        return np.asarray(self.offset + self.drift * (time - self.middle)[:, None, None])


def unloaded(
    time: Float[np.ndarray, " t"], pressure: Float[np.ndarray, "t r c"], windows: Sequence[tuple[float, float]]
) -> Unloaded:
    """Offset, and with two windows or more drift by least squares, from frames in `windows` [s]."""
    inside = np.zeros(len(time), bool)
    for first, last in windows:
        own = (time >= first) & (time <= last)
        if own.sum() < FEWEST:
            raise ValueError(f"{first:g} … {last:g} s holds {int(own.sum())} frames, at least {FEWEST} are needed")
        inside |= own
    middle = float(time[inside].mean())
    total = [part[chosen].sum(axis=0) for part, chosen in parts(pressure, inside)]
    offset = np.asarray(np.sum(total, axis=0) / inside.sum())
    drift = np.zeros_like(offset)
    if len(windows) > 1:
        each = parts(pressure, time - middle, inside)
        pulled = [np.einsum("t,trc->rc", after[chosen], part[chosen] - offset) for part, after, chosen in each]
        drift = np.asarray(np.sum(pulled, axis=0) / float(np.square(time[inside] - middle).sum()))
    return Unloaded(offset, drift, middle)


AROUND = 0.2  # of the area; cells whose normals add up to less have no side that they look to
AT_ONCE = 500  # frames, for bounded memory
TOUCHED = 1000.0
"""Pa; a cell under less carries its noise only."""


@dataclass(frozen=True, eq=False)
class MatLoad:
    """What a mat's pressure does to the body, over time, in the surface's frame.

    Parameters
    ----------
    wrench
        Force and moment about its origin.
    pressing
        Sum of pressure times sensing area [N], whichever way the cells look; not smaller than the force.
    perpendicular
        Part of the force along the inward mean normal of the interface [N].
    normal
        That mean normal, outwards, unit length; NaN, as `perpendicular` is then, where cells look all ways.
    area
        Of the cells under at least the touching pressure [m^2].
    peak, mean
        Largest pressure, and mean over that area, 0 where nothing touches [Pa].
    centre
        Centre of pressure [m]: cells weighted with pressure times area, NaN below the gate. Where the surface bends it
        lies a little under it.
    """

    wrench: Wrench
    pressing: Float[np.ndarray, " t"]
    perpendicular: Float[np.ndarray, " t"]
    normal: Float[np.ndarray, " 3"]
    area: Float[np.ndarray, " t"]
    peak: Float[np.ndarray, " t"]
    mean: Float[np.ndarray, " t"]
    centre: Float[np.ndarray, "t 3"]


def mat_load(
    placed: MatMap,
    pressure: Float[np.ndarray, "t n"],
    origin: Float[np.ndarray, " 3"],
    frame: str,
    gate: float = 0.0,
    touched: float = TOUCHED,
    cells: Bool[np.ndarray, " n"] | None = None,
) -> MatLoad:
    """Load of pressures [Pa] on the cells of a map.

    Readings below zero, noise of unloaded cells, count in forces and moments; in the centre they have no weight.

    Parameters
    ----------
    origin, frame
        Point that the moment refers to [m], and the name of the surface's frame.
    gate
        Pressing [N] below which there is no centre of pressure.
    touched
        Pressure from which a cell counts as touched [Pa].
    cells
        Which cells count: those of a segment. All without.
    """
    use = np.ones(len(placed.area), bool) if cells is None else cells
    if not use.any():
        raise ValueError("a segment needs at least one cell that lies on the surface")

    def of_part(part: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "t m"]:
        own = part if use.all() else part[:, use]
        wrench = own @ np.concatenate([placed.force[use], placed.moment[use]], axis=1)
        return np.column_stack([wrench, *_sizes(placed.centre[use], own, placed.area[use], gate, touched)])

    each = worked(of_part, pressure)
    force, moment, centre = each[:, :3], each[:, 3:6] - np.cross(origin, each[:, :3]), each[:, 6:9]
    normal = _facing(placed.force[use], placed.area[use])
    at = np.broadcast_to(np.asarray(origin, float), force.shape)
    return MatLoad(
        Wrench(force, moment, at, frame),
        each[:, 9],
        -(force @ normal),
        normal,
        each[:, 10],
        each[:, 11],
        each[:, 12],
        centre,
    )


def _sizes(
    points: Float[np.ndarray, "n 3"],
    pressure: Float[np.ndarray, "t n"],
    area: Float[np.ndarray, " n"],
    gate: float,
    touched: float,
) -> tuple[np.ndarray, ...]:
    """Centre, pressing, touched area, largest pressure, and mean on that area, of some frames."""
    weight = pressure * area
    pressing = weight.sum(axis=1)
    loaded = (pressing > 0.0) & (pressing >= gate)
    centre = _centres(points, np.maximum(weight, 0.0), loaded)
    on = pressure >= touched
    touched_area = (on * area).sum(axis=1)
    mean = np.divide((on * weight).sum(axis=1), touched_area, out=np.zeros(len(on)), where=touched_area > 0.0)
    return centre, pressing, touched_area, pressure.max(axis=1, initial=0.0), mean


def _facing(force: Float[np.ndarray, "n 3"], area: Float[np.ndarray, " n"]) -> Float[np.ndarray, " 3"]:
    """Mean outward normal; NaN where cells look all ways, as those of a belt do."""
    facing = -force.sum(axis=0)
    size = float(np.linalg.norm(facing))
    return np.asarray(facing / size if size > AROUND * float(area.sum()) else np.full(3, np.nan))


def _centres(
    points: Float[np.ndarray, "n 3"], weight: Float[np.ndarray, "t n"], loaded: Bool[np.ndarray, " t"]
) -> Float[np.ndarray, "t 3"]:
    """Weighted centre of each loaded frame, NaN in the others, a few frames at a time."""
    centre = np.full((len(weight), 3), np.nan)
    for some in np.array_split(np.flatnonzero(loaded), loaded.sum() // AT_ONCE + 1):
        same = np.broadcast_to(points, (len(some), *points.shape))
        centre[some] = weighted_centre(same, weight[some], "centre of pressure")
    return centre


def segment_loads(
    placed: MatMap,
    pressure: Float[np.ndarray, "t n"],
    origin: Float[np.ndarray, " 3"],
    frame: str,
    segments: Mapping[str, Bool[np.ndarray, " n"]],
    gate: float = 0.0,
    touched: float = TOUCHED,
) -> dict[str, MatLoad]:
    """`mat_load` of each segment; together they are the whole where every cell is in one of them."""
    return {name: mat_load(placed, pressure, origin, frame, gate, touched, cells) for name, cells in segments.items()}


@dataclass(frozen=True)
class MatErrors:
    """Standard deviations.

    Parameters
    ----------
    cell
        Of each cell's reading by itself, as a share of it.
    gain
        Of what all cells share.
    shift
        Of where the mat lies, along each axis [m].
    turn
        Of how it is turned, about each axis [rad].
    pose
        Of where the mat lies, as the residuals tell it of the body's registration and of the mat's own marks.
    """

    cell: float = 0.0
    gain: float = 0.0
    shift: float = 0.0
    turn: float = 0.0
    pose: PoseCovariance | None = None


def wrench_covariance(
    placed: MatMap, pressure: Float[np.ndarray, "t n"], wrench: Wrench, errors: MatErrors
) -> Float[np.ndarray, "t six six"]:
    """Covariance of force [N] and moment [N m] about the wrench's origin, frame by frame."""
    middle = placed.middle
    origin = wrench.origin[0]
    own = np.concatenate([placed.force, placed.moment - np.cross(origin, placed.force)], axis=1)
    pose = None if errors.pose is None else errors.pose.at(middle)

    def of_part(part: Float[np.ndarray, "t n"], loads: Float[np.ndarray, "t 9"]) -> Float[np.ndarray, "t six six"]:
        force, whole, about = loads[:, :3], loads[:, :6], loads[:, 6:]
        total = np.einsum("tn,ni,nj->tij", (errors.cell * part) ** 2, own, own, optimize=True)
        total += errors.gain**2 * whole[:, :, None] * whole[:, None, :]
        turned = np.concatenate([-_crossing(force), -_crossing(about)], axis=1)
        turned[:, 3:] += _crossing((middle - origin)[None]) @ turned[:, :3]
        moved = np.concatenate([np.zeros((len(whole), 3, 3)), -_crossing(force)], axis=1)
        for by, jacobian in ((errors.turn, turned), (errors.shift, moved)):
            total += by**2 * jacobian @ jacobian.transpose(0, 2, 1)
        if pose is not None:
            both = np.concatenate([moved, turned], axis=2)
            total += both @ pose @ both.transpose(0, 2, 1)
        return np.asarray(total)

    loads = np.concatenate([wrench.force, wrench.moment, wrench.moved_to(middle).moment], axis=1)
    return worked(of_part, pressure, loads, each=COVARIANCE)


def _crossing(vector: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3 3"]:
    """Matrices [v] with [v] w = v × w."""
    x, y, z = vector.T
    nothing = np.zeros_like(x)
    return np.stack([nothing, -z, y, z, nothing, -x, -y, x, nothing], axis=1).reshape(-1, 3, 3)


def load_in(load: MatLoad, X_GB: RigidTransform, point: Float[np.ndarray, " 3"], frame: str) -> MatLoad:
    """The load of a segment B in the frame G that B has the poses X_GB in, one for each frame of the mat.

    F_G = R F, M_G = R M + (X o - point) x F_G, with o the origin of the moment in B. The centre goes with the segment.
    What has no direction stays, and so does `normal`, which is one vector of the segment.

    Parameters
    ----------
    point
        Of G, that the moment refers to [m].
    frame
        Name of G.
    """
    wrench = load.wrench
    turn = X_GB.rotation
    force = turn.apply(wrench.force)
    there = X_GB.apply(wrench.origin)
    moment = turn.apply(wrench.moment) + np.cross(there - point, force)
    origin = np.broadcast_to(np.asarray(point, float), force.shape)
    return replace(load, wrench=Wrench(force, moment, origin, frame), centre=X_GB.apply(load.centre))


def covariance_in(
    covariance: Float[np.ndarray, "t six six"],
    origin: Float[np.ndarray, " 3"],
    X_GB: RigidTransform,
    point: Float[np.ndarray, " 3"],
) -> Float[np.ndarray, "t six six"]:
    """Covariance of force and moment about `origin` of B [m] as one about `point` of G: T C T^t, the poses exact."""
    turn = X_GB.rotation.as_matrix()
    arm = X_GB.apply(origin) - point
    x, y, z = arm.T
    nothing = np.zeros_like(x)
    crossing = np.stack([nothing, -z, y, z, nothing, -x, -y, x, nothing], axis=1).reshape(-1, 3, 3)
    change = np.zeros((len(turn), 6, 6))
    change[:, :3, :3] = change[:, 3:, 3:] = turn
    change[:, 3:, :3] = crossing @ turn
    return np.asarray(change @ covariance @ change.transpose(0, 2, 1))
