"""How a curve agrees with a measured one: mean absolute error, root mean square, R², lag, over all and per phase."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from jaxtyping import Float


def rms_difference(first: Float[np.ndarray, " t"], second: Float[np.ndarray, " t"]) -> float:
    """Root mean square of the difference where both have a value; NaN where they never do."""
    there = np.isfinite(first) & np.isfinite(second)
    return float(np.sqrt(np.mean((first[there] - second[there]) ** 2))) if there.any() else float("nan")


FEWEST = 3  # samples that both have
NAN = float("nan")
LONGEST = 0.5  # s, of the lags that are looked at
LONG_ENOUGH = 20  # samples of a stretch that tells a lag
RANGE = 0.25  # of the shortest stretch: the lags that are looked at in it
SHARP = 0.02  # that the correlation falls on both sides of a lag that is reported
OVERLAP = 0.5  # of the samples that a lag must leave to both


@dataclass(frozen=True)
class Agreement:
    """Numbers of one comparison; NaN where there is nothing to compare.

    Parameters
    ----------
    mae, rmsd, bias
        Mean absolute, root mean square and mean difference, model - measured, in the curves' unit.
    r2
        Coefficient of determination 1 - SS_res/SS_tot about the measured mean: negative where the mean is the better
        model; NaN where the measured curve is constant.
    lag
        How much the model is late [s]: the shift that makes the correlation largest, to a fraction of a sample.
    correlation
        At that lag.
    samples
        How many were compared.
    """

    mae: float
    rmsd: float
    bias: float
    r2: float
    lag: float
    correlation: float
    samples: int


def agreement(
    model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"], step: float, longest: float = LONGEST
) -> Agreement:
    """Curves on the same evenly spaced times, `step` [s] apart; samples that are NaN in either do not count.

    `longest` [s] is the largest lag that is looked at.
    """
    both = np.isfinite(model) & np.isfinite(measured)
    count = int(both.sum())
    if count < FEWEST:
        return Agreement(NAN, NAN, NAN, NAN, NAN, NAN, count)
    off = (model - measured)[both]
    spread = measured[both] - measured[both].mean()
    total = float(spread @ spread)
    lag, correlation = lag_of(np.where(both, model, np.nan), np.where(both, measured, np.nan), step, longest)
    return Agreement(
        float(np.abs(off).mean()),
        float(np.sqrt(np.mean(off**2))),
        float(off.mean()),
        1.0 - float(off @ off) / total if total > 0.0 else NAN,
        lag,
        correlation,
        count,
    )


FARTHEST, LATE, ALIKE, SHARPER = 2.0, 0.15, 0.9, 0.02
"""s, the largest lag that a clock is looked for at and the least that it is doubted from; correlation at a lag, and
how much it is above that without, from which a clock is doubted."""


def clock_off(model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"], step: float) -> float:
    """How much the model is late [s] where a clock that is off is likely; 0 where it is not."""
    model = np.where(np.isfinite(measured), model, np.nan)
    lag, there = lag_of(model, measured, step, FARTHEST)
    _, now = lag_of(model, measured, step, 0.0)
    return lag if abs(lag) >= LATE and there >= ALIKE and there - now >= SHARPER else 0.0


def clock_words(lag: float) -> str:
    """A lag of `clock_off` in words."""
    return f"the recording is {abs(lag):.2f} s {'early' if lag > 0.0 else 'late'}: is its clock right?"


SIZES, UNIT_RATIOS = 0.02, (9.80665, 4.4482216, 25.4, 10.0, 100.0, 1000.0)
"""Part of a curve's size below which, or its inverse above which, another unit is likely; and ratios of two units:
kgf and lbf to N, in, cm and m to mm, kN to N."""
EXACT, SAME_COURSE = 0.04, 0.9
"""Share by which a ratio of sizes may be off that of two units, and correlation from which courses are one."""


def likely_cause(model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"]) -> str:
    """Why a model may describe a recording worse than a constant: another unit, a turned sign; empty where neither is.

    The words go on a sentence.
    """
    there = np.isfinite(model) & np.isfinite(measured)
    model, measured = model[there], measured[there]
    if not model.any() or not measured.any():
        return ""
    size = float(np.sqrt(np.mean(measured**2) / np.mean(model**2)))
    vary = np.std(model) > 0.0 and np.std(measured) > 0.0
    course = float(np.corrcoef(model, measured)[0, 1]) if vary else 0.0
    ratios = [each**sign for each in UNIT_RATIOS for sign in (1.0, -1.0)]
    of_units = course > SAME_COURSE and any(abs(size / ratio - 1.0) < EXACT for ratio in ratios)
    if of_units or size < SIZES or size > 1.0 / SIZES:
        return f"; recorded values are {size:.2g} times the simulated ones: is the unit right?"
    return ": is a sign turned?" if course < 0.0 else ""


GAIN, TAKEN = 0.2, 0.8
"""By how much sizes of two curves of one course differ that are spoken of, and part of the squared difference that one
factor takes away then, also of what a constant leaves."""


def gain_off(model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"]) -> float:
    """How many times the model a recording is where one factor is between them, and neither a constant nor much else;
    1 where not so.
    """
    there = np.isfinite(model) & np.isfinite(measured)
    model, measured = model[there], measured[there]
    if len(model) < FEWEST or not model.any():
        return 1.0
    gain = float(model @ measured / (model @ model))
    stays, off = float(np.sum((measured - gain * model) ** 2)), measured - model
    least = min(float(np.sum(off**2)), float(np.sum((off - off.mean()) ** 2)))
    return gain if gain > 0.0 and max(gain, 1.0 / gain) > 1.0 + GAIN and stays < (1.0 - TAKEN) * least else 1.0


def per_phase(
    model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"], step: float, parts: int = 10
) -> list[Agreement]:
    """The same over `parts` equal stretches of the recording, each too short to tell a lag: it is NaN there."""
    edges = np.round(np.linspace(0, len(model), parts + 1)).astype(int)
    found = [agreement(model[a:b], measured[a:b], step, 0.0) for a, b in pairwise(edges)]
    return [replace(each, lag=NAN) for each in found]


def over_stretches(
    model: Float[np.ndarray, " t"],
    measured: Float[np.ndarray, " t"],
    step: float,
    stretches: Sequence[tuple[int, int]],
) -> Agreement:
    """The same over several stretches taken together, as a phase that comes back in every cycle.

    A lag is reported where the stretches are long enough: each has at least `LONG_ENOUGH` samples; lags up to `RANGE`
    of the shortest are looked at; and the correlation, of pairs inside the stretches only, is largest within that range
    and `SHARP` above both of its ends. A phase in which the load only rises or only falls steadily tells none: it is
    NaN then, and the correlation is that without lag.

    Parameters
    ----------
    stretches
        First sample of each, and the one after its last.
    """
    shortest = min(b - a for a, b in stretches)
    most = min(round(LONGEST / step), int(RANGE * shortest)) if shortest >= LONG_ENOUGH else 0
    apart = np.full(most, np.nan)
    one, other = (
        np.concatenate([part for a, b in stretches for part in (curve[a:b], apart)]) for curve in (model, measured)
    )
    plain = replace(agreement(one, other, step, 0.0), lag=NAN)
    around = _correlations(one, other, most)
    at = int(np.nanargmax(around)) if np.isfinite(around).any() else 0
    ends = float(np.max(around[[0, -1]]))
    if not (0 < at < 2 * most and around[at] - ends >= SHARP):
        return plain
    lag, correlation = lag_of(one, other, step, most * step)
    return replace(plain, lag=lag, correlation=correlation)


ROUNDED = 1e-6
"""s; a sample that close to a start or an end belongs to the phase."""


def samples_within(time: Float[np.ndarray, " t"], start: float, end: float) -> tuple[int, int]:
    """First sample from `start` to `end` [s], both included, and the one after the last; `time` [s] grows."""
    first = int(np.searchsorted(time, start - ROUNDED))
    return first, int(np.searchsorted(time, end + ROUNDED, side="right"))


def overlap(stretches: Sequence[tuple[int, int]]) -> bool:
    """Whether two stretches, first sample and the one after the last, have a sample in common."""
    return any(before > start for (_, before), (start, _) in pairwise(sorted(stretches)))


def by_phase(
    model: Float[np.ndarray, " t"],
    measured: Float[np.ndarray, " t"],
    step: float,
    phases: Mapping[str, Sequence[tuple[int, int]]] | None = None,
    parts: int = 10,
) -> dict[str, Agreement]:
    """Agreement over all ("all") and in each phase, in their order; in tenths ("0-10 %", …) where none are named.

    Parameters
    ----------
    model, measured
        On the same times, `step` [s] apart; NaN where there is no value.
    phases
        Stretches of each: first sample and the one after the last; "all" is no name of a phase.
    parts
        Equal stretches where no phases are named.
    """
    whole = {"all": agreement(model, measured, step)}
    if phases is not None:
        return whole | {name: over_stretches(model, measured, step, stretches) for name, stretches in phases.items()}
    names = [f"{100 * k // parts}-{100 * (k + 1) // parts} %" for k in range(parts)]
    return whole | dict(zip(names, per_phase(model, measured, step, parts), strict=True))


def lag_of(
    model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"], step: float, longest: float
) -> tuple[float, float]:
    """Lag [s] of the largest correlation, a parabola through it and its neighbours, and that correlation."""
    most = min(round(longest / step), int((1.0 - OVERLAP) * len(model)))
    found = _correlations(model, measured, most)
    if not np.isfinite(found).any():
        return NAN, NAN
    at = int(np.nanargmax(found))
    shift = 0.0
    if 0 < at < len(found) - 1 and np.isfinite(found[at - 1 : at + 2]).all():
        left, middle, right = found[at - 1 : at + 2]
        bend = left - 2.0 * middle + right
        shift = 0.5 * float(left - right) / float(bend) if bend < 0.0 else 0.0
    return float((at - most + shift) * step), float(found[at])


def _correlations(
    model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"], most: int
) -> Float[np.ndarray, " lags"]:
    """Correlations of the model from `most` samples early to as many late."""
    return np.array([_correlation(model, measured, k) for k in range(-most, most + 1)])


def _correlation(model: Float[np.ndarray, " t"], measured: Float[np.ndarray, " t"], late: int) -> float:
    """Pearson's, of the model `late` samples on with the measured."""
    count = len(model) - abs(late)
    a, b = model[max(late, 0) :][:count], measured[max(-late, 0) :][:count]
    both = np.isfinite(a) & np.isfinite(b)
    if both.sum() < FEWEST:
        return NAN
    a, b = a[both] - a[both].mean(), b[both] - b[both].mean()
    size = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / size if size > 0.0 else NAN
