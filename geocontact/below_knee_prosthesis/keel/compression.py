"""Bending stiffness of the keel and stiffness in series with it, from static compression at both ends of the range.

1/K(l) = C(l) EI / EI + 1/k is linear in the unknowns 1/EI and 1/k, so that two settings give both, and a third one of
known stiffness its fulcrum. With three stiffnesses and one fulcrum unknown nothing is left over to test the theory, and
how the posterior end is held cannot be told either: that choice moves EI by 5 %, the series stiffness by 20 %.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

from geocontact.below_knee_prosthesis.keel.beam import SHARE, Support, compression_stiffness, tip_compliance
from geocontact.identify.identifiability import Identifiability, identifiability


@dataclass(frozen=True)
class Compressed:
    """A static compression: fulcrum [m] and the stiffness that was measured there [N/m]."""

    fulcrum: float
    stiffness: float


@dataclass(frozen=True)
class CompressionFit:
    """What two compressions say.

    Parameters
    ----------
    length
        Of the keel [m].
    support
        How its posterior end is held, which was assumed.
    bending
        EI [N m²].
    series
        Stiffness of all that gives besides the keel [N/m]; infinite where nothing does.
    """

    length: float
    support: Support
    bending: float
    series: float

    def stiffness(self, fulcrum: float) -> float:
        """Of a compression [N/m]."""
        return compression_stiffness(fulcrum, self.length, self.bending, self.series, self.support)

    def fulcrum(self, stiffness: float, lowest: float, highest: float) -> float:
        """Where a stiffness [N/m] is reached [m]; ValueError where it is not within the range."""
        if not self.stiffness(lowest) <= stiffness <= self.stiffness(highest):
            raise ValueError(f"{stiffness:g} N/m is not reached between {lowest:g} and {highest:g} m")
        return float(brentq(lambda at: self.stiffness(at) - stiffness, lowest, highest, xtol=1e-12))


def fitted(low: Compressed, high: Compressed, length: float, support: Support) -> CompressionFit:
    """EI and series stiffness from two settings; ValueError where beam theory cannot span them."""
    unit = [tip_compliance(each.fulcrum, length, 1.0, support) for each in (low, high)]
    measured = [1.0 / each.stiffness for each in (low, high)]
    softness = (measured[0] - measured[1]) / (unit[0] - unit[1])
    rest = measured[1] - softness * unit[1]
    if not softness > 0.0 or rest < 0.0:
        raise ValueError(
            f"stiffnesses {low.stiffness:g} and {high.stiffness:g} N/m differ by more than a beam with a {support} end "
            f"does between {low.fulcrum:g} and {high.fulcrum:g} m, or not at all"
        )
    return CompressionFit(length, support, 1.0 / softness, 1.0 / rest if rest > 0.0 else np.inf)


def rounded(low: Compressed, high: Compressed, length: float, support: Support, half: float) -> list[CompressionFit]:
    """Fits to the four corners of stiffnesses that were rounded, by up to `half` [N/m] each."""
    return [
        fitted(
            Compressed(low.fulcrum, low.stiffness + a), Compressed(high.fulcrum, high.stiffness + b), length, support
        )
        for a, b in product((-half, half), repeat=2)
    ]


def told_apart(
    fulcrums: Float[np.ndarray, " n"], fit: CompressionFit, *, share: bool, place: bool = False
) -> Identifiability:
    """What compressions at some fulcrums tell apart: EI and series stiffness, and on demand more.

    Parameters
    ----------
    share
        Also how the posterior end is held: turn at the fulcrum over M l/EI, 1/3 pinned to 1/4 clamped.
    place
        Also where the plate presses, as a length L of the beam.

    Derivatives of the logarithm of the stiffness by those of the unknowns, so that errors are equal shares.
    ValueError for fewer fulcrums than unknowns.
    """
    names = ["bending", "series", *(["share"] if share else []), *(["place"] if place else [])]
    start = np.log([fit.bending, fit.series, SHARE[fit.support], fit.length])
    if len(fulcrums) < len(names):
        raise ValueError(f"{len(fulcrums)} compressions cannot tell {len(names)} numbers apart")
    chosen = [0, 1, *([2] if share else []), *([3] if place else [])]

    def logarithms(values: Float[np.ndarray, " four"]) -> Float[np.ndarray, " n"]:
        bending, series, part, length = np.exp(values)
        overhang = length - fulcrums
        compliance = (overhang**2 * part * fulcrums + overhang**3 / 3.0) / bending + 1.0 / series
        return np.asarray(-np.log(compliance))

    step = 1e-5
    columns = [(logarithms(start + step * e) - logarithms(start - step * e)) / (2.0 * step) for e in np.eye(4)[chosen]]
    return identifiability(names, np.stack(columns, axis=1))
