"""A point beside a line: how far along it, and what leads from the line to the point.

Scalar in, scalar out: columns of arrays and CasADi symbols go through the same lines, so that a tube's distance and the
contact inside of it in a simulation are one formula.
"""

from __future__ import annotations

from typing import Any, TypeVar

X = TypeVar("X", bound=Any)
"""A number, a column or a symbol."""


def off_axis(offset: tuple[X, X, X], axis: tuple[X, X, X]) -> tuple[X, tuple[X, X, X]]:
    """Distance along a unit vector, and the part of the offset that is across it, in the same axes.

    Parameters
    ----------
    offset
        From any point of the line to the point [m].
    axis
        Unit vector along the line.
    """
    along = offset[0] * axis[0] + offset[1] * axis[1] + offset[2] * axis[2]
    return along, (offset[0] - along * axis[0], offset[1] - along * axis[1], offset[2] - along * axis[2])
