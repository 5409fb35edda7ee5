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
"""Hz; of the plate's forces and of the simulated ones beside them, as the study has it."""
SLOWEST = 0.4
"""Of a plate's rate: the cut-off of both where the plate is too slow for `CUTOFF`."""
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
        What was not simulated is NaN.
    table
        By quantity: R² and root mean square error in the curve's unit, over what was simulated.
    stance
        Length by simulation and by the plate [s]; NaN by simulation where it ended before toe-off.
    start
        Touch-down by the plate [s].
    """

    share: Float[np.ndarray, " s"]
    curves: Mapping[str, tuple[Float[np.ndarray, " s"], Float[np.ndarray, " s"]]]
    table: Mapping[str, tuple[float, float]]
    stance: tuple[float, float]
    start: float

    @property
    def simulated(self) -> float:
        """Share of the plate's stance that was simulated, 0 to 1."""
        return float(np.isfinite(self.curves["resultant"][0]).mean())


def stance_errors(found: Stance, plate: PlateStance) -> StanceErrors:
    """Over the plate's stance, as far as it was simulated; ValueError where the plate has none.

    Forces of both pass the same zero-lag low-pass, each at its own rate and over all of its recording.
    """
    weight = found.motion.leg.person.mass * GRAVITY
    span = longest_stance(plate.time, plate.force[:, 1])
    if span is None:
        raise ValueError(f"the plate never carries {GATE:g} N")
    share = np.linspace(0.0, 1.0, SAMPLES)
    time = span[0] + share * (span[1] - span[0])
    steps = [float(np.median(np.diff(each))) for each in (found.time, plate.time)]
    cutoff = min(CUTOFF, *(SLOWEST / step for step in steps))
    own = simulated_at(time, found.time, zero_lag(found.force, steps[0], cutoff)) / weight
    seen = at_times(time, plate.time, zero_lag(plate.force, steps[1], cutoff)) / weight
    curves = {"resultant": (np.linalg.norm(own, axis=1), np.linalg.norm(seen, axis=1))}
    for name, axis in (("vertical", 1), ("fore_aft", 0), ("medio_lateral", 2)):
        curves[name] = (own[:, axis], seen[:, axis])
    curves["impulse"] = _impulses(time, *curves["resultant"])
    poses, length = found.poses, found.foot.keel.length
    across = np.column_stack([np.interp(found.time, plate.time, column) for column in plate.centre.T])
    along = [share_of_foot(poses, length, across), *(found.along_foot(point) for point in POINTS)]
    seen_centre, *centres = simulated_at(time, found.time, np.column_stack(along)).T
    for point, centre in zip(POINTS, centres, strict=True):
        curves[f"cop_{point}"] = (centre, seen_centre)
    table = {}
    for name, (model, measured) in curves.items():
        told = agreement(model, measured, float(time[1] - time[0]))
        table[name] = (told.r2, told.rmsd)
    own_span = longest_stance(found.time, found.force[:, 1])
    lasting = np.nan if own_span is None else own_span[1] - own_span[0]
    return StanceErrors(share, curves, table, (float(lasting), float(span[1] - span[0])), float(span[0]))


def _impulses(
    time: Float[np.ndarray, " s"], own: Float[np.ndarray, " s"], seen: Float[np.ndarray, " s"]
) -> tuple[Float[np.ndarray, " s"], Float[np.ndarray, " s"]]:
    """Of forces over time, from the first sample that both have; the simulated one is NaN where it has none."""
    both = np.isfinite(own)
    model = np.full_like(own, np.nan)
    model[both] = cumulative_trapezoid(own[both], time[both], initial=0)
    measured = np.asarray(cumulative_trapezoid(seen, time, initial=0))
    return model, measured - measured[int(np.argmax(both))]


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


def simulated_at(
    wanted: Float[np.ndarray, " s"], time: Float[np.ndarray, " t"], values: Float[np.ndarray, "t k"]
) -> Float[np.ndarray, "s k"]:
    """The same of what was simulated: NaN before its start and past its end."""
    return np.column_stack([np.interp(wanted, time, column, np.nan, np.nan) for column in values.T])
