"""Distances at corresponding points: their values, mean ± SD, and where two conditions differ."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.analyses.area.distance_file import FILE, read_series
from geocontact.data.errors import InputError
from geocontact.data.trial import mean_and_sd
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.particles import read_particles
from geocontact.study.curves import conditions_of, subjects_of
from geocontact.study.description import StudyFile, SurfaceSettings
from geocontact.study.statistics import SignFlips, sign_flips
from geocontact.study.store import Store
from geocontact.study.trials import CohortTrial, filled
from geocontact.view.surfaces.scene import MappedBody

FAR = 2e-3
"""A particle may be so far off its mesh [m]: ShapeWorks keeps them on a smoothed, resampled surface."""
MM = 1e3
Place = Float[np.ndarray, "a p"]


@dataclass(frozen=True, eq=False)
class SurfaceValues:
    """Distances [m] of n trials at a places of the curve and p particles; NaN beyond what the analysis looked for.

    Parameters
    ----------
    points
        Particles of the first trial [m], on which results are shown.
    at
        Places on the curve [%].
    subjects, conditions
        Of the trials.
    """

    points: Float[np.ndarray, "p 3"]
    at: tuple[float, ...]
    subjects: tuple[str, ...]
    conditions: tuple[str, ...]
    distance: Float[np.ndarray, "n a p"]

    @property
    def known(self) -> tuple[str, ...]:
        """Conditions in the order of the trials."""
        return tuple(dict.fromkeys(self.conditions))

    def by_subject(self, condition: str) -> dict[str, Float[np.ndarray, "a p"]]:
        """Mean of each subject's trials in a condition."""
        own: dict[str, list[int]] = {}
        for k, (subject, what) in enumerate(zip(self.subjects, self.conditions, strict=True)):
            if what == condition:
                own.setdefault(subject, []).append(k)
        return {subject: self.distance[places].mean(axis=0) for subject, places in own.items()}


@dataclass(frozen=True, eq=False)
class _Places:
    """Where particles are on a mesh: corners of their faces, and the weights of these."""

    corners: Int[np.ndarray, "p 3"]
    weights: Float[np.ndarray, "p 3"]

    def read(self, values: Float[np.ndarray, "a n"]) -> Float[np.ndarray, "a p"]:
        """Values of the vertices, linear in each face; NaN where one of its corners has none."""
        known = np.where(np.isfinite(values), values, np.nan)
        return np.asarray((known[:, self.corners] * self.weights).sum(axis=2))


def surface_values(study: StudyFile, done: Sequence[tuple[CohortTrial, str]], store: Store) -> SurfaceValues | None:
    """Distances of all trials that are done; None where the study asks for nothing on a surface."""
    asked = study.surface
    if asked is None or not done:
        return None
    known: dict[tuple[Path, bytes], tuple[np.ndarray, _Places]] = {}
    found: list[Float[np.ndarray, "a p"]] = []
    for trial, address in done:
        series = read_series(store.place(address) / FILE)
        body: MappedBody = getattr(series, asked.body)
        file = study.home / str(filled(study, "particles", asked.particles, trial.factors, "[surface]"))
        key = (file, body.vertices.tobytes())
        if key not in known:
            points = read_particles(file, asked.unit)
            known[key] = points, _places(file, points, body)
        points, places = known[key]
        if found and len(points) != found[0].shape[1]:
            what = f"holds {len(points)} particles, the first file {found[0].shape[1]}"
            raise InputError(file, "", what, "particles correspond within one shape model only")
        found.append(places.read(_at(asked, series.time, body.distance)))
    trials = [trial for trial, _ in done]
    first = next(iter(known.values()))[0]
    return SurfaceValues(first, asked.at, subjects_of(study, trials), conditions_of(study, trials), np.array(found))


def _at(asked: SurfaceSettings, time: Float[np.ndarray, " t"], distance: Float[np.ndarray, "t n"]) -> np.ndarray:
    """Distances of the vertices at the places of the curve, linear between frames."""
    if len(time) == 1:
        return np.asarray(np.repeat(distance, len(asked.at), axis=0))
    place = np.interp(np.array(asked.at) / 100.0, (time - time[0]) / (time[-1] - time[0]), np.arange(len(time)))
    before = np.minimum(place.astype(int), len(time) - 2)
    share = (place - before)[:, None]
    known = np.where(np.isfinite(distance), distance, np.nan)
    between = (1.0 - share) * known[before] + share * known[before + 1]
    return np.asarray(np.where(share == 0.0, known[before], np.where(share == 1.0, known[before + 1], between)))


