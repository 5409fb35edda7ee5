"""Synthetic trials of a knee implant with load cells, by code of its own around the same surfaces, law and weights.

Contact areas: distances by libigl, summed over the centroids of a finer surface (the chain: its own tree, triangles cut
at the iso-line). Cells: lever rule and regression solved by Cramer's rule. Forces are made at a finer step, filtered
without phase, thinned and given noise; the modulus and the registration of the pose differ from trial to trial.
Nothing here was measured, except the surfaces and the mean motion where real ones are given.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import igl
import numpy as np
from scipy.interpolate import CubicSpline
from scipy.signal import butter, sosfiltfilt
from scipy.spatial.transform import Rotation

POSE = {"flexion": "rad", "adduction": "rad", "rotation": "rad", "tx": "m", "ty": "m", "tz": "m"}
CELLS = ("PM", "AM", "AL", "PL")
MEDIAL_WEIGHT = {"PM": 0.9683, "AM": 0.9871, "AL": 0.0387, "PL": 0.0211}
ROWS = (-0.015, 0.015)
"""x of the rear and of the front row of cells [m]."""
THRESHOLD, RADIUS, MODULUS = 4e-3, 0.037, 3e6
FINER, DURATION = 2, (0.95, 1.2)
"""How much finer than the recordings the truth is sampled, and duration of a cycle [s]."""
CYCLE = 40
"""Recorded steps of a cycle."""
FILTER = 15.0
"""Corner of the cells' low-pass, without phase [Hz]: of the signal, and of half the power of the noise."""
NOISE, POSE_NOISE, REGISTRATION = 4.0, (5e-4, 3e-5), (5e-4, 3e-5)
"""Of a cell [N], half of it white; of a pose (rad, m) from sample to sample, and from trial to trial."""
VARIES = 0.03
"""Of the modulus, from trial to trial."""
WANDERS = np.array([0.03, 0.004, 0.010, 4e-4, 2.5e-4, 3e-4])
"""How much each coordinate differs from the mean motion in the course of a trial [rad, m]."""

Mesh = tuple[np.ndarray, np.ndarray]


