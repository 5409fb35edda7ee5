"""A compensation joint of an elbow exoskeleton: its free stroke, its ends in a recording, and the scale of stiffness
and lengths that it shows.

The joint takes up the deflection as long as it lies between the ends, so F = k (d - min(max(d, lower), upper)); locked,
both ends are 0. All that a limit on |F| asks of the ends follows from the least and the largest deflection.

A joint at a stroke end does not move although the angle does, and force builds up; a joint that slides keeps the force
at one level. Both are asked for: a displacement curve has a flat extreme of its own.

While the joint slides between its ends its displacement is d_tot but for its zero, in metres: over it the law's d_tot
has to rise one for one. Where the device has a second, rotary joint at the cuff that is free as well, as the paper's
had in its unlocked condition, the cuff turns instead of being pushed aside, and the displacement is d_lin. Either is
asked of the lengths alone, beside the locked forces, which so are counted once.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Bool, Float

from geocontact.axis_misalignment.bins import BETA, DISPLACEMENT, FORCE, Binned
from geocontact.axis_misalignment.law import ElbowLaw


@dataclass(frozen=True)
class Compensation:
    """Stiffness k of the attachment [N/m] and stroke ends of the joint [m]; locked unless stated otherwise."""

    stiffness: float
    lower: float = 0.0
    upper: float = 0.0

    def force(self, deflection: Float[np.ndarray, "*shape"]) -> Float[np.ndarray, "*shape"]:
        """Force on the limb [N], positive where the attachment is deflected towards the joint."""
        return np.asarray(self.stiffness * taken_up(deflection, (self.lower, self.upper))[1])

    def peak(self, extremes: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, " n"]:
        """Largest |F| [N] over a range in which the deflection has these extremes; NaN is kept."""
        return self.stiffness * beyond(extremes, self.lower, self.upper)


def taken_up(
    total: Float[np.ndarray, "*shape"], stroke: tuple[float, float]
) -> tuple[Float[np.ndarray, "*shape"], Float[np.ndarray, "*shape"]]:
    """Displacement of a joint that slides freely from `stroke[0]` to `stroke[1]` [m], and what is left for the cuff.

    `total` is d_tot [m]. A locked joint has both ends at 0. ValueError where the stroke ends before it begins.
    """
    low, high = stroke
    if low > high:
        raise ValueError(f"a stroke from {low * 1e3:g} to {high * 1e3:g} mm ends before it begins")
    moved = np.clip(total, low, high)
    return moved, np.asarray(total - moved)


def beyond(extremes: Float[np.ndarray, "n 2"], lower: float, upper: float) -> Float[np.ndarray, " n"]:
    """How far a deflection between these extremes goes beyond the stroke at most, to either side [m]; NaN is kept."""
    return np.asarray(np.maximum(np.maximum(extremes[:, 1] - upper, lower - extremes[:, 0]), 0.0))


def needed_ends(extremes: Float[np.ndarray, "n 2"], slack: float) -> Float[np.ndarray, "n 2"]:
    """Stroke ends [m] that keep |F| under k `slack` while the deflection goes between these extremes [m].

    The lower end must not be above the first, the upper end not below the second. Where the first is the larger of the
    two no stroke is needed: a joint locked anywhere between them will do.
    """
    return np.asarray(extremes + slack * np.array([1.0, -1.0]))


STILL = 0.05  # of the displacement's range: so close to its extreme the joint stands
STANDS = 0.005  # of it, median deviation: a smooth extreme has more within STILL of it
FEWEST = 3  # bins that make up a stand, or a free range
BUILT_UP = 3.0  # standard deviations of the force while the joint slides


@dataclass(frozen=True, eq=False)
class BinMeans:
    """Means over all trials of a bin: angle [rad], force [N], displacement of the joint [m]."""

    beta: Float[np.ndarray, " b"]
    force: Float[np.ndarray, " b"]
    joint: Float[np.ndarray, " b"]


@dataclass(frozen=True)
class EndStop:
    """A stand of the joint at one end of its stroke.

    Parameters
    ----------
    side
        "lower" or "upper" end of the displacement.
    position
        Where it stands [m].
    first, last
        Angles over which it stands [rad].
    leaves
        Angle at which it starts to slide [rad].
    force
        Of the largest magnitude there, less the level while it slides [N].
    """

    side: str
    position: float
    first: float
    last: float
    leaves: float
    force: float


@dataclass(frozen=True, eq=False)
class RecordedStroke:
    """What the joint does over the angle: its stands, and the level and spread of the force while it slides [N].

    `slides` says for each bin whether the joint is at neither extreme of its displacement.
    """

    curve: BinMeans
    stops: tuple[EndStop, ...]
    level: float
    spread: float
    slides: Bool[np.ndarray, " b"]


@dataclass(frozen=True)
class Stiffness:
    """Slope of the locked force over the free joint's displacement [N/m].

    While the joint slides its displacement is d_tot (but for its zero), and the locked force is k d_tot: their ratio is
    k, which angle and force alone do not tell.

    Parameters
    ----------
    value, error
        Mean over the locked trials and its standard error; NaN with a single trial.
    trials, bins
        Trials, and bins in common of each on average.
    """

    value: float
    error: float
    trials: int
    bins: float


def bin_means(data: Binned) -> BinMeans:
    """Means over all trials, bin by bin, of the bins that were reached."""
    cells = data.cells
    bins = len(data.visits.edges) - 1
    count = np.bincount(cells.place, cells.count, bins)
    there = count > 0.0
    wanted = (cells.means[:, k] for k in (BETA, FORCE, DISPLACEMENT))
    columns = [np.bincount(cells.place, cells.count * means, bins)[there] / count[there] for means in wanted]
    return BinMeans(*columns)


def recorded_stroke(curve: BinMeans) -> RecordedStroke | None:
    """Stands and free range of the joint; None where it slides over fewer than three bins."""
    low, high = float(curve.joint.min()), float(curve.joint.max())
    near = STILL * (high - low)
    at = {"lower": curve.joint <= low + near, "upper": curve.joint >= high - near}
    slides = ~(at["lower"] | at["upper"])
    if slides.sum() < FEWEST:
        return None
    level = float(np.median(curve.force[slides]))
    spread = float(curve.force[slides].std())
    stops = [stop for side, still in at.items() if (stop := _stop(curve, side, still, level, spread)) is not None]
    return RecordedStroke(curve, tuple(stops), level, spread, slides)


def _stop(curve: BinMeans, side: str, still: Bool[np.ndarray, " b"], level: float, spread: float) -> EndStop | None:
    """The longest stand at one extreme, where force builds up in it."""
    runs = np.split(np.arange(len(still)), np.flatnonzero(np.diff(still.astype(int))) + 1)
    run = max((r for r in runs if still[r[0]]), key=len)
    built = curve.force[run] - level
    most = float(built[int(np.argmax(np.abs(built)))])
    position = float(np.median(curve.joint[run]))
    stands = float(np.median(np.abs(curve.joint[run] - position))) <= STANDS * float(np.ptp(curve.joint))
    if len(run) < FEWEST or abs(most) < BUILT_UP * spread or not stands:
        return None
    first, last = float(curve.beta[run[0]]), float(curve.beta[run[-1]])
    return EndStop(side, position, first, last, _leaves(curve, run, position), most)


def _leaves(curve: BinMeans, run: np.ndarray, position: float) -> float:
    """Angle at which the straight line through the first two bins off the stand meets it [rad]; its end without."""
    last = len(curve.beta) - 1
    way = 1 if run[-1] < last else -1
    begin = int(run[-1] if way == 1 else run[0])
    outside = [begin + way, begin + 2 * way]
    if not 0 <= outside[1] <= last:
        return float(curve.beta[begin])
    (b1, b2), (d1, d2) = curve.beta[outside], curve.joint[outside]
    met = b1 + (position - d1) * (b2 - b1) / (d2 - d1) if d1 != d2 else curve.beta[begin]
    low, high = sorted((float(curve.beta[begin]), float(b1)))
    return min(max(float(met), low), high)


def stiffness_by_displacement(locked: Sequence[BinMeans], stroke: RecordedStroke, width: float) -> Stiffness | None:
    """k from the locked force of each trial and the free displacement at the same angles.

    None where no trial has three bins in common with the free range; `width` is that of a bin [rad].
    """
    found = [slope_over(each.beta, each.force, stroke, width) for each in locked]
    slopes = [(s, n) for s, n in found if n >= FEWEST]
    if not slopes:
        return None
    values = np.array([s for s, _ in slopes])
    error = float(values.std(ddof=1) / np.sqrt(len(values))) if len(values) > 1 else float("nan")
    return Stiffness(float(values.mean()), error, len(values), float(np.mean([n for _, n in slopes])))


def slope_over(
    beta: Float[np.ndarray, " b"], values: Float[np.ndarray, " b"], stroke: RecordedStroke, width: float
) -> tuple[float, int]:
    """Least-squares slope of one trial's bin means over the free displacement at the same angles, and of how many bins.

    Bins over which the joint slides count; NaN where there are fewer than three.
    """
    free = stroke.curve
    near = {j: np.flatnonzero(np.abs(beta - free.beta[j]) < 0.5 * width) for j in np.flatnonzero(stroke.slides)}
    pairs = [(j, int(places[0])) for j, places in near.items() if len(places)]
    if len(pairs) < FEWEST:
        return float("nan"), len(pairs)
    moved = free.joint[[j for j, _ in pairs]]
    off = moved - moved.mean()
    return float(off @ values[[k for _, k in pairs]] / (off @ off)), len(pairs)


TOTAL = {0: 1.0, 5: 0.0, 6: 0.0, 7: 0.0}
"""k, b, s and c with which the law's force is d_tot: without force the upper arm's fixation does not yield."""
LINEAR = {**TOTAL, 4: 0.0}
"""And z, with which it is d_lin: what a free joint slides by where a rotary joint beside it is free as well."""


@dataclass(frozen=True, eq=False)
class DisplacementScale:
    """Slope of the law's d_tot over the free displacement, and the error with which it is 1.

    Parameters
    ----------
    law
        At the mean angles of the bins over which the joint slides.
    share
        Of each bin's d_tot in the least-squares slope over the displacement [1/m].
    slope
        That is asked of the law: 1, or a draw about it.
    error
        Standard error of the mean displacement's own scale over the free trials.
    trials
        Free trials.
    rest
        Numbers of the law, by place, with which its force is what the free joint slides by.
    """

    law: ElbowLaw
    share: Float[np.ndarray, " b"]
    slope: float
    error: float
    trials: int
    rest: Mapping[int, float] = field(default_factory=lambda: dict(TOTAL))

    def residual(self, theta: Float[np.ndarray, " 8"]) -> float:
        """What the law's slope is too large by, in standard errors."""
        return (float(self.share @ self.law.force(self._at_rest(theta))) - self.slope) / self.error

    def slopes(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " 8"]:
        """Derivative of the residual with respect to each number; k, b, s and c have none."""
        found = self.share @ self.law.slopes(self._at_rest(theta), fixation=False) / self.error
        found[list(self.rest)] = 0.0
        return np.asarray(found)

    def drawn(self, rng: np.random.Generator) -> DisplacementScale:
        """The bin means as they could have been measured."""
        return replace(self, slope=float(rng.normal(self.slope, self.error)))

    def _at_rest(self, theta: Float[np.ndarray, " 8"]) -> Float[np.ndarray, " 8"]:
        rest = theta.copy()
        rest[list(self.rest)] = list(self.rest.values())
        return rest


def displacement_scale(
    trials: Sequence[BinMeans], stroke: RecordedStroke, width: float, *, rotary_free: bool = False
) -> DisplacementScale | None:
    """The scale by the mean displacement of some free trials; None where it has no standard error.

    That is estimated from how each trial's displacement runs over the mean of all, which takes two trials that differ,
    each with three bins over which the joint slides; `width` is that of a bin [rad]. Where a rotary joint of the device
    was free too (`rotary_free`), the displacement is d_lin.
    """
    found = [slope_over(each.beta, each.joint, stroke, width) for each in trials]
    slopes = np.array([slope for slope, bins in found if bins >= FEWEST])
    error = float(slopes.std(ddof=1) / np.sqrt(len(slopes))) if len(slopes) > 1 else 0.0
    if not error > 0.0:
        return None
    beta, joint = stroke.curve.beta[stroke.slides], stroke.curve.joint[stroke.slides]
    off, still = joint - joint.mean(), np.zeros(len(beta))
    law, share = ElbowLaw(beta, still, still), off / (off @ off)
    return DisplacementScale(law, share, 1.0, error, len(slopes), dict(LINEAR if rotary_free else TOTAL))
