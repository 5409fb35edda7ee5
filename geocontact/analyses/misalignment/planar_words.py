"""What designs and populations have in common: states in words, tables of the page, rounded numbers."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from geocontact.axis_misalignment.planar_joint import FOLD, LOST, POLE, SOUND
from geocontact.view.page.content import Table

MODEL = (
    "A spring between limb and attachment, the joint a hinge whose axis stays or drifts as told, slow motion: no "
    "damping, no friction in the compensation joint, no slip of the cuff, a rigid upper attachment. Stiffness and all "
    "lengths together are known up to one factor only, F(k/s, s · lengths) = F: a force measured at some angles tells "
    "the product, not its parts."
)
STATES = {SOUND: "ok", POLE: "pole", FOLD: "fold", LOST: "lost"}
WITHOUT_FORCE = (POLE, FOLD, LOST)
DIGITS = 9
"""Decimals of a number in the JSON: nanometres where it is in mm."""


def page_table(title: str, rows: pd.DataFrame) -> Table:
    """The table with four digits, for the page."""
    texts = rows.map(lambda value: f"{value:.4g}" if isinstance(value, float) else str(value))
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
