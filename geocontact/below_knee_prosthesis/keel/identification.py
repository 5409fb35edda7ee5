"""EI of a keel, what gives in series with it, and fulcrums that are not known, from static compressions.

Beam theory: a plate that presses with F on the keel moves by

    d = F (C(l)/EI + 1/k) + d0

with C(l) the compliance at EI 1 and fulcrum l (`sections`), k the stiffness of all that gives besides the keel, and d0
where the plate first touches. Least squares of deflections over their noise and of stiffnesses over their standard
deviations. Deflections along a curve are off together where the model is off: intervals are those of residuals with
their own memory and size (`noise.autocorrelation`), and never narrower than the stated noise makes them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.optimize import least_squares
from scipy.special import ndtri

from geocontact.below_knee_prosthesis.keel.keel import Keel
from geocontact.identify.identifiability import Identifiability, identifiability
from geocontact.identify.noise.autocorrelation import PAUSE, autocorrelation_of, sandwich, spread

FACTOR = 100.0
"""By which EI may differ from where its search begins, either way."""
SERIES = 1e3, 1e8
"""Stiffness in series [N/m]: the upper end is as good as rigid."""
LEAST = 1e-13
"""Relative change at which a search ends."""
FREE = 2
"""EI and the stiffness in series."""


@dataclass(frozen=True, eq=False)
class MeasuredCompression:
    """A static compression.

    Parameters
    ----------
    fulcrum
        [m]; where its search begins if it is `sought`.
    force, deflection
        Of a curve [N, m]; a stiffness alone is one row, force at a deflection of 1 m.
    sd
        Standard deviation of one deflection [m]; of a stiffness alone its own [N/m].
    curve
        Whether it is a curve.
    """

    name: str
    fulcrum: float
    sought: bool
    force: Float[np.ndarray, " n"]
    deflection: Float[np.ndarray, " n"]
    sd: float
    curve: bool = True

    def slope(self, level: float = 0.95) -> tuple[float, float]:
        """Stiffness [N/m] by a straight line through the curve, and its standard deviation."""
        if not self.curve:
            return float(self.force[0] / self.deflection[0]), self.sd
        design = np.column_stack([self.force, np.ones(len(self.force))])
        line = np.linalg.lstsq(design, self.deflection, rcond=None)[0]
        off = design @ line - self.deflection
        half = half_widths([off / self.sd], [design / self.sd], level)[0]
        sd = half / ndtri(0.5 + 0.5 * level)
        return float(1.0 / line[0]), float(sd / line[0] ** 2)


def compressed_curve(
    name: str,
    fulcrum: float,
    force: Float[np.ndarray, " n"],
    deflection: Float[np.ndarray, " n"],
    noise: float,
    *,
    sought: bool = False,
) -> MeasuredCompression:
    """A measured curve with the standard deviation of one of its deflections [m]."""
    return MeasuredCompression(name, fulcrum, sought, force, deflection, noise)


def compressed_to(
    name: str, fulcrum: float, stiffness: float, sd: float, *, sought: bool = False
) -> MeasuredCompression:
    """A measured stiffness [N/m] with its standard deviation."""
    return MeasuredCompression(name, fulcrum, sought, np.array([stiffness]), np.ones(1), sd, curve=False)


@dataclass(frozen=True)
class IdentifiedNumber:
    """A number in SI with its interval; NaN at an end that the data do not bound."""

    name: str
    unit: str
    value: float
    lower: float
    upper: float


@dataclass(frozen=True, eq=False)
class IdentifiedKeel:
    """Outcome for a keel.

    Parameters
    ----------
    keel
        With the EI that was identified.
    series
        [N/m].
    fulcrums, fulcrum_sd
        Of each compression [m]; the standard deviation is 0 where it is known.
    numbers
        EI, series stiffness where it was sought, fulcrums that were sought.
    residuals
        Measured less modelled over the standard deviation, of each compression.
    freedom
        Rows less unknowns.
    separated
        What the compressions separate.
    """

    keel: Keel
    series: float
    at: float
    fulcrums: tuple[float, ...]
    fulcrum_sd: tuple[float, ...]
    numbers: tuple[IdentifiedNumber, ...]
    offsets: tuple[float, ...]
    residuals: tuple[Float[np.ndarray, " n"], ...]
    freedom: int
    separated: Identifiability

    def stiffness(self, fulcrum: float) -> float:
        """Force of the plate over its travel [N/m]."""
        return 1.0 / (self._compliance(fulcrum) + 1.0 / self.series)

    def deflection(self, number: int, force: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """Deflection of a compression at forces [m]."""
        return force / self.stiffness(self.fulcrums[number]) + self.offsets[number]

    def _compliance(self, fulcrum: float) -> float:
        return self.keel.sections.tip_compliance(fulcrum, self.at, self.keel.bending, self.keel.support)


@dataclass(frozen=True, eq=False)
class _Beam:
    """Rows of all compressions over the unknowns: logarithm of EI's factor, of k, fulcrums, offsets of curves."""

    keel: Keel
    at: float
    series: float | None
    measured: Sequence[MeasuredCompression]

    @property
    def sought(self) -> list[int]:
        return [k for k, one in enumerate(self.measured) if one.sought]

    @property
    def curves(self) -> list[int]:
        return [k for k, one in enumerate(self.measured) if one.curve]

    @property
    def first(self) -> int:
        """Where fulcrums begin."""
        return FREE if self.series is None else FREE - 1

    def compliance(self, fulcrum: float, bending: float) -> float:
        """Deflection of the keel per force, where the plate presses [m/N]."""
        return self.keel.sections.tip_compliance(fulcrum, self.at, bending, self.keel.support)

    def parts(self, p: Float[np.ndarray, " p"]) -> tuple[float, float, list[float], list[float]]:
        """EI, k, fulcrums and offsets."""
        bending = self.keel.bending * float(np.exp(p[0]))
        series = float(np.exp(p[1])) if self.series is None else self.series
        fulcrums = [one.fulcrum for one in self.measured]
        for place, k in enumerate(self.sought, self.first):
            fulcrums[k] = float(p[place])
        offsets = [0.0] * len(self.measured)
        for place, k in enumerate(self.curves, self.first + len(self.sought)):
            offsets[k] = float(p[place])
        return bending, series, fulcrums, offsets

    def rows(self, p: Float[np.ndarray, " p"]) -> list[Float[np.ndarray, " n"]]:
        """Modelled less measured over the standard deviation, of each compression."""
        bending, series, fulcrums, offsets = self.parts(p)
        found = []
        for one, fulcrum, offset in zip(self.measured, fulcrums, offsets, strict=True):
            soft = self.compliance(fulcrum, bending) + 1.0 / series
            if one.curve:
                found.append((one.force * soft + offset - one.deflection) / one.sd)
            else:
                found.append((1.0 / soft - one.force) / one.sd)
        return found

    def start(self) -> Float[np.ndarray, " p"]:
        """Unknowns by a straight line of compliances over those of the beam, where fulcrums are known."""
        known = [one for one in self.measured if not one.sought]
        beam = [
            self.keel.sections.tip_compliance(o.fulcrum, self.at, self.keel.bending, self.keel.support) for o in known
        ]
        soft = np.array([1.0 / one.slope()[0] for one in known])
        if self.series is None:
            factor, rest = np.polyfit(beam, soft, 1)
            logs = [-np.log(max(factor, 1.0 / FACTOR)), -np.log(np.clip(rest, 1.0 / SERIES[1], 1.0 / SERIES[0]))]
        else:
            logs = [float(np.log(np.mean(beam) / max(np.mean(soft) - 1.0 / self.series, 1e-9)))]
        reach = np.log(FACTOR)
        logs[0] = float(np.clip(logs[0], -0.99 * reach, 0.99 * reach))
        low, high = self.keel.range
        places = [float(np.clip(self.measured[k].fulcrum, low + 1e-4, high - 1e-4)) for k in self.sought]
        return np.array([*logs, *places, *(0.0 for _ in self.curves)])

    def bounds(self) -> tuple[list[float], list[float]]:
        """Lower and upper bounds of the search."""
        reach, (low, high) = float(np.log(FACTOR)), self.keel.range
        ends = [(-reach, reach)]
        if self.series is None:
            ends.append((float(np.log(0.5 * SERIES[0])), float(np.log(2.0 * SERIES[1]))))
        ends += [(low, high)] * len(self.sought) + [(-np.inf, np.inf)] * len(self.curves)
        return [end[0] for end in ends], [end[1] for end in ends]


