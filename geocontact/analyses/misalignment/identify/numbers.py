"""What an identification at an elbow starts from: recordings, numbers known and free, and a table of all that ran.

The table has every number in SI, and where it is from: default, option, or file.
A file is a recording: noise, stretches and the displacement's scale are estimated from them before the law is fitted.
What a search steps by, and what is only drawn, is not a number of the result.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd

from geocontact.analyses.misalignment.identify import beside as beside_cuts
from geocontact.analyses.misalignment.identify import fitted as fit_cuts
from geocontact.analyses.misalignment.identify import sentences as said_cuts
from geocontact.analyses.misalignment.identify.fitted import Fitted, Free
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.identify.tracking import read_scores
from geocontact.analyses.misalignment.law_numbers import MMHG, PER_SI, WRITTEN
from geocontact.analyses.misalignment.recordings import SLID, doubt_moments, recordings
from geocontact.analyses.motion.checked_trial import check_apart
from geocontact.axis_misalignment import bins, compensation, explicit, known_by_sensor, least_squares, uncertainty
from geocontact.axis_misalignment.law import ABSENT, NAMES, UNITS
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter
from geocontact.identify.intervals import bin_tests, profile_likelihood
from geocontact.identify.noise import autoregressive
from geocontact.identify.optimise import bounded_gauss_newton, quasi_newton
from geocontact.identify.signals import angle_bins
from geocontact.io.recordings.elbow_recording import DISPLACEMENT, FORCE

WIDEST = {
    "k": (10.0, 10e3),
    "x": (-0.15, 0.15),
    "y": (-0.15, 0.15),
    "l": (0.05, 0.5),
    "z": (-0.3, 0.3),
    "b": (-500.0, 500.0),
    "s": (-1e-3, 1e-3),
    "c": (0.0, 0.02),
}
"""Bounds of free numbers by default, in SI units."""
BEGIN = {"k": 300.0, "x": 0.03, "y": 0.04, "l": 0.2, "z": 0.12, "b": 0.0, "s": 0.0, "c": 1e-3}
"""Starts of the explicit model's paper; that of c, a fixation of 1 N/mm, is invented."""

Values = Mapping[str, float]
Pairs = Mapping[str, tuple[float, float]]


def unknowns(known: Values, prior: Pairs, bounds: Pairs, start: Values, free: Sequence[str]) -> tuple[Parameter, ...]:
    """The numbers in the order of NAMES, in SI; InputError where what is given of them contradicts itself."""
    _refuse_free(free)
    for option, given in (("`bounds`", bounds), ("`start`", start), ("`prior`", prior)):
        _refuse_not_free(option, given, known, free)
    _refuse_bounds_and_priors(bounds, prior)
    _refuse_values(known, prior, bounds, start)
    made = []
    for name in NAMES:
        if name in known or (name in ABSENT and name not in free):
            value = known.get(name, ABSENT.get(name, 0.0))
            made.append(Parameter(name, UNITS[name], value, value, value, fixed=True))
        else:
            low, high = bounds.get(name, WIDEST[name])
            made.append(_free(name, low, high, start, prior))
    if all(p.fixed for p in made):
        raise InputError("", "`known`", "leaves nothing to identify", "leave a number out, or compare instead")
    return tuple(made)


def _free(name: str, low: float, high: float, start: Values, prior: Pairs) -> Parameter:
    first = start.get(name, prior[name][0] if name in prior else BEGIN[name])
    if name in start and not low <= first <= high:
        what = f"{name} = {first * PER_SI[name]:g} {WRITTEN[name]} is not between its bounds"
        raise InputError("", "`start`", what, "give another, or `bounds`")
    return Parameter(name, UNITS[name], min(max(first, low), high), low, high)


def _refuse_free(free: Sequence[str]) -> None:
    for name in free:
        if name not in ABSENT:
            raise InputError(
                "", "`free`", f"{name!r} is not b, s or c", "give one or more of b, s, c; the others are free"
            )


def _refuse_not_free(option: str, given: Mapping[str, object], known: Values, free: Sequence[str]) -> None:
    for name in given:
        if name in known:
            raise InputError("", option, f"{name} is known already", "give one")
        if name in ABSENT and name not in free:
            raise InputError("", option, f"{name} is not free", f"give `free` {name}")


def _refuse_bounds_and_priors(bounds: Pairs, prior: Pairs) -> None:
    for name, (low, high) in bounds.items():
        if not low < high:
            raise InputError("", "`bounds`", f"{name} has no room between its bounds", "give the lower one first")
    for name, (_, sd) in prior.items():
        if not sd > 0.0:
            what = f"{name} has an SD that is not above 0"
            raise InputError("", "`prior`", what, "give mean and SD, such as 185 and 10 mm for l")


