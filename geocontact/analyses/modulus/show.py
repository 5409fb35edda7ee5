"""What is shown of a modulus: the static figure, and the page with its answer, intervals and tables."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from geocontact.analyses.frame.collector import contradicted, if_it_fits
from geocontact.analyses.frame.words import NOT_A_DEVICE, rounded
from geocontact.analyses.modulus.identified import PER_SI, UNITS, Identified
from geocontact.analyses.modulus.recommended import MPA, reason, recommended, undescribed
from geocontact.data.motion import Course
from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.elastic_modulus.identify import Identification, agreement
from geocontact.elastic_modulus.sensitivity import constant
from geocontact.identify.identifiability import Identifiability
from geocontact.identify.intervals.profile_likelihood import Profile
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Limit, Points, Shade, stroke
from geocontact.view.page.content import IntervalRow, Intervals, Page, Section, Table, Words

RISE = 2.0
"""Largest rise of a profile that is drawn, in cuts."""


def modulus_curves(found: Identified) -> CurveSheet:
    """Forces of each side over time, measured and by the law, and the profiles of E*.

    A profile is the rise of the sum of squares in units of the cut: the interval of 95 % ends where it is 1.
    """
    pairs = found.curves()
    panels = [
        Curves(
            f"Contact force, {side}",
            "N",
            [Curve("measured", pair.measured, stroke=INK), Curve("by the law", pair.predicted, stroke=0)],
        )
        for side, pair in pairs.items()
    ]
    profiles = {side: each.profiles[MODULUS] for side, each in found.sides.items()}
    lines = [
        Points(side, p.values * MPA, np.where(p.rise <= RISE, p.rise, np.nan), stroke(k + 1, k), joined=True)
        for k, (side, p) in enumerate(profiles.items())
    ]
    reach = np.concatenate([line.time for line in lines])
    profile = Curves(
        "Rise of the sum of squares away from the best E*",
        "cuts at 95 %",
        [],
        points=lines,
        limits=[Limit("95 % interval ends", 1.0)],
        spans=[Shade("best values", p.best * MPA, p.best * MPA) for p in profiles.values()],
        over=Course("E*", "MPa", np.array([reach.min(), reach.max()])),
        words=PROFILE,
    )
    return CurveSheet([*panels, profile], Course("time", "s", next(iter(pairs.values())).time))


def headline(found: Identified) -> list[str]:
    """Whether the law holds, E* of the sides to use and why those, and a trial that was not used."""
    missed = undescribed(found)
    lines = [] if not missed else [_not_described(found, missed)]
    if contradicted():
        return lines
    chosen = recommended(found)
    lines.append(_answer(found, chosen, missed))
    why = reason(found)
    lines += [f"{why[0].upper()}{why[1:]}."] if why else []
    lines += [
        f"In a trial not used it meets the {_force(told.side)} to {told.rmse:.0f} N, R² {_r2(told.r2)}."
        for told in found.predictions
        if told.measured is not None and told.side in chosen
    ]
    return lines


def _answer(found: Identified, chosen: tuple[str, ...], missed: dict[str, float]) -> str:
    """E* of one side with how well the law meets its force, or of medial and lateral."""
    each = {side: found.sides[side] for side in chosen}
    values = {side: _with_interval(one.profiles[MODULUS]) for side, one in each.items()}
    if len(chosen) > 1:
        met = " and ".join(f"{agreement(one.measured, one.predicted)[0]:.0f} N" for one in each.values())
        shown = ", ".join(f"{value} {side}" for side, value in values.items())
        return f"E* is {shown}: the law{_sticking(found)} meets these forces to {met}."
    side = chosen[0]
    rmse, r2 = agreement(each[side].measured, each[side].predicted)
    if side in missed:
        return f"E* of {values[side]} is only the number that fits the {_force(side)} best{_sticking(found)}."
    met = f"the law{_sticking(found)} meets the {_force(side)} to {rmse:.0f} N, R² {_r2(r2)}"
    return f"E* is {values[side]}: {met}."


def _with_interval(p: Profile) -> str:
    """ "1.415 MPa (95 % 1.406 … 1.424 MPa)"."""
    return f"{rounded(p.best * MPA)} MPa (95 % {rounded(p.lower * MPA)} … {rounded(p.upper * MPA)} MPa)"


def _not_described(found: Identified, missed: dict[str, float]) -> str:
    flat = [side for side in missed if constant(found.sides[side])]
    if flat:
        return f"The law is not tested: the area is the same in every frame, the {_listed(flat)} is not."
    worse = ", a constant force would do better" if max(missed.values()) < 0.0 else ""
    shares = ", ".join(f"{side} {_r2(r2)}" for side, r2 in missed.items()) if len(missed) > 1 else _r2(*missed.values())
    return f"The law does not describe the {_listed(list(missed))}: R² {shares}{worse}."


def _sticking(found: Identified) -> str:
    """What the law holds the bodies together by, where it does."""
    sticks = found.first.model.sticking(found.first.fit.values)
    return "" if sticks is None else f" with {sticks.words}"


def _listed(sides: list[str]) -> str:
    return f"{' and '.join(sides)} force" if sides != ["both"] else _force("both")


def _force(side: str) -> str:
    return "medial and lateral force" if side == "both" else f"{side} force"


def _r2(value: float) -> str:
    return f"{value:.2f}".replace("-", "−")


def facts(found: Identified) -> list[tuple[str, str]]:
    """E* of each side, those to use first, then E of the first for each stated Poisson's ratio; five at most."""
    lines = []
    chosen = recommended(found)
    sides = {side: found.sides[side] for side in (*chosen, *(other for other in found.sides if other not in chosen))}
    for side, each in sides.items():
        p = each.profiles[MODULUS]
        interval = if_it_fits(f" ({rounded(p.lower * MPA)} … {rounded(p.upper * MPA)})")
        span = f"{rounded(p.best * MPA)} MPa{interval}"
        use = (
            ""
            if contradicted()
            else "use"
            if len(sides) > 1 and side in chosen
            else "do not use"
            if len(sides) > 1 and reason(found)
            else ""
        )
        lines.append((", ".join(filter(None, (f"E*, {side}", use))), span))
    side, first = next(iter(sides.items()))
    lines += [
        (f"E, {side}, for ν = {nu:g}", f"{rounded(first.modulus * (1.0 - nu**2) * MPA)} MPa") for nu in found.poisson
    ]
    return lines[:5]


