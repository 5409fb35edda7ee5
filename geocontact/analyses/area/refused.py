"""Options of an area analysis that contradict each other, or have no effect."""

from __future__ import annotations

from pathlib import Path

from geocontact.analyses.frame.shared_options import refuse_pose_sd
from geocontact.data.errors import InputError

LITERATURE = Path("literature")
"""In place of a table: published areas of knees."""


def refuse_comparison(compare: Path | None, tolerance: float | None, flexion: str | None) -> None:
    """What has no effect on the comparison that is asked for."""
    if compare == LITERATURE and tolerance is not None:
        what = "has no effect with `compare` literature: areas of other implants accept or refuse nothing"
        raise InputError("", "`tolerance`", what, "leave it out")
    if flexion is not None and compare != LITERATURE:
        raise InputError("", "`flexion`", "has no effect on your own table", "give `compare` literature")


def refuse_errors(
    rule: str, threshold: tuple[float, ...], draws: int | None, seed: int | None, pose_sd: tuple[float, ...] | None
) -> None:
    """What keeps errors of poses from being propagated; thresholds in m."""
    if rule not in ("refined", "clip"):
        raise InputError("", "`rule`", f"{rule} changes in jumps with the pose", "leave it out")
    if min(threshold) <= 0.0:
        raise InputError("", "`threshold`", "0 has no error of poses", "give a threshold above 0")
    if draws is not None and not 20 <= draws <= 1_000_000:
        raise InputError("", "`draws`", f"{draws} is not between 20 and 1000000", "give for example 400")
    refuse_pose_sd(pose_sd)
    if seed is not None and seed < 0:
        raise InputError("", "`seed`", f"{seed} is negative", "give 0 or more")
