"""A box of faces as an expression of `region`."""

from __future__ import annotations

from dataclasses import dataclass, field

NAMES = ("x", "y", "z", "nx", "ny", "nz")
STEPS = 1000
"""Steps of a slider from the least value to the largest."""
DIGITS = 5
"""Digits of a limit."""


@dataclass
class Box:
    """Limits of face centroids and normals, each at a step of its range.

    Parameters
    ----------
    ranges
        Least and largest value of each of `NAMES`.
    ends
        Steps of the lower and the upper limit; at an end of the range there is none.

    Examples
    --------
    >>> box = Box(((0.0, 10.0),) * 3 + ((-1.0, 1.0),) * 3)
    >>> box.drag(1, 0, 250)
    >>> box.drag(4, 1, 750)
    >>> box.expression
    'y>2.5 and ny<0.5'
    """

    ranges: tuple[tuple[float, float], ...]
    ends: dict[tuple[int, int], int] = field(default_factory=dict)

    def drag(self, axis: int, end: int, step: int) -> None:
        """Move the lower (0) or the upper (1) limit of an axis."""
        self.ends[axis, end] = step

    @property
    def expression(self) -> str:
        """What `region` reads; "" for the whole surface."""
        terms = []
        for axis, name in enumerate(NAMES):
            low, high = self.ranges[axis]
            for end, sign in enumerate("><"):
                step = self.ends.get((axis, end), end * STEPS)
                if step != end * STEPS:
                    terms.append(f"{name}{sign}{low + (high - low) * step / STEPS:.{DIGITS}g}")
        return " and ".join(terms)
