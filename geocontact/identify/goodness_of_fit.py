"""One test of fit for everything that is fitted, or simulated beside a recording: does a result agree with its data.

A residual is compared with the noise that was stated, a model with the mean of what it is to describe, parameters with
their bounds and with what is physical. What fails becomes a `Doubt`; all of them together are the outcome.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from jaxtyping import Float

from geocontact.data.plausible import Plausible

Outcome = Literal["fits", "doubtful", "contradicts"]

SURE = 3.0
"""Standard errors by which a mean square has to exceed that of the noise: by chance in 1 of 700 channels."""
LARGER, FAR = 1.25, 3.0
"""Times the stated noise: from the one on a residual is doubtful, from the other it contradicts the model. Nobody knows
the noise of a recording to better than a quarter."""
TOO_SMALL = 0.1
"""Times the stated noise: what is below was measured better than was stated, or the noise is in another unit."""
AT_BOUND = 1e-3
"""Share of the width of its bounds within which a parameter is on one of them."""
SAID = 3
"""Doubts that a sentence names; run.json has them all."""
DESCRIBES = 0.5
"""R² below which a model leaves more of a course than it describes: the fit is doubtful."""
MUCH = 0.5
"""Share of the samples outside of what a model describes, from which it describes something else."""


@dataclass(frozen=True)
class Doubt:
    """Something that does not agree.

    Parameters
    ----------
    what
        In words, with the numbers and the place.
    contradicts
        Whether the result cannot be right; else it may be.
    size
        How large it is beside others of its kind.
    """

    what: str
    contradicts: bool
    size: float = 0.0


@dataclass(frozen=True)
class GoodnessOfFit:
    """Outcome of the test of fit.

    Parameters
    ----------
    doubts
        What does not agree; nothing where the result fits.
    tested
        Names of what was compared.
    """

    doubts: tuple[Doubt, ...]
    tested: tuple[str, ...]

    @property
    def outcome(self) -> Outcome:
        """In one word."""
        if any(doubt.contradicts for doubt in self.doubts):
            return "contradicts"
        return "doubtful" if self.doubts else "fits"

    @property
    def words(self) -> str:
        """A sentence; empty where the result fits."""
        if not self.doubts:
            return ""
        first = sorted(self.doubts, key=lambda doubt: (not doubt.contradicts, -doubt.size))
        said = "; ".join(doubt.what for doubt in first[:SAID])
        said += f"; and {len(first) - SAID} more, see run.json" if len(first) > SAID else ""
        if self.outcome == "contradicts":
            return f"the result contradicts its data, and its numbers must not be used: {said}"
        return f"the fit is doubtful: {said}"


@dataclass(frozen=True)
class ResidualTest:
    """A residual beside the noise that was stated.

    Parameters
    ----------
    rms
        Root mean square of the residual, in its unit.
    ratio
        Of that to the noise.
    excess
        Standard errors by which the mean square exceeds the noise's.
    """

    rms: float
    ratio: float
    excess: float


def residual_test(residual: Float[np.ndarray, " n"], noise: float) -> ResidualTest:
    """Mean square of a residual against the variance of white noise, with the residual's own memory.

    For a stationary Gaussian process with autocorrelation rho the variance of the mean square of n samples is
    2 s^4 / n (1 + 2 sum rho_k^2) (Bartlett 1946, J R Stat Soc Suppl 8, 27), summed here up to the first lag at which
    rho is negative.

    Parameters
    ----------
    residual
        Measured less modelled; samples that are NaN do not count.
    noise
        Standard deviation that was stated, in the residual's unit.
    """
    known = residual[np.isfinite(residual)]
    if len(known) < 2 or not noise > 0.0:
        return ResidualTest(float("nan"), float("nan"), 0.0)
    square = float(np.mean(known**2))
    spread = np.sqrt(2.0 / len(known) * _memory(known))
    rms = float(np.sqrt(square))
    return ResidualTest(rms, rms / noise, float((square / noise**2 - 1.0) / spread))


def _memory(values: Float[np.ndarray, " n"]) -> float:
    """1 + 2 sum of the squared autocorrelation up to the first negative one."""
    n = len(values)
    power = np.abs(np.fft.rfft(values, 2 * n)) ** 2
    correlation = np.fft.irfft(power)[:n]
    if not correlation[0] > 0.0:
        return 1.0
    rho = correlation / correlation[0]
    negative = np.flatnonzero(rho < 0.0)
    last = int(negative[0]) if len(negative) else n
    return float(1.0 + 2.0 * np.sum(rho[1:last] ** 2))


def of_residual(name: str, unit: str, residual: Float[np.ndarray, " n"], noise: float) -> Iterable[Doubt]:
    """A doubt for a channel whose residual is not its stated noise, or of which nothing could be compared."""
    if not np.isfinite(residual).any():
        yield Doubt(f"{name}: nothing could be compared", False)
        return
    test = residual_test(residual, noise)
    if test.excess > SURE and test.ratio > LARGER:
        times = f"{test.ratio:.3g} times the stated noise of {noise:.3g} {unit}"
        yield Doubt(f"{name}: residual {test.rms:.3g} {unit} is {times}", test.ratio > FAR, test.ratio)
    elif test.ratio < TOO_SMALL:
        times = f"{test.ratio:.2g} times the stated noise of {noise:.3g} {unit}, and intervals are too wide by as much"
        yield Doubt(
            f"{name}: residual {test.rms:.3g} {unit} is {times}: is that noise in its unit, and the data in theirs?",
            False,
            LARGER,
        )


def of_each(model: str, off: Mapping[str, tuple[float, float]], unit: str) -> Iterable[Doubt]:
    """A doubt for a number missed.

    For every one that a model misses by more than `SURE` of its standard deviations, where of a few the mean square is
    still that of the noise: one of three that is missed by 3 exceeds it by 2.4 standard errors. By chance one number in
    370 is missed so far.

    Parameters
    ----------
    model
        What misses them, in words.
    off
        Modelled less measured, and the standard deviation of that, by what was measured.
    """
    for name, (by, sd) in off.items():
        if sd > 0.0 and abs(by) > SURE * sd:
            what = f"{model} is {by:+.3g} {unit} off {name}, {abs(by) / sd:.3g} times its standard deviation"
            yield Doubt(what, False, abs(by) / sd)


def of_r2(name: str, r2: float) -> Iterable[Doubt]:
    """A doubt for a model that describes a channel worse than the channel's own mean does."""
    if np.isfinite(r2) and r2 < 0.0:
        yield Doubt(f"{name}: R² is {r2:.2f}, a constant would describe it better", True)


