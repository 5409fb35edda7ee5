"""Tables of the page: what was identified, and what the data tell apart."""

from __future__ import annotations

import math

from geocontact.analyses.modulus.identified import Identified
from geocontact.analyses.modulus.numbers import PER_SI, UNITS
from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.elastic_modulus.identify import Identification, agreement
from geocontact.identify.identifiability import Identifiability
from geocontact.view.page.content import Table

Row = tuple[str, ...]


def moduli(found: Identified) -> Table:
    """Every free number of every side with its intervals, and E for each stated Poisson's ratio."""
    header = ("side", "number", "value", "profile likelihood, 95 %", "block bootstrap, 95 %", "RMSE [N]", "R²")
    rows: list[Row] = []
    for side, each in found.sides.items():
        rows += _free(side, each)
        rows += [
            (side, f"E for ν = {nu:g}", f"{each.modulus * (1.0 - nu**2) * 1e-6:.4g} MPa", "", "", "", "")
            for nu in found.poisson
        ]
    return Table("What was identified", header, rows)


def _free(side: str, each: Identification) -> list[Row]:
    rmse, r2 = agreement(each.measured, each.predicted)
    drawn = each.replicates
    rows: list[Row] = []
    for k, (name, p) in enumerate(each.profiles.items()):
        per, unit = (1e-6, "MPa") if name == MODULUS else (PER_SI[name], UNITS[name])
        label = "E*" if name == MODULUS else name
        blocks = "" if drawn is None else _span(float(drawn.lower[k]) * per, float(drawn.upper[k]) * per)
        profile = _span(p.lower * per, p.upper * per)
        rows.append((side, label, f"{p.best * per:.4g} {unit}", profile, blocks, f"{rmse:.0f}", f"{r2:.2f}"))
    return rows


def told_apart(found: Identified) -> Table:
    """Singular values and verdict of every group of numbers that somebody may want together."""
    header = ("side", "numbers", "singular values", "condition", "correlation", "verdict")
    rows = [_apart(side, group) for side, each in found.sides.items() for group in each.told_apart.values()]
    return Table("What the data tell apart", header, rows)


def _apart(side: str, group: Identifiability) -> Row:
    values = ", ".join(f"{value:.3g}" for value in group.singular_values)
    condition = f"{group.condition:.3g}" if math.isfinite(group.condition) else "infinite"
    correlation = f"{group.correlation[0, 1]:.4f}" if len(group.names) == 2 else "see modulus.json"
    return side, ", ".join(group.names), values, condition, correlation, group.verdict


def _span(low: float, high: float) -> str:
    return f"{low:.4g} … {high:.4g}"
