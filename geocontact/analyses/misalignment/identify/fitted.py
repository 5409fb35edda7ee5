"""The fit to recordings with a locked joint, and what those with a free joint tell beside it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import if_it_fits, reserve
from geocontact.analyses.misalignment.identify.beside import Beside, beside_of
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.law_numbers import PER_SI, WRITTEN
from geocontact.axis_misalignment.bins import FORCE, Binned, binned
from geocontact.axis_misalignment.compensation import (
    DisplacementScale,
    RecordedStroke,
    Stiffness,
    bin_means,
    displacement_scale,
    recorded_stroke,
    stiffness_by_displacement,
)
from geocontact.axis_misalignment.explicit import require_no_pole, require_reach
from geocontact.axis_misalignment.law import GROWING, LENGTHS, SCALED, offsets_of
from geocontact.axis_misalignment.least_squares import ElbowFit, law_at, r_squared
from geocontact.axis_misalignment.prediction import (
    Held,
    Residuals,
    ScaleLine,
    correlations_with_others,
    each_left_out,
    held_out,
    mirrored_r2,
    residuals_of,
    scale_line,
    turned_words,
)
from geocontact.axis_misalignment.uncertainty import (
    Direction,
    Separability,
    covariance,
    direction,
    profiled,
    separability,
    wild_bootstrap,
    with_link_held,
)
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.intervals.bin_tests import BinPair, BinTest, between_bins, between_neighbours
from geocontact.identify.intervals.profile_likelihood import Profile

ROUNDING = 1e-9  # of the force's range; less is no noise
LEAST_BINS = 8  # that a fit is made to
APART, TOGETHER = 0.5, 0.9  # correlation of a trial with the others below which it is looked at; that of what mends it
MIRRORED = -0.5  # correlation of a trial with the others from which on its sign is turned


def require_bins(paths: Sequence[Path], recordings: Sequence[ElbowRecording], data: Binned) -> None:
    """Refuse too few bins, name those that are missing inside the range reached, and a trial of the other sign."""
    bins = len(data.visits.edges) - 1
    reached = np.bincount(data.cells.place, minlength=bins) > 0
    if reached.sum() < LEAST_BINS:
        span = np.degrees(data.visits.edges[[0, -1]])
        what = f"{reached.sum()} bins are reached between {span[0]:.0f} and {span[1]:.0f} degrees"
        raise InputError(paths[0], "", what, f"{LEAST_BINS} are needed: give narrower bins (`bin`) or wider motion")
    _require_noise(paths[0], data)
    inside = np.flatnonzero(reached)[[0, -1]]
    missing = np.flatnonzero(~reached[: inside[1]])
    missing = missing[missing > inside[0]]
    if len(missing):
        runs = np.split(missing, np.flatnonzero(np.diff(missing) > 1) + 1)
        edges = np.degrees(data.visits.edges)
        told = ", ".join(f"{edges[run[0]]:.0f}…{edges[run[-1] + 1]:.0f}°" for run in runs)
        reserve(f"no sample in {len(missing)} bins inside the range reached: {told}")
    _refuse_mirrored(paths, recordings, data)


def _require_noise(path: Path, data: Binned) -> None:
    """Refuse recordings whose samples all lie on the curve through their bins, as one sample in each bin does."""
    noise, force = float(data.noise.sd[0]), data.cells.means[:, FORCE]
    if not noise > ROUNDING * float(np.ptp(force)):
        what = f"{data.cells.count.sum():.0f} samples in {len(np.unique(data.cells.place))} bins show no noise"
        raise InputError(path, "", what, "give longer recordings or wider bins (`bin`): noise sets the intervals")


def _refuse_mirrored(paths: Sequence[Path], recordings: Sequence[ElbowRecording], data: Binned) -> None:
    """A trial whose force mirrors that of the others; a warning where it does not go with them and would, if turned."""
    width = float(data.visits.edges[1] - data.visits.edges[0])
    for k, (path, correlation) in enumerate(zip(paths, correlations_with_others(data, LEAST_BINS), strict=True)):
        if not correlation < APART:
            continue
        most, likely = turned_words(recordings, k, width, LEAST_BINS)
        others_are = "the other trial, and nothing shows which is right" if len(paths) == 2 else "the other trials"
        at = f"(correlation {correlation:.2f} over the bins)"
        remedy = f"most likely {likely}: correct the file, or leave it out"
        if correlation < MIRRORED:
            raise InputError(path, "", f"its force mirrors that of {others_are} {at}", remedy)
        if most > TOGETHER:
            reserve(f"{path}: its force does not go with that of {others_are} {at}; {remedy}", cause=True)


def predicted(
    paths: Sequence[Path], recordings: Sequence[ElbowRecording], data: Binned, e: ElbowFit, width: float
) -> list[Held]:
    """Recordings of their own, in bins of `width` [rad]; InputError for one whose force mirrors what is predicted."""
    found = []
    for path, r in zip(paths, recordings, strict=True):
        own = binned([r], width, data.pressure)
        measured, force = own.cells.means[:, FORCE], law_at(own.cells.means).force(e.theta)
        with np.errstate(invalid="ignore"):
            along = float(np.corrcoef(measured, force)[0, 1])
        if along < MIRRORED:
            what = f"its force mirrors what the fitted trials predict (correlation {along:.2f} over the bins)"
            raise InputError(path, "", what, "is its sign turned? correct the file, or leave it out")
        found.append(held_out(r.name, own, e.theta))
    return found


TIMES_LINK = {"k": "N", "b": "N s"}
"""Units of the stiffness and the damping times the link's length."""
TAILS = (2.5, 97.5)


