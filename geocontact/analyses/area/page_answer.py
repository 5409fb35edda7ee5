"""The head of a contact page: the answer in sentences, and the few numbers that belong to it."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.area.page_sections import Told, in_mm
from geocontact.analyses.area.pressure import page as pressure
from geocontact.analyses.area.reference_areas import Compared
from geocontact.analyses.page_words import counted, rounded
from geocontact.data.evolution import MM, MM2


def part(name: str) -> str:
    """What a body is called in a sentence: the name of its file without the ending."""
    return name.rsplit(".", 1)[0] or name


def headline(told: Told, k: int) -> list[str]:
    """How much of FIXED is in contact within threshold `k`, or how hard it is pressed; measured areas beside it."""
    said = [_contact(told, k)]
    if told.pressures is not None:
        moving, fixed = part(told.moving.name), part(told.fixed.name)
        said.insert(0, pressure.sentence(told.pressures, told.motion.course, moving, fixed))
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
        f"Beside {counted(len(compared.rows), 'measured area')} the largest difference is {compared.largest:.1%}, "
        f"{verdict} the tolerance of {compared.tolerance:.1%}."
    )


def facts(told: Told, k: int) -> list[tuple[str, str]]:
    """How much, when, where."""
    e, course = told.evolution, told.motion.course
    area = e.fixed.area[:, k] * MM2
    largest, nearest = int(np.argmax(area)), int(np.argmin(e.min_distance))

    lines = [] if told.pressures is None else pressure.facts(told.pressures, course)
    lines.append(("Largest contact area on the fixed body", f"{area[largest]:.0f} mm² at {course.at(largest)}"))
    if told.pressures is None:
        span = f"{area.min():.0f} … {area.max():.0f} mm² (mean {area.mean():.0f} mm²)"
        lines.append(("Range over the motion", span))
        if area[largest] > 0.0:
            lines.append(("Where, in that frame", _where(told, largest, k)))
    word = "Deepest overlap" if e.min_distance[nearest] < 0.0 else "Smallest distance"
    lines.append((word, f"{abs(e.min_distance[nearest]) * MM:.2f} mm at {course.at(nearest)}"))
    return lines


def _where(told: Told, frame: int, k: int) -> str:
    e = told.evolution
    x, y, z = e.fixed.centroid[frame, k] * MM
    where = f"centroid x {x:.1f}, y {y:.1f}, z {z:.1f} mm"
    if e.medial_side:
        medial = e.medial[frame, k] / e.fixed.area[frame, k]
        where += f"; {medial:.0%} medial, {1.0 - medial:.0%} lateral"
    return where
