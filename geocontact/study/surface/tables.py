"""Mean ± SD of distances at corresponding points, and where two conditions differ."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.ensemble import mean_and_sd
from geocontact.study.statistics.sign_flip import SignFlips, sign_flips
from geocontact.study.surface.values import SurfaceValues

MM = 1e3
Place = Float[np.ndarray, "a p"]


def surface_table(v: SurfaceValues) -> pd.DataFrame:
    """Mean and standard deviation over subjects, at each particle, place of the curve and condition."""
    parts = []
    for condition in v.known:
        mean, sd, subjects = _ensemble(v, condition)
        told = {"distance_mean [mm]": MM * mean.ravel(), "distance_sd [mm]": MM * sd.ravel()}
        parts.append(pd.DataFrame({"condition": condition, **_places(v), "subjects [-]": subjects.ravel(), **told}))
    return pd.concat(parts, ignore_index=True)


def surface_difference_table(v: SurfaceValues) -> pd.DataFrame:
    """First condition minus second at each particle and place that all subjects with both have, with corrected p."""
    parts = []
    for first, second, there, found in surface_differences(v):
        told = {"difference [mm]": MM * found.difference, "t [-]": found.t, "p [-]": found.p}
        own = pd.DataFrame(_places(v))[there.ravel()].reset_index(drop=True)
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


def _places(v: SurfaceValues) -> dict[str, np.ndarray]:
    places, particles = len(v.at), len(v.points)
    return {
        "cycle [%]": np.repeat(np.array(v.at), particles),
        "particle [-]": np.tile(np.arange(1, particles + 1), places),
    }


def _between(table: pd.DataFrame, first: str, second: str) -> pd.DataFrame:
    table.insert(0, "first", first)
    table.insert(1, "second", second)
    return table