@dataclass(frozen=True, eq=False)
class ShownInterval:
    """One number or ratio in the unit shown, with its 95 %.

    Parameters
    ----------
    key, words
        Name in files and in sentences: k, or k_times_l and "k l".
    unit, per
        Shown, empty for a ratio; how many of it one of the profile's is.
    profile
        Of the number, or with l held of that which the ratio is made of.
    drawn
        Ends by the bootstrap in the unit shown; None without.
    """

    key: str
    words: str
    unit: str
    per: float
    profile: Profile
    drawn: tuple[float, float] | None

    @property
    def value(self) -> float:
        """Best value."""
        return self.profile.best * self.per

    @property
    def parts(self) -> list[tuple[float, float]]:
        """Lower and upper end of each part of the profile's interval."""
        return [(low * self.per, high * self.per) for low, high in self.profile.parts]

    @property
    def lower(self) -> float:
        """Least value within."""
        return self.profile.lower * self.per

    @property
    def upper(self) -> float:
        """Largest value within."""
        return self.profile.upper * self.per

    @property
    def lower_open(self) -> bool:
        """Whether the recordings set no least value."""
        return self.profile.lower_open

    @property
    def upper_open(self) -> bool:
        """Whether the recordings set no largest value."""
        return self.profile.upper_open

    @property
    def ends(self) -> str:
        """Ends in words, of each part."""
        told = [f"{end:.4g}" for part in self.parts for end in part]
        if self.lower_open:
            told[0] = "open"
        if self.upper_open:
            told[-1] = "open"
        return " or ".join(f"{low} … {high}" for low, high in zip(told[::2], told[1::2], strict=True))

    @property
    def sign_open(self) -> bool:
        """Whether there are values of both signs within."""
        return self.lower < 0.0 < self.upper

    @property
    def shown(self) -> str:
        """Value, unit as far as there is one, and ends; without ends where the law contradicts the forces."""
        return f"{' '.join(filter(None, (f'{self.value:.4g}', self.unit)))}{if_it_fits(f' (95 % {self.ends})')}"


def intervals(data: Binned, e: ElbowFit, replicates: int) -> tuple[ShownInterval, ...]:
    """One for each free number; where nothing sets the scale, for k l, x/l, y/l, z/l in place of k and the lengths.

    `replicates` of the bootstrap are drawn, none for 0.
    """
    spread = covariance(data, e)
    if not e.problem.scale_free:
        drawn = _drawn(data, e, replicates)
        return tuple(_number(name, profiled(e, spread, name), drawn.get(name)) for name in e.problem.names)
    held, link = with_link_held(e), e.named["l"]
    held_spread, drawn = covariance(data, held), _drawn(data, held, replicates)
    return tuple(
        _ratio(name, profiled(held, held_spread, name), link, drawn.get(name))
        if name in SCALED
        else _number(name, profiled(e, spread, name), None)
        for name in e.problem.names
        if name != "l"
    )


def _drawn(data: Binned, e: ElbowFit, replicates: int) -> dict[str, tuple[float, float]]:
    """Ends of the bootstrap's 95 % by free number; empty without one."""
    if not replicates:
        return {}
    low, high = np.percentile(wild_bootstrap(data, e, replicates), TAILS, axis=0)
    return {name: (float(low[k]), float(high[k])) for k, name in enumerate(e.problem.names)}


