"""Every number that an identification at an elbow ran with, in SI, and where it is from: default, option, or file.

A file is a recording: noise, stretches and the displacement's scale are estimated from them before the law is fitted.
What a search steps by, and what is only drawn, is not a number of the result.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from dataclasses import fields
from typing import Any, Literal

import numpy as np
import pandas as pd

from geocontact.analyses.misalignment.identify import fitted as fit_cuts
from geocontact.analyses.misalignment.identify import free_joint as free_cuts
from geocontact.analyses.misalignment.identify import inputs as input_cuts
from geocontact.analyses.misalignment.identify import sentences as said_cuts
from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.free_joint import Free
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.axis_misalignment import bins, compensation, explicit, least_squares, uncertainty
from geocontact.data.parameter import Parameter
from geocontact.identify.intervals import bin_tests, profile_likelihood
from geocontact.identify.noise import autoregressive
from geocontact.identify.optimise import bounded_gauss_newton, quasi_newton
from geocontact.identify.signals import angle_bins

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
        ("locked slides", input_cuts.SLID, "m", "a locked joint moves less, a free one more"),
        ("pole", explicit.POLE_SHARE, "-", "of the link: nearer to a pole is beyond the model"),
        ("flat", uncertainty.FLAT, "-", "of the largest singular value: nothing is identified"),
        ("fixation series", uncertainty.SERIES, "-", "share of its own below which c is not told from k"),
        ("fixation own", s.OWN, "-", "share of its own below which c is hardly separable"),
        ("stretches few", s.FEW_STRETCHES, "-", "fewer make intervals rough"),
        ("excess p", s.RARE, "-", "and below"),
        ("excess ratio", s.MORE, "-", "from which residuals are more than noise"),
        ("mirrored better", s.BETTER, "-", "of R², from which a mirrored force is named"),
        ("test level", bin_tests.LEVEL, "-", "of tests between bins and of residuals"),
        ("test visits", bin_tests.FEWEST, "-", "of a bin that is compared"),
    )
    if "s" in found.estimate.problem.names:
        yield from _default(("pressure varies", input_cuts.SAME_PRESSURE, "Pa", "less is refused where s is free"))


def _stroke_cuts() -> Iterator[Row]:
    """Cut-offs of recordings with a free joint."""
    yield from _default(
        ("stroke still", compensation.STILL, "-", "of the displacement's range, at its ends: the joint does not slide"),
        ("stroke stands", compensation.STANDS, "-", "of that range, median deviation of a stand"),
        ("stroke bins", compensation.FEWEST, "-", "of a stand, or of a slope"),
        ("stroke built_up", compensation.BUILT_UP, "-", "standard deviations of the force at a stand"),
        ("displacement against", free_cuts.AGAINST, "-", "standard errors below 0: refused as a turned sign"),
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
