"""Reference markers of the device: recorded, or attached to the trunk of a person without the device."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.shoulder_exoskeleton.from_markers.marker_names import LEFT_OF_MIDDLE, MIDDLE, T10
from geocontact.shoulder_exoskeleton.from_markers.virtual_device import (
    Attachment,
    ReferenceMarkers,
    trunk_sets,
    virtual_reference,
)

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