def _refuse_values(known: Values, prior: Pairs, bounds: Pairs, start: Values) -> None:
    """Stiffness and link whose bounds are not positive."""
    for name in ("k", "l"):
        if name in bounds and not bounds[name][0] > 0.0:
            raise InputError("", "`bounds`", f"{name} may not be 0 or less", "give a lower bound above 0")


SAME_PRESSURE = MMHG  # Pa; pressures that differ by less are one


@dataclass(frozen=True, eq=False)
class IdentifyInputs:
    """Numbers of the law as far as they are known, recordings (joint locked, held out, joint free), scores by trial."""

    parameters: tuple[Parameter, ...]
    locked: Sequence[ElbowRecording]
    held_out: Sequence[ElbowRecording]
    unlocked: Sequence[ElbowRecording]
    scores: pd.DataFrame | None = None


def read(o: IdentifyOptions) -> IdentifyInputs:
    """Everything the options name."""
    parameters = unknowns(o.known or {}, o.prior or {}, o.bounds or {}, o.start or {}, o.free or ())
    locked = _recordings("locked", o.recordings, o)
    _require_locked(o.recordings, locked)
    if o.turning is not None or o.alpha_zeroed:
        _require_sensors(o, locked)
    if not all(p.fixed for p in parameters if p.name == "s"):
        _require_pressures(o.recordings[0], locked)
    apart = _recordings("held out", o.held_out or (), o)
    _require_locked(o.held_out or (), apart)
    free = _recordings("unlocked", o.unlocked or (), o, (FORCE, DISPLACEMENT))
    _require_free(o.unlocked or (), free)
    doubt_moments(o.recordings, locked)
    check_apart(
        {r.name: np.column_stack([r.beta, r.force]) for r in (*locked, *apart, *free)},
        "intervals are too short, and errors of what is held out too small",
    )
    scores = read_scores(o.scores, [*locked, *apart, *free])
    return IdentifyInputs(parameters, locked, apart, free, scores)


def _recordings(
    role: str, paths: Sequence[Path], o: IdentifyOptions, needed: tuple[str, ...] = (FORCE,)
) -> list[ElbowRecording]:
    return recordings(role, paths, o.map, o.angles, o.unit, o.cutoff, needed)


def _require_locked(paths: Sequence[Path], found: Sequence[ElbowRecording]) -> None:
    """Refuse recordings whose compensation joint slides among the locked ones."""
    for path, r in zip(paths, found, strict=True):
        moved = 0.0 if r.displacement is None else float(np.ptp(r.displacement))
        if moved > SLID:
            what = f"the compensation joint slides by {moved * 1e3:.1f} mm in it"
            raise InputError(path, "", what, "give it with `unlocked`, or map another column: `map` displacement=…")


def _require_free(paths: Sequence[Path], found: Sequence[ElbowRecording]) -> None:
    """Refuse recordings whose compensation joint does not slide: locked ones, or metres called millimetres."""
    for path, r in zip(paths, found, strict=True):
        moved = 0.0 if r.displacement is None else float(np.ptp(r.displacement))
        if moved < SLID:
            what = f"the compensation joint slides by {moved * 1e3:.3g} mm in it, less than a locked one may"
            remedy = "is its column in m, and not in mm? write displacement [m]; or was it locked?"
            raise InputError(path, "", what, remedy)


def _require_sensors(o: IdentifyOptions, locked: Sequence[ElbowRecording]) -> None:
    """Refuse what is said of a moment or of the arm's angle where none was recorded."""
    if o.turning is not None and all(r.moment is None for r in locked):
        raise InputError(o.recordings[0], "", "`turning` needs a column moment", "name it: `map` moment=…")
    if o.alpha_zeroed and all(r.alpha is None for r in locked):
        raise InputError(o.recordings[0], "", "`alpha_zeroed` needs a column alpha", "name it: `map` alpha=…")


def _require_pressures(path: Path, locked: Sequence[ElbowRecording]) -> None:
    """Refuse to look for s where no pressure was recorded or none differs from the others."""
    known = [r.pressure for r in locked if r.pressure is not None]
    if len(known) < len(locked):
        raise InputError(path, "", "`free` s needs a column pressure in every trial", "name it: `map` pressure=…")
    reached = float(np.ptp(np.concatenate(known)))
    if reached < SAME_PRESSURE:
        what = f"`free` s: the cuff's pressure varies by {reached / MMHG:.2g} mmHg only, too little to identify s"
        raise InputError(path, "", what, "leave `free` s out, or record trials at other pressures")


COLUMNS = ["number", "value", "unit", "source", "note"]
Origin = Literal["default", "option", "file"]
Row = tuple[str, float, str, Origin, str]
USUAL = {each.name: each.default for each in fields(IdentifyOptions)}


