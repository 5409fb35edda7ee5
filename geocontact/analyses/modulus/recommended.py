"""Which of the moduli of total, medial and lateral force to use, and why."""

from __future__ import annotations

from geocontact.analyses.frame.words import rounded
from geocontact.analyses.modulus.identified import Identified
from geocontact.analyses.modulus.inputs import HALVES
from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.elastic_modulus.identify import agreement
from geocontact.identify.goodness_of_fit import DESCRIBES

TOTAL = "total"
ALIKE = 0.05
"""Relative difference up to which two values are one answer; also where their intervals overlap."""
MPA = 1e-6


def undescribed(found: Identified) -> dict[str, float]:
    """R² of the sides whose forces the law does not describe."""
    met = {side: agreement(each.measured, each.predicted)[1] for side, each in found.sides.items()}
    return {side: r2 for side, r2 in met.items() if r2 < DESCRIBES}


def recommended(found: Identified) -> tuple[str, ...]:
    """Sides whose E* is the answer: the total where both halves agree with it, else the halves.

    Hertz's law is of one patch: F grows with the power 3/2 of its area. Two patches of areas A and B carry
    (A^3/2 + B^3/2); read as one of area A + B the same force asks for a smaller E*, by √2 where A = B. The halves are
    read as they are.
    """
    halves = [side for side in HALVES if side in found.sides and side not in undescribed(found)]
    first = next(iter(found.sides))
    if first != TOTAL or len(halves) < len(HALVES):
        return (first,)
    return (TOTAL,) if all(_alike(found, TOTAL, side) for side in halves) else tuple(halves)


def reason(found: Identified) -> str:
    """Why those, in a sentence; "" where there is nothing to choose from."""
    chosen = recommended(found)
    halves = [side for side in HALVES if side in found.sides]
    if TOTAL not in found.sides or len(halves) < len(HALVES) or any(side in undescribed(found) for side in halves):
        return ""
    if chosen == (TOTAL,):
        return "use E* of the total: medial and lateral agree with it"
    total = f"the total's {_value(found, TOTAL)} MPa reads two patches as one contact, which the law is not for"
    if found.first.model.reading.name == "disc":
        total += "; reading discs takes them apart"
    if _alike(found, *HALVES):
        return f"use E* of the sides, which agree: {total}"
    return f"use E* of each side for that side, since they differ: {total}"


def agree_by_width(found: Identified) -> str:
    """What is to be said where sides are called alike only because their intervals overlap; else nothing."""
    if TOTAL not in found.sides or not reason(found):
        return ""
    chosen = recommended(found)
    pairs = [(TOTAL, side) for side in HALVES] if chosen == (TOTAL,) else [HALVES]
    for one, other in pairs:
        p, q = (found.sides[side].profiles[MODULUS] for side in (one, other))
        if _alike(found, one, other) and not _near(p.best, q.best):
            apart = abs(p.best - q.best) / max(p.best, q.best)
            what = f"E* of {one} and {other} is {apart:.0%} apart, and called alike since the intervals overlap"
            return f"{what}: the forces do not say whether they differ"
    return ""


def _near(one: float, other: float) -> bool:
    return abs(one - other) <= ALIKE * max(one, other)


def _alike(found: Identified, one: str, other: str) -> bool:
    p, q = (found.sides[side].profiles[MODULUS] for side in (one, other))
    return _near(p.best, q.best) or (p.lower <= q.upper and q.lower <= p.upper)


def _value(found: Identified, side: str) -> str:
    return rounded(found.sides[side].profiles[MODULUS].best * MPA)
