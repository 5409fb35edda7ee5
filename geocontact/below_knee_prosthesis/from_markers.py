"""The prosthetic leg from markers: names and sides, frames of segments, the standing trial, and motion of pelvis and
leg in a walking one.

Pelvis and thigh after the ISB (Wu et al. 2002). Hip centre by the regression of Harrington, Zavatsky, Lawson, Yuan &
Theologis (2007), Prediction of the hip joint centre in adults, children, and patients with cerebral palsy based on
magnetic resonance imaging, J Biomech 40, 595-602, unless a functional trial gives it. The shank has the knee's axis;
the foot is taken to stand flat and unloaded, its keel above the line from heel to toe.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.below_knee_prosthesis.leg import Leg, Person, Side
from geocontact.below_knee_prosthesis.leg_tree import RECORDED, LegMotion, recorded_tree
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTasks, MarkerTrajectories
from geocontact.data.multibody.model import Marker
from geocontact.dynamics.functional_joint import FunctionalCentre, functional_centre, segment_poses
from geocontact.dynamics.inverse_kinematics import Poses, inverse_kinematics
from geocontact.dynamics.tree import tree_of
from geocontact.identify.signals.filters import filled_and_smoothed

PELVIS = ("RASI", "LASI", "RPSI", "LPSI")
"""Front and back spines."""
THIGH = ("RTH1", "RTH2", "RTH3")
KNEE = ("RKNE", "RKNM")
"""Lateral and medial epicondyle; the medial one only while standing."""
SOCKET = ("RSO1", "RSO2", "RSO3")
ANKLE = ("RANK", "RANM")
"""Lateral and medial of the adapter above the foot; the medial one only while standing."""
FOOT = ("RHEE", "RTOE")
"""Over the posterior and the anterior end of the keel; the toe, which bends, only while standing."""
STANDING = (*PELVIS, *THIGH, *KNEE, *SOCKET, *ANKLE, *FOOT)
WALKING = (*PELVIS, *THIGH, KNEE[0], *SOCKET, ANKLE[0], FOOT[0])
BODIES = {
    "pelvis": PELVIS,
    "thigh": (*THIGH, KNEE[0]),
    "shank": (*SOCKET, ANKLE[0], FOOT[0]),
}
"""Markers of a walking trial by the body they are fixed to."""
INTACT_THIGH = ("LTH1", "LTH2", "LTH3")
INTACT_KNEE = ("LKNE", "LKNM")
INTACT_SHANK = ("LSH1", "LSH2", "LSH3")
INTACT_ANKLE = ("LANK", "LANM")
"""Lateral and medial malleolus; the medial one only while standing."""
INTACT_FOOT = ("LHEE", "LMT1", "LMT5")
"""Back of the heel, over the heads of the first and the fifth metatarsal."""
INTACT_TOES = ("LHLX",)
"""Tip of the big toe."""
INTACT_BODIES = {
    "intact_thigh": (*INTACT_THIGH, INTACT_KNEE[0]),
    "intact_shank": (*INTACT_SHANK, INTACT_ANKLE[0]),
    "intact_foot": INTACT_FOOT,
    "intact_toes": INTACT_TOES,
}
"""Markers of the intact leg, a left one, that a moving trial has, by the body they are fixed to."""
INTACT_STANDING = (*INTACT_THIGH, *INTACT_KNEE, *INTACT_SHANK, *INTACT_ANKLE, *INTACT_FOOT, *INTACT_TOES)
MAP = "is `side` right? else name them with `markers_map`"


def mirrored_name(name: str) -> str:
    """The same marker on the other side: a first letter R becomes L and the other way round."""
    return {"R": "L", "L": "R"}.get(name[:1], name[:1]) + name[1:]


MIRROR = np.array([1.0, 1.0, -1.0])
"""Mirror of vectors at the plane z = 0; moments change sign besides."""


def as_right(markers: MarkerTrajectories, side: Side) -> MarkerTrajectories:
    """Markers of a person with a left prosthesis mirrored, left and right exchanged; others as they are."""
    if side == "right":
        return markers
    names = tuple(mirrored_name(name) for name in markers.names)
    return MarkerTrajectories(markers.time, markers.positions * MIRROR, names, markers.source)


def of_side(vectors: Float[np.ndarray, "*t 3"], side: Side) -> Float[np.ndarray, "*t 3"]:
    """Places or forces of a right leg as those of the person's own side, and the other way round."""
    return vectors if side == "right" else vectors * MIRROR


