"""What trials that are joined cannot be: copies, shares of 50, forces turned round, outputs a second late.

A copy is refused, and so is a share beyond 1. Signs and lags are warned of: they may be real, and only the diagnosis
knows the model.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.gap.case import names, require_shares
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.plausible import FOOT_LAW, numbers_in
from geocontact.data.trial import Trial
from geocontact.gap.case.admission import repeated

OPPOSITE = -0.8
"""Cosine between how two trials' outputs go with their inputs, from which one is the other turned round."""
CLEAR = 0.5
"""Size of that relation, of 1, below which its sign says nothing."""
LATEST = 2.0
"""Lag up to which outputs are looked for behind or before inputs [s]."""
LATE = 0.3
"""Lag that no sensor and no strap makes [s]."""
EXPLAINED = 0.9
"""Part of an output's variance that its inputs must explain at the best lag, for the lag to be one."""
MISSED = 0.05
"""Part of the variance that inputs must leave unexplained without a lag, for one to be looked for."""
CLEARER = 0.5
"""Part of what is unexplained without a lag that may remain at it."""
SHARED, ALIKE = 0.5, 0.02
"""Share of a trial's samples within the times of another one, and of the standard deviation of a channel by which the
two differ, from which it is a copy of that one: no two movements of a person are alike to a fiftieth."""
FOOT, ZONE = "foot", ("k_", "b_")
"""System whose force law has numbers by the names of `FOOT_LAW`, and what names of its zones begin with: k_heel."""
STEPS = 40
"""Lags that are tried to either side."""


def check_gathered(case: GapCase, measured: Mapping[str, Sequence[str]], file: Path) -> None:
    """InputError for copies and shares beyond 1; a reservation for forces turned round and for late outputs.

    Parameters
    ----------
    measured
        Channels of each trial that were measured beside its inputs.
    file
        The settings, gather.toml.
    """
    trials = [*case.calibration, *case.evaluation]
    channels = [name for name in case.calibration[0].signals.channels if all(name in measured[t.name] for t in trials)]
    same = repeated(trials, channels)
    if same is not None:
        what = f"{same.channel} is the same as in [from.{same.first}], sample by sample"
        raise InputError(file, f"[from.{same.second}]", what, "name the files of that trial's own recording")
    require_shares(case, file)
    if case.system == FOOT:
        _doubt_law(case, file)
    for line in (*copied(trials, channels), *turned_round(trials, channels), *late(trials, channels)):
        reserve(line)


def copied(trials: Sequence[Trial], channels: Sequence[str]) -> list[str]:
    """Which trials have a channel that at the same times is that of another trial, in words."""
    found = []
    for first, second in combinations(trials, 2):
        start, end = max(first.time[0], second.time[0]), min(first.time[-1], second.time[-1])
        own = (second.time >= start) & (second.time <= end)
        if own.mean() < SHARED:
            continue
        for name in channels:
            values = second.column(name)[own]
            other = np.interp(second.time[own], first.time, first.column(name))
            both = np.isfinite(values) & np.isfinite(other)
            spread = float(np.std(values[both])) if both.sum() >= STEPS else 0.0
            if spread > 0.0 and float(np.sqrt(np.mean((values - other)[both] ** 2))) < ALIKE * spread:
                what = f"{name} of trial {second.name} is that of trial {first.name} at the same times"
                found.append(f"{what}; name the files of each trial's own recording")
                break
    return found


def turned_round(trials: Sequence[Trial], channels: Sequence[str]) -> list[str]:
    """Which trials have a channel with the sign of another trial's turned round, in words."""
    found = []
    for name in channels:
        related = {trial.name: _relation(trial, name, channels) for trial in trials}
        pairs = [
            (a, b)
            for a, b in combinations(related, 2)
            if min(np.linalg.norm(related[a]), np.linalg.norm(related[b])) > CLEAR
            and related[a] @ related[b] < OPPOSITE * np.linalg.norm(related[a]) * np.linalg.norm(related[b])
        ]
        if not pairs:
            continue
        count = {each: sum(each in pair for pair in pairs) for each in related}
        odd = [each for each in related if count[each] == max(count.values())]
        signs = f"in {names(odd)} its sign is opposite to that in the other trials"
        if len(pairs) == 1:
            signs = f"its signs in {names(pairs[0])} are opposite"
        found.append(f"{name}: {signs}; is one of them the load on the other body?")
    return found


