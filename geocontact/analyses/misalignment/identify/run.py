"""Stiffness, link and offsets of an exoskeleton from force and angle."""

from __future__ import annotations

from dataclasses import replace

from geocontact.analyses.misalignment.identify.description import described
from geocontact.analyses.misalignment.identify.fitted import fitted
from geocontact.analyses.misalignment.identify.free_joint import Free, free_joint
from geocontact.analyses.misalignment.identify.options import IdentifyOptions
from geocontact.analyses.misalignment.identify.reached_bins import require_bins
from geocontact.analyses.misalignment.identify.read import IdentifyInputs
from geocontact.analyses.misalignment.identify.reservations import reserve
from geocontact.analyses.misalignment.identify.result import IdentifyResult
from geocontact.analyses.misalignment.identify.sentences import say
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.bins import binned
from geocontact.axis_misalignment.least_squares import ElbowProblem, Prior, estimated, problem_of


def run(recorded: IdentifyInputs, o: IdentifyOptions, record: Record) -> IdentifyResult:
    """The best numbers, their intervals, and what the recordings do not tell."""
    data = binned(recorded.locked, o.bin)
    require_bins(record, o.recordings, data)
    free = free_joint(record, o, recorded.unlocked, data)
    priors = {name: Prior(*pair) for name, pair in (o.prior or {}).items()}
    problem = problem_of(data, recorded.parameters, priors)
    if problem.scale_free and free is not None:
        problem = _scaled_by(record, problem, free)
    found = fitted(recorded.locked, data, estimated(problem), recorded.held_out, o)
    reserve(record, found, free)
    say(record, found, free)
    summary = described(found, free)
    record.results["elbow"] = summary
    return IdentifyResult(record=record, options=o, fit=found, free=free, summary=summary)


def _scaled_by(record: Record, problem: ElbowProblem, free: Free) -> ElbowProblem:
    """The problem with the free joint's displacement beside it; as it was where that has no standard error."""
    if free.scale is None:
        record.warn("the free joint's displacement sets no scale without a standard error, which takes two free trials")
        return problem
    record.warn(
        f"the scale is set by the free joint's displacement (SE {free.scale.error:.2%} over {free.scale.trials} "
        "trials), which supposes the same offsets while the joint was free"
        + ("" if free.rotary_free else ", and no other joint of the device free beside it (else `rotary_free`)")
    )
    return replace(problem, scale=free.scale)