Vector = Float[np.ndarray, " 3"]
OFF_LINE = 5e-3
"""m; least distance of a segment's markers from one line."""
THIGHS, SHANKS, KNEES = (0.2, 0.7), (0.2, 0.7), (0.05, 0.2)
"""m; lengths, and distances of epicondyles, that are plausible."""
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
    """Plausible lengths of a leg [m], else an error; `knee` is the distance of the epicondyles."""
    for name, value, plausible in (("thigh", thigh, THIGHS), ("shank", shank, SHANKS), ("knee", knee, KNEES)):
        require_length(seen, name, value, plausible)


def require_length(seen: MarkerTrajectories, name: str, value: float, plausible: tuple[float, float]) -> None:
    """InputError for a length that is not plausible [m]."""
    low, high = plausible
    if not low <= value <= high:
        what = f"the {name} would measure {value:.3g} m, not {low:g} to {high:g} m"
        raise InputError(seen.source, "`static`", what, "is the unit in the file right? are the markers named right?")


HIP = ((-0.24, -9.9e-3), (-0.30, -10.9e-3), (0.33, 7.3e-3))
"""Forward and up per pelvic depth and width, outward per width, and constants [m]: Harrington et al., table 4."""
WIDTHS = (0.12, 0.5)
"""m; distances of the front spines that are plausible."""
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
        by default.
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
        raise InputError(
            seen.source, "`static`", what, "y must be up: turn the file with `axes`; is its unit of length right?"
        )
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


SLOWEST = 0.2
"""m/s; a pelvis that moves forward less does not walk along x."""


@dataclass(frozen=True, eq=False)
class Walked:
    """A motion and how well the markers fit it, root mean square over markers that were seen [m]."""

    motion: LegMotion
    off: Float[np.ndarray, " t"]


def walked(seen: MarkerTrajectories, leg: Leg, *, cutoff: float | None, gap_limit: float) -> Walked:
    """Coordinates of a right leg; InputError where the markers do not tell them.

    Parameters
    ----------
    cutoff
        Of a zero-lag low-pass of the coordinates [Hz]; None for none.
    gap_limit
        Longest gap that is bridged [s].
    """
    missing = [name for name in WALKING if name not in seen.names]
    if missing:
        raise InputError(seen.source, "", f"no marker {', '.join(missing)}", MAP)
    tree = tree_of(recorded_tree(leg))
    try:
        found: Poses = inverse_kinematics(tree, seen, MarkerTasks(dict.fromkeys(WALKING, 1.0)))
        columns = [found.names.index(name) for name in RECORDED]
        values = found.values[:, columns]
        time, smooth = filled_and_smoothed(seen.time, values, cutoff=cutoff, longest_gap=gap_limit)
    except ValueError as error:
        raise InputError(
            seen.source, "", str(error), "fill the gaps, or give another `cutoff` or `gap_limit`"
        ) from error
    motion = LegMotion(leg, time, smooth)
    speed = float((motion.of("pelvis_tx")[-1] - motion.of("pelvis_tx")[0]) / (time[-1] - time[0]))
    if speed < SLOWEST:
        what = f"the pelvis moves along x with {speed:.2f} m/s"
        raise InputError(seen.source, "", what, "x must point where the person walks: turn the file with `axes`")
    with np.errstate(invalid="ignore"):
        off = np.sqrt(np.nanmean(found.distances**2, axis=1))
    return Walked(motion, off)


def functional_hip(seen: MarkerTrajectories, pelvis: Float[np.ndarray, "4 3"]) -> FunctionalCentre:
    """Hip centre in the pelvis' frame, in which its markers have these places [m]; InputError where there is none."""
    places = [seen.of(BODIES[body]) for body in ("pelvis", "thigh")]
    try:
        one, known, _ = segment_poses(places[0], pelvis)
        other, known_too, _ = segment_poses(places[1])
        both = known & known_too
        return functional_centre(one[both[known]], other[both[known_too]])
    except ValueError as error:
        raise InputError(
            seen.source, "`functional`", str(error), "swing the leg in all directions, markers seen"
        ) from error


def standing_hip(standing: MarkerTrajectories, moving: MarkerTrajectories) -> FunctionalCentre:
    """Hip centre of a functional trial, in the pelvis' frame of the standing one.

    InputError where markers of the pelvis lie on a line, and where the trial does not tell the centre.
    """
    places = np.nanmedian(standing.of(PELVIS), axis=0)
    frame = pelvis_frame(dict(zip(PELVIS, places, strict=True)), standing.source)
    return functional_hip(moving, frame.inv().apply(places))
