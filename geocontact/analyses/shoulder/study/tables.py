"""Tables of a study: errors by trial and arm and over all, differences of both groups, passive joints."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.shoulder.recorded_channels import FORCE
from geocontact.analyses.shoulder.study.case import StudyCase, screw_in
from geocontact.shoulder_exoskeleton.device import JOINTS

DEG = float(np.degrees(1.0))
DIFFERENCES = ("exoskeleton [deg]", "shoulder [deg]", "force [N]", "shoulder less exoskeleton [deg]")


def shown_in(channel: str) -> tuple[str, float]:
    """Unit of a channel's errors, and how many of it one SI unit is."""
    return ("N", 1.0) if channel == FORCE else ("deg", DEG)


def error_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """One row for each trial, arm, channel and part of the trial."""
    rows = []
    for case in cases:
        t = case.trial
        for channel, errors in case.errors.items():
            unit, factor = shown_in(channel)
            for part, a in errors.items():
                numbers = {"mae": a.mae * factor, "rmsd": a.rmsd * factor, "bias": a.bias * factor, "r2 [-]": a.r2}
                words = {
                    "trial": t.name,
                    "arm": case.within.side,
                    "person": t.person,
                    "task": t.task,
                    "level": t.level,
                    "channel": channel,
                }
                rows.append({**words, "part": part, "unit": unit, **numbers, "samples": a.samples})
    of = ["trial", "arm", "person", "task", "level", "channel", "part", "unit"]
    return pd.DataFrame(rows, columns=[*of, "mae", "rmsd", "bias", "r2 [-]", "samples"])


def summary_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """Means over all arms and trials, each counting the same, with the standard deviation of the RMSD between them."""
    errors = error_table(cases)
    rows = []
    for (channel, part), group in errors.groupby(["channel", "part"], sort=False):
        spread = float(group["rmsd"].std(ddof=1)) if len(group) > 1 else float("nan")
        means = {name: float(group[name].mean()) for name in ("mae", "rmsd", "bias")}
        unit = str(group["unit"].iloc[0])
        rows.append({"channel": channel, "part": part, "unit": unit, **means, "sd of rmsd": spread, "arms": len(group)})
    return pd.DataFrame(rows, columns=["channel", "part", "unit", "mae", "rmsd", "bias", "sd of rmsd", "arms"])


def difference_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """Means over the screw-in, motion recorded in the device less that without it; last row: means of their sizes.

    The last column is of the motion recorded in the device: what copying joint angles would miss.
    """
    rows: list[dict[str, object]] = []
    for case in cases:
        if case.without is None:
            continue
        one, two = screw_in(case.within), screw_in(case.without)
        values = (
            DEG * (one.exoskeleton - two.exoskeleton),
            DEG * (one.shoulder - two.shoulder),
            one.force - two.force,
            DEG * (one.shoulder - one.exoskeleton),
        )
        rows.append({"trial": case.trial.name, "arm": case.within.side, **dict(zip(DIFFERENCES, values, strict=True))})
    table = pd.DataFrame(rows, columns=["trial", "arm", *DIFFERENCES])
    if len(table):
        table.loc[len(table)] = ["mean", "both", *table[list(DIFFERENCES)].abs().mean()]
    return table


def passive_table(cases: Sequence[StudyCase]) -> pd.DataFrame:
    """How far the passive joints move, and how the sphere does in the cuff, in both groups."""
    rows = []
    for case in cases:
        for group, arm in (("in the device", case.within), ("without it", case.without)):
            if arm is None:
                continue
            s = arm.simulation
            spans = {
                f"{joint} {end} [deg]": DEG * float(getattr(s.angles[:, k], end)())
                for k, joint in enumerate(JOINTS[:-1])
                for end in ("min", "max")
            }
            slip = {"slip [mm]": 1e3 * float(s.slip[-1]), "out of the cuff [-]": float(s.out_of_cuff.mean())}
            rows.append({"trial": case.trial.name, "arm": case.within.side, "motion recorded": group, **spans, **slip})
    return pd.DataFrame(rows)
