"""Where a segment is, from a cluster of markers on it, frame by frame."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial.transform import RigidTransform

from geocontact.geometry.register.landmarks import fit_landmarks

FEWEST = 3
"""Markers that fix a pose."""


Known = tuple[RigidTransform, Bool[np.ndarray, " t"]]
"""Poses in the frames that are known, and which of all frames those are."""


def seen_together(one: Known, other: Known) -> tuple[RigidTransform, RigidTransform, Bool[np.ndarray, " t"]]:
    """Poses of two segments in the frames that tell both, and which frames those are."""
    (first, known), (second, known_too) = one, other
    both = known & known_too
    return first[both[known]], second[both[known_too]], both


def segment_poses(
    places: Float[np.ndarray, "t m 3"], template: Float[np.ndarray, "m 3"] | None = None
) -> tuple[RigidTransform, Bool[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """Poses of the template in the ground in the frames that tell them, which those are, how far markers are off [m].

    Parameters
    ----------
    places
        Of the markers [m], NaN where one was not seen.
    template
        Their places in the segment's frame; the first frame that shows all of them, about their mean, unless given.

    The distance is the root mean square over the markers that were seen, NaN in frames that are not known: those with
    fewer than three.
    ValueError where no frame shows all markers and no template is given, or the markers lie on a line.
    """
    seen = np.isfinite(places).all(axis=2)
    if template is None:
        whole = np.flatnonzero(seen.all(axis=1))
        if not len(whole):
            raise ValueError("no frame shows all markers of the segment; give a template")
        template = places[whole[0]] - places[whole[0]].mean(axis=0)
    known = seen.sum(axis=1) >= FEWEST
    if not known.any():
        raise ValueError(f"no frame shows {FEWEST} markers of the segment")
    matrices, off = [], np.full(len(places), np.nan)
    for frame in np.flatnonzero(known):
        there = seen[frame]
        found = fit_landmarks(template[there], places[frame, there], tolerance=np.inf)
        matrices.append(found.pose.as_matrix())
        off[frame] = np.sqrt(np.mean(np.sum((found.pose.apply(template[there]) - places[frame, there]) ** 2, axis=1)))
    return RigidTransform.from_matrix(np.array(matrices)), known, off
