"""What designs and populations share: how the joint's axis wanders, states in words, tables of the page."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.frame import quantities
from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.axis_misalignment.axis_drift import STILL, AxisDrift, from_instant_centre, polynomial, table
from geocontact.axis_misalignment.planar_joint import FOLD, LOST, POLE, SOUND
from geocontact.data.errors import InputError
from geocontact.io.recordings.elbow_recording import read_axis_drift
from geocontact.view.page.content import Table

MODEL = (
    "A spring between limb and attachment, the joint a hinge whose axis stays or drifts as stated, slow motion: no "
    "damping, no friction in the compensation joint, no slip of the cuff, a rigid upper attachment. Stiffness and all "
    "lengths together are known up to one factor only, F(k/s, s · lengths) = F: a force measured at some angles gives "
    "the product, not its parts."
)
STATES = {SOUND: "ok", POLE: "pole", FOLD: "fold", LOST: "lost"}
WITHOUT_FORCE = (POLE, FOLD, LOST)
DIGITS = 9
"""Decimals of a number in the JSON: nanometres where it is in mm."""
EXAMPLE = "x=0:-8:2,y=0:5"


def drift(text: str, option: str) -> Path | dict[str, tuple[float, ...]]:
    """ "x=0:-8:2,y=0:5" (mm, mm/rad, mm/rad²) to coefficients in SI; else the file of that name."""
    path = quantities.named_file(text)
    if path is not None or "=" not in text:
        return path or Path(text)
    found: dict[str, tuple[float, ...]] = {}
    for part in text.split(","):
        name, _, numbers = (piece.strip() for piece in part.partition("="))
        if name not in ("x", "y") or name in found:
            raise InputError("", option, f"{part.strip()!r} is neither x=… nor y=…, once each", f"write {EXAMPLE}")
        found[name] = tuple(1e-3 * quantities.number(each, option, EXAMPLE) for each in numbers.split(":"))
    return found


def axis_drift(told: Path | Mapping[str, tuple[float, ...]] | None, span: tuple[float, float]) -> AxisDrift:
    """Drift of coefficients [m, m/rad, m/rad², …] or of a table; none where nothing is given.

    A table that does not hold all angles of `span` [rad] is used with a warning: it is held at its ends.
    """
    if told is None:
        return STILL
    drift = polynomial(told.get("x", ()), told.get("y", ())) if isinstance(told, Mapping) else _table(told, span)
    _doubt_travel(drift, span, "" if isinstance(told, Mapping) else f"{told}: ")
    return drift


TRAVEL = (0.3e-3, 0.06)
"""m; limits of this command, not of a source: axes of elbows move by a few mm, instant centres of knees by more."""


def _doubt_travel(drift: AxisDrift, span: tuple[float, float], file: str) -> None:
    """A warning for an axis that moves less or farther over a range [rad] than axes of joints do."""
    beta = np.linspace(*span, max(2, round(math.degrees(span[1] - span[0])) + 1))
    x, y = drift.at(beta).T
    way = float(max(np.ptp(x), np.ptp(y)))
    if 0.0 < way < TRAVEL[0] or way > TRAVEL[1]:
        least, most = (1e3 * each for each in TRAVEL)
        what = f"the axis moves by {1e3 * way:.3g} mm over the range; {least:g} to {most:g} are expected of joints"
        reserve(f"{file}`drift`: {what}: is it in mm, not in m, over angles in their unit, and no row wrong?")


def _table(file: Path, span: tuple[float, float]) -> AxisDrift:
    told = read_axis_drift(file)
    add_input("`drift`", file, rows=len(told.angle), tells=told.tells)
    if told.angle[0] > span[0] or told.angle[-1] < span[1]:
        ends, asked = (
            " to ".join(f"{math.degrees(a):.4g}" for a in two) for two in ((told.angle[0], told.angle[-1]), span)
        )
        reserve(f"{file}: angles from {ends} deg, asked for {asked}: beyond its ends the axis is assumed fixed")
    try:
        if told.tells == "instant centre":
            return from_instant_centre(told.angle, told.x, told.y)
        return table(told.angle, told.x, told.y, over_joint=told.tells == "joint")
    except ValueError as error:
        raise InputError(file, "", str(error), "give rising angles that hold the whole range") from error


def page_table(title: str, rows: pd.DataFrame) -> Table:
    """The table with four digits, for the page: what is not known is empty, what is infinite is ∞."""

    def text(value: object) -> str:
        if not isinstance(value, float):
            return str(value)
        if math.isnan(value):
            return ""
        return f"{value:.4g}" if math.isfinite(value) else f"{'−' if value < 0.0 else ''}∞"

    texts = rows.map(text)
    return Table(title, tuple(map(str, rows.columns)), texts.to_numpy().tolist())


def rounded(value: Any) -> Any:
    """The same with numbers rounded, and None for what is not finite."""
    if isinstance(value, dict):
        return {key: rounded(each) for key, each in value.items()}
    if isinstance(value, list):
        return [rounded(each) for each in value]
    if isinstance(value, float):
        return round(value, DIGITS) if math.isfinite(value) else None
    return value