def numbers_table(found: Fitted, free: Free | None, o: IdentifyOptions) -> pd.DataFrame:
    """Numbers of the law, of how recordings are read, of what they tell before the fit, of the search, then all
    cut-offs.
    """
    rows: list[Row] = []
    for parameter in found.estimate.problem.parameters:
        rows += _of_law(parameter, o)
    rows += [*_of_options(o), *_of_files(found, free), *_of_search(o), *_of_intervals(o), *_cuts(found)]
    return pd.DataFrame([*rows, *(() if free is None else _stroke_cuts())], columns=COLUMNS)


def _of_law(p: Parameter, o: IdentifyOptions) -> Iterator[Row]:
    """A known number, or start, bounds and prior of a free one."""
    known, prior, bounds, start = (given or {} for given in (o.known, o.prior, o.bounds, o.start))
    if p.fixed:
        told = "known" if p.name in known else "not free"
        yield f"{p.name} fixed", p.start, p.unit, _from(p.name in known), told
        return
    note = "mean of the prior" if p.name in prior and p.name not in start else ""
    yield f"{p.name} start", p.start, p.unit, _from(p.name in start or p.name in prior), note
    for end, value in (("least", p.lower), ("most", p.upper)):
        yield f"{p.name} {end}", value, p.unit, _from(p.name in bounds), "bound of the search"
    if p.name in prior:
        for part, value in zip(("mean", "sd"), (o.prior or {})[p.name], strict=True):
            yield f"{p.name} prior {part}", value, p.unit, "option", "normal"


def _of_options(o: IdentifyOptions) -> Iterator[Row]:
    """Bins, filter and replicates."""
    for name, value, unit, note in (
        ("bin", o.bin, "rad", "width of the bins that are fitted"),
        ("box", o.box, "rad", "width of the bins of box plots and of tests between bins"),
        ("bootstrap", o.bootstrap, "-", "replicates"),
    ):
        yield name, float(value), unit, _from(value != USUAL[name]), note
    if o.cutoff is not None:
        yield "cutoff", o.cutoff, "Hz", "option", "of the zero-lag low-pass"
    if o.turning is not None:
        yield "turning", o.turning, "N m/rad", "option", "stiffness of the cuff against turning"
    if o.alpha_zeroed:
        yield "alpha_zeroed", 1.0, "-", "option", "1: the level of the arm's angle counts, 0: its change"
    if o.unlocked is not None:
        yield (
            "rotary_free",
            float(o.rotary_free),
            "-",
            _from(o.rotary_free),
            "1: the joint slides by d_lin, 0: by d_tot",
        )


def _of_files(found: Fitted, free: Free | None) -> Iterator[Row]:
    """What was estimated from the recordings, and entered the fit as if it were known."""
    data, scale = found.data, found.estimate.problem.scale
    yield "noise sd", float(data.noise.sd[0]), "N", "file", "of the force about the curve through the bins' means"
    yield "noise correlation_time", float(data.noise.tau[0]), "s", "file", "of the same"
    yield "step", data.step, "s", "file", "median between samples"
    yield "stretch", data.stretch, "s", "file", "that counts as independent"
    if any(r.pressure is not None for r in found.recordings):
        yield "pressure", data.pressure, "Pa", "file", "mean, at which the stiffness is k"
    for each in found.beside.sensors:
        noise, unit = data.beside[each.measured.channel], "N m" if each.measured.channel == bins.MOMENT else "rad"
        yield f"noise of the {each.measured.name} sd", float(noise.sd[0]), unit, "file", "about its bins' means"
        yield f"noise of the {each.measured.name} correlation_time", float(noise.tau[0]), "s", "file", "of the same"
    if scale is not None and free is not None:
        yield "scale slope", scale.slope, "-", "default", "of the law's displacement over the measured one"
        yield "scale se", scale.error, "-", "file", f"of that slope, over {scale.trials} trials"


def _of_search(o: IdentifyOptions) -> Iterator[Row]:
    """Starts and ends of a search, and how the noise was looked for."""
    t, spread_starts = bounded_gauss_newton, quasi_newton.spread_starts
    yield from _default(
        ("starts", least_squares.STARTS, "-", "besides the own one, spread over the bounds"),
        ("starts seed", _usual(spread_starts, "seed"), "-", "of the Latin hypercube"),
        ("search same", least_squares.SAME, "-", "of the cost: searches that end equally well"),
        ("search steps", t.LIMIT, "-", "at most"),
        ("search rounding", t.ROUNDING, "-", "share of a number below which a step ends the search"),
        ("noise chunk", bins.CHUNK, "s", "over which residuals are averaged for the noise"),
        ("noise shortest", autoregressive.SHORTEST, "-", "least correlation time, in steps between chunks"),
        ("noise longest", autoregressive.LONGEST, "-", "largest correlation time, in the same"),
        ("noise least beside_force", bins.LEAST_NOISE, "-", "of the range of moment or angle: less is not counted on"),
        ("stretch memories", bins.MEMORIES, "-", "correlation times in a stretch"),
        ("stretch shortest", bins.SHORTEST, "s", ""),
        ("stretch fewest", bins.FEWEST, "-", "in the longest of few trials"),
        ("stretch many", bins.MANY, "-", "trials from which on there are stretches enough"),
        ("bin least", angle_bins.LEAST_SECONDS, "s", "in a bin; less does not reach it"),
    )


