"""The leg from a standing trial: joint centres, frames of the segments, where the markers are on them.

Pelvis and thigh after the ISB (Wu et al. 2002). Hip centre by the regression of Harrington, Zavatsky, Lawson, Yuan &
Theologis (2007), Prediction of the hip joint centre in adults, children, and patients with cerebral palsy based on
magnetic resonance imaging, J Biomech 40, 595-602, unless a functional trial gives it. The shank has the knee's axis;
the foot is taken to stand flat and unloaded, its keel above the line from heel to toe.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.from_markers.marker_names import ANKLE, BODIES, FOOT, KNEE, PELVIS, STANDING
from geocontact.below_knee_prosthesis.from_markers.segments import (
    OFF_LINE,
    along_y,
    along_z,
    knee_line,
    median_places,
    require_forward,
    require_length,
    require_lengths,
    require_spread,
)
from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.model.leg import Leg, Person
from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.data.multibody.model import Marker

Vector = Float[np.ndarray, " 3"]
HIP = ((-0.24, -9.9e-3), (-0.30, -10.9e-3), (0.33, 7.3e-3))
"""Forward and up per pelvic depth and width, outward per width, and constants [m]: Harrington et al., table 4."""
WIDTHS = (0.12, 0.5)
"""m; distances of the front spines that are believed."""
FEET = 0.15
"""Share by which the markers of heel and toe may be apart more or less than the keel is long."""


def standing_leg(
    seen: MarkerTrajectories,
    person: Person,
    keel: Keel,
    below: float,
    hip: Vector | None = None,
    axis: tuple[Vector, Vector] | None = None,
) -> Leg:
    """Geometry of a right leg; InputError where the markers cannot tell it.

    Parameters
    ----------
    below
        From the sole up to the keel's axis [m].
    hip
        Centre in the pelvis' frame [m] where it is known better than by regression.
    axis
        Of the knee: centre [m] and direction to the right in the laboratory, likewise; that of the epicondyles
        unless given.
    """
    at = median_places(seen, STANDING)
    _require_side(seen, at)
    pelvis, hip = pelvis_frame(at, seen.source), hip_by_regression(at) if hip is None else hip
    knee, across = knee_line(at, KNEE, side=1.0) if axis is None else axis
    ankle = 0.5 * (at[ANKLE[0]] + at[ANKLE[1]])
    centre = pelvis.apply(hip)
    thigh = along_y(centre, centre - knee, across)
    shank = along_z(knee, thigh.rotation.apply([0.0, 0.0, 1.0]), knee - ankle)
    forward = _foot_line(seen, at, keel)
    require_forward(seen, at, FOOT)
    heel = np.array([at[FOOT[0]][0], below, at[FOOT[0]][2]])
    foot = Rotation.from_matrix(np.column_stack([forward, [0.0, 1.0, 0.0], np.cross(forward, [0.0, 1.0, 0.0])]))
    frames = {"pelvis": pelvis, "thigh": thigh, "shank": shank}
    markers = tuple(
        Marker(name, body, frames[body].inv().apply(at[name])) for body, names in BODIES.items() for name in names
    )
    require_spread(seen, markers)
    leg = Leg(
        person,
        hip,
        float(np.linalg.norm(centre - knee)),
        shank.inv().apply(ankle),
        0.5 * float(np.linalg.norm(at[KNEE[0]] - at[KNEE[1]])),
        shank.inv().apply(heel),
        shank.rotation.inv() * foot,
        markers,
    )
    width = float(np.linalg.norm(at[PELVIS[0]] - at[PELVIS[1]]))
    require_lengths(seen, leg.thigh, leg.shank, 2.0 * leg.knee_radius)
    require_length(seen, "pelvis", width, WIDTHS)
    return leg


def pelvis_frame(at: dict[str, Vector], source: str) -> RigidTransform:
    """Origin between the front spines, z to the right through them, x forward in the plane of all four."""
    right, left, back = at[PELVIS[0]], at[PELVIS[1]], 0.5 * (at[PELVIS[2]] + at[PELVIS[3]])
    middle = 0.5 * (right + left)
    across, forward = right - left, middle - back
    up = np.cross(across, forward)
    if np.linalg.norm(up) < OFF_LINE * np.linalg.norm(across):
        raise InputError(source, "", f"markers {', '.join(PELVIS)} lie on a line", "look at their names")
    return along_z(middle, across, up)


def hip_by_regression(at: dict[str, Vector]) -> Vector:
    """Right hip centre in the pelvis' frame [m]."""
    width = float(np.linalg.norm(at[PELVIS[0]] - at[PELVIS[1]]))
    depth = float(np.linalg.norm(at[PELVIS[0]] + at[PELVIS[1]] - at[PELVIS[2]] - at[PELVIS[3]])) / 2.0
    return np.array([slope * size + at0 for (slope, at0), size in zip(HIP, (depth, width, width), strict=True)])


def _require_side(seen: MarkerTrajectories, at: dict[str, Vector]) -> None:
    """Upright along y, front spines on their sides, the leg on its own."""
    middle = 0.5 * (at[PELVIS[0]] + at[PELVIS[1]])
    forward = middle - 0.5 * (at[PELVIS[2]] + at[PELVIS[3]])
    knee = 0.5 * (at[KNEE[0]] + at[KNEE[1]])
    if not middle[1] - knee[1] > 0.15:
        what = f"the pelvis is {middle[1] - knee[1]:.2f} m above the knee along y"
        raise InputError(seen.source, "`static`", what, "y must be up: turn the file with `axes`")
    right = np.cross(forward, [0.0, 1.0, 0.0])
    wrong = (at[PELVIS[0]] - at[PELVIS[1]]) @ right <= 0.0
    if wrong or (knee - middle) @ right <= 0.0 or (at[KNEE[0]] - at[KNEE[1]]) @ right <= 0.0:
        what = "left and right are exchanged: the spines, the knee's markers or the leg lie on the wrong side"
        raise InputError(seen.source, "`static`", what, "is `side` right? else rename with `markers_map`")


def _foot_line(seen: MarkerTrajectories, at: dict[str, Vector], keel: Keel) -> Vector:
    line = (at[FOOT[1]] - at[FOOT[0]]) * np.array([1.0, 0.0, 1.0])
    length = float(np.linalg.norm(line))
    if abs(length / keel.length - 1.0) > FEET:
        what = f"{FOOT[0]} and {FOOT[1]} are {1e3 * length:.0f} mm apart, the keel is {1e3 * keel.length:.0f} mm long"
        raise InputError(seen.source, "`static`", what, "is the unit right? they belong over the ends of the keel")
    return np.asarray(line / length)