def halved(mesh: Mesh, times: int = 1) -> Mesh:
    """Every triangle cut into four at the middles of its edges: the same surface."""
    vertices, faces = mesh
    for _ in range(times):
        edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, place = np.unique(edges, axis=0, return_inverse=True)
        a, b, c = faces.T
        ab, bc, ca = (place.ravel().reshape(-1, 3) + len(vertices)).T
        vertices = np.concatenate([vertices, vertices[unique].mean(axis=1)])
        faces = np.concatenate([np.column_stack(t) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return vertices, faces


@dataclass(frozen=True)
class Bodies:
    """A femoral component, and the insert as points with areas [m^2]; `size` is that of a point's triangle [m]."""

    femoral: Mesh
    point: np.ndarray
    area: np.ndarray
    size: np.ndarray

    @classmethod
    def of(cls, femoral: Mesh, insert: Mesh, least_ny: float = -2.0) -> Bodies:
        """Faces of the insert whose normals have an upward component above `least_ny` count."""
        corners = insert[0][insert[1]]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        double = np.linalg.norm(normal, axis=1)
        keep = (double > 0.0) & (normal[:, 1] > least_ny * double)
        area = 0.5 * double[keep]
        return cls(femoral, corners[keep].mean(axis=1), area, np.sqrt(area))

    @property
    def box(self) -> np.ndarray:
        """Corners of the femoral component's bounding box [m]."""
        return np.array([self.femoral[0].min(axis=0), self.femoral[0].max(axis=0)])

    def patches(self, pose: np.ndarray, threshold: float = THRESHOLD) -> tuple[np.ndarray, np.ndarray]:
        """Area and x of the centre of the medial and lateral patch, (t, 2) each, for poses (6, t) of a right knee.

        A point counts in part within half the size of its triangle of the threshold, so areas are smooth in the pose.
        """
        kind = igl.SignedDistanceType.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
        area, centre = np.zeros((pose.shape[1], 2)), np.zeros((pose.shape[1], 2))
        turned = Rotation.from_euler("YXZ", np.column_stack([-pose[2], -pose[1], pose[0]])).as_matrix()
        for i, (matrix, shift) in enumerate(zip(turned, pose[3:].T, strict=True)):
            seen = (self.point - shift) @ matrix
            near = ((seen > self.box[0] - 2 * threshold) & (seen < self.box[1] + 2 * threshold)).all(axis=1)
            distance = np.full(len(seen), np.inf)
            distance[near] = igl.signed_distance(seen[near], *self.femoral, kind)[0]
            share = self.area * np.clip(0.5 + (threshold - distance) / self.size, 0.0, 1.0)
            for side, mine in enumerate((self.point[:, 2] <= 0.0, self.point[:, 2] > 0.0)):
                area[i, side] = share[mine].sum()
                centre[i, side] = share[mine] @ self.point[mine, 0] / max(area[i, side], 1e-12)
        return area, centre


def cells_of(force: np.ndarray, centre: np.ndarray) -> np.ndarray:
    """Four cells (t, 4) that carry the sides' forces (t, 2), which act at `centre` (t, 2)."""
    front = (centre - ROWS[0]) / (ROWS[1] - ROWS[0])
    m = MEDIAL_WEIGHT
    a = m["PM"] + front[:, 0] * (m["AM"] - m["PM"])
    b = m["PL"] + front[:, 1] * (m["AL"] - m["PL"])
    total = force.sum(axis=1)  # weights of a cell add up to 1, so the sums of the sides' cells are the total
    medial = (force[:, 0] - b * total) / (a - b)
    lateral = total - medial
    return np.column_stack(
        [medial * (1 - front[:, 0]), medial * front[:, 0], lateral * front[:, 1], lateral * (1 - front[:, 1])]
    )


@dataclass(frozen=True)
class Withheld:
    """What the base model is not told: an error of the measured pose, R(φ), a coupling of two cells.

    Parameters
    ----------
    offset
        Added to the measured coordinates [rad, m].
    transition
        R falls from that of the base to 22/34 of it around 0.5 rad of flexion, along a logistic curve of this width
        [rad]; 0 where it does not. 34 and 22 mm are the distal and posterior radius of the sample knee.
    coupling
        Share of the first cell that shows up in the second.
    """

    offset: tuple[float, ...] = (0.0,) * 6
    transition: float = 0.0
    coupling: tuple[str, str, float] = ("PM", "AM", 0.0)

    def radius(self, flexion: np.ndarray) -> np.ndarray:
        """R along a trial [m]."""
        if self.transition == 0.0:
            return np.full_like(flexion, RADIUS)
        return RADIUS / 34.0 * (22.0 + 12.0 / (1.0 + np.exp((flexion - 0.5) / self.transition)))

    def mixed(self, cells: np.ndarray) -> np.ndarray:
        """What the cells read of what they carry."""
        source, target, share = self.coupling
        out = cells.copy()
        out[:, CELLS.index(target)] += share * cells[:, CELLS.index(source)]
        return out

    def reading(self, area: np.ndarray, centre: np.ndarray, flexion: np.ndarray, modulus: float) -> np.ndarray:
        """Cells for areas and centres of the patches."""
        force = 4.0 / 3.0 * modulus * (area / np.pi) ** 1.5 / self.radius(flexion)[:, None]
        return self.mixed(cells_of(force, centre))


NOTHING = Withheld()


def coloured(rng: np.random.Generator, count: int, step: float, corner: float) -> np.ndarray:
    """Noise of standard deviation 1, low-passed without phase."""
    spare = 40
    low = sosfiltfilt(butter(2, corner, fs=1.0 / step, output="sos"), rng.normal(size=count + 2 * spare))
    return low[spare:-spare] / low.std()


@dataclass(frozen=True)
class Course:
    """True motion of one trial at the finer step, the patches along it, and what differs from other trials."""

    time: np.ndarray
    pose: np.ndarray
    modulus: float
    registration: np.ndarray
    patches: tuple[np.ndarray, np.ndarray]
    seen: np.ndarray
    """Pose (6, n) as it is measured at the recording's step, without a withheld offset."""
    noise: np.ndarray
    kept: dict[tuple[float, ...], tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)

    @classmethod
    def drawn(cls, bodies: Bodies, mean: CubicSpline, rng: np.random.Generator, samples: int) -> Course:
        """A trial around the mean motion, a function of the phase 0 to 1; fewer samples are a part of the cycle."""
        fine = rng.uniform(*DURATION) / CYCLE / FINER
        time = fine * np.arange(FINER * (samples - 1) + 1)
        phase = np.arange(len(time)) / (FINER * CYCLE)
        wave = sum(
            rng.normal(size=(6, 1)) / k * np.sin(2 * np.pi * k * phase + rng.uniform(0, 2 * np.pi, (6, 1)))
            for k in (1, 2, 3)
        )
        pose = mean(phase).T + WANDERS[:, None] * wave
        kinds = np.repeat([0, 1], 3)
        registration = np.array(REGISTRATION)[kinds] * rng.normal(size=6)
        some = np.array([coloured(rng, samples, FINER * fine, 6.0) for _ in range(6)])
        seen = pose[:, ::FINER] + registration[:, None] + np.array(POSE_NOISE)[kinds][:, None] * some
        slow = np.column_stack([coloured(rng, samples, FINER * fine, FILTER) for _ in CELLS])
        noise = NOISE * (slow + rng.normal(size=slow.shape)) / np.sqrt(2.0)
        modulus = MODULUS * (1.0 + VARIES * rng.normal())
        return cls(time, pose, modulus, registration, bodies.patches(pose), seen, noise)

    def cells(self, withheld: Withheld) -> np.ndarray:
        """Cells as they are recorded."""
        read = withheld.reading(*self.patches, self.pose[0], self.modulus)
        low = butter(2, FILTER, fs=1.0 / (self.time[1] - self.time[0]), output="sos")
        return sosfiltfilt(low, read, axis=0)[::FINER] + self.noise

    def measured(self, withheld: Withheld) -> np.ndarray:
        """Pose as it is recorded."""
        return self.seen + np.array(withheld.offset)[:, None]

    def unit_cells(self, bodies: Bodies, pose: np.ndarray, model: Withheld) -> np.ndarray:
        """Cells that a model says at a recorded pose, for a modulus of 1 Pa."""
        key = tuple(np.round((pose - self.seen)[:, 0], 9).tolist())
        if key not in self.kept:
            self.kept[key] = bodies.patches(pose)
        return model.reading(*self.kept[key], pose[0], 1.0)


def true_reduction(bodies: Bodies, fitted: list[Course], fresh: list[Course], withheld: Withheld) -> np.ndarray:
    """By what share the error of each cell falls on trials not used, when the base is told what was withheld.

    One modulus is fitted by least squares to the calibration trials, with and without it.
    """
    errors = []
    for told in (NOTHING, withheld):
        undone = np.array(told.offset)[:, None]
        pairs = [
            (c.unit_cells(bodies, c.measured(withheld) - undone, told), c.cells(withheld)) for c in (*fitted, *fresh)
        ]
        known = pairs[: len(fitted)]
        modulus = sum((u * y).sum() for u, y in known) / sum((u * u).sum() for u, _ in known)
        off = np.concatenate([y - modulus * u for u, y in pairs[len(fitted) :]])
        errors.append(np.sqrt((off**2).mean(axis=0)))
    return 1.0 - errors[1] / errors[0]