def _relation(trial: Trial, name: str, measured: Sequence[str]) -> Float[np.ndarray, " r"]:
    """How a channel goes with the inputs: its mean over its root mean square, and its correlation with each of them."""
    values = trial.column(name)
    there = np.isfinite(values)
    others = [trial.column(each) for each in trial.signals.channels if each not in measured]
    for each in others:
        there &= np.isfinite(each)
    if there.sum() < STEPS:
        return np.zeros(1 + len(others))
    own = values[there]
    size = float(np.sqrt(np.mean(own**2)))
    level = float(own.mean()) / size if size > 0.0 else 0.0
    return np.array([level, *(_correlation(own, each[there]) for each in others)])


def _correlation(a: Float[np.ndarray, " t"], b: Float[np.ndarray, " t"]) -> float:
    spread = float(a.std() * b.std())
    return float(np.mean((a - a.mean()) * (b - b.mean()))) / spread if spread > 0.0 else 0.0


def late(trials: Sequence[Trial], channels: Sequence[str]) -> list[str]:
    """Which measured channels follow the inputs of their trial much later, or precede them, in words."""
    found = []
    for trial in trials:
        worst = [(name, lag) for name in channels if (lag := lag_of(trial, name, channels)) is not None]
        if worst:
            some = names(list(dict.fromkeys(name for name, _ in worst)))
            lag = worst[0][1]
            way = "later" if lag > 0.0 else "earlier"
            found.append(
                f"trial {trial.name}: {some} moves {abs(lag):.2g} s {way} than the inputs; is it the same clock?"
            )
    return found


def lag_of(trial: Trial, name: str, measured: Sequence[str]) -> float | None:
    """By how much a channel is late [s]: where inputs and their squares explain it far better than without lag.

    None where the lag is less than `LATE`, is none, or may lie beyond the lags that are tried.
    """
    time, values = trial.time, trial.column(name)
    inputs = [trial.column(each) for each in trial.signals.channels if each not in measured]
    inputs = [each for each in inputs if np.isfinite(each).all() and np.ptp(each) > 0.0]
    reach = min(LATEST, 0.15 * float(time[-1] - time[0]))
    if not inputs or reach < LATE:
        return None
    lags = np.linspace(-reach, reach, 2 * STEPS + 1)
    inside = np.isfinite(values) & (time >= time[0] + reach) & (time <= time[-1] - reach)
    if inside.sum() < STEPS or np.ptp(values[inside]) == 0.0:
        return None
    moved = [np.array([np.interp(time - lag, time, each) for each in inputs]) for lag in lags]
    rests = np.array([_unexplained(values[inside], _regressors(each)[inside]) for each in moved])
    best, none = int(np.argmin(rests)), rests[STEPS]
    clear = none > MISSED and rests[best] < min(1.0 - EXPLAINED, CLEARER * none)
    if not LATE <= abs(lags[best]) < reach or not clear:  # at the end of the search there is no least value
        return None
    return float(lags[best])


def _regressors(inputs: Float[np.ndarray, "i t"]) -> Float[np.ndarray, "t r"]:
    """A constant, the inputs and their squares; with their rates any lag of a harmonic movement would do."""
    return np.column_stack([np.ones(inputs.shape[1]), *inputs, *inputs**2])


def _unexplained(values: Float[np.ndarray, " t"], regressors: Float[np.ndarray, "t r"]) -> float:
    """Part of the variance that a straight combination of the regressors leaves."""
    off = values - regressors @ np.linalg.lstsq(regressors, values, rcond=None)[0]
    return float(np.var(off) / np.var(values))


def _doubt_law(case: GapCase, file: Path) -> None:
    """Numbers of a foot's force law, constants and where parameters start: refused or warned of as those of `cop`.

    Of the zones' stiffnesses and of their dampings only the largest is looked at: a zone that a stance hardly loads may
    have any, or none.
    """
    starts = {one.name: one.start for one in case.parameters}
    stiff, damped = (sorted((name for name in starts if name.startswith(of)), key=starts.__getitem__) for of in ZONE)
    asked = {name: value for name, value in starts.items() if name not in stiff[:-1]}
    for place, values in (("[constants]", case.constants), ("[parameters]", asked)):
        for name, value in values.items():
            for _, known, number in numbers_in(FOOT_LAW, {name.partition("_")[0] if name in starts else name: value}):
                refusal, doubt = known.refusal(number), known.doubt(number)
                if refusal:
                    raise InputError(file, f"{place} {name}", *refusal)
                if doubt and name not in damped[:-1]:
                    reserve(f"{file} {place} {name}: {doubt}")
    still, sliding = (case.constants.get(name, 0.0) for name in ("mu_s", "mu_k"))
    if sliding > still:
        reserve(f"{file} [constants]: kinetic friction mu_k {sliding:g} is larger than the static mu_s, {still:g}")
