"""Everything that is found of recordings with a locked joint."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.identify.held_out import Held, each_left_out, predicted
from geocontact.analyses.misalignment.identify.intervals import ShownInterval, intervals
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.axis_misalignment.bins import FORCE, Binned, binned
from geocontact.axis_misalignment.explicit import require_no_pole, require_reach
from geocontact.axis_misalignment.law import SCALED, offsets_of
from geocontact.axis_misalignment.least_squares import ElbowFit, estimated, r_squared
from geocontact.axis_misalignment.residuals import Excess, excess, normality, residual_by_bin, standard_residuals
from geocontact.axis_misalignment.uncertainty import Direction, Separability, along_the_scale, direction, separability
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.intervals.bin_tests import BinPair, BinTest, Normality, between_bins, between_neighbours

FACTORS = np.geomspace(0.5, 2.0, 41)


@dataclass(frozen=True, eq=False)
class ScaleLine:
    """Numbers along the scale, which all give the same force.

    Parameters
    ----------
    numbers
        A row each, in the order of NAMES, SI units.
    r2, alone_r2
        R² of each row, and where k alone changes as it does along the line.
    """

    numbers: Float[np.ndarray, "m 8"]
    r2: Float[np.ndarray, " m"]
    alone_r2: Float[np.ndarray, " m"]


@dataclass(frozen=True, eq=False)
class Residuals:
    """Measured less fitted mean force of each bin.

    Parameters
    ----------
    beta, off
        Angle [rad] and residual [N], all trials together.
    standard
        Over the standard deviation of the bin's mean.
    normality, excess
        Whether they are normal, and how much larger than noise within the trials.
    """

    beta: Float[np.ndarray, " b"]
    off: Float[np.ndarray, " b"]
    standard: Float[np.ndarray, " _"]
    normality: Normality
    excess: Excess


@dataclass(frozen=True, eq=False)
class Fitted:
    """What the locked recordings tell.

    Parameters
    ----------
    data, boxes
        In the bins that are fitted, and in wider ones.
    intervals
        Of each free number, or of ratios where nothing sets the scale.
    stretches
        Of time, that intervals count.
    all_directions, free_directions
        What is told least of k and the lengths, and of those of them that are free.
    separable
        Whether a fixation of the upper arm that yields can be told from a softer cuff.
    held
        Of every trial left out, or of the recordings that were held out.
    bins_differ, neighbours
        Tests of the force between the wider bins.
    r2, mirrored_r2
        Of bin means, and of the force turned over.
    """

    recordings: Sequence[ElbowRecording]
    data: Binned
    boxes: Binned
    estimate: ElbowFit
    intervals: tuple[ShownInterval, ...]
    stretches: int
    all_directions: Direction
    free_directions: Direction | None
    separable: Separability
    line: ScaleLine
    held: Sequence[Held]
    bins_differ: BinTest | None
    neighbours: Sequence[BinPair]
    residuals: Residuals
    r2: float
    mirrored_r2: float


def fitted(
    locked: Sequence[ElbowRecording], data: Binned, e: ElbowFit, apart: Sequence[ElbowRecording], o: IdentifyOptions
) -> Fitted:
    """Intervals, directions, tests and predictions of an estimate; InputError where it is beyond the model."""
    _refuse_beyond(e)
    measured = data.cells.means[:, FORCE]
    free = tuple(name for name in e.problem.names if name in SCALED and e.named[name] != 0.0)
    boxes = binned(locked, o.box)
    return Fitted(
        recordings=locked,
        data=data,
        boxes=boxes,
        estimate=e,
        intervals=intervals(data, e, o.bootstrap),
        stretches=len(np.unique(data.visits.stretch)),
        all_directions=direction(e),
        free_directions=direction(e, free) if len(free) > 1 else None,
        separable=separability(e),
        line=_line(e, measured),
        held=predicted(o.held_out or (), apart, data, e, o.bin) if apart else each_left_out(data, e),
        bins_differ=between_bins(boxes.visits, FORCE),
        neighbours=between_neighbours(boxes.visits, FORCE),
        residuals=_residuals(locked, data, e),
        r2=r_squared(measured, e.predicted),
        mirrored_r2=_mirrored(e, measured),
    )


def _refuse_beyond(e: ElbowFit) -> None:
    """A fit that ended where the model has a pole or folds."""
    offsets = offsets_of(e.theta)
    try:
        require_reach(offsets)
        require_no_pole(e.problem.law.beta, offsets)
    except ValueError as error:
        raise InputError("", "", f"the best numbers are beyond the model: {error}", "narrow `bounds`") from error


def _line(e: ElbowFit, measured: Float[np.ndarray, " n"]) -> ScaleLine:
    rows = along_the_scale(e, FACTORS)
    alone = np.tile(e.theta, (len(rows), 1))
    alone[:, 0] = rows[:, 0]
    r2, alone_r2 = (
        np.array([r_squared(measured, e.problem.law.force(theta)) for theta in each]) for each in (rows, alone)
    )
    return ScaleLine(rows, r2, alone_r2)


def _residuals(locked: Sequence[ElbowRecording], data: Binned, e: ElbowFit) -> Residuals:
    beta, off = residual_by_bin(data, e)
    return Residuals(beta, off, standard_residuals(data, e), normality(locked, data, e), excess(locked, data, e))


def _mirrored(e: ElbowFit, measured: Float[np.ndarray, " n"]) -> float:
    """R² that the same model reaches on the force turned over."""
    turned = estimated(e.problem.measuring(-e.problem.force))
    return r_squared(-measured, turned.predicted)
