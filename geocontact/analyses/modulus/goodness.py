"""Whether a modulus agrees with the forces that it was identified from, and with what a modulus can be."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.analyses.modulus.identified import Identified
from geocontact.analyses.modulus.inputs import BOTH, HALVES
from geocontact.analyses.modulus.recommended import agree_by_width, recommended
from geocontact.data.plausible import ADHESION, BEARING, CONTACT
from geocontact.elastic_modulus.area_force import MODULUS, WORK, ThresholdAreas
from geocontact.elastic_modulus.identify import agreement
from geocontact.elastic_modulus.sensitivity import constant
from geocontact.identify.goodness_of_fit import DESCRIBES, Doubt, GoodnessOfFit, of_r2, of_size
from geocontact.identify.signals.agreement import likely_cause
from geocontact.trial_checks.twice import same_recordings

OFFSET, TAKEN = 0.1, 0.1
"""Parts of the largest force, and of the squared residual that may stay with a constant beside the law."""


OTHER_RADIUS, LARGER_RADIUS = 2.0, 1.6
"""Times the radius of a side, either way, and of all contacts together, above, that the given one may be. Bodies that
conform have a larger radius than either alone: 40 and 47 mm where the sample's femoral condyles have 37."""
EVEN = 1.5
"""Ratio of the area's growth over neighbouring thresholds below which it is even. On an insert of a knee that 4 mm
cover it falls threefold from one to the next."""


def goodness_of(found: Identified) -> GoodnessOfFit:
    """The law against the forces of every side, E* against its bounds and sizes, a trial that was not used."""
    doubts = [each for side in found.sides for each in _of_side(found, side)]
    for told in found.predictions:
        if told.measured is not None and told.r2 < 0.0:
            what = f"{told.side}, trial not used: R² is {told.r2:.2f}, a constant force would do better than the law"
            what += likely_cause(told.predicted, told.measured)
            doubts.append(Doubt(what, False))
    forces = {f"{side} force": each.measured for side, each in found.sides.items() if side != "total"}
    for one, other in same_recordings(forces):
        doubts.append(Doubt(f"{other} is the {one}, sample by sample: is a column copied?", False))
    doubts += _of_exchanged(found)
    for told in found.predictions:
        own = found.sides.get(told.side)
        if own is not None and told.measured is not None and same_recordings({"a": own.measured, "b": told.measured}):
            doubts.append(Doubt(f"{told.side}, trial not used: its force is that of the trial that was used", False))
    if words := agree_by_width(found):
        doubts.append(Doubt(words, False))
    return GoodnessOfFit(tuple(doubts), tuple(f"{side} force" for side in found.sides))


DIFFER, AGREE = 1.3, 0.03
"""Ratio of the moduli of both sides, and how near they come to each other where forces of the sides are exchanged."""


def _of_exchanged(found: Identified) -> Iterable[Doubt]:
    """A doubt for two sides whose moduli differ, and would agree if each had the other's force."""
    if not {"medial", "lateral"} <= set(found.sides):
        return
    sides = [found.sides[name] for name in ("medial", "lateral")]
    modulus = [float(np.sqrt(each.profiles[MODULUS].lower * each.profiles[MODULUS].upper)) for each in sides]
    force = [float(np.sqrt(np.nanmean(each.measured**2))) for each in sides]
    if not min(*modulus, *force) > 0.0:
        return
    ratio, exchanged = modulus[0] / modulus[1], modulus[0] / modulus[1] * (force[1] / force[0]) ** 2
    if max(ratio, 1.0 / ratio) > DIFFER and abs(exchanged - 1.0) < AGREE:
        what = f"E* of the sides differs by a factor of {max(ratio, 1.0 / ratio):.2f}, and would agree"
        yield Doubt(f"{what} if medial and lateral forces were exchanged: are their columns?", False)


def radius_by_areas(areas: ThresholdAreas) -> float:
    """Radius R of a contact by how its area A grows with the threshold T, dA/dT = 2 pi R [m]; NaN where none shows it.

    Of two surfaces whose distance is d0 + r^2/(2 R), the area nearer than T is 2 pi R (T - d0) (a paraboloid's; without
    load). Two contacts at once show the sum of their radii. Where growth changes by more than `EVEN` from one threshold
    to the next, the surface ends or is no paraboloid: no radius shows, nor in fewer than three thresholds.
    """
    grown = np.diff(areas.area, axis=1)[areas.area[:, 0] > 0.0] / np.diff(areas.thresholds)
    steps = np.median(grown, axis=0) if grown.size else np.zeros(0)
    even = len(steps) > 1 and np.all(steps > 0.0) and np.all(np.abs(np.diff(np.log(steps))) < np.log(EVEN))
    return float(np.median(grown) / (2.0 * np.pi)) if even else float("nan")


