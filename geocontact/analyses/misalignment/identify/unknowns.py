"""What is known beforehand of the numbers of the elbow's law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from geocontact.analyses.misalignment.law_numbers import PER_SI, WRITTEN
from geocontact.axis_misalignment.law import ABSENT, NAMES, UNITS
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter

WIDEST = {
    "k": (10.0, 10e3),
    "x": (-0.15, 0.15),
    "y": (-0.15, 0.15),
    "l": (0.05, 0.5),
    "z": (-0.3, 0.3),
    "b": (-500.0, 500.0),
    "s": (-1e-3, 1e-3),
    "c": (0.0, 0.02),
}
"""Bounds of free numbers unless given, in SI units."""
BEGIN = {"k": 300.0, "x": 0.03, "y": 0.04, "l": 0.2, "z": 0.12, "b": 0.0, "s": 0.0, "c": 1e-3}
"""Starts of the explicit model's paper; that of c, a fixation of 1 N/mm, is invented."""

Values = Mapping[str, float]
Pairs = Mapping[str, tuple[float, float]]


def unknowns(known: Values, prior: Pairs, bounds: Pairs, start: Values, free: Sequence[str]) -> tuple[Parameter, ...]:
    """The numbers in the order of NAMES, in SI; InputError where what is told of them contradicts itself."""
    _refuse_free(free)
    for option, given in (("`bounds`", bounds), ("`start`", start), ("`prior`", prior)):
        _refuse_not_free(option, given, known, free)
    _refuse_bounds_and_priors(bounds, prior)
    _refuse_values(known, prior, bounds, start)
    made = []
    for name in NAMES:
        if name in known or (name in ABSENT and name not in free):
            value = known.get(name, ABSENT.get(name, 0.0))
            made.append(Parameter(name, UNITS[name], value, value, value, fixed=True))
        else:
            low, high = bounds.get(name, WIDEST[name])
            made.append(_free(name, low, high, start, prior))
    if all(p.fixed for p in made):
        raise InputError("", "`known`", "leaves nothing to be found", "leave a number out, or compare instead")
    return tuple(made)


def _free(name: str, low: float, high: float, start: Values, prior: Pairs) -> Parameter:
    first = start.get(name, prior[name][0] if name in prior else BEGIN[name])
    if name in start and not low <= first <= high:
        what = f"{name} = {first * PER_SI[name]:g} {WRITTEN[name]} is not between its bounds"
        raise InputError("", "`start`", what, "give another, or `bounds`")
    return Parameter(name, UNITS[name], min(max(first, low), high), low, high)


def _refuse_free(free: Sequence[str]) -> None:
    for name in free:
        if name not in ABSENT:
            raise InputError(
                "", "`free`", f"{name!r} is not b, s or c", "give one or more of b, s, c; the others are free"
            )


def _refuse_not_free(option: str, given: Mapping[str, object], known: Values, free: Sequence[str]) -> None:
    for name in given:
        if name in known:
            raise InputError("", option, f"{name} is known already", "give one")
        if name in ABSENT and name not in free:
            raise InputError("", option, f"{name} is not free", f"give `free` {name}")


def _refuse_bounds_and_priors(bounds: Pairs, prior: Pairs) -> None:
    for name, (low, high) in bounds.items():
        if not low < high:
            raise InputError("", "`bounds`", f"{name} has no room between its bounds", "give the lower one first")
    for name, (_, sd) in prior.items():
        if not sd > 0.0:
            what = f"{name} has an SD that is not above 0"
            raise InputError("", "`prior`", what, "give mean and SD, such as 185 and 10 mm for l")


def _refuse_values(known: Values, prior: Pairs, bounds: Pairs, start: Values) -> None:
    """Stiffness and link whose bounds are not positive."""
    for name in ("k", "l"):
        if name in bounds and not bounds[name][0] > 0.0:
            raise InputError("", "`bounds`", f"{name} may not be 0 or less", "give a lower bound above 0")
