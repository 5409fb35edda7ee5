"""Options of an area analysis that contradict each other, or have no effect."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from geocontact.analyses.frame.shared_options import medial_side, refuse_pose_sd
from geocontact.data.errors import InputError

if TYPE_CHECKING:
    from geocontact.analyses.area.options import AreaOptions

LITERATURE = Path("literature")
"""In place of a table: published areas of knees."""


def refuse_sides(o: AreaOptions) -> None:
    """Sides and the medial one, which may contradict each other."""
    if o.split is not None:
        medial_side(o.split, o.side, o.medial)
    if o.medial is not None and o.side is not None and o.convention is None:
        raise InputError("", "`side`", "has no effect with `medial`, which says what is medial", "give one")


def refuse_comparison(o: AreaOptions) -> None:
    """What has no effect on the comparison that is asked for."""
    if o.compare == LITERATURE and o.tolerance is not None:
        what = "has no effect with `compare` literature: areas of other implants accept or refuse nothing"
        raise InputError("", "`tolerance`", what, "leave it out")
    if o.flexion is not None and o.compare != LITERATURE:
        raise InputError("", "`flexion`", "has no effect on your own table", "give `compare` literature")


def refuse_errors(o: AreaOptions) -> None:
    """What keeps errors of poses from being propagated."""
    if o.pose_sd is None and o.markers is None:
        return
    if o.rule not in ("refined", "clip"):
        raise InputError("", "`rule`", f"{o.rule} changes in jumps with the pose", "leave it out")
    if min(o.threshold) <= 0.0:
        raise InputError("", "`threshold`", "0 has no error of poses", "give a threshold above 0")
    if o.draws is not None and not 20 <= o.draws <= 1_000_000:
        raise InputError("", "`draws`", f"{o.draws} is not between 20 and 1000000", "give for example 400")
    refuse_pose_sd(o.pose_sd)
    if o.seed is not None and o.seed < 0:
        raise InputError("", "`seed`", f"{o.seed} is negative", "give 0 or more")