def _of_radius(side: str, areas: ThresholdAreas) -> Iterable[Doubt]:
    """A doubt for a radius that is not that by which the area grows with the threshold."""
    shown, given = radius_by_areas(areas), float(np.median(areas.radius))
    if side not in (BOTH, *HALVES):  # one contact, or the sum of two
        far = given > LARGER_RADIUS * shown > 0.0
    else:
        far = shown > 0.0 and max(given / shown, shown / given) > OTHER_RADIUS
    if far:
        what = f"{side}: the area grows with the threshold as on a radius of {1e3 * shown:.3g} mm, dA/dT = 2 pi R, and"
        yield Doubt(f"{what} R is {1e3 * given:.4g} mm: is one of them a diameter, or in another unit?", False)


def _of_zero(side: str, measured: Float[np.ndarray, " n"], predicted: Float[np.ndarray, " n"]) -> Iterable[Doubt]:
    """A doubt for a force that is not zero without contact: a constant beside the law takes most of what it leaves."""
    design = np.column_stack([predicted, np.ones_like(predicted)])
    (_, offset), *_ = np.linalg.lstsq(design, measured, rcond=None)
    left = float(np.sum((measured - design @ np.linalg.lstsq(design, measured, rcond=None)[0]) ** 2))
    if abs(offset) > OFFSET * np.max(np.abs(measured)) and left < TAKEN * float(np.sum((measured - predicted) ** 2)):
        what = f"{side}: a constant of {offset:.0f} N beside the law takes all but {TAKEN:.0%} of the squared residual"
        yield Doubt(f"{what}: is the force zero without contact?", False)


def _of_side(found: Identified, side: str) -> Iterable[Doubt]:
    """Doubts on one side; what a side alone shows contradicts the result where its E* is the answer."""
    each, used = found.sides[side], side in recommended(found)
    _, r2 = agreement(each.measured, each.predicted)
    flat = constant(each)
    if flat:
        yield Doubt(f"{side}: the area is the same in every frame: the law cannot be checked", False)
    for doubt in of_r2(f"{side} force by the law", r2):
        yield Doubt(doubt.what, used and not flat, -r2)
    if not flat:
        yield from _of_zero(side, each.measured, each.predicted)
    if 0.0 <= r2 < DESCRIBES and not flat:
        yield Doubt(f"{side}: R² is {r2:.2f}, the law leaves most of the force's course unexplained", False)
    for name in each.on_bound:
        yield Doubt(f"{side}: the data do not limit {name} within its bounds, on one side or both", False)
    profile = each.profiles[MODULUS]
    yield from of_size(f"{side}: E*", (profile.lower, profile.upper), CONTACT)
    pressure = float(np.nanmax(each.measured) / each.model.evolution.area.max())
    for doubt in of_size(f"{side}: largest force over largest area", (pressure, pressure), BEARING):
        yield replace(doubt, what=f"{doubt.what}: is the force in N, and are the areas in mm²?", contradicts=False)
    if (work := each.profiles.get(WORK)) and not work.upper_open:
        yield from of_size(f"{side}: work of adhesion", (work.lower, work.upper), ADHESION)
    if each.model.reading.name != "strip":
        yield from _of_radius(side, each.model.evolution)
    yield from _of_width(side, each.model.evolution, strip=each.model.reading.name == "strip")


def _of_width(side: str, areas: ThresholdAreas, *, strip: bool) -> Iterable[Doubt]:
    """A doubt for an area that is wider than the contact's radius: as a circle, or as a strip of the stated length."""
    if strip:
        half, radius = float(areas.area.max()) / (2.0 * areas.length), float(np.max(areas.radius))
        if half > radius:
            what = f"{side}: the largest area is {2e3 * half:.1f} mm wide on a strip of {1e3 * areas.length:.4g} mm"
            yield Doubt(f"{what}, more than twice the radius, {1e3 * radius:.4g} mm: is its length in mm?", False)
        return
    width, radius = float(np.sqrt(areas.area.max() / np.pi)), float(np.max(areas.radius))
    if width > radius:
        what = f"{side}: the largest area is that of a circle of {1e3 * width:.1f} mm, wider than the radius of the"
        yield Doubt(f"{what} contact, {1e3 * radius:.4g} mm: is that radius in mm, and are the areas in mm²?", False)