def _places(file: Path, points: Float[np.ndarray, "p 3"], body: MappedBody) -> _Places:
    """Nearest points of the mesh; InputError where particles are not on it."""
    surface = Surface(body.vertices, body.faces)
    near = surface.proximity(points)
    off = np.linalg.norm(near.closest - points, axis=1)
    if off.max() > FAR:
        k = int(off.argmax())
        what = f"particle {k + 1} is {1e3 * off[k]:.1f} mm off the mesh"
        raise InputError(file, "", what, "give the local particles of this mesh, in the unit of their file")
    corners = np.asarray(body.faces)[near.face]
    return _Places(corners, _barycentric(body.vertices[corners], near.closest))


def _barycentric(triangles: Float[np.ndarray, "p 3 3"], points: Float[np.ndarray, "p 3"]) -> Float[np.ndarray, "p 3"]:
    """Shares of the areas of the three triangles that a point makes with the edges."""
    areas = [
        np.linalg.norm(np.cross(triangles[:, (k + 1) % 3] - points, triangles[:, (k + 2) % 3] - points), axis=1)
        for k in range(3)
    ]
    weights = np.stack(areas, axis=1)
    return np.asarray(weights / np.maximum(weights.sum(axis=1, keepdims=True), 1e-300))


def surface_table(v: SurfaceValues) -> pd.DataFrame:
    """Mean and standard deviation over subjects, at each particle, place of the curve and condition."""
    parts = []
    for condition in v.known:
        mean, sd, subjects = _ensemble(v, condition)
        told = {"distance_mean [mm]": MM * mean.ravel(), "distance_sd [mm]": MM * sd.ravel()}
        parts.append(pd.DataFrame({"condition": condition, **_numbered(v), "subjects [-]": subjects.ravel(), **told}))
    return pd.concat(parts, ignore_index=True)


def surface_difference_table(v: SurfaceValues) -> pd.DataFrame:
    """First condition minus second at each particle and place that all subjects with both have, with corrected p."""
    parts = []
    for first, second, there, found in surface_differences(v):
        told = {"difference [mm]": MM * found.difference, "t [-]": found.t, "p [-]": found.p}
        own = pd.DataFrame(_numbered(v))[there.ravel()].reset_index(drop=True)
        parts.append(own.assign(**told).pipe(_between, first, second))
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def surface_differences(v: SurfaceValues) -> Iterator[tuple[str, str, np.ndarray, SignFlips]]:
    """Tests of each two conditions with two subjects or more in common: where there is a value, and what was found.

    The largest |t| is taken over all particles and all places of the curve together, so that 5 % hold for the surface
    as a whole.
    """
    for first, second in combinations(v.known, 2):
        a, b = v.by_subject(first), v.by_subject(second)
        both = [subject for subject in a if subject in b]
        if len(both) < 2:
            continue
        differences = np.array([a[subject] - b[subject] for subject in both])
        there = np.isfinite(differences).all(axis=0)
        if there.any():
            yield first, second, there, sign_flips(differences[:, there])


def surface_fields(v: SurfaceValues) -> dict[str, Float[np.ndarray, " p"]]:
    """The same for a picture: a value for each particle under the name of what it is; NaN where there is none."""
    fields: dict[str, Float[np.ndarray, " p"]] = {}
    for condition in v.known:
        for name, values in zip(("mean", "sd"), _ensemble(v, condition)[:2], strict=True):
            fields |= {f"{condition} {at:g} %: {name} [mm]": MM * own for at, own in zip(v.at, values, strict=True)}
    for first, second, there, found in surface_differences(v):
        for name, own in (("difference [mm]", MM * found.difference), ("p [-]", found.p)):
            whole = np.full(there.shape, np.nan)
            whole[there] = own
            fields |= {f"{first} - {second} {at:g} %: {name}": row for at, row in zip(v.at, whole, strict=True)}
    return fields


def _ensemble(v: SurfaceValues, condition: str) -> tuple[Place, Place, np.ndarray]:
    values = np.array(list(v.by_subject(condition).values()))
    mean, sd = mean_and_sd(values.reshape(len(values), -1))
    shape = values.shape[1:]
    return mean.reshape(shape), sd.reshape(shape), np.isfinite(values).sum(axis=0)


def _numbered(v: SurfaceValues) -> dict[str, np.ndarray]:
    places, particles = len(v.at), len(v.points)
    return {
        "cycle [%]": np.repeat(np.array(v.at), particles),
        "particle [-]": np.tile(np.arange(1, particles + 1), places),
    }


def _between(table: pd.DataFrame, first: str, second: str) -> pd.DataFrame:
    table.insert(0, "first", first)
    table.insert(1, "second", second)
    return table