def of_bounds(values: Mapping[str, tuple[float, float, float]], allowed: Iterable[str] = ()) -> Iterable[Doubt]:
    """A doubt for every parameter that is on a bound of its search.

    `values` are value, lower and upper bound by name; `allowed` are parameters that may be there: their bound is what
    is physical.
    """
    free = frozenset(allowed)
    for name, (value, lower, upper) in values.items():
        width = upper - lower if np.isfinite(upper - lower) else abs(value)
        for end, where in ((lower, "lower"), (upper, "upper")):
            if name not in free and np.isfinite(end) and abs(value - end) <= AT_BOUND * width:
                yield Doubt(f"{name} is on the {where} bound of its search, {end:.4g}", False)


def of_range(what: str, share: float, whole: str = "the time") -> Iterable[Doubt]:
    """A doubt for samples in which the model does not hold.

    `what` ends in "for": "outside … for"; `share` is that of them, `whole` what it is of.
    """
    if share > 0.0:
        shown = f"{share:.0%}" if share >= 5e-3 else f"{share:.2%}"
        yield Doubt(f"{what} {shown} of {whole}", share >= MUCH, share)


def of_many_r2(name: str, values: Mapping[str, float]) -> Iterable[Doubt]:
    """A doubt for a model that describes members of a group, by their names, worse than their own means do.

    It contradicts the data where that are half of them or more; some may be spoilt, or of another person.
    """
    known = {member: r2 for member, r2 in values.items() if np.isfinite(r2)}
    below = sorted((r2, member) for member, r2 in known.items() if r2 < 0.0)
    if not below:
        return
    many = "" if len(below) <= SAID else f" and {len(below) - SAID} more"
    listed = ", ".join(f"{member} ({r2:.2f})" for r2, member in below[:SAID]) + many
    where = f"in {len(below)} of {len(known)}: {listed}" if len(known) > 1 else f"in {listed}"
    share = len(below) / len(known)
    yield Doubt(f"{name}: R² is below 0 {where}; a constant would describe it better", share >= MUCH, share)


def of_low_r2(name: str, r2: float) -> Iterable[Doubt]:
    """A doubt for a model that describes less than half of a channel's course, or worse than its mean does."""
    yield from of_r2(name, r2)
    if 0.0 <= r2 < DESCRIBES:
        yield Doubt(f"{name}: R² is {r2:.2f}, the model leaves more of its course than it describes", False)


def of_size(name: str, interval: tuple[float, float], known: Plausible) -> Iterable[Doubt]:
    """A doubt for a number [SI] whose interval lies wholly outside of the sizes that its quantity has.

    Outside of what is possible it contradicts the data, outside of what is usual it is doubtful. A number without an
    interval has the same value twice.
    """
    lower, upper = interval
    if not (np.isfinite(lower) and np.isfinite(upper)):
        return
    (least, most), unit = known.possible, known.unit
    if upper < least * unit.factor or lower > most * unit.factor:
        shown = known.shown(lower) if lower == upper else f"{known.shown(lower)} to {known.shown(upper)}"
        what = f"{name} is {shown}, which cannot be {known.what}"
        yield Doubt(f"{what}: is a sign turned, or a unit another one?", True)
    elif not known.usually(lower, upper):
        near = lower if lower > 0.0 else upper
        yield Doubt(f"{name}: {known.doubt(near)}", False)


def of_verdict(what: str, interval: tuple[float, float], turns: float, shown: str = "") -> Iterable[Doubt]:
    """A doubt for a verdict whose interval reaches the other one.

    `what` is the verdict in words; it turns where a number passes `turns`. `shown` is the interval in words.
    """
    lower, upper = interval
    if lower <= turns <= upper:
        words = shown or f"{lower:.3g} to {upper:.3g}"
        yield Doubt(f"{what}: the interval {words} reaches the other verdict", False)
