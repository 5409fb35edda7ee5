"""How alike the surfaces are curved where they are in contact, along a motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.area.bodies import Bodies
from geocontact.analyses.frame.collector import listener, note, reserve, say
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.congruence import CongruencePair

FEW = 0.9
"""Share of the contact area that has both curvatures, below which a warning says so."""
LEAST = 0.2
"""Share below which there is no index: it would be that of a few places."""
ENOUGH = 0.5
"""Share from which a radius is proposed."""
EDGES = (2.5, 3.5, 5.0)
"""Radii that are tried for a proposal, in median edges of the coarser mesh: 2.5 reach a vertex's second neighbours."""
PER_MM = 1e-3


@dataclass(frozen=True, eq=False)
class CongruenceEvolution:
    """Means over FIXED's area, over frames and thresholds: relative curvatures and index [1/m], share with both [-]."""

    least: Float[np.ndarray, "t k"]
    most: Float[np.ndarray, "t k"]
    index: Float[np.ndarray, "t k"]
    share: Float[np.ndarray, "t k"]

    def columns(self) -> dict[str, Float[np.ndarray, " r"]]:
        """Frames outer, thresholds inner, as in `area.csv`."""
        return {
            "relative_curvature_min [1/mm]": self.least.ravel() * PER_MM,
            "relative_curvature_max [1/mm]": self.most.ravel() * PER_MM,
            "congruence_index [1/mm]": self.index.ravel() * PER_MM,
            "congruence_share [-]": self.share.ravel(),
        }


def congruence_evolution(bodies: Bodies, radius: float, name: str, motion: Motion) -> CongruenceEvolution:
    """Congruence of all frames, curvatures fitted within `radius` [m]; none over less than `LEAST` of the area."""
    pair = CongruencePair(bodies.moving, bodies.fixed, bodies.settings, radius)
    rotation = motion.poses.rotation.as_matrix().reshape(-1, 3, 3)
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    frames = []
    with listener().progress(f"{name or 'frames'}, congruence", len(motion)) as step:
        for turn, shift in zip(rotation, translation, strict=True):
            frames.append(pair.at(turn, shift))
            step()
    every = CongruenceEvolution(
        *(np.array([getattr(each, part) for each in frames]) for part in ("least", "most", "index", "share"))
    )
    label = f"{name}: " if name else ""
    found = _over_enough(bodies, radius, label, motion, every)
    _tell(bodies, radius, name, found)
    return found


def _over_enough(
    bodies: Bodies, radius: float, label: str, motion: Motion, found: CongruenceEvolution
) -> CongruenceEvolution:
    """The same without what is over too little of the area: a reservation, or a refusal where there is nothing else."""
    few = found.share < LEAST
    if not few.any():
        return found
    remedy = _remedy(bodies, radius, motion, found)
    if not np.isfinite(found.index).any():
        what = (
            f"{label}no congruence of {bodies.moving.name} and {bodies.fixed.name} in any frame, although they are near"
        )
        raise InputError("", "`congruence`", what, remedy)
    for k, threshold in enumerate(bodies.settings.thresholds):
        if few[:, k].any():
            low, high = found.share[few[:, k], k].min(), found.share[few[:, k], k].max()
            reserve(
                f"{label}no index of congruence within {threshold * 1e3:g} mm in {few[:, k].sum()} of {len(few)} "
                f"frames: both curvatures are known over {low:.0%} to {high:.0%} of the area, and {LEAST:.0%} are "
                f"needed; {remedy}"
            )
    least, most, index = (np.where(few, np.nan, part) for part in (found.least, found.most, found.index))
    return CongruenceEvolution(least, most, index, found.share)


def _remedy(bodies: Bodies, radius: float, motion: Motion, found: CongruenceEvolution) -> str:
    """A larger radius that works for the meshes, tried in the frame of the largest share; else what is the matter."""
    share = np.where(np.isfinite(found.share), found.share, -1.0)
    frame, k = np.unravel_index(int(np.argmax(share)), share.shape)
    pose = motion.poses[int(frame)]
    edges = [float(np.median(body.edge_length)) for body in (bodies.moving, bodies.fixed)]
    longest = EDGES[-1] * max(edges)
    for each in (float(np.ceil(factor * max(edges) * 1e4) * 1e-4) for factor in EDGES):
        if each <= radius:
            continue
        pair = CongruencePair(bodies.moving, bodies.fixed, bodies.settings, each)
        if pair.at(pose.rotation.as_matrix(), np.asarray(pose.translation)).share[k] >= ENOUGH:
            return (
                f"too few vertices lie within {radius * 1e3:g} mm: edges of the meshes are {edges[0] * 1e3:.2g} and "
                f"{edges[1] * 1e3:.2g} mm at the median, give `congruence` {each * 1e3:.3g}mm"
            )
    return (
        f"no radius to {longest * 1e3:.3g} mm does better, so the surfaces do not face each other there (turn over an "
        "open patch whose faces are wound inwards; look at the pose: where they overlap deeply their normals are not "
        "opposite)"
    )


def _tell(bodies: Bodies, radius: float, name: str, found: CongruenceEvolution) -> None:
    """Range of the index, and what it is not over."""
    summary: dict[str, object] = {"radius_mm": radius * 1e3}
    note(f"{name} congruence".lstrip(), summary)
    label = f"{name}: " if name else ""
    for k, threshold in enumerate(bodies.settings.thresholds):
        index, share = found.index[:, k], found.share[:, k]
        there = np.isfinite(index)
        if not there.any():
            continue
        low, high = (float(end) * PER_MM for end in (index[there].min(), index[there].max()))
        summary[f"index_per_mm_at_{threshold * 1e3:g}_mm"] = [round(low, 6), round(high, 6)]
        say(
            f"{label}index of congruence within {threshold * 1e3:g} mm: {low:.4f} … {high:.4f} 1/mm "
            f"(0 fits exactly), curvatures fitted within {radius * 1e3:g} mm"
        )
        worst = float(share[there].min())
        if worst < FEW:
            reserve(
                f"{label}the index of congruence is over {worst:.0%} of the area within {threshold * 1e3:g} mm in the "
                "worst frame: elsewhere the surfaces do not face each other, or too few vertices lie within "
                f"`congruence` {radius * 1e3:g} mm"
            )
