"""What force, moment and angle of the arm identify of an elbow's numbers, each set of sensors by itself.

At the numbers that were fitted, from the derivatives of all measured means over their noise: standard errors are those
that the noise leaves were the law linear there, priors and the free joint's displacement left out. Where a set of
sensors identifies nothing in some direction (singular values of the derivatives over the logarithms), the numbers that
change along it have no standard error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.law import GROWING, SCALED
from geocontact.axis_misalignment.least_squares import ElbowFit, estimated
from geocontact.axis_misalignment.uncertainty import FLAT

MOVES = 1e-3  # part in the direction that is not identified, from which on a number changes along it


@dataclass(frozen=True, eq=False)
class KnownBy:
    """Standard errors with one set of sensors.

    Parameters
    ----------
    sensors
        "force", then what else: "moment of the cuff", "angle of the arm".
    names
        Free numbers, then in units of l the ratios that no scale changes: "k l", "x/l".
    values, errors
        In SI; NaN where a number is not identified.
    ratio
        Least singular value over the largest.
    """

    sensors: tuple[str, ...]
    names: tuple[str, ...]
    values: Float[np.ndarray, " p"]
    errors: Float[np.ndarray, " p"]
    ratio: float


def known_by(e: ElbowFit) -> list[KnownBy]:
    """Force alone, force with each other sensor, and all of them; empty where nothing but the force was measured."""
    if not e.problem.beside:
        return []
    rows = _rows(e)
    others = [each.name for each in e.problem.beside]
    sets = [(), *((name,) for name in others), *([tuple(others)] if len(others) > 1 else [])]
    return [_known(e, ("force", *more), np.vstack([rows[name] for name in ("force", *more)])) for more in sets]


def _rows(e: ElbowFit) -> dict[str, Float[np.ndarray, "_ p"]]:
    """Derivatives of the residuals by sensor."""
    jacobian, first = e.problem.jacobian(e.values), len(e.problem.force)
    found = {"force": jacobian[:first]}
    for each in e.problem.beside:
        found[each.name] = jacobian[first : first + len(each.means)]
        first += len(each.means)
    return found


def _known(e: ElbowFit, sensors: tuple[str, ...], rows: Float[np.ndarray, "n p"]) -> KnownBy:
    names = e.problem.names
    errors, ratio = _errors(e.values, rows)
    if not (e.problem.scalable and "l" in names):
        return KnownBy(sensors, names, e.values, errors, ratio)
    place, link = names.index("l"), e.named["l"]
    held = [name for name in names if name in SCALED and name != "l"]
    some = _errors(np.delete(e.values, place), np.delete(rows, place, axis=1))[0]
    per = np.array([1.0 / link if name in GROWING else link for name in held])
    own = [np.delete(np.arange(len(names)), place).tolist().index(names.index(name)) for name in held]
    words = tuple(f"{name}/l" if name in GROWING else f"{name} l" for name in held)
    values = per * e.values[[names.index(name) for name in held]]
    return KnownBy(sensors, names + words, np.append(e.values, values), np.append(errors, per * some[own]), ratio)


def _errors(values: Float[np.ndarray, " p"], rows: Float[np.ndarray, "n p"]) -> tuple[Float[np.ndarray, " p"], float]:
    """Standard errors, and the least singular value of the derivatives over logarithms over the largest."""
    size = np.where(values != 0.0, np.abs(values), 1.0)
    _, singular, directions = np.linalg.svd(rows * size, full_matrices=False)
    known = singular > FLAT * singular[0]
    errors = size * np.sqrt(np.sum((directions[known] / singular[known, None]) ** 2, axis=0))
    open_to = np.abs(directions[~known]).max(axis=0, initial=0.0) > MOVES
    return np.where(open_to, np.nan, errors), float(singular[-1] / singular[0])


def cost_with_moment_turned(e: ElbowFit) -> float | None:
    """Half the sum of squares of a fit to the moment with its sign turned; None without a moment."""
    turned = [each.turned() for each in e.problem.beside]
    if all(a is b for a, b in zip(turned, e.problem.beside, strict=True)):
        return None
    return estimated(e.problem.with_beside(turned)).cost


def over_noise(residual: Sequence[float] | Float[np.ndarray, " n"], nuisance: int) -> float:
    """Root mean square of weighted residuals, 1 where noise is all."""
    off = np.asarray(residual, float)
    return float(np.sqrt(off @ off / max(len(off) - nuisance, 1)))
