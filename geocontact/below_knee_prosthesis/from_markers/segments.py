"""Frames of segments from markers while standing, and what their markers must be like to tell them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.from_markers.marker_names import MAP, PELVIS
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Marker

Vector = Float[np.ndarray, " 3"]
OFF_LINE = 5e-3
"""m; least distance of a segment's markers from one line."""
THIGHS, SHANKS, KNEES = (0.2, 0.7), (0.2, 0.7), (0.05, 0.2)
"""m; lengths, and distances of epicondyles, that are believed."""
FEWEST = 3
"""Markers that fix a segment."""


def median_places(seen: MarkerTrajectories, names: Sequence[str]) -> dict[str, Vector]:
    """Median place of each marker while standing; InputError where one is missing."""
    missing = [name for name in names if name not in seen.names]
    if missing:
        raise InputError(seen.source, "`static`", f"no marker {', '.join(missing)} while standing", MAP)
    places = seen.of(tuple(names))
    never = [name for name, of in zip(names, np.isfinite(places).all(axis=2).T, strict=True) if not of.any()]
    if never:
        raise InputError(seen.source, "`static`", f"{never[0]} is never seen", "give a trial that shows all markers")
    return dict(zip(names, np.nanmedian(places, axis=0), strict=True))


def knee_line(at: Mapping[str, Vector], names: tuple[str, str], side: float) -> tuple[Vector, Vector]:
    """Middle of two markers, and the direction to the right through them: `side` 1 where the first is the right one."""
    outer, inner = (at[name] for name in names)
    return 0.5 * (outer + inner), side * (outer - inner)


def along_y(origin: Vector, up: Vector, across: Vector) -> RigidTransform:
    """y along `up`, z as near to `across` as it can be."""
    y = up / np.linalg.norm(up)
    z = across - (across @ y) * y
    z /= np.linalg.norm(z)
    return RigidTransform.from_components(origin, Rotation.from_matrix(np.column_stack([np.cross(y, z), y, z])))


def along_z(origin: Vector, across: Vector, up: Vector) -> RigidTransform:
    """z along `across`, y as near to `up` as it can be."""
    z = across / np.linalg.norm(across)
    y = up - (up @ z) * z
    y /= np.linalg.norm(y)
    return RigidTransform.from_components(origin, Rotation.from_matrix(np.column_stack([np.cross(y, z), y, z])))


def require_spread(seen: MarkerTrajectories, markers: Sequence[Marker]) -> None:
    """Markers of a body that has three or more do not lie on a line."""
    for body in dict.fromkeys(m.body for m in markers):
        own = [m for m in markers if m.body == body]
        places = np.array([m.location for m in own])
        off = np.linalg.svd(places - places.mean(axis=0), compute_uv=False)[1:2].sum() / np.sqrt(len(places))
        if len(own) >= FEWEST and off < OFF_LINE:
            what = f"markers {', '.join(m.name for m in own)} lie on a line, within {1e3 * off:.1f} mm"
            raise InputError(seen.source, "`static`", what, "a segment needs three that do not")


def require_forward(seen: MarkerTrajectories, at: Mapping[str, Vector], foot: tuple[str, str]) -> None:
    """A foot, from heel to toe, points to where the pelvis does."""
    front, back = (at[PELVIS[k]] + at[PELVIS[k + 1]] for k in (0, 2))
    if (at[foot[1]] - at[foot[0]]) @ (front - back) <= 0.0:
        what = f"{foot[0]} and {foot[1]} are exchanged: the foot points backwards"
        raise InputError(seen.source, "`static`", what, "are the markers named right? else rename with `markers_map`")


def require_lengths(seen: MarkerTrajectories, thigh: float, shank: float, knee: float) -> None:
    """Of a leg [m]; `knee` is the distance of the epicondyles."""
    for name, value, believed in (("thigh", thigh, THIGHS), ("shank", shank, SHANKS), ("knee", knee, KNEES)):
        require_length(seen, name, value, believed)


def require_length(seen: MarkerTrajectories, name: str, value: float, believed: tuple[float, float]) -> None:
    """InputError for a length that is not believed [m]."""
    low, high = believed
    if not low <= value <= high:
        what = f"the {name} would measure {value:.3g} m, not {low:g} to {high:g} m"
        raise InputError(seen.source, "`static`", what, "is the unit in the file right? are the markers named right?")
