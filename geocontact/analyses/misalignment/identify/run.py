"""The identification at an elbow: reads, computes, writes, says what it found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.misalignment.identify.intervals import intervals
from geocontact.analyses.misalignment.identify.unknowns import SCALE_WORDS, checked_widths, unknowns
from geocontact.analyses.misalignment.parameters import MMHG
from geocontact.analyses.misalignment.recordings import MIRRORED, recordings, require_bins, require_locked
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.bins import FORCE, Binned, binned
from geocontact.axis_misalignment.end_stop import (
    RecordedStroke,
    Stiffness,
    bin_means,
    recorded_stroke,
    stiffness_by_displacement,
)
from geocontact.axis_misalignment.explicit import require_no_pole, require_reach
from geocontact.axis_misalignment.law import LENGTHS, SCALED, offsets_of
from geocontact.axis_misalignment.least_squares import (
    ElbowFit,
    ElbowProblem,
    estimated,
    law_at,
    problem_of,
    r_squared,
)
from geocontact.axis_misalignment.residuals import Excess, excess, normality
from geocontact.axis_misalignment.scale import DisplacementScale, displacement_scale
from geocontact.axis_misalignment.uncertainty import (
    Direction,
    along_the_scale,
    covariance,
    direction,
    profiled,
    wild_bootstrap,
    with_link_held,
)
from geocontact.cli.elbow_fit import ElbowFitOptions
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.intervals.bin_tests import BinPair, BinTest, Normality, between_bins, between_neighbours
from geocontact.identify.intervals.profile_likelihood import Profile
from geocontact.io.recordings.elbow_recording import DISPLACEMENT
from geocontact.io.recordings.elbow_recording import FORCE as FORCE_CHANNEL

FEW_STRETCHES = 12
FACTORS = np.geomspace(0.5, 2.0, 41)
RARE, MORE = 0.01, 1.5  # p and size from which residuals are more than noise
BETTER = 0.02  # of R² that the mirrored force must gain to be worth a word
TAILS = (2.5, 97.5)
SAME_PRESSURE = MMHG  # Pa; pressures that differ by less are one
AGAINST = 3.0  # standard errors below 0 from which a stiffness is a turned sign


@dataclass(frozen=True, eq=False)
class Held:
    """R² of bin means that were not fitted, by what was held out."""

    name: str
    r2: float
    rmse: float
    bins: int


@dataclass(frozen=True, eq=False)
class Fitted:
    """Everything found of the locked recordings.

    Parameters
    ----------
    profiles, drawn
        By free number; `drawn` are ends of the bootstrap's 95 %, empty without.
    link_held
        Profiles with l held at what was found, by free number; empty unless nothing known sets the scale.
    link_drawn
        Ends of the bootstrap's 95 % with l held likewise; empty without.
    told_least
        Of k and the lengths, and of those of them that are free.
    held
        Of every trial left out, or of the recordings that were held out.
    """

    recordings: Sequence[ElbowRecording]
    data: Binned
    boxes: Binned
    estimate: ElbowFit
    profiles: Mapping[str, Profile]
    drawn: Mapping[str, tuple[float, float]]
    link_held: Mapping[str, Profile]
    link_drawn: Mapping[str, tuple[float, float]]
    stretches: int
    all_directions: Direction
    free_directions: Direction | None
    line: Float[np.ndarray, "m 7"]
    line_r2: Float[np.ndarray, " m"]
    held: Sequence[Held]
    bins_differ: BinTest | None
    neighbours: Sequence[BinPair]
    normality: Normality
    excess: Excess
    r2: float
    mirrored_r2: float


@dataclass(frozen=True, eq=False)
class Free:
    """What the recordings with a free joint tell."""

    recordings: Sequence[ElbowRecording]
    boxes: Binned
    stroke: RecordedStroke
    stiffness: Stiffness | None
    scale: DisplacementScale | None
    bins_differ: BinTest | None
    neighbours: Sequence[BinPair]
    rotary_free: bool


def analyse(paths: tuple[Path, ...], o: ElbowFitOptions) -> int:
    """Run the whole analysis."""
    from geocontact.analyses.misalignment.identify.write import describe, write_results

    record = Record("elbow fit", {"recordings": list(paths), **asdict(o)})
    checked_widths(o)
    parameters, priors = unknowns(o)
    with record.catching_warnings(), written_whole(o.out) as draft:
        locked = recordings(record, "locked", paths, o.map, o.angles, o.unit, o.cutoff)
        require_locked(paths, locked)
        data = binned(locked, float(np.radians(o.bin_deg)))
        require_bins(record, paths, data)
        if not all(p.fixed for p in parameters if p.name == "s"):
            _require_pressures(paths[0], locked)
        apart = _held_out(record, o)
        free = None if o.unlocked is None else _free(record, o, data)
        problem = problem_of(data, parameters, priors)
        if problem.scale_free and free is not None:
            problem = _scaled_by(record, problem, free)
        found = _fitted(locked, data, estimated(problem), apart, o)
        _reserve(record, found)
        record.results["elbow"] = describe(found, free)
        write_results(record, found, free, o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    _tell(record, found, free)
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def _require_pressures(path: Path, locked: Sequence[ElbowRecording]) -> None:
    """Refuse to look for s where no pressure was recorded or none differs from the others."""
    known = [r.pressure for r in locked if r.pressure is not None]
    if len(known) < len(locked):
        raise InputError(path, "", "--free s needs a column pressure in every trial", "name it: --map pressure=…")
    reached = float(np.ptp(np.concatenate(known)))
    if reached < SAME_PRESSURE:
        what = f"--free s: the cuff's pressure varies by {reached / MMHG:.2g} mmHg only, which tells no s"
        raise InputError(path, "", what, "leave --free s out, or record trials at other pressures")


def _held_out(record: Record, o: ElbowFitOptions) -> list[ElbowRecording]:
    paths = o.held_out or []
    found = recordings(record, "held out", paths, o.map, o.angles, o.unit, o.cutoff)
    require_locked(paths, found)
    return found


def _scaled_by(record: Record, problem: ElbowProblem, free: Free) -> ElbowProblem:
    """The problem with the free joint's displacement beside it; as it was where that has no standard error."""
    if free.scale is None:
        record.warn("the free joint's displacement sets no scale without a standard error, which takes two free trials")
        return problem
    record.warn(
        f"the scale is set by the free joint's displacement (SE {free.scale.error:.2%} over {free.scale.trials} "
        "trials), which supposes the same offsets while the joint was free"
        + ("" if free.rotary_free else ", and no other joint of the device free beside it (else --rotary-free)")
    )
    return replace(problem, scale=free.scale)


