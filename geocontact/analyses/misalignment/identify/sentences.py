"""What is said of an identification: reservations, elbow.json, sentences."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from geocontact.analyses.frame.collector import contradicted, if_it_fits, judge, reserve, say
from geocontact.analyses.frame.json_file import finite
from geocontact.analyses.misalignment.identify.beside import described_beside, doubts_of, sentences_of
from geocontact.analyses.misalignment.identify.fitted import Fitted, Free, ShownInterval, stroke_stiffness
from geocontact.analyses.misalignment.law_numbers import MMHG, NUMBERS, PER_SI, WRITTEN, with_units
from geocontact.axis_misalignment.bins import Binned
from geocontact.axis_misalignment.compensation import EndStop
from geocontact.axis_misalignment.law import LENGTHS, SCALED
from geocontact.axis_misalignment.synthetic import ideal
from geocontact.axis_misalignment.uncertainty import Direction
from geocontact.data.plausible import Plausible
from geocontact.identify.goodness_of_fit import Doubt, GoodnessOfFit, of_each, of_r2, of_size
from geocontact.identify.intervals.bin_tests import LEVEL, BinPair, BinTest
from geocontact.identify.signals.agreement import clock_off, clock_words
from geocontact.identify.signals.filters import even_times

FEW_STRETCHES = 12
OWN = 0.1  # of what c does to the force; less is called hardly separable from the cuff
RARE, MORE = 0.01, 1.5  # p and size from which residuals are more than noise
BETTER = 0.02  # of R² that the mirrored force must gain to be worth a word
APART = 3.0  # times that two stiffnesses may differ before a unit is doubted
SCALE_FREE = (
    f"k and the lengths {', '.join(LENGTHS)} are known up to one factor only: F(k/s, s × lengths) = F for every s; "
    "state l, z or k (`known`), give a prior (`prior`), record the cuff's moment (a column moment), or the free "
    "joint's displacement (`unlocked`)"
)


SIZES = {name: known for name, known in NUMBERS.ranges if isinstance(known, Plausible)}
"""What the numbers of the law can be."""


def reserve_doubts(found: Fitted, free: Free | None) -> None:
    """Warn of what is open, rough or odd."""
    _say_what_is_open(found)
    if free is not None:
        _doubt_displacement(found, free)
    e = found.estimate
    if found.stretches < FEW_STRETCHES:
        reserve(f"{found.stretches} stretches of {found.data.stretch:.2g} s are few: intervals are approximate")
    if not e.converged:
        reserve("the search did not converge; see `start` and `bounds`")
    judge(against_the_forces(found))
    if found.mirrored_r2 > found.r2 + BETTER:
        told = f"the force with its sign turned fits better (R² {found.mirrored_r2:.3f} instead of {found.r2:.3f})"
        reserve(f"{told}: is its sign turned? see `map` force=-…")


def against_the_forces(found: Fitted) -> GoodnessOfFit:
    """The law against the forces that it was fitted to, those that were left out, and priors."""
    excess = found.residuals.excess
    doubts = list(of_r2("the force that was fitted", found.r2))
    if excess.p < RARE and excess.ratio > MORE:
        what = f"the residual is {excess.ratio:.2g} times what noise within the trials would leave"
        cause = "offsets that change from trial to trial, a trial with another unit, gain or zero, another length that "
        cause += "is `known`, or something the law misses"
        if found.held:
            worst = min(found.held, key=lambda each: each.r2)
            cause += f" (by the others {worst.name} is described worst, R² {worst.r2:.2f})"
        cause += "; intervals are too short"
        doubts.append(Doubt(f"{what}: {cause}", False, excess.ratio))
    bad = [f"{each.name} ({each.r2:.2f})" for each in found.held if each.r2 < 0.0]
    if bad:  # the law may be right, and the trial that was left out another one
        what = f"R² of unused data is below 0, a constant force would do better: {', '.join(bad)}"
        doubts.append(Doubt(f"{what}; is a unit, a sign or a zero another one there?", False))
    for each in found.intervals:
        if (known := SIZES.get(each.key)) is not None:
            ends = each.profile.lower, each.profile.upper
            doubts += of_size(each.words, ends, known)
    for name, prior in found.estimate.problem.priors.items():
        off = PER_SI[name] * (found.estimate.named[name] - prior.mean), PER_SI[name] * prior.sd
        doubts += of_each("the fit", {f"the mean of the prior of {name}": off}, WRITTEN[name])
    doubts += doubts_of(found.beside)
    doubts += _of_clocks(found)
    others = [each.measured.name for each in found.beside.sensors]
    return GoodnessOfFit(tuple(doubts), ("force", *others, *(each.name for each in found.held)))


def _of_clocks(found: Fitted) -> Iterator[Doubt]:
    """Trials whose force comes earlier or later than the law makes it along the recorded angle."""
    numbers = found.estimate.named
    for r in found.recordings:
        pressure = 0.0 if r.pressure is None else r.pressure - found.data.pressure
        try:
            force, _ = ideal(r.time, r.beta, numbers, pressure=pressure)
        except ValueError:  # a pole, of which the law itself is doubted
            continue
        time, step = even_times(r.time)
        if lag := clock_off(np.interp(time, r.time, force), np.interp(time, r.time, r.force), step):
            words = f"{r.name}, force: {clock_words(lag)} Or is damping b missing? see `free`"
            yield Doubt(words, False, abs(lag))


def _doubt_displacement(found: Fitted, free: Free) -> None:
    """A stroke that is not that of the fitted geometry, where something else than the displacement sets its scale."""
    problem = found.estimate.problem
    if free.stiffness is None or problem.scale_free or problem.scale is not None or not free.stiffness.value > 0.0:
        return
    times = free.stiffness.value / found.estimate.named["k"]
    if 1.0 / APART < times < APART:
        return
    stroke = f"the free joint slides by {1.0 / times:.3g} times the displacement that the fitted lengths predict"
    reserve(
        f"{stroke}, so that k by its displacement is {free.stiffness.value:.4g} N/m and not "
        f"{found.estimate.named['k']:.4g}: is the displacement in another unit than its header says?"
    )


def _say_what_is_open(found: Fitted) -> None:
    """The scale, ends of intervals, signs."""
    if found.estimate.problem.scale_free:
        reserve(SCALE_FREE)
    apart, problem = found.separable, found.estimate.problem
    if "c" in problem.names and apart.from_all < OWN and not set(problem.priors) & {"k", "c"}:
        told = (
            f"only {apart.from_all:.2%} of the effect of c on the force is its own" if apart.separable else "not at all"
        )
        reserve(
            "angle and force hardly separate the compliance c of the upper arm's fixation from that of the cuff "
            f"in series with it ({told}): state k or c (`known`), or give a prior (`prior`)"
        )
    driven = [r.name for r in found.recordings if r.torque is not None and r.torque.any()]
    if driven and found.estimate.named["c"] != 0.0:
        told = f"{', '.join(driven)}: an actuator's torque pushes a fixation that yields"
        reserve(f"{told}; the fit takes it as 0, as if the exoskeleton were not driven")
    ends = [each.words for each in found.intervals if each.lower_open or each.upper_open]
    if ends:
        reserve(f"no limit within the bounds to {', '.join(ends)}, on one side or both")
    signs = [each.words for each in found.intervals if each.key[0] in LENGTHS and each.sign_open]
    if signs:
        reserve(f"the sign of {', '.join(signs)} is not identified: values of both signs fit within the interval")


def described(found: Fitted, free: Free | None) -> dict[str, Any]:
    """Numbers, intervals, what is identified and what is not, tests; units in the keys."""
    e, residuals, noise = found.estimate, found.residuals, found.data.noise
    content: dict[str, Any] = {
        "numbers": with_units(e.named),
        "free": list(e.problem.names),
        "scale_free": e.problem.scale_free,
        "ratios": ratios(e.named),
        "intervals": {each.key: _interval(each) for each in found.intervals},
        "identifiability": _directions(found),
        "r2": finite(found.r2),
        "r2_along_the_scale": [float(found.line.r2.min()), float(found.line.r2.max())],
        "r2_of_the_force_turned_over": finite(found.mirrored_r2),
        "held_out": [{"name": h.name, "r2": finite(h.r2), "rmse_N": h.rmse, "bins": h.bins} for h in found.held],
        "between_bins": _tested(found.bins_differ, found.neighbours, found.boxes),
        "residuals": {
            "p_lilliefors": residuals.normality.p,
            "in_words": residuals.normality.words,
            "over_noise": residuals.excess.ratio,
            "p_over_noise": residuals.excess.p,
        },
        "noise": {"sd_N": float(noise.sd[0]), "correlation_time_s": float(noise.tau[0])},
        "stretches": {"count": found.stretches, "length_s": found.data.stretch},
        "pressure_mmHg": found.data.pressure / MMHG if found.data.pressure else None,
        "starts": {"count": len(e.costs), "costs": list(e.costs)},
    }
    if found.beside.sensors:
        content["beside_force"] = described_beside(found.beside)
    return content if free is None else {**content, "free_joint": _free_joint(found, free)}


def ratios(numbers: dict[str, float]) -> dict[str, float]:
    """Independent of the scale: the force k l, and lengths over the link."""
    lengths = {f"{name}_over_l": numbers[name] / numbers["l"] for name in LENGTHS if name != "l"}
    return {"k_times_l_N": numbers["k"] * numbers["l"], **lengths}


def _interval(one: ShownInterval) -> dict[str, Any]:
    return {
        "unit": one.unit,
        "value": one.value,
        "profile_likelihood": [one.lower, one.upper],
        "parts": [list(part) for part in one.parts],
        "open": [one.lower_open, one.upper_open],
        "wild_bootstrap": None if one.drawn is None else list(one.drawn),
    }


def _directions(found: Fitted) -> dict[str, Any]:
    known = {"k_and_lengths": found.all_directions, "free": found.free_directions}
    told = {key: _direction(each) for key, each in known.items() if each is not None}
    apart = found.separable
    fixation = {"own_beside_k": apart.from_cuff, "own_beside_all_free": apart.from_all, "told_apart": apart.separable}
    return {**told, "fixation_from_cuff": fixation}


def _direction(one: Direction) -> dict[str, Any]:
    return {
        "numbers": list(one.names),
        "singular_values_N": one.singular_values.tolist(),
        "told_least": one.least.tolist(),
        "flat": one.flat,
    }


def _free_joint(found: Fitted, free: Free) -> dict[str, Any]:
    s, scale, k = free.stiffness, free.scale, stroke_stiffness(found.estimate, free)
    told = None if s is None else {"value": s.value, "se": finite(s.error), "trials": s.trials, "bins": s.bins}
    return {
        "stops": [_stop_numbers(stop, k) for stop in free.stroke.stops],
        "level_while_sliding_N": free.stroke.level,
        "spread_while_sliding_N": free.stroke.spread,
        "k_by_displacement_N_per_m": told,
        "scale": None if scale is None else {"se": scale.error, "trials": scale.trials},
        "between_bins": _tested(free.bins_differ, free.neighbours, free.boxes),
    }


def _stop_numbers(stop: EndStop, stiffness: float | None) -> dict[str, Any]:
    return {
        "side": stop.side,
        "position_mm": stop.position * 1e3,
        "leaves_at_deg": math.degrees(stop.leaves),
        "from_deg": math.degrees(stop.first),
        "to_deg": math.degrees(stop.last),
        "force_N": stop.force,
        "stroke_wanting_mm": None if stiffness is None else abs(stop.force) / stiffness * 1e3,
    }


def _tested(test: BinTest | None, pairs: Sequence[BinPair], boxes: Binned) -> dict[str, Any] | None:
    if test is None:
        return None
    middle = np.degrees(boxes.centres)
    neighbours = [
        {
            "between_deg": [float(middle[k]) for k in pair.places],
            "mann_whitney": pair.statistic,
            "p": pair.p,
            "p_holm": pair.p_holm,
        }
        for pair in pairs
    ]
    return {
        "kruskal_wallis": test.statistic,
        "p": test.p,
        "bins": test.bins,
        "counted_visits": test.counted,
        "samples": test.samples,
        "neighbours": neighbours,
    }


def say_numbers(found: Fitted, free: Free | None) -> None:
    """Say each number, how well the force is predicted, and what the free joint does."""
    for each in found.intervals:
        say(f"{each.words} {each.shown}")
    told = [f"R² {found.r2:.3f} of {len(found.estimate.problem.force)} bin means"]
    if found.held:
        worst = min(each.r2 for each in found.held)
        told.append(f"not used: {worst:.3f} at least over {len(found.held)}")
    say("; ".join(told))
    say(f"residuals: {found.residuals.normality.words}")
    for line in sentences_of(found.beside):
        say(line)
    if free is None:
        return
    for stop in free.stroke.stops:
        span = f"{np.degrees(stop.first):.0f} … {np.degrees(stop.last):.0f}°"
        say(
            f"free joint: stands at its {stop.side} end, {stop.position * 1e3:.1f} mm, over {span} under "
            f"{stop.force:+.1f} N; it slides from {np.degrees(stop.leaves):.0f}°, and the force levels off"
        )
    if free.stiffness is not None:
        s = free.stiffness
        error = if_it_fits(f" (SE {s.error:.2g}, {s.trials} trials)")
        say(f"k by the free joint's displacement: {s.value:.4g} N/m{error}")


def answer(found: Fitted) -> list[str]:
    """Offsets or their ratios, and what else was identified, for the page; nothing where forces contradict them."""
    if contradicted():
        return []
    told = [f"{each.words} is {each.shown}" for each in found.intervals]
    offsets = [line for line in told if line[0] in "xy"]
    others = [line for line in told if line[0] not in "xy"]
    axes = "The exoskeleton's axis lies off the joint's"
    lines = [f"{axes}: {' and '.join(offsets)}."] if offsets else []
    return [*lines, *([f"{'; '.join(others)}."] if others else [])]


def explained(found: Fitted, free: Free | None) -> list[str]:
    """What the data identify and what they do not, for the page."""
    words = found.residuals.normality.words
    told = [
        _scale(found),
        fixation_words(found),
        f"Residuals are {words}." if found.residuals.normality.p < 0.05 else f"Residuals: {words}.",
    ]
    told += [f"{line[0].upper()}{line[1:]}." for line in sentences_of(found.beside)]
    if found.bins_differ is not None:
        told += _bins(found, found.bins_differ)
    if free is not None:
        stiffness = stroke_stiffness(found.estimate, free)
        told += [_stop(stop, stiffness) for stop in free.stroke.stops]
    return told


def _scale(found: Fitted) -> str:
    """What set the scale, or that nothing did."""
    problem = found.estimate.problem
    if problem.scale_free:
        r = ratios(found.estimate.named)
        shares = ", ".join(f"{key.replace('_over_', '/')} {value:.3f}" for key, value in r.items() if "over" in key)
        return f"{SCALE_FREE}. Independent of the scale: k l = {r['k_times_l_N']:.4g} N, {shares}."
    if problem.scale is None and problem.scale_by_moment and not set(problem.priors) & set(SCALED):
        return (
            "The scale of k and the lengths is set by the measured moment of the cuff: over the force it is −z/cos² γ."
        )
    if problem.scale is not None:
        return (
            "The scale of k and the lengths is set by the free joint's displacement, over which d_tot rises one for "
            f"one (SE {problem.scale.error:.2%})."
        )
    return "The scale of k and the lengths comes from prior knowledge, not from these recordings."


def fixation_words(found: Fitted) -> str:
    """What k holds beside the cuff, and how far a fixation that yields is separable from it."""
    apart, c = found.separable, found.estimate.named["c"]
    if not apart.separable:
        told = "Angle and force cannot separate them: only 1/k + c is identified."
    else:
        told = (
            f"Of the effect of a yielding fixation on the force, {apart.from_all:.1%} is its own with all free numbers "
            f"({apart.from_cuff:.1%} with k alone); the rest looks like another cuff."
        )
    if "c" in found.estimate.problem.names or c != 0.0:
        return f"Cuff (k) and fixation of the upper arm (c) yield in series. {told}"
    return f"k is that of the cuff and of the upper arm's fixation in series, as c is taken as 0. {told}"


def _bins(found: Fitted, test: BinTest) -> list[str]:
    middle = np.degrees(found.boxes.centres)
    differing = [pair.places for pair in found.neighbours if pair.p_holm < LEVEL]
    apart = ", ".join(f"{middle[a]:.0f}|{middle[b]:.0f}°" for a, b in differing)
    differ = (
        f"Bins of the box plots differ with p = {test.p:.2g} (Kruskal-Wallis over {test.counted} visits, one for each "
        f"stretch of {found.boxes.stretch:.2g} s in a bin, not {test.samples} samples)."
    )
    pairs = f"Mann-Whitney, Holm's correction over {len(found.neighbours)} pairs"
    return [differ, f"Neighbouring bins that differ ({pairs}): {apart or 'none'}."]


def _stop(stop: EndStop, stiffness: float | None) -> str:
    wanting = ""
    if stiffness is not None:
        side = "lower" if stop.side == "lower" else "raise"
        wanting = f": {side} that end by {abs(stop.force) / stiffness * 1e3:.1f} mm for k = {stiffness:.4g} N/m"
    return (
        f"The free joint stands at its {stop.side} end to one side of {math.degrees(stop.leaves):.0f}°, "
        f"under {stop.force:+.1f} N{wanting}."
    )
