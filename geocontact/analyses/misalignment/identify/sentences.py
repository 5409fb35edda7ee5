"""What an identification says, in the terminal and on its page."""

from __future__ import annotations

import math

import numpy as np

from geocontact.analyses.misalignment.identify.description import ratios
from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.free_joint import Free, stroke_stiffness
from geocontact.analyses.misalignment.identify.reservations import SCALE_FREE
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.end_stop import EndStop
from geocontact.identify.intervals.bin_tests import LEVEL, BinTest


def say(record: Record, found: Fitted, free: Free | None) -> None:
    """Tell the record each number, how well the force is predicted, and what the free joint does."""
    for each in found.intervals:
        record.say(f"{each.words} {each.shown}")
    told = [f"R² {found.r2:.3f} of {len(found.estimate.problem.force)} bin means"]
    if found.held:
        worst = min(each.r2 for each in found.held)
        told.append(f"not used: {worst:.3f} at least over {len(found.held)}")
    record.say("; ".join(told))
    record.say(f"residuals: {found.residuals.normality.words}")
    if free is None:
        return
    for stop in free.stroke.stops:
        span = f"{np.degrees(stop.first):.0f} … {np.degrees(stop.last):.0f}°"
        record.say(
            f"free joint: stands at its {stop.side} end, {stop.position * 1e3:.1f} mm, over {span} under "
            f"{stop.force:+.1f} N; it slides from {np.degrees(stop.leaves):.0f}°, and the force levels off"
        )
    if free.stiffness is not None:
        s = free.stiffness
        record.say(f"k by the free joint's displacement: {s.value:.4g} N/m (SE {s.error:.2g}, {s.trials} trials)")


def answer(found: Fitted) -> list[str]:
    """The offsets, or their ratios, and what else was identified, for the page."""
    told = [f"{each.words} is {each.shown}" for each in found.intervals]
    offsets = [line for line in told if line[0] in "xy"]
    others = [line for line in told if line[0] not in "xy"]
    axes = "The exoskeleton's axis lies off the joint's"
    lines = [f"{axes}: {' and '.join(offsets)}."] if offsets else []
    return [*lines, *([f"{'; '.join(others)}."] if others else [])]


def explained(found: Fitted, free: Free | None) -> list[str]:
    """What the data tell and what they do not, for the page."""
    words = found.residuals.normality.words
    told = [
        _scale(found),
        fixation_words(found),
        f"Residuals are {words}." if found.residuals.normality.p < 0.05 else f"Residuals: {words}.",
    ]
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
        return f"{SCALE_FREE}. What no scale changes: k l = {r['k_times_l_N']:.4g} N, {shares}."
    if problem.scale is not None:
        return (
            "The scale of k and the lengths is set by the free joint's displacement, over which d_tot rises one for "
            f"one (SE {problem.scale.error:.2%})."
        )
    return "The scale of k and the lengths is set by what was known beforehand, not by these recordings."


def fixation_words(found: Fitted) -> str:
    """What k holds beside the cuff, and how far a fixation that yields could be told from it."""
    apart, c = found.separable, found.estimate.named["c"]
    if not apart.told:
        told = "Angle and force cannot tell them apart: only 1/k + c is known."
    else:
        told = (
            f"Of what a yielding fixation does to the force, {apart.from_all:.1%} is its own beside the free numbers "
            f"({apart.from_cuff:.1%} beside k alone); the rest looks like another cuff."
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
