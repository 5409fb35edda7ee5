"""A pressure mat on a body scan: made ready, placed, turned into loads, put beside what there is to compare."""

from __future__ import annotations

from collections.abc import Callable

from geocontact.analyses.mat.closest_point import closest_point
from geocontact.analyses.mat.comparison.agreement import compared
from geocontact.analyses.mat.loads import loads
from geocontact.analyses.mat.motion import followed
from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.mat.placed import placed
from geocontact.analyses.mat.read import MatInputs
from geocontact.analyses.mat.recording import made_ready
from geocontact.analyses.mat.result import MatResult
from geocontact.analyses.run_record import Record


def run(given: MatInputs, o: MatOptions, record: Record) -> MatResult:
    """Loads of every frame that has a pose, or of every frame where nothing moves."""
    with record.listener.stages(o.frames.name) as at:
        return _evaluated(given, o, record, at)


def _evaluated(given: MatInputs, o: MatOptions, record: Record, at: Callable[[str], None]) -> MatResult:
    at("recording made ready")
    seen, travel = followed(record, made_ready(record, given.recorded, given.listed_dead, o), given.motion, o)
    frames = seen.frames
    at("mat laid on its surface")
    with record.listener.preparing():
        there = placed(record, given, frames, o)
    at(f"loads of {len(frames.time)} frames")
    found = loads(record, given, there, seen, travel, o)
    model, agreement = given.model, None
    if model is not None:
        at("comparison with the model")
        agreement = compared(record, model, given.phases, found.whole, frames.time, o)
    return MatResult(
        record=record,
        options=o,
        frames=frames,
        saturated=seen.saturated,
        surface=there.surface,
        landmarks=there.landmarks,
        drape=there.drape,
        cells=there.cells,
        pressure=found.pressure,
        loads=found.whole,
        segments=found.segments,
        uncertainty=found.covariance,
        errors=found.errors,
        home=found.home,
        registration=there.registration,
        closest_point=closest_point(record, there, frames, o),
        agreement=agreement,
    )
