"""Work of adhesion that was identified beside E*: whether the forces separate it from none, and the pull-off force.

The pull of an adhesion law (`contact.adhesion`) is small beside the load of a joint, so only forces near zero show it.
Where its interval has no lower end within the bounds, bodies that do not stick fit as well. An error of the
force's zero acts much as the pull does: exactly so in the law DMT on a constant radius, which has no verdict therefore.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocontact.elastic_modulus.area_force import MODULUS, WORK, derivative
from geocontact.elastic_modulus.identify import Identification

STEP = 1e-4
"""Share of a number by which it is changed for its derivative."""
ALIKE = 0.9
"""Cosine from which on an error of the force's zero is said to act as the work of adhesion does."""
SAME = 0.99
"""Cosine from which on nothing of the work of adhesion is separable from an error of the force's zero; a choice."""


@dataclass(frozen=True)
class SurfaceEnergy:
    """Work of adhesion of one side.

    Parameters
    ----------
    law
        "dmt" or "jkr".
    work, lower, upper
        Estimate and interval of 95 % by profile likelihood [J/m^2].
    from_none
        Whether the interval has a lower end within the bounds: bodies that do not stick fit worse.
    limited
        Whether it has an upper end within them.
    from_modulus
        Whether E* does not act alike.
    pull_off, weakest, strongest
        Force at which the bodies come apart, of the estimate and both ends, on the radius of the frame with the least
        force; below 0 [N].
    radius
        That radius [m].
    as_zero
        Cosine between the force's change with w and an error of its zero, each less what E* explains.
    zero
        Mean pull over the frames [N]: an error of the zero of this size would be taken for w, as far as they are alike.
    """

    law: str
    work: float
    lower: float
    upper: float
    from_none: bool
    limited: bool
    from_modulus: bool
    pull_off: float
    weakest: float
    strongest: float
    radius: float
    as_zero: float
    zero: float

    @property
    def separable(self) -> bool:
        """Whether the forces identify it."""
        return self.from_none and self.limited and self.from_modulus and self.from_zero

    @property
    def from_zero(self) -> bool:
        """Whether an error of the force's zero acts otherwise than it does."""
        return self.as_zero < SAME

    @property
    def why(self) -> str:
        """Why they do not, as a clause."""
        if not self.from_modulus:
            return "is one number with E*"
        if not self.limited:
            return f"is not limited below {self.upper:.3g} J/m²: the pull stands for something that the law lacks"
        if not self.from_none:
            return f"is not separable from none: 95 % up to {self.upper:.3g} J/m²"
        alike = f"is not separable from an error of the force's zero (cosine {self.as_zero:.2f})"
        return f"{alike}: {self.zero:.3g} N of it would be taken for all of w"


def surface_energy(each: Identification) -> SurfaceEnergy | None:
    """The work of adhesion that was free; None where it was not."""
    sticks = each.model.sticking(each.fit.values)
    if sticks is None or WORK not in each.profiles:
        return None
    p, values, evolution = each.profiles[WORK], each.fit.values, each.model.evolution
    least = each.model.frames[int(np.argmin(each.measured))]
    radius = float(np.interp(least, evolution.time, evolution.with_offsets(values).radius))
    one = each.told_apart[f"E*, {WORK}"].verdict == "one number"
    without = each.model.force({**values, WORK: 0.0})
    return SurfaceEnergy(
        law=sticks.law,
        work=p.best,
        lower=p.lower,
        upper=p.upper,
        from_none=not p.lower_open,
        limited=not p.upper_open,
        from_modulus=not one,
        pull_off=sticks.pull_off(radius, p.best),
        weakest=sticks.pull_off(radius, p.lower),
        strongest=sticks.pull_off(radius, p.upper),
        radius=radius,
        as_zero=_as_zero(each),
        zero=float(np.mean(without - each.predicted)),
    )


def _as_zero(each: Identification) -> float:
    values = dict(each.fit.values)
    star, work = (derivative(each.model.force, values, name, STEP * values[name]) for name in (MODULUS, WORK))
    along = star / np.linalg.norm(star)
    rest = [column - along * (along @ column) for column in (work, np.ones(len(work)))]
    size = float(np.prod([np.linalg.norm(column) for column in rest]))
    return abs(float(rest[0] @ rest[1])) / size if size > 0.0 else float("nan")
