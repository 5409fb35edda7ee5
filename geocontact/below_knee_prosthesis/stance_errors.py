"""A simulated stance beside a force plate, as the study judges it (its sec. 2.5)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.integrate import cumulative_trapezoid

from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.simulate import GATE, Stance, share_of_foot
from geocontact.identify.signals.agreement import agreement
from geocontact.identify.signals.cycles import loaded_spans
from geocontact.identify.signals.zero_lag import zero_lag
from geocontact.loads.centre_of_pressure import POINTS

CUTOFF = 40.0
"""Hz; of the plate's forces, and of the simulated ones beside them."""
SAMPLES = 101
"""Over the stance that the plate saw."""


@dataclass(frozen=True, eq=False)
class PlateStance:
    """What a plate saw of the prosthetic foot, in the frame of a right leg.

    Parameters
    ----------
    force
        On the foot [N].
    centre
        Of pressure [m]; NaN where the foot is not loaded.
    """

    time: Float[np.ndarray, " t"]
    force: Float[np.ndarray, "t 3"]
    centre: Float[np.ndarray, "t 3"]


@dataclass(frozen=True, eq=False)
class StanceErrors:
    """Numbers of the comparison.

    Parameters
    ----------
    share
        Of the plate's stance, 0 to 1.
    curves
        Simulated and measured by name: forces over body weight, impulse [s], centre of pressure (share of the foot).
    table
        By quantity: R² and root mean square error in the curve's unit.
    stance
        Length by simulation and by the plate [s].
    start
        Touch-down by the plate [s].
    """

    share: Float[np.ndarray, " s"]
    curves: Mapping[str, tuple[Float[np.ndarray, " s"], Float[np.ndarray, " s"]]]
    table: Mapping[str, tuple[float, float]]
    stance: tuple[float, float]
    start: float


def stance_errors(found: Stance, plate: PlateStance) -> StanceErrors:
    """Over the plate's stance; ValueError where the plate has none."""
    weight = found.motion.leg.person.mass * GRAVITY
    span = longest_stance(plate.time, plate.force[:, 1])
    if span is None:
        raise ValueError(f"the plate never carries {GATE:g} N")
    share = np.linspace(0.0, 1.0, SAMPLES)
    time = span[0] + share * (span[1] - span[0])
    step = float(found.time[1] - found.time[0])
    own = at_times(time, found.time, zero_lag(found.force, step, CUTOFF)) / weight
    seen = at_times(time, plate.time, plate.force) / weight
    curves = {"resultant": (np.linalg.norm(own, axis=1), np.linalg.norm(seen, axis=1))}
    for name, axis in (("vertical", 1), ("fore_aft", 0), ("medio_lateral", 2)):
        curves[name] = (own[:, axis], seen[:, axis])
    sums = [np.asarray(cumulative_trapezoid(each, time, initial=0)) for each in curves["resultant"]]
    curves["impulse"] = (sums[0], sums[1])
    poses, length = found.poses, found.foot.keel.length
    across = np.column_stack([np.interp(found.time, plate.time, column) for column in plate.centre.T])
    seen_centre = np.interp(time, found.time, share_of_foot(poses, length, across))
    for point in POINTS:
        curves[f"cop_{point}"] = (np.interp(time, found.time, found.along_foot(point)), seen_centre)
    table = {}
    for name, (model, measured) in curves.items():
        told = agreement(model, measured, float(time[1] - time[0]))
        table[name] = (told.r2, told.rmsd)
    own_span = longest_stance(found.time, found.force[:, 1])
    lasting = np.nan if own_span is None else own_span[1] - own_span[0]
    return StanceErrors(share, curves, table, (float(lasting), float(span[1] - span[0])), float(span[0]))


def longest_stance(time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"]) -> tuple[float, float] | None:
    """Start and end of the longest span under load [s]; None where there is none."""
    spans = loaded_spans(time, load, GATE)
    if not spans:
        return None
    longest = max(spans, key=lambda each: each.end - each.start)
    return float(longest.start), float(longest.end)


def at_times(
    wanted: Float[np.ndarray, " s"], time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t 3"]
) -> Float[np.ndarray, "s 3"]:
    """Columns at other times [s], linear between samples."""
    return np.column_stack([np.interp(wanted, time, column) for column in values.T])
