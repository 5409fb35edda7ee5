"""Contacts from the trials of one person: phase A for the feet, then B for the straps of an exoskeleton."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from jaxtyping import Float

from geocontact.dynamics.collocation.solve import Progress
from geocontact.standing_up.calibrated_phase import INTERRUPTED, CalibratedPhase, PhaseSearch, calibrated_phase
from geocontact.standing_up.chain import FOOT_PARAMETERS, feet_on_ground
from geocontact.standing_up.contact_numbers import held_covariance, prior_covariance
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
from geocontact.standing_up.selection import SelectedParameter, selected, trials_information
from geocontact.standing_up.stance import standing_leg
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.trial_result import TrialResult, trial_result
from geocontact.standing_up.trials import StandingTrial, StandingUpTrials, seen_in

PhaseProgress = Callable[[str, int, float, float], None]
"""Gets the phase, the iteration, the objective and the largest residual."""
Start = Float[np.ndarray, " p"] | None
BuildFree = Callable[[Sequence[StandingTrial], Start, Sequence[str]], PhaseProblem]
"""Makes a phase of trials, of where its parameters start, and of the names of those that are free."""


def calibrated_phases(
    given: StandingUpTrials, search: PhaseSearch, progress: PhaseProgress | None = None
) -> tuple[CalibratedPhase, ...]:
    """A, and with an exoskeleton B with the feet as A found them; only A where its search has no answer."""
    if given.one_leg:
        model = standing_leg(given.subject)
    elif given.exoskeleton:
        model = strapped(given.subject, given.sites, seated=given.seated)
    else:
        model = feet_on_ground(given.subject, seated=given.seated)
    w = given.weights
    in_a = tuple(name for name in TRACKS if name in given.tracks)
    in_phase_a, in_phase_b = (None if progress is None else partial(progress, name) for name in "AB")

    def build_a(trials: Sequence[StandingTrial], start: Start, free: Sequence[str]) -> PhaseProblem:
        return phase_a(model, given.subject, trials, given.noise, free=free, tracks=in_a, start=start, weights=w)

    every = [each.name for each in FOOT_PARAMETERS]

    def held_in_a(free: Sequence[str]) -> Float[np.ndarray, "p p"]:
        return prior_covariance(model.parameters, [name for name in every if name not in free])

    first = _phase("A", model, given, build_a, (given.free, every), search, in_phase_a, held_in_a)
    if not given.exoskeleton or not first.found.solved:
        return (first,)
    feet, straps = first.found.p[: len(FOOT_PARAMETERS)], [name for site in given.sites for name in site.names]

    def build_b(trials: Sequence[StandingTrial], start: Start, free: Sequence[str]) -> PhaseProblem:
        strap = None if start is None else start[len(feet) :]
        noise, tracks = given.noise, given.tracks
        return phase_b(model, given.subject, trials, noise, feet, free=free, tracks=tracks, start=strap, weights=w)

    known = held_covariance(first.numbers, first.phase.parameters)

    def held_in_b(free: Sequence[str]) -> Float[np.ndarray, "p p"]:
        return np.asarray(known + prior_covariance(model.parameters, [name for name in straps if name not in free]))

    second = _phase("B", model, given, build_b, (straps, straps), search, in_phase_b, held_in_b)
    return first, second


def _phase(
    name: str,
    model: StandingModel,
    given: StandingUpTrials,
    build: BuildFree,
    names: tuple[Sequence[str], Sequence[str]],
    search: PhaseSearch,
    progress: Progress | None,
    held: Callable[[Sequence[str]], Float[np.ndarray, "p p"]],
) -> CalibratedPhase:
    """A phase with what is usually free, and which of all candidates its trials identify; `names` are both.

    Where the search selects, the phase is solved again with those, and their selection is that of the first answer;
    where nothing is selected the usual ones stay free, and are searched as asked all the same.
    """
    usual_free, every = names

    def solved(free: Sequence[str], how: PhaseSearch) -> CalibratedPhase:
        build_free = partial(_with_free, build, free)
        return calibrated_phase(name, model, given.trials, given.noise, build_free, how, progress, held(free))

    how = replace(search, resamples=0, starts=0, profiles=0) if search.select else search
    one = solved(usual_free, how)
    if not one.found.solved and how != search and not one.found.ending.startswith(INTERRUPTED):
        how = search
        one = solved(usual_free, how)
    if not one.found.solved:
        return replace(one, unselected="the search did not converge")
    chosen, why = selection_among(one, build(given.trials, one.found.p, every))
    free = [of.name for of in chosen if of.outcome == "identified"]
    if search.select and (free or how != search):
        one = solved(free or usual_free, search)
    return replace(one, selection=chosen, unselected=why)


def selection_among(one: CalibratedPhase, whole: PhaseProblem) -> tuple[tuple[SelectedParameter, ...], str]:
    """Selection of the parameters that `whole` frees, about an answer; none, and why, where there is no curvature."""
    try:
        return selected(whole.free, trials_information(whole, one.found)), ""
    except (ValueError, np.linalg.LinAlgError) as error:
        return (), str(error)


def _with_free(build: BuildFree, free: Sequence[str], trials: Sequence[StandingTrial], start: Start) -> PhaseProblem:
    return build(trials, start, free)


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
