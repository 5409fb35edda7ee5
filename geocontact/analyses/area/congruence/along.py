"""Congruence over a motion, frame by frame: from options to numbers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.area.read import Bodies
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.congruence import CongruencePair

FEW = 0.9
"""Share of the contact area that has both curvatures, below which a warning says so."""
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


def congruence_evolution(
    record: Record, bodies: Bodies, radius: float, name: str, motion: Motion
) -> CongruenceEvolution:
    """Congruence of all frames, curvatures fitted within `radius` [m]."""
    pair = CongruencePair(bodies.moving, bodies.fixed, bodies.settings, radius)
    rotation = motion.poses.rotation.as_matrix().reshape(-1, 3, 3)
    translation = np.asarray(motion.poses.translation).reshape(-1, 3)
    frames = []
    with record.listener.progress(f"{name or 'frames'}, congruence", len(motion)) as step:
        for turn, shift in zip(rotation, translation, strict=True):
            frames.append(pair.at(turn, shift))
            step()
    found = CongruenceEvolution(
        *(np.array([getattr(each, part) for each in frames]) for part in ("least", "most", "index", "share"))
    )
    _tell(record, bodies, radius, name, found)
    return found


def _tell(record: Record, bodies: Bodies, radius: float, name: str, found: CongruenceEvolution) -> None:
    """Range of the index, and what it is not over."""
    summary: dict[str, object] = {"radius_mm": radius * 1e3}
    record.results[f"{name} congruence".lstrip()] = summary
    label = f"{name}: " if name else ""
    _refuse_without_any(bodies, radius, label, found)
    for k, threshold in enumerate(bodies.settings.thresholds):
        index, share = found.index[:, k], found.share[:, k]
        there = np.isfinite(index)
        if not there.any():
            if np.isfinite(share).any():
                record.warn(
                    f"{label}no index of congruence within {threshold * 1e3:g} mm: nothing of the area there has both "
                    f"curvatures and faces the other surface"
                )
            continue
        low, high = (float(end) * PER_MM for end in (index[there].min(), index[there].max()))
        summary[f"index_per_mm_at_{threshold * 1e3:g}_mm"] = [round(low, 6), round(high, 6)]
        record.say(
            f"{label}index of congruence within {threshold * 1e3:g} mm: {low:.4f} … {high:.4f} 1/mm "
            f"(0 fits exactly), curvatures fitted within {radius * 1e3:g} mm"
        )
        worst = float(np.nanmin(share))
        if worst < FEW:
            record.warn(
                f"{label}the index of congruence is over {worst:.0%} of the area within {threshold * 1e3:g} mm in the "
                "worst frame: elsewhere the surfaces do not face each other, or too few vertices lie within "
                f"`congruence` {radius * 1e3:g} mm"
            )


def _refuse_without_any(bodies: Bodies, radius: float, label: str, found: CongruenceEvolution) -> None:
    """Surfaces that are near in some frame, and never have a value at any threshold, are refused."""
    if np.isfinite(found.index).any() or not np.isfinite(found.share).any():
        return
    what = f"{label}no congruence of {bodies.moving.name} and {bodies.fixed.name} in any frame, although they are near"
    remedy = (
        f"either too few vertices lie within {radius * 1e3:g} mm (give a radius of several edges of the meshes), or "
        "the surfaces do not face each other (turn over an open patch whose faces are wound inwards; look at the "
        "pose: where they overlap deeply their normals are not opposite)"
    )
    raise InputError("", "`congruence`", what, remedy)