WORDS = "95 % intervals. They include the noise of the force, not errors of the law."


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
    return Table("What the data separate", header, rows)


def _apart(side: str, group: Identifiability) -> Row:
    values = ", ".join(f"{value:.3g}" for value in group.singular_values)
    condition = f"{group.condition:.3g}" if math.isfinite(group.condition) else "infinite"
    correlation = f"{group.correlation[0, 1]:.4f}" if len(group.names) == 2 else "see modulus.json"
    return side, ", ".join(group.names), values, condition, correlation, group.verdict


def _span(low: float, high: float) -> str:
    return f"{low:.4g} … {high:.4g}"


PROFILE = "How far the sum of squares rises when E* is held away from its best value: an interval of 95 % ends at 1."
LAW = (
    "The law computes one force from one area. It has no friction, no damping and no creep. It uses the area of "
    "rigid surfaces within a threshold as the area of an elastic contact: E* describes a material only as far as "
    "this holds. Compare the table of thresholds and readings."
)


def modulus_page(title: str, found: Identified, curves: CurveSheet, tables: Sequence[Table]) -> Page:
    """The page before it becomes a file; it opens with E*, or with the forces where the law does not describe them.

    Parameters
    ----------
    curves
        Those of `modulus_curves`.
    tables
        Results first.
    """
    first = next(iter(found.curves().values()))
    forces: list[Section] = [*curves.panels]
    intervals = modulus_intervals(found)
    sections: list[Section] = [
        *([*forces, intervals] if undescribed(found) else [intervals, *forces]),
        tables[0],
        Words("What the data cannot identify", found.not_identifiable()),
        *tables[1:],
        Words("What the numbers do not contain", [LAW, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle=_subtitle(found),
        time=first.time,
        time_label="time [s]",
        headline=headline(found),
        facts=facts(found),
        start_frame=int(np.argmax(first.measured)),
        sections=tuple(sections),
        plays=False,
    )


def _subtitle(found: Identified) -> str:
    sticks = found.first.model.sticking(found.first.fit.values)
    source = "which was identified" if found.surfaces else "which is given"
    law = "the area-integrated Hertz law" if sticks is None else f"Hertz's law less {sticks.words}, {source}"
    return f"Elastic modulus of a contact by {law}"
