"""From the laboratory's frame to the device's: reference markers that were recorded, or attached to the trunk of a
person without the device.

Yao et al. (2024), Robotics 13:27, sec. 2.2, eqs 1-4: the origin moves to Lucy_MC, R1 turns Lucy_MC → Lucy_Mleft into x,
R2 turns about x until T10 lies where it lies on a wearer who stands upright.

The paper attaches the 3-D model of the device to its human model (sec. 2.2, fig. 3b) and gives no distances. Those
below are invented; the result repeats them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import Rotation, Slerp

from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.shoulder_exoskeleton.arm_motion import Side

MIDDLE, LEFT_OF_MIDDLE, T10 = "Lucy_MC", "Lucy_Mleft", "T10"
"""Reference markers of the device's frame; Yao et al. (2024), Robotics 13:27, fig. 3."""
UPPER: dict[Side, str] = {"right": "humerus_rup", "left": "humerus_lup"}
LOWER: dict[Side, str] = {"right": "humerus_rdn", "left": "humerus_ldn"}
"""Markers of the upper arms; the lower one is the centre of the sphere in the cuff."""
SHOULDER: dict[Side, str] = {"right": "RSHO", "left": "LSHO"}
ELBOW: dict[Side, str] = {"right": "RELB", "left": "LELB"}
WRIST: dict[Side, str] = {"right": "RWRI", "left": "LWRI"}
FINGER: dict[Side, str] = {"right": "RFIN", "left": "LFIN"}
C7, STERNUM, CLAVICLES, T8 = "C7", "STRN", "CLAV", "T8"
PELVIS = ("RASI", "LASI", "RPSI", "LPSI")
"""Markers of people, with or without the device; T8 in place of T10 as the ISB's thorax has it (Wu et al. 2005)."""


APART = 0.01
"""Least distance of Lucy_Mleft from Lucy_MC, and of T10 from the line through both [m]: a marker's own size."""
FARTHEST = 1.0
"""Largest distance of reference markers [m]; a trunk is shorter."""
MAP = "name them with `markers_map`"


def reference_markers(markers: MarkerTrajectories, attachment: Attachment) -> ReferenceMarkers:
    """Lucy_MC, Lucy_Mleft and T10; InputError where they are missing or cannot make a frame."""
    found = _recorded(markers) if {MIDDLE, LEFT_OF_MIDDLE} & set(markers.names) else _virtual(markers, attachment)
    _require_a_frame(markers, found)
    return found


def _recorded(markers: MarkerTrajectories) -> ReferenceMarkers:
    wanted = (MIDDLE, LEFT_OF_MIDDLE, T10)
    missing = [name for name in wanted if name not in markers.names]
    if missing:
        raise InputError(markers.source, "", f"no marker {', '.join(missing)}", f"{MAP}, or leave out {MIDDLE} as well")
    return ReferenceMarkers(*np.moveaxis(markers.of(wanted), 1, 0))


def _virtual(markers: MarkerTrajectories, attachment: Attachment) -> ReferenceMarkers:
    found = virtual_reference(markers, attachment)
    if found is None:
        sets = " or ".join("{" + ", ".join(names) + "}" for names in ((MIDDLE, LEFT_OF_MIDDLE, T10), *trunk_sets()))
        lacking = min(
            ([name for name in names if name not in markers.names] for names in trunk_sets()),
            key=len,
        )
        what = f"no reference markers: one of {sets} must be complete, {', '.join(lacking)} missing"
        raise InputError(markers.source, "", what, MAP)
    return found