def _fitted(
    locked: Sequence[ElbowRecording],
    data: Binned,
    e: ElbowFit,
    apart: Sequence[ElbowRecording],
    o: ElbowFitOptions,
) -> Fitted:
    _refuse_beyond(e)
    c = covariance(data, e)
    free = tuple(name for name in e.problem.names if name in SCALED and e.named[name] != 0.0)
    profiles = {name: profiled(e, c, name) for name in e.problem.names}
    drawn: dict[str, tuple[float, float]] = {}
    if o.bootstrap and not e.problem.scale_free:
        rows = np.percentile(wild_bootstrap(data, e, o.bootstrap), TAILS, axis=0)
        drawn = {name: (float(rows[0, k]), float(rows[1, k])) for k, name in enumerate(e.problem.names)}
    link_held: dict[str, Profile] = {}
    link_drawn: dict[str, tuple[float, float]] = {}
    if e.problem.scale_free:
        rest = with_link_held(e)
        spread = covariance(data, rest)
        link_held = {name: profiled(rest, spread, name) for name in rest.problem.names}
        if o.bootstrap:
            rows = np.percentile(wild_bootstrap(data, rest, o.bootstrap), TAILS, axis=0)
            link_drawn = {name: (float(rows[0, k]), float(rows[1, k])) for k, name in enumerate(rest.problem.names)}
    line = along_the_scale(e, FACTORS)
    measured = data.cells.means[:, FORCE]
    boxes = binned(locked, float(np.radians(o.box_deg)))
    return Fitted(
        recordings=locked,
        data=data,
        boxes=boxes,
        estimate=e,
        profiles=profiles,
        drawn=drawn,
        link_held=link_held,
        stretches=len(np.unique(data.visits.stretch)),
        all_directions=direction(e),
        free_directions=direction(e, free) if len(free) > 1 else None,
        line=line,
        line_r2=np.array([r_squared(measured, e.problem.law.force(theta)) for theta in line]),
        held=_apart(data, e, apart, o) if apart else _each_left_out(data, e),
        link_drawn=link_drawn,
        bins_differ=between_bins(boxes.visits, FORCE),
        neighbours=between_neighbours(boxes.visits, FORCE),
        normality=normality(locked, data, e),
        excess=excess(locked, data, e),
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
        raise InputError("", "", f"the best numbers are beyond the model: {error}", "narrow --bounds") from error


def _mirrored(e: ElbowFit, measured: Float[np.ndarray, " n"]) -> float:
    """R² that the same model reaches on the force turned over."""
    turned = estimated(e.problem.measuring(-e.problem.force))
    return r_squared(-measured, turned.predicted)


def _each_left_out(data: Binned, e: ElbowFit) -> list[Held]:
    """Each trial in turn, predicted by what the others give."""
    if len(data.names) < 2:
        return []
    found = []
    for trial, name in enumerate(data.names):
        problem = problem_of(data.without(trial), e.problem.parameters, e.problem.priors, e.problem.scale)
        theta = problem.theta(problem.searched(e.values).values)
        found.append(_held(name, data.only(trial), theta))
    return found


def _apart(data: Binned, e: ElbowFit, apart: Sequence[ElbowRecording], o: ElbowFitOptions) -> list[Held]:
    """Recordings of their own."""
    width = float(np.radians(o.bin_deg))
    found = []
    for path, r in zip(o.held_out or [], apart, strict=True):
        own = binned([r], width, data.pressure)
        measured, predicted = own.cells.means[:, FORCE], law_at(own.cells.means).force(e.theta)
        with np.errstate(invalid="ignore"):
            along = float(np.corrcoef(measured, predicted)[0, 1])
        if along < MIRRORED:
            what = f"its force mirrors what the fitted trials predict (correlation {along:.2f} over the bins)"
            raise InputError(path, "", what, "is its sign turned? correct the file, or leave it out")
        found.append(_held(r.name, own, e.theta))
    return found


def _held(name: str, data: Binned, theta: Float[np.ndarray, " 7"]) -> Held:
    measured, predicted = data.cells.means[:, FORCE], law_at(data.cells.means).force(theta)
    rmse = float(np.sqrt(np.mean((measured - predicted) ** 2)))
    return Held(name, r_squared(measured, predicted), rmse, len(measured))


def _free(record: Record, o: ElbowFitOptions, locked: Binned) -> Free:
    paths = o.unlocked or []
    needed = (FORCE_CHANNEL, DISPLACEMENT)
    free = recordings(record, "unlocked", paths, o.map, o.angles, o.unit, o.cutoff, needed)
    width = float(np.radians(o.bin_deg))
    data = binned(free, width)
    require_bins(record, paths, data)
    stroke = recorded_stroke(bin_means(data))
    if stroke is None:
        raise InputError(paths[0], "", "the compensation joint slides over fewer than three bins", "was it free?")
    each = [bin_means(locked.only(trial)) for trial in range(len(locked.names))]
    stiffness = None if o.rotary_free else stiffness_by_displacement(each, stroke, width)
    if stiffness is not None and stiffness.value + AGAINST * np.nan_to_num(stiffness.error) < 0.0:
        what = f"displacement and locked force run against each other ({stiffness.value:.4g} N/m)"
        raise InputError(paths[0], "", what, "one of them has its sign turned: --map displacement=-… or force=-…")
    boxes = binned(free, float(np.radians(o.box_deg)))
    scale = displacement_scale(
        [bin_means(data.only(trial)) for trial in range(len(data.names))], stroke, width, rotary_free=o.rotary_free
    )
    return Free(
        free, boxes, stroke, stiffness, scale, between_bins(boxes.visits, FORCE),
        between_neighbours(boxes.visits, FORCE), o.rotary_free,
    )  # fmt: skip


def _reserve(record: Record, found: Fitted) -> None:
    """What has to be said."""
    e = found.estimate
    if e.problem.scale_free:
        record.warn(SCALE_WORDS)
    shown = intervals(found)
    open_ends = [each.words for each in shown if each.lower_open or each.upper_open]
    if open_ends:
        record.warn(f"no limit within the bounds to {', '.join(open_ends)}, on one side or both")
    signs = [each.words for each in shown if each.key[0] in LENGTHS and each.sign_open]
    if signs:
        record.warn(f"the sign of {', '.join(signs)} is not told: values of both signs fit within the interval")
    if found.stretches < FEW_STRETCHES:
        record.warn(f"{found.stretches} stretches of {found.data.stretch:.2g} s are few: intervals are rough")
    if not e.converged:
        record.warn("the search did not end by itself; see --start and --bounds")
    if found.excess.p < RARE and found.excess.ratio > MORE:
        record.warn(
            f"the fit leaves {found.excess.ratio:.2g} times what noise within the trials would: offsets that change "
            "from trial to trial, or something the law misses; intervals do not know of it and are too short"
        )
    if found.r2 < 0.0:
        record.warn(f"R² is {found.r2:.2f}: a constant force would do better than the law")
    bad = [f"{each.name} ({each.r2:.2f})" for each in found.held if each.r2 < 0.0]
    if bad:
        record.warn(f"R² of what was not used is below 0, a constant force would do better: {', '.join(bad)}")
    if found.mirrored_r2 > found.r2 + BETTER:
        told = f"the force turned over fits better (R² {found.mirrored_r2:.3f} instead of {found.r2:.3f})"
        record.warn(f"{told}: is its sign turned? see --map force=-…")


def _tell(record: Record, found: Fitted, free: Free | None) -> None:
    e = found.estimate
    for each in intervals(found):
        record.say(f"{each.words} {each.shown}")
    told = [f"R² {found.r2:.3f} of {len(e.problem.force)} bin means"]
    if found.held:
        worst = min(each.r2 for each in found.held)
        told.append(f"not used: {worst:.3f} at least over {len(found.held)}")
    record.say("; ".join(told))
    record.say(f"residuals: {found.normality.words}")
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
