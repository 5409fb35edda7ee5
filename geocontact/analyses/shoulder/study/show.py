"""What is shown of a study: errors of all arms in one drawing, curves of each arm, the answer in words."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.words import counted, headline
from geocontact.analyses.shoulder.study.cases import COPIED, StudyCase, summary_table
from geocontact.data.motion import Course
from geocontact.shoulder_exoskeleton.beside_recording import ALL, ELEVATION, FORCE, WORK
from geocontact.shoulder_exoskeleton.working_arm import SimulatedArm
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, stroke
from geocontact.view.page.content import IntervalRow, Intervals, Section

MOST = 24
"""Arms that are drawn."""
SHOWN = {ELEVATION: ("elevation of the exoskeleton's arm", "deg"), FORCE: ("force that lifts the arm", "N")}
"""Channels, with title and unit."""
UNITS = {"deg": "°", "N": " N"}
KINDS = {ELEVATION: "simulated", FORCE: "simulated", COPIED: "copied from the shoulder"}


def study_curves(cases: Sequence[StudyCase]) -> CurveSheet:
    """Both channels of each arm in its trial, the first 24: recorded, and simulated along both motions."""
    return CurveSheet([_panel(case, channel) for case in cases[:MOST] for channel in SHOWN], columns=4)


def _panel(case: StudyCase, channel: str) -> Curves:
    factor = float(np.degrees(1.0)) if channel == ELEVATION else 1.0
    time = case.within.simulation.motion.time
    curves = []
    if case.recorded is not None and channel in case.recorded.curves:
        seen = np.interp(time, case.recorded.time, case.recorded.curves[channel], np.nan, np.nan)
        curves.append(Curve("recorded", factor * seen, stroke=INK))
    for k, (name, arm) in enumerate((("motion in the device", case.within), ("motion without it", case.without))):
        if arm is not None:
            values = np.interp(time, arm.simulation.motion.time, _curve(arm, channel), np.nan, np.nan)
            curves.append(Curve(name, factor * values, stroke=stroke(k, k)))
    title, unit = SHOWN[channel]
    return Curves(f"{case.name}: {title}", unit, curves, over=Course("time", "s", time))


def normalised_curves(table: pd.DataFrame) -> CurveSheet:
    """Exoskeleton, shoulder and force of each arm over the work in per cent, both groups: the first 24 arms."""
    panels = []
    for (trial, side), rows in list(table.groupby(["trial", "arm"], sort=False))[:MOST]:
        groups = list(rows.groupby("motion recorded", sort=False))
        over = Course("work", "%", 100.0 * groups[0][1]["work [-]"].to_numpy())
        angles = [
            Curve(f"{what}, motion {group}", own[f"{what} [deg]"].to_numpy(), stroke=stroke(k, way))
            for k, (group, own) in enumerate(groups)
            for way, what in enumerate(("exoskeleton", "shoulder"))
        ]
        forces = [
            Curve(f"motion {group}", own["force [N]"].to_numpy(), stroke=stroke(k, k))
            for k, (group, own) in enumerate(groups)
        ]
        name = f"{trial}, {side} arm"
        panels += [
            Curves(f"{name}: elevation over the work", "deg", angles, over=over),
            Curves(f"{name}: force that lifts the arm over the work", "N", forces, over=over),
        ]
    return CurveSheet(panels, columns=4)


def _curve(arm: SimulatedArm, channel: str) -> Float[np.ndarray, " t"]:
    return arm.simulation.elevation if channel == ELEVATION else arm.simulation.supporting


def answer(cases: Sequence[StudyCase], sentences: Sequence[str]) -> tuple[str, ...]:
    """How far elevation and force are off, and joints at their stops; without recordings the run's own sentences."""
    sizes = _sizes(summary_table(cases), ALL)
    stops = headline([line for line in sentences if " is at a stop in all of " in line])
    if not sizes:
        return (*headline([line for line in sentences if " is at a stop in all of " not in line], most=2), *stops)
    arms = counted(sum(case.beside is not None for case in cases), "recorded arm")
    off = " and ".join(f"the {channel} by {size}" for channel, size in sizes.items())
    return (f"Over {arms} the simulation misses {off}: mean root mean square over the whole trial.", *stops)


def facts(summary: pd.DataFrame) -> list[tuple[str, str]]:
    """Error of each channel over the whole trial and over the work, mean of all arms."""
    return [
        (f"{channel}, {where}, RMSD", size)
        for part, where in ((ALL, "whole trial"), (WORK, "at work"))
        for channel, size in _sizes(summary, part).items()
    ]


def _sizes(summary: pd.DataFrame, part: str) -> dict[str, str]:
    rows = summary[(summary["part"] == part) & summary["channel"].isin(SHOWN)]
    return {str(row["channel"]): f"{row['rmsd']:.3g}{UNITS[str(row['unit'])]}" for row in rows.to_dict("records")}


def error_bars(errors: pd.DataFrame) -> list[Section]:
    """Error of every arm over its whole trial, a drawing for each channel; none where fewer than two were recorded."""
    whole = errors[errors["part"] == ALL]
    found: list[Section] = []
    for channels in ((ELEVATION, COPIED), (FORCE,)):
        own = whole[whole["channel"].isin(channels)]
        if own["trial"].size < 2 * len(channels):
            continue
        rows = [
            IntervalRow(f"{row['trial']}, {row['arm']}", float(row["rmsd"]), kind=KINDS[str(row["channel"])])
            for row in own.sort_values(["trial", "arm"], kind="stable").to_dict("records")
        ]
        title, unit = SHOWN[channels[0]]
        found.append(Intervals(f"Error of each arm: {title}, RMSD over the whole trial", unit, rows, bars=True))
    return found