def _ratio(name: str, p: Profile, link: float, drawn: tuple[float, float] | None) -> ShownInterval:
    per = 1.0 / link if name in GROWING else link
    ends = None if drawn is None else (drawn[0] * per, drawn[1] * per)
    if name in GROWING:
        return ShownInterval(f"{name}_over_l", f"{name}/l", "" if name in LENGTHS else "1/N", per, p, ends)
    return ShownInterval(f"{name}_times_l", f"{name} l", TIMES_LINK[name], per, p, ends)


def _number(name: str, p: Profile, drawn: tuple[float, float] | None) -> ShownInterval:
    per = PER_SI[name]
    ends = None if drawn is None else (drawn[0] * per, drawn[1] * per)
    return ShownInterval(name, name, WRITTEN[name], per, p, ends)


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
        What is least known of k and the lengths, and of those of them that are free.
    separable
        Whether a fixation of the upper arm that yields is separable from a softer cuff.
    held
        Of every trial left out, or of the recordings that were held out.
    bins_differ, neighbours
        Tests of the force between the wider bins.
    r2, mirrored_r2
        Of bin means, and of the force turned over.
    beside
        What was measured beside the force.
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
    beside: Beside


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
        line=scale_line(e),
        held=predicted(o.held_out or (), apart, data, e, o.bin) if apart else each_left_out(data, e),
        bins_differ=between_bins(boxes.visits, FORCE),
        neighbours=between_neighbours(boxes.visits, FORCE),
        residuals=residuals_of(locked, data, e),
        r2=r_squared(measured, e.predicted),
        mirrored_r2=mirrored_r2(e),
        beside=beside_of(data, e),
    )


def _refuse_beyond(e: ElbowFit) -> None:
    """A fit that ended where the model has a pole or folds."""
    offsets = offsets_of(e.theta)
    try:
        require_reach(offsets)
        require_no_pole(e.problem.law.beta, offsets)
    except ValueError as error:
        raise InputError("", "", f"the best numbers are beyond the model: {error}", "narrow `bounds`") from error


AGAINST = 3.0  # standard errors below 0 from which a stiffness is a turned sign


@dataclass(frozen=True, eq=False)
class Free:
    """What the recordings with a free joint tell.

    Parameters
    ----------
    boxes
        Their samples in wide bins.
    stiffness
        Locked force over the free joint's displacement; None where that is not identified.
    scale
        What the displacement tells of the lengths; None without a standard error.
    """

    recordings: Sequence[ElbowRecording]
    boxes: Binned
    stroke: RecordedStroke
    stiffness: Stiffness | None
    scale: DisplacementScale | None
    bins_differ: BinTest | None
    neighbours: Sequence[BinPair]
    rotary_free: bool


def free_joint(o: IdentifyOptions, recordings: Sequence[ElbowRecording], locked: Binned) -> Free | None:
    """Ends of the stroke, stiffness and scale from trials with a free joint beside locked ones; None without any."""
    if not recordings or o.unlocked is None:
        return None
    data = binned(recordings, o.bin)
    require_bins(o.unlocked, recordings, data)
    stroke = recorded_stroke(bin_means(data))
    if stroke is None:
        what = "the compensation joint slides over fewer than three bins"
        raise InputError(o.unlocked[0], "", what, "was it free?")
    boxes = binned(recordings, o.box)
    trials = [bin_means(data.only(trial)) for trial in range(len(data.names))]
    return Free(
        recordings=recordings,
        boxes=boxes,
        stroke=stroke,
        stiffness=None if o.rotary_free else _stiffness(o, locked, stroke),
        scale=displacement_scale(trials, stroke, o.bin, rotary_free=o.rotary_free),
        bins_differ=between_bins(boxes.visits, FORCE),
        neighbours=between_neighbours(boxes.visits, FORCE),
        rotary_free=o.rotary_free,
    )


def stroke_stiffness(e: ElbowFit, free: Free) -> float | None:
    """k that says how much stroke is wanting [N/m]: by displacement, else as fitted; None where the scale is free."""
    if free.stiffness is not None and free.stiffness.value > 0.0:
        return free.stiffness.value
    return None if e.problem.scale_free else e.named["k"]


def _stiffness(o: IdentifyOptions, locked: Binned, stroke: RecordedStroke) -> Stiffness | None:
    each = [bin_means(locked.only(trial)) for trial in range(len(locked.names))]
    found = stiffness_by_displacement(each, stroke, o.bin)
    if found is not None and found.value + AGAINST * np.nan_to_num(found.error) < 0.0:
        what = f"displacement and locked force run against each other ({found.value:.4g} N/m)"
        remedy = "one of them has its sign turned: `map` displacement=-… or force=-…"
        raise InputError((o.unlocked or ("",))[0], "", what, remedy)
    return found