def _of_intervals(o: IdentifyOptions) -> Iterator[Row]:
    """Level, curve and draws."""
    low, high = fit_cuts.TAILS
    yield from _default(
        ("interval level", _usual(uncertainty.profiled, "level"), "-", "of a profile"),
        ("interval points", profile_likelihood.POINTS, "-", "of a profile's curve"),
        ("interval doublings", profile_likelihood.DOUBLINGS, "-", "of the half-width in search of an end"),
        ("interval distinct", uncertainty.DISTINCT, "-", "of a number: closer minima are one"),
        ("residual draws", bin_tests.DRAWS, "-", "of noise, for residuals and their excess"),
        ("residual seed", _usual(least_squares.normal_residuals, "seed"), "-", "of the test of normality"),
        ("excess seed", _usual(least_squares.excess, "seed"), "-", ""),
    )
    if o.bootstrap:
        yield from _default(
            ("bootstrap seed", _usual(uncertainty.wild_bootstrap, "seed"), "-", ""),
            ("bootstrap lower", low / 100.0, "-", "share of the replicates below the interval"),
            ("bootstrap upper", high / 100.0, "-", "share of them up to its end"),
        )


def _cuts(found: Fitted) -> Iterator[Row]:
    """Where something is refused, warned of, or called open."""
    f, s = fit_cuts, said_cuts
    yield from _default(
        ("bins least", f.LEAST_BINS, "-", "fewer are refused"),
        ("noise least", f.ROUNDING, "-", "of the force's range; less is refused"),
        ("mirrored", f.MIRRORED, "-", "correlation below which a force is refused as mirrored"),
        ("turned", f.TOGETHER, "-", "correlation above which what mends a trial is named as its cause"),
        ("locked slides", SLID, "m", "a locked joint moves less, a free one more"),
        ("pole", explicit.POLE_SHARE, "-", "of the link: nearer to a pole is beyond the model"),
        ("flat", uncertainty.FLAT, "-", "of the largest singular value: nothing is identified"),
        ("fixation series", uncertainty.SERIES, "-", "share of its own below which c is not separable from k"),
        ("fixation own", s.OWN, "-", "share of its own below which c is hardly separable"),
        ("stretches few", s.FEW_STRETCHES, "-", "fewer make intervals rough"),
        ("excess p", s.RARE, "-", "and below"),
        ("excess ratio", s.MORE, "-", "from which residuals are more than noise"),
        ("mirrored better", s.BETTER, "-", "of R², from which a mirrored force is named"),
        ("beside twice", beside_cuts.TWICE, "-", "times its noise: a residual beside the force is doubtful"),
        ("beside half", beside_cuts.HALF, "-", "of the sum of squares: a turned moment that leaves less is named"),
        ("beside moves", known_by_sensor.MOVES, "-", "part in a direction that is not identified"),
        ("test level", bin_tests.LEVEL, "-", "of tests between bins and of residuals"),
        ("test visits", bin_tests.FEWEST, "-", "of a bin that is compared"),
    )
    if "s" in found.estimate.problem.names:
        yield from _default(("pressure varies", SAME_PRESSURE, "Pa", "less is refused where s is free"))


def _stroke_cuts() -> Iterator[Row]:
    """Cut-offs of recordings with a free joint."""
    yield from _default(
        ("stroke still", compensation.STILL, "-", "of the displacement's range, at its ends: the joint does not slide"),
        ("stroke stands", compensation.STANDS, "-", "of that range, median deviation of a stand"),
        ("stroke bins", compensation.FEWEST, "-", "of a stand, or of a slope"),
        ("stroke built_up", compensation.BUILT_UP, "-", "standard deviations of the force at a stand"),
        ("displacement against", fit_cuts.AGAINST, "-", "standard errors below 0: refused as a turned sign"),
        ("stiffnesses apart", said_cuts.APART, "-", "times, from which a unit is doubted"),
    )


def _default(*each: tuple[str, int | float, str, str]) -> Iterator[Row]:
    for name, value, unit, note in each:
        yield name, float(value), unit, "default", note


def _from(asked: bool | np.bool_) -> Origin:
    return "option" if asked else "default"


def _usual(function: Callable[..., Any], parameter: str) -> float:
    """A parameter's value where nobody gives another."""
    return float(inspect.signature(function).parameters[parameter].default)
