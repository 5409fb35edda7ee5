"""Contacts from the trials of one person: phase A for the feet, then B for the straps of an exoskeleton."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.calibrated_phase import CalibratedPhase, PhaseSearch, calibrated_phase
from geocontact.standing_up.chain import FOOT_PARAMETERS, feet_on_ground
from geocontact.standing_up.contact_numbers import believed_covariance, held_covariance
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.numbers_that_ran import (
    Ran,
    belief_numbers,
    model_numbers,
    parameter_numbers,
    search_numbers,
    size_numbers,
)
from geocontact.standing_up.phase import PhaseProblem, sizes_of
from geocontact.standing_up.phases import TRACKS, phase_a, phase_b
from geocontact.standing_up.trial_result import TrialResult, trial_result
from geocontact.standing_up.trials import StandingTrial, StandingUpTrials, seen_in

PhaseProgress = Callable[[str, int, float, float], None]
"""Gets the phase, the iteration, the objective and the largest residual."""
Start = Float[np.ndarray, " p"] | None


def calibrated_phases(
    given: StandingUpTrials, search: PhaseSearch, progress: PhaseProgress | None = None
) -> tuple[CalibratedPhase, ...]:
    """A, and with an exoskeleton B with the feet as A found them; only A where its search has no answer."""
    if given.exoskeleton:
        model = strapped(given.subject, given.sites, seated=given.seated)
    else:
        model = feet_on_ground(given.subject, seated=given.seated)
    w = given.weights
    in_a = tuple(name for name in TRACKS if name in given.tracks)
    in_phase_a, in_phase_b = (None if progress is None else partial(progress, name) for name in "AB")

    def build_a(trials: Sequence[StandingTrial], start: Start) -> PhaseProblem:
        return phase_a(model, given.subject, trials, given.noise, free=given.free, tracks=in_a, start=start, weights=w)

    of_feet = [each.name for each in FOOT_PARAMETERS if each.name not in given.free]
    believed = believed_covariance(model.parameters, of_feet)
    first = calibrated_phase("A", model, given.trials, given.noise, build_a, search, in_phase_a, believed)
    if not given.exoskeleton or not first.found.solved:
        return (first,)
    feet, straps = first.found.p[: len(FOOT_PARAMETERS)], [name for site in given.sites for name in site.names]

    def build_b(trials: Sequence[StandingTrial], start: Start) -> PhaseProblem:
        strap = None if start is None else start[len(feet) :]
        noise, tracks = given.noise, given.tracks
        return phase_b(model, given.subject, trials, noise, feet, free=straps, tracks=tracks, start=strap, weights=w)

    known = held_covariance(first.numbers, first.phase.parameters)
    second = calibrated_phase("B", model, given.trials, given.noise, build_b, search, in_phase_b, known)
    return first, second


def calibrated_trials(phase: CalibratedPhase, trials: Sequence[StandingTrial]) -> tuple[TrialResult, ...]:
    """The trials beside the motions of a phase that was calibrated with them."""
    return tuple(
        trial_result(trial, motion, judged, partial(seen_in, phase.model, motion, phase.found.p, name=trial.name))
        for trial, motion, judged in zip(trials, phase.found.motions, phase.motions, strict=True)
    )


def calibration_numbers(phases: Sequence[CalibratedPhase], trials: Sequence[StandingTrial]) -> list[Ran]:
    """The model once; for each phase what it sought, its priors and weights, and its meshes."""
    rows = model_numbers(phases[-1].model)
    for one in phases:
        prefix = f"phase {one.name} "
        rows += parameter_numbers(one.phase.parameters, one.found.p, prefix, free=one.phase.free)
        rows += belief_numbers(one.phase, prefix) + size_numbers(sizes_of(one.phase), prefix)
        rows += search_numbers(one.found.motions, trials, prefix)
    return rows
