"""The head of the page of an identification: first whether the law describes the forces at all, then E*."""

from __future__ import annotations

from geocontact.analyses.modulus.identified import Identified, constant
from geocontact.analyses.page_words import rounded
from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.elastic_modulus.identify import agreement

DESCRIBES = 0.5
"""R² below which the law leaves more of a force's course than it describes: E* is no answer then."""
MPA = 1e-6


def undescribed(found: Identified) -> dict[str, float]:
    """R² of the sides whose forces the law does not describe."""
    met = {side: agreement(each.measured, each.predicted)[1] for side, each in found.sides.items()}
    return {side: r2 for side, r2 in met.items() if r2 < DESCRIBES}


def headline(found: Identified) -> list[str]:
    """Whether the law holds, E* of the first side, and a trial that was not used."""
    missed = undescribed(found)
    lines = [] if not missed else [_not_described(found, missed)]
    side, first = next(iter(found.sides.items()))
    p = first.profiles[MODULUS]
    value, span = f"{rounded(p.best * MPA)} MPa", f"95 % {rounded(p.lower * MPA)} … {rounded(p.upper * MPA)} MPa"
    rmse, r2 = agreement(first.measured, first.predicted)
    if side in missed:
        lines.append(f"E* of {value} ({span}) is only the number that fits the {_force(side)} best{_sticking(found)}.")
    else:
        lines.append(
            f"E* is {value} ({span}): the law{_sticking(found)} meets the {_force(side)} to {rmse:.0f} N, R² {_r2(r2)}."
        )
    lines += [
        f"In a trial not used it meets the {_force(told.side)} to {told.rmse:.0f} N, R² {_r2(told.r2)}."
        for told in found.predictions
        if told.measured is not None and told.side == side
    ]
    return lines


def _not_described(found: Identified, missed: dict[str, float]) -> str:
    flat = [side for side in missed if constant(found.sides[side])]
    if flat:
        return f"The law is not tested: the area is the same in every frame, the {_listed(flat)} is not."
    worse = ", a constant force would do better" if max(missed.values()) < 0.0 else ""
    shares = ", ".join(f"{side} {_r2(r2)}" for side, r2 in missed.items()) if len(missed) > 1 else _r2(*missed.values())
    return f"The law does not describe the {_listed(list(missed))}: R² {shares}{worse}."


def _sticking(found: Identified) -> str:
    """What the law holds the bodies together by, where it does; the work is given, not found."""
    sticks = found.first.model.adhesion
    return "" if sticks is None else f" with {sticks.words}"


def _listed(sides: list[str]) -> str:
    return f"{' and '.join(sides)} force" if sides != ["both"] else _force("both")


def _force(side: str) -> str:
    return "medial and lateral force" if side == "both" else f"{side} force"


def _r2(value: float) -> str:
    return f"{value:.2f}".replace("-", "−")


def facts(found: Identified) -> list[tuple[str, str]]:
    """E* of each side, then E for each stated Poisson's ratio of the first one; five at most."""
    lines = []
    for side, each in found.sides.items():
        p = each.profiles[MODULUS]
        span = f"{rounded(p.best * MPA)} MPa ({rounded(p.lower * MPA)} … {rounded(p.upper * MPA)})"
        lines.append((f"E*, {side}", span))
    side, first = next(iter(found.sides.items()))
    lines += [
        (f"E, {side}, for ν = {nu:g}", f"{rounded(first.modulus * (1.0 - nu**2) * MPA)} MPa") for nu in found.poisson
    ]
    return lines[:5]