def identified_keel(
    keel: Keel,
    measured: Sequence[MeasuredCompression],
    *,
    at: float | None = None,
    series: float | None = None,
    level: float = 0.95,
) -> IdentifiedKeel:
    """EI of a keel by beam theory, sections in the ratio that they have.

    Parameters
    ----------
    at
        Where the plate presses on the keel [m]; its tip by default.
    series
        Stiffness of all that gives besides it [N/m]; identified by default.

    ValueError where fewer settings are known than numbers are sought.
    """
    known = {round(one.fulcrum, 6) for one in measured if not one.sought}
    needed = 1 if series is not None else FREE
    if len(known) < needed:
        what = "EI and the stiffness in series" if needed == FREE else "EI"
        raise ValueError(f"{what} need compressions at {needed} known places of the fulcrum, there are {len(known)}")
    beam = _Beam(keel, keel.length if at is None else at, series, measured)

    def over(p: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        return np.concatenate(beam.rows(p))

    found = least_squares(over, beam.start(), bounds=beam.bounds(), x_scale="jac", xtol=LEAST, ftol=LEAST)
    p, rows = found.x, beam.rows(found.x)
    slope = np.asarray(found.jac)
    slopes = np.split(slope, np.cumsum([len(row) for row in rows])[:-1])
    half = half_widths(rows, slopes, level)
    bending, stiff, fulcrums, offsets = beam.parts(p)
    sd = [0.0] * len(measured)
    for place, k in enumerate(beam.sought, beam.first):
        sd[k] = float(half[place] / ndtri(0.5 + 0.5 * level))
    numbers = [by_logarithm("EI, plate on the keel", "N m^2", bending, half[0])]
    if series is None:
        numbers.append(_series(stiff, float(half[1])))
    for place, k in enumerate(beam.sought, beam.first):
        value, wide = fulcrums[k], float(half[place])
        numbers.append(IdentifiedNumber(f"fulcrum of {measured[k].name}", "m", value, value - wide, value + wide))
    names = ["EI", *(["series"] if series is None else []), *(measured[k].name for k in beam.sought)]
    names += [f"touch of {measured[k].name}" for k in beam.curves]
    return IdentifiedKeel(
        keel=replace(keel, bending=bending, torsional=keel.torsional * bending / keel.bending),
        series=stiff,
        at=beam.at,
        fulcrums=tuple(fulcrums),
        fulcrum_sd=tuple(sd),
        numbers=tuple(numbers),
        offsets=tuple(offsets),
        residuals=tuple(-row for row in rows),
        freedom=sum(map(len, rows)) - len(p),
        separated=identifiability(names, slope),
    )


def by_logarithm(name: str, unit: str, value: float, half: float) -> IdentifiedNumber:
    """A number and its interval, from half of the interval of its logarithm."""
    reach = float(np.exp(half))
    return IdentifiedNumber(name, unit, float(value), float(value / reach), float(value * reach))


def _series(value: float, half: float) -> IdentifiedNumber:
    """The stiffness in series; an end beyond what is as good as rigid is none."""
    found = by_logarithm("in series", "N/m", value, half)
    return replace(found, upper=found.upper if found.upper < SERIES[1] else np.inf)


def half_widths(
    rows: Sequence[Float[np.ndarray, " n"]], slopes: Sequence[Float[np.ndarray, "n p"]], level: float
) -> Float[np.ndarray, " p"]:
    """Half the interval of every unknown.

    Parameters
    ----------
    rows, slopes
        Residuals over their standard deviation, and their derivatives, part by part.

    Parts do not remember each other. Where no part has several rows, or nothing is over, the stated deviations count.
    """
    off, slope = np.concatenate(rows), np.concatenate(slopes)
    stated = np.sqrt(np.diag(spread(slope))) * float(ndtri(0.5 + 0.5 * level))
    if max(map(len, rows)) < FEWEST or len(off) - slope.shape[1] < FEWEST:
        return np.asarray(stated)
    time, start = [], 0.0
    for row in rows:
        time.append(start + np.arange(len(row)))
        start += len(row) + 2.0 * PAUSE
    at = np.concatenate(time)
    memory = autocorrelation_of(at, off, slope)
    covariance = sandwich(memory, at, slope)
    own = [memory.half_width(np.sqrt(covariance[:, k, k]), level) for k in range(slope.shape[1])]
    return np.maximum(stated, own)


FEWEST = 5
"""Rows of a curve, and rows more than unknowns, from which on residuals tell their own size."""
