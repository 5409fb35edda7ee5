"""E* of each side with its intervals, as the page draws it."""

from __future__ import annotations

from geocontact.analyses.modulus.identified import Identified
from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.view.page.content import IntervalRow, Intervals

MPA = 1e-6
WORDS = "95 % intervals. They hold what the force's noise leaves open, not what the law leaves out."


def modulus_intervals(found: Identified) -> Intervals:
    """By profile likelihood, and by block bootstrap where it was drawn."""
    rows = []
    for side, each in found.sides.items():
        profile, drawn = each.profiles[MODULUS], each.replicates
        best = profile.best * MPA
        rows.append(IntervalRow(f"{side}, profile likelihood", best, profile.lower * MPA, profile.upper * MPA))
        if drawn is not None:
            k = list(each.profiles).index(MODULUS)
            rows.append(IntervalRow(f"{side}, block bootstrap", best, drawn.lower[k] * MPA, drawn.upper[k] * MPA))
    return Intervals("Elastic modulus E*", "MPa", rows, words=WORDS)
