"""The answer of an area analysis in a few lines, and the facts beside it."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.area import pressure_page as pressure
from geocontact.analyses.area.page_sections import (
    Told,
    congruence_range,
    in_mm,
    largest_within,
)
from geocontact.analyses.area.wear import wear_facts
from geocontact.analyses.frame.words import counted, rounded
from geocontact.data.evolution import MM, MM2
from geocontact.geometry.contact_area.comparison import Compared


def part(name: str) -> str:
    """What a body is called in a sentence: the name of its file without the ending."""
    return name.rsplit(".", 1)[0] or name


def headline(told: Told, k: int) -> list[str]:
    """How much of FIXED is in contact within threshold `k`, or how hard it is pressed; measured areas beside it."""
    said = [_contact(told, k)]
    if told.pressures is not None:
        moving, fixed = part(told.moving.name), part(told.fixed.name)
        said.insert(0, pressure.sentence(told.pressures, told.motion.course, moving, fixed))
    if told.uncertainty is not None:
        low, high = largest_within(told.uncertainty, k)
        said.append(
            f"With the error of the pose the largest area is {low:.0f} … {high:.0f} mm² (95 %, "
            f"{len(told.uncertainty.error.draws)} draws)."
        )
    alike = congruence_range(told, k)
    if alike is not None:
        low, high, _ = alike
        said.append(
            f"The index of congruence is {_span(low, high)} 1/mm (0: they fit exactly): as of a sphere of "
            f"{_span(1.0 / high, 1.0 / low)} mm radius on a plane."
        )
    if told.compared is not None:
        said.append(_compared(told.compared))
    return said


def _contact(told: Told, k: int) -> str:
    e, course = told.evolution, told.motion.course
    area = e.fixed.area[:, k] * MM2
    most, nearest = int(np.argmax(area)), int(np.argmin(e.min_distance))
    fixed = part(told.fixed.name)
    within = f"within {in_mm(e, k)} of {part(told.moving.name)}"
    if not area[most] > 0.0:
        least = f"{e.min_distance[nearest] * MM:.3g} mm away, at {course.at(nearest)}"
        return f"{fixed} never comes {within}: at its nearest it is {least}."
    largest = f"Up to {rounded(area[most])} mm² of {fixed} lie {within}, at {course.at(most)}"
    return largest + (f"; the least is {rounded(area.min())} mm²." if len(area) > 1 else ".")


def _compared(compared: Compared) -> str:
    verdict = "within" if compared.accepted else "beyond"
    return (
        f"Against {counted(len(compared.rows), 'measured area')} the largest difference is {compared.largest:.1%}, "
        f"{verdict} the tolerance of {compared.tolerance:.1%}."
    )


def facts(told: Told, k: int) -> list[tuple[str, str]]:
    """How much, when, where."""
    e, course = told.evolution, told.motion.course
    area = e.fixed.area[:, k] * MM2
    largest, nearest = int(np.argmax(area)), int(np.argmin(e.min_distance))

    lines = [] if told.pressures is None else pressure.facts(told.pressures, course)
    lines += [] if told.wear is None else wear_facts(told.wear)
    lines.append(("Largest contact area on the fixed body", f"{area[largest]:.0f} mm² at {course.at(largest)}"))
    lines += _coverage(told, k)
    if told.pressures is None:
        span = f"{area.min():.0f} … {area.max():.0f} mm² (mean {area.mean():.0f} mm²)"
        lines.append(("Range over the motion", span))
        if area[largest] > 0.0:
            lines.append((f"Centre of the patch, at {course.at(largest)}", _where(told, largest, k)))
    lines += _uncertain_facts(told, k)
    word = "Deepest overlap" if e.min_distance[nearest] < 0.0 else "Smallest distance"
    lines.append((word, f"{abs(e.min_distance[nearest]) * MM:.2f} mm at {course.at(nearest)}"))
    return lines


def _coverage(told: Told, k: int) -> list[tuple[str, str]]:
    """Largest share of each region that is in contact."""
    e, course = told.evolution, told.motion.course
    lines = []
    for body, side in (("fixed", e.fixed), ("moving", e.moving)):
        if side.coverage is not None and side.region is not None:
            most = int(np.argmax(side.coverage[:, k]))
            share = f"{side.coverage[most, k]:.1%} of {side.region * MM2:.0f} mm² at {course.at(most)}"
            lines.append((f"Largest coverage of the {body} body's region", share))
    return lines


def _uncertain_facts(told: Told, k: int) -> list[tuple[str, str]]:
    """The largest area with the error of the pose, how well its SD is known, and the congruence."""
    lines = []
    u, alike = told.uncertainty, congruence_range(told, k)
    if u is not None:
        low, high = largest_within(u, k)
        sd, least, most = (u.deviation(k) * MM2)[:, int(np.argmax(u.drawn_sd(k)))]
        lines.append(("Largest area with the pose's error, 95 %", f"{low:.0f} … {high:.0f} mm²"))
        drawn = f"{sd:.3g} mm² (95 % {least:.3g} … {most:.3g}; {len(u.error.draws)} draws)"
        lines.append(("Largest SD of the area", drawn))
    if alike is not None:
        low, high, share = alike
        lines.append(("Index of congruence", f"{_span(low, high)} 1/mm, over {share:.0%} of the area or more"))
    return lines


def _span(low: float, high: float) -> str:
    """Two ends of three digits, or the one that both are."""
    ends = dict.fromkeys((f"{low:.3g}", f"{high:.3g}"))
    return " … ".join(ends)


def _where(told: Told, frame: int, k: int) -> str:
    e = told.evolution
    x, y, z = e.fixed.centroid[frame, k] * MM
    where = f"x {x:.1f}, y {y:.1f}, z {z:.1f} mm"
    if e.medial_side:
        medial = e.medial[frame, k] / e.fixed.area[frame, k]
        where += f"; {medial:.0%} medial, {1.0 - medial:.0%} lateral"
    return where
