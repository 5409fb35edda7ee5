"""Whether two things are given in the same unit, and in the same size."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

UNITS = {"mm": 1e-3, "cm": 1e-2, "in": 0.0254, "m": 1.0}
ALIKE = 0.15  # relative difference of landmark distances that passes without a word
SPREAD = 2.0  # factor between landmark distances beyond which they are not those of one body in one unit
PART = 20.0  # factor between boxes beyond which one is not a part of the other: a hand on a whole body is 1 : 10


@dataclass(frozen=True)
class ScaleCheck:
    """Size of A over that of B, and what there is to say about it; an empty warning is none."""

    ratio: float
    warning: str = ""


def compare_landmarks(
    moving: Float[np.ndarray, "n 3"], fixed: Float[np.ndarray, "n 3"], names: tuple[str, str] = ("scan", "body model")
) -> ScaleCheck:
    """Scale between the same landmarks of A and B [m], by the root mean square distances from their centroids.

    A ratio outside 1/2 to 2 is refused, with the unit named that would explain it; one that is off by more than 15 % is
    reported as a warning: the bodies differ, or a landmark is the wrong one.
    """
    a, b = (float(np.sqrt(((p - p.mean(axis=0)) ** 2).sum(axis=1).mean())) for p in (moving, fixed))
    if not (a > 0.0 and b > 0.0):
        raise ValueError(f"the landmarks of the {names[0] if a <= 0.0 else names[1]} lie all in one place")
    ratio = a / b
    if not 1.0 / SPREAD < ratio < SPREAD:
        raise ValueError(_refusal("landmarks", a, b, names, 1.5))
    if abs(ratio - 1.0) <= ALIKE:
        return ScaleCheck(ratio)
    word = "larger" if ratio > 1.0 else "smaller"
    return ScaleCheck(
        ratio, f"the {names[0]} is {100.0 * abs(ratio - 1.0):.0f} % {word} than the {names[1]} by their landmarks"
    )


def compare_boxes(
    moving: Float[np.ndarray, "n 3"], fixed: Float[np.ndarray, "m 3"], names: tuple[str, str] = ("scan", "body model")
) -> ScaleCheck:
    """Diagonal of A's bounding box over that of B's [m].

    One may be a part of the other, so only factors beyond 20 are refused: metres taken for millimetres or centimetres,
    inches for metres; not centimetres for millimetres, which landmarks show.
    """
    a, b = (float(np.linalg.norm(np.ptp(p, axis=0))) for p in (moving, fixed))
    if not (a > 0.0 and b > 0.0):
        raise ValueError(f"the {names[0] if a <= 0.0 else names[1]} has no size")
    ratio = a / b
    if not 1.0 / PART < ratio < PART:
        raise ValueError(_refusal("box", a, b, names, PART))
    return ScaleCheck(ratio)


def _refusal(what: str, a: float, b: float, names: tuple[str, str], slack: float) -> str:
    """One line: what was compared, by how much it is off, and which unit explains it to within the factor `slack`."""
    big, small = (names[0], names[1]) if a > b else (names[1], names[0])
    largest, least = max(a, b), min(a, b)
    factor = largest / least
    start = (
        f"{what} of the {big} ({largest:.4g} m) and of the {small} ({least:.4g} m) differ by a factor of {factor:.4g}"
    )
    found = []
    for u, v in MISTAKES:
        k = UNITS[u] / UNITS[v]
        off = abs(float(np.log(factor / k)))
        if off < np.log(slack):
            found.append(
                (not OF_A_BODY[0] < largest / k < OF_A_BODY[1], off, f"the {big} is in {v} and was read as {u}")
            )
            found.append(
                (not OF_A_BODY[0] < least * k < OF_A_BODY[1], off, f"the {small} is in {u} and was read as {v}")
            )
    if not found:
        return f"{start}, which no unit explains; check that they belong together"
    odd, off, _ = min(found)
    return f"{start}: likely {' or '.join(text for *rank, text in found if rank == [odd, off])}"


MISTAKES = (("m", "mm"), ("m", "cm"), ("cm", "mm"), ("in", "mm"), ("m", "in"), ("in", "cm"))
"""Units that are taken for each other, the larger one first."""
OF_A_BODY = (0.01, 3.0)
"""Sizes of bodies, their parts and mats [m]."""