def _require_a_frame(markers: MarkerTrajectories, found: ReferenceMarkers) -> None:
    """Three points that are apart and not on one line, in every frame that shows them."""
    bar, spine = found.left - found.origin, found.below - found.origin
    width, length = np.linalg.norm(bar, axis=1), np.linalg.norm(spine, axis=1)
    if not np.isfinite(width + length).any():
        what = f"{MIDDLE}, {LEFT_OF_MIDDLE} and {T10} are never seen together"
        raise InputError(markers.source, "", what, "fill their gaps, or cut the trial with `time`")
    _refuse(
        markers,
        width < APART,
        f"{MIDDLE} and {LEFT_OF_MIDDLE} lie on one point",
        "is one marker given twice?",
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        off = np.linalg.norm(np.cross(bar, spine), axis=1) / width
    remedy = f"T10 belongs below {MIDDLE}; look at its name"
    _refuse(markers, off < APART, f"{T10} lies on the line through {MIDDLE} and {LEFT_OF_MIDDLE}", remedy)
    far = max(float(np.nanmedian(width)), float(np.nanmedian(length)))
    if far > FARTHEST:
        what = f"reference markers of the device are {far:.3g} m apart"
        raise InputError(markers.source, "", what, "is the unit in the file right? are the markers named right?")


def _refuse(markers: MarkerTrajectories, bad: Bool[np.ndarray, " t"], what: str, remedy: str) -> None:
    if bad.any():
        first: Float[np.ndarray, ""] = markers.time[np.flatnonzero(bad)[0]]
        raise InputError(markers.source, "", f"{what} in {bad.sum()} frames, first at {first:.2f} s", remedy)


HALF_TURN = np.diag([-1.0, -1.0, 1.0])


@dataclass(frozen=True)
class DeviceFrame:
    """Pose of the device's frame L in the laboratory G, frame by frame.

    Parameters
    ----------
    origin
        p_GL, marker Lucy_MC [m].
    rotation
        R_LG: turns components in G into components in L. NaN where a reference marker was not seen.
    """

    origin: Float[np.ndarray, "t 3"]
    rotation: Float[np.ndarray, "t 3 3"]

    def points(self, places: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3"]:
        """Points of G in L [m], eq. 4."""
        return self.vectors(places - self.origin)

    def vectors(self, directions: Float[np.ndarray, "t 3"] | Float[np.ndarray, " 3"]) -> Float[np.ndarray, "t 3"]:
        """Directions of G in L."""
        return np.asarray(np.einsum("tij,tj->ti", self.rotation, np.broadcast_to(directions, self.origin.shape)))

    def at(self, time: Float[np.ndarray, " t"], wanted: Float[np.ndarray, " e"]) -> DeviceFrame:
        """The device in the laboratory at other times [s]: origin linear, turns along the shortest arcs.

        Frames without a pose are bridged; before the first and after the last pose it stands still.

        Parameters
        ----------
        time
            Of the frames.
        """
        known = np.isfinite(self.rotation).all(axis=(1, 2)) & np.isfinite(self.origin).all(axis=1)
        at = np.clip(wanted, time[known][0], time[known][-1])
        origin = np.column_stack([np.interp(at, time[known], column) for column in self.origin[known].T])
        turns = Slerp(time[known], Rotation.from_matrix(self.rotation[known]))(at)
        return DeviceFrame(origin, turns.as_matrix())

    def markers(self, seen: MarkerTrajectories, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t m 3"]:
        """All markers in the device's frame [m], each as it was nearest to these times [s], which are the frame's."""
        nearest = np.clip(np.searchsorted(0.5 * (seen.time[1:] + seen.time[:-1]), time), 0, len(seen) - 1)
        return np.stack([self.points(each) for each in seen.positions[nearest].swapaxes(0, 1)], axis=1)


def device_frame(
    origin: Float[np.ndarray, "t 3"],
    left: Float[np.ndarray, "t 3"],
    below: Float[np.ndarray, "t 3"],
    pitch: float = 0.0,
) -> DeviceFrame:
    """Frame of the device from Lucy_MC, Lucy_Mleft and T10 [m].

    Parameters
    ----------
    pitch
        Angle in the plane across x from straight below Lucy_MC to T10, positive where T10 lies farther back [rad]; see
        `upright_pitch`. The paper takes what it is while standing upright, without its number.
    """
    first = aligned_with_x(left - origin)
    lateral = np.einsum("tij,tj->ti", first, below - origin)
    theta = pitch - np.arctan2(lateral[:, 1], -lateral[:, 2])
    return DeviceFrame(origin, about_x(theta) @ first)


def upright_pitch(
    origin: Float[np.ndarray, "t 3"],
    left: Float[np.ndarray, "t 3"],
    below: Float[np.ndarray, "t 3"],
    up: Float[np.ndarray, " 3"],
) -> float:
    """Pitch of T10 with which z is upright, in the mean over frames in which the wearer stands upright [rad].

    Parameters
    ----------
    up
        In the laboratory's frame, of any length.
    """
    frame = device_frame(origin, left, below)
    vertical = np.nanmean(frame.vectors(up / np.linalg.norm(up)), axis=0)
    return float(np.arctan2(vertical[1], vertical[2]))


def aligned_with_x(vectors: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3 3"]:
    """Shortest turns R1 of vectors into x, eq. 2.

    The paper prints the vector u where its skew form belongs: R = cos α I + sin α [u]× + (1 - cos α) u uᵀ. Vectors that
    point against x, where u is lost, are first given half a turn about z; the turn about x that follows undoes it.
    """
    unit = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    against = unit[:, 0] < 0.0
    unit = np.where(against[:, None], unit @ HALF_TURN, unit)
    cosine = unit[:, 0]
    across = np.column_stack((np.zeros(len(unit)), unit[:, 2], -unit[:, 1]))  # v × x = sin α u
    squared = across[:, :, None] * across[:, None, :] / (1.0 + cosine)[:, None, None]  # (1 - cos α) u uᵀ
    turns = cosine[:, None, None] * np.eye(3) + _skew(across) + squared
    return np.asarray(np.where(against[:, None, None], turns @ HALF_TURN, turns))


def about_x(angle: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t 3 3"]:
    """Turns R2 about x by an angle [rad], eq. 3."""
    found = np.zeros((len(angle), 3, 3))
    found[:, 0, 0] = 1.0
    found[:, 1, 1] = found[:, 2, 2] = np.cos(angle)
    found[:, 2, 1] = np.sin(angle)
    found[:, 1, 2] = -found[:, 2, 1]
    return found


def _skew(v: Float[np.ndarray, "t 3"]) -> Float[np.ndarray, "t 3 3"]:
    """[v]×, so that [v]× w = v × w."""
    found = np.zeros((len(v), 3, 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[:, i, j], found[:, j, i] = -v[:, k], v[:, k]
    return found


Places = Float[np.ndarray, "t 3"]
ACROMIA = (SHOULDER["right"], SHOULDER["left"])


@dataclass(frozen=True)
class Attachment:
    """Where the shoulder bar and the reference markers are on the trunk [m]; all invented.

    Parameters
    ----------
    behind_acromia
        From the middle between both acromia back to Lucy_MC.
    behind_spine
        From the marker C7 back to Lucy_MC, where the acromia were not recorded.
    half_bar
        From Lucy_MC to Lucy_Mleft.
    down
        From Lucy_MC down to where T10 is taken to be.
    cuff
        Share of the way from shoulder to elbow at which the cuff holds the arm [-].
    """

    behind_acromia: float = 0.12
    behind_spine: float = 0.06
    half_bar: float = 0.10
    down: float = 0.25
    cuff: float = 0.6


@dataclass(frozen=True)
class ReferenceMarkers:
    """Lucy_MC, Lucy_Mleft and T10 in the laboratory [m], and how they came about where they were not recorded."""

    origin: Places
    left: Places
    below: Places
    note: str = ""


def virtual_reference(markers: MarkerTrajectories, attachment: Attachment) -> ReferenceMarkers | None:
    """The device attached to the trunk markers; None where no set of trunk markers is complete."""
    for needed, directions in _SETS:
        if set(needed) <= set(markers.names):
            return _attached(markers, attachment, needed, directions)
    return None


def trunk_sets() -> tuple[tuple[str, ...], ...]:
    """Sets of markers each of which is enough, the best first."""
    return tuple(needed for needed, _ in _SETS)


def _attached(
    markers: MarkerTrajectories,
    attachment: Attachment,
    needed: tuple[str, ...],
    directions: Callable[[MarkerTrajectories], tuple[Places, Places]],
) -> ReferenceMarkers:
    """The bar behind the trunk, T10 below it in the trunk's own axes: its pitch is 0 by definition."""
    left, up = directions(markers)
    left = left / np.linalg.norm(left, axis=1, keepdims=True)
    back = np.cross(up, left)
    back = back / np.linalg.norm(back, axis=1, keepdims=True)
    acromia = set(ACROMIA) <= set(needed)
    start = markers.of(ACROMIA).mean(axis=1) if acromia else markers.of((C7,))[:, 0]
    behind = attachment.behind_acromia if acromia else attachment.behind_spine
    origin = start + behind * back
    note = (
        f"the device is attached virtually to {', '.join(needed)}: Lucy_MC {1e3 * behind:.0f} mm behind "
        f"{'the middle of the acromia' if acromia else C7} (invented)"
    )
    return ReferenceMarkers(
        origin, origin + attachment.half_bar * left, origin + attachment.down * np.cross(back, left), note
    )


def _isb(lower: str) -> Callable[[MarkerTrajectories], tuple[Places, Places]]:
    """Thorax of the ISB: up from between sternum and spine to between clavicles and C7, left across both and C7."""

    def directions(markers: MarkerTrajectories) -> tuple[Places, Places]:
        incisura, c7, xiphoid, spine = np.moveaxis(markers.of((CLAVICLES, C7, STERNUM, lower)), 1, 0)
        up = 0.5 * (incisura + c7) - 0.5 * (xiphoid + spine)
        return np.cross(up, incisura - c7), up

    return directions


def _by_acromia_and_pelvis(markers: MarkerTrajectories) -> tuple[Places, Places]:
    """Left from acromion to acromion, up from the middle of the pelvis to that of the acromia.

    InputError where that makes the front of the pelvis its back.
    """
    right, left = np.moveaxis(markers.of(ACROMIA), 1, 0)
    pelvis = markers.of(PELVIS)
    across, up = left - right, 0.5 * (right + left) - pelvis.mean(axis=1)
    back = pelvis[:, 2:].mean(axis=1) - pelvis[:, :2].mean(axis=1)
    if np.nanmedian(np.einsum("ti,ti->t", np.cross(up, across), back)) < 0.0:
        what = f"with {' and '.join(ACROMIA)} the person looks away from {' and '.join(PELVIS[:2])}"
        raise InputError(markers.source, "", what, "left and right are exchanged; rename with `markers_map`")
    return across, up


_SETS: tuple[tuple[tuple[str, ...], Callable[[MarkerTrajectories], tuple[Places, Places]]], ...] = (
    ((CLAVICLES, C7, STERNUM, T10), _isb(T10)),
    ((CLAVICLES, C7, STERNUM, T8), _isb(T8)),
    ((*ACROMIA, *PELVIS), _by_acromia_and_pelvis),  # last: acromia move with the arms, the pelvis without the thorax
)
