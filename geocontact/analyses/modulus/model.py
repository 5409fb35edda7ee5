"""The law of one side on the frames that its area and its force share, at a threshold."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.analyses.modulus.options import ModulusOptions
from geocontact.analyses.modulus.read import BOTH, HALVES, ModulusInputs
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.elastic_modulus.area_force import LAG, AreaForce
from geocontact.elastic_modulus.both_sides import end_to_end
from geocontact.identify.signals.gaps import gaps, in_gaps
from geocontact.io.recordings.area_table import FEWEST, AreaTable

USUAL = 4.0e-3  # m, the threshold of the knee-implant paper


def threshold_given(o: ModulusOptions, table: AreaTable) -> float:
    """Threshold [m] as given, or the usual one."""
    if o.threshold is None:
        near = np.isclose(table.thresholds, USUAL, rtol=1e-9)
        if near.any() or len(table.thresholds) == 1:
            return float(table.thresholds[int(np.argmax(near))])
    wanted = USUAL if o.threshold is None else o.threshold
    near = np.isclose(table.thresholds, wanted, rtol=1e-9, atol=1e-12)
    if not near.any():
        levels = ", ".join(f"{level * 1e3:g}" for level in table.thresholds)
        what = f"{wanted * 1e3:g} mm was not evaluated; {table.file} has {levels} mm"
        raise InputError("", "`threshold`", what, "name one of these, or `free` threshold")
    return float(table.thresholds[int(np.argmax(near))])


def model_of(
    i: ModulusInputs, side: str, threshold: float, others: tuple[Parameter, ...]
) -> tuple[AreaForce, Float[np.ndarray, " n"]]:
    """The law of one side on the frames that area and force share at every lag that is allowed, and the force there."""
    if side == BOTH:
        halves = [model_of(i, half, threshold, others) for half in HALVES]
        return end_to_end([model for model, _ in halves], [force for _, force in halves])
    time, clock, evolution = i.table.time, i.forces.time, i.evolutions[side]
    free = next((p for p in others if p.name == LAG), None)
    low, high = (i.lag, i.lag) if free is None else (free.lower, free.upper)
    taken = i.lag if free is None else free.start
    inside = (time + taken >= clock[0]) & (time + taken <= clock[-1])
    inside &= (time + taken - high >= time[0] - 1e-12) & (time + taken - low <= time[-1] + 1e-12)
    inside &= ~in_gaps(time + taken, gaps(clock))
    if inside.sum() < FEWEST:
        what = f"{int(inside.sum())} frames of the area ({time[0]:g} to {time[-1]:g} s) lie in the force's time"
        remedy = f"{FEWEST} at least; are the clocks the same? see `lag`"
        raise InputError(i.forces.file, "", f"{what} ({clock[0]:g} to {clock[-1]:g} s)", remedy)
    frames = time[inside]
    measured = np.interp(frames + taken, clock, i.forces.forces[side])
    return AreaForce(evolution, i.reading, frames, taken, threshold, i.adhesion), measured
