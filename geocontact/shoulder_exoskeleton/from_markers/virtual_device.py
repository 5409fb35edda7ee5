"""Reference markers of a device that was not worn: attached to the trunk of the person whose markers were recorded.

The paper attaches the 3-D model of the device to its human model (sec. 2.2, fig. 3b) and gives no distances. Those
below are invented; the result repeats them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.shoulder_exoskeleton.from_markers.marker_names import (
    C7,
    CLAVICLES,
    PELVIS,
    SHOULDER,
    STERNUM,
    T8,
    T10,
)

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
