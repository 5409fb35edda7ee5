"""What is known beforehand of the numbers of the elbow's law, as the options say."""

from __future__ import annotations

from geocontact.analyses import quantities
from geocontact.analyses.checks import bootstrap_rule, refuse, width_rule
from geocontact.analyses.misalignment import parameters as elbow_numbers
from geocontact.analyses.misalignment.parameters import EXAMPLE, PER_SI, TYPED
from geocontact.axis_misalignment.law import ABSENT, LENGTHS, NAMES, UNITS
from geocontact.axis_misalignment.least_squares import Prior
from geocontact.cli.elbow_fit import ElbowFitOptions
from geocontact.data.errors import InputError
from geocontact.data.parameter import Parameter

WIDEST = {
    "k": (10.0, 10e3), "x": (-0.15, 0.15), "y": (-0.15, 0.15), "l": (0.05, 0.5), "z": (-0.3, 0.3), "b": (-500.0, 500.0),
    "s": (-1e-3, 1e-3),
}  # fmt: skip
"""Bounds of free numbers unless given, in SI units."""
BEGIN = {"k": 300.0, "x": 0.03, "y": 0.04, "l": 0.2, "z": 0.12, "b": 0.0, "s": 0.0}
"""Starts of the explicit model's paper."""


def unknowns(o: ElbowFitOptions) -> tuple[tuple[Parameter, ...], dict[str, Prior]]:
    """The numbers in the order of NAMES, and priors by name."""
    known, start = elbow_numbers.values(o.known, "--known"), elbow_numbers.values(o.start, "--start")
    bounds = elbow_numbers.pairs(o.bounds, "--bounds")
    priors = elbow_numbers.pairs(o.prior, "--prior")
    more = [] if o.free is None else [name.strip() for name in o.free.split(",")]
    _refuse(known, bounds, start, priors, more)
    made = []
    for name in NAMES:
        if name in known or (name in ABSENT and name not in more):
            value = known.get(name, ABSENT.get(name, 0.0))
            made.append(Parameter(name, UNITS[name], value, value, value, fixed=True))
            continue
        low, high = bounds.get(name, WIDEST[name])
        first = start.get(name, priors[name][0] if name in priors else BEGIN[name])
        if name in start and not low <= first <= high:
            what = f"{name} = {first * PER_SI[name]:g} {TYPED[name]} is not between its bounds"
            raise InputError("", "--start", what, "give another, or --bounds")
        made.append(Parameter(name, UNITS[name], min(max(first, low), high), low, high))
    if all(p.fixed for p in made):
        raise InputError("", "--known", "leaves nothing to be found", "see geocontact elbow compare")
    return tuple(made), {name: Prior(*pair) for name, pair in priors.items()}


def _refuse(
    known: dict[str, float],
    bounds: dict[str, tuple[float, float]],
    start: dict[str, float],
    priors: dict[str, tuple[float, float]],
    more: list[str],
) -> None:
    for name in more:
        refuse((name not in ABSENT, "--free", f"{name!r} is not b or s", "write --free b,s; the others are free"))
    for option, given in (("--bounds", bounds), ("--start", start), ("--prior", priors)):
        for name in given:
            idle = name in ABSENT and name not in more
            refuse(
                (name in known, option, f"{name} is known already", "give one"),
                (idle, option, f"{name} is not free", f"give --free {name}"),
            )
    for name, (low, high) in bounds.items():
        refuse((not low < high, "--bounds", f"{name} has no room between its bounds", "write lower:upper"))
    for name, (_, sd) in priors.items():
        refuse((sd <= 0.0, "--prior", f"{name} has an SD that is not above 0", "write mean:SD, such as l=185:10"))
    for option, values in (("--known", known), ("--start", start)):
        for name in ("k", "l"):
            refuse((values.get(name, 1.0) <= 0.0, option, f"{name} is not positive", f"write for example {EXAMPLE}"))
    means, tops = {n: mean for n, (mean, _) in priors.items()}, {n: top for n, (_, top) in bounds.items()}
    for option, values in (("--known", known), ("--start", start), ("--prior", means), ("--bounds", tops)):
        elbow_numbers.require_link(values.get("l", 1.0), option)
    for name in ("k", "l"):
        low = bounds.get(name, (1.0, 2.0))[0]
        refuse((low <= 0.0, "--bounds", f"{name} may not be 0 or less", "give a lower bound above 0"))


def checked_widths(o: ElbowFitOptions) -> None:
    """Widths, cut-off and replicates that can be."""
    refuse(
        width_rule("--bin-deg", o.bin_deg), width_rule("--box-deg", o.box_deg), bootstrap_rule(o.bootstrap, 500),
        (o.rotary_free and o.unlocked is None, "--rotary-free", "does nothing without --unlocked", "leave it out"),
    )  # fmt: skip
    if o.cutoff is not None:
        quantities.number(str(o.cutoff), "--cutoff", "6")


SCALE_WORDS = (
    f"k and the lengths {', '.join(LENGTHS)} are known up to one factor only: F(k/s, s × lengths) = F for every s; "
    "know l, z or k (--known), give a prior (--prior), or record the free joint's displacement (--unlocked)"
)
