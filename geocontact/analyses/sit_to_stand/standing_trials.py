"""Trials of one person as a study describes them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.trial_channels import channels_of
from geocontact.data.errors import InputError
from geocontact.io.recordings.standing_study import read_standing_study
from geocontact.standing_up.chain import Subject, leg_chain
from geocontact.standing_up.chair import COMPONENTS
from geocontact.standing_up.exoskeleton import two_chains
from geocontact.standing_up.feet import FOOT_PARAMETERS, SOUGHT, SOUGHT_WORN
from geocontact.standing_up.phase_a import TRACKS
from geocontact.standing_up.phase_b import TRACKS_B
from geocontact.standing_up.strap_sites import THIGH_STRAP, StrapSite, strap_sites
from geocontact.standing_up.trials import StandingNoise, StandingTrial


@dataclass(frozen=True, eq=False)
class StandingUpTrials:
    """Trials of one person.

    Parameters
    ----------
    exoskeleton
        Whether it was worn, so that its strap is calibrated too.
    free, tracks
        Names of the feet's parameters, and channels.
    sites
        Where straps are, if an exoskeleton was worn.
    """

    subject: Subject
    noise: StandingNoise
    trials: tuple[StandingTrial, ...]
    exoskeleton: bool
    free: tuple[str, ...]
    tracks: tuple[str, ...]
    sites: tuple[StrapSite, ...] = (THIGH_STRAP,)

    @property
    def seated(self) -> bool:
        """Whether a trial begins on the chair."""
        return any(trial.chair is not None for trial in self.trials)


def standing_trials(file: Path, role: str, record: Record, c3d_unit: str | None = None) -> StandingUpTrials:
    """Everything in the study; `c3d_unit` is that of .c3d files that have none."""
    study = read_standing_study(file)
    record.add_input(role, file, trials=len(study.trials))
    subject = Subject(study.mass, study.height)
    usual = SOUGHT_WORN if study.exoskeleton else SOUGHT
    free = _known(file, "free", study.free, usual, tuple(each.name for each in FOOT_PARAMETERS))
    channels = TRACKS_B if study.exoskeleton else TRACKS
    tracks = _known(file, "tracks", study.tracks, channels, channels)
    if "coordinates" not in tracks:
        raise InputError(file, "tracks", "coordinates are not among them", "add them: the motion must stay near")
    if study.exoskeleton and "strap" not in tracks:
        raise InputError(file, "tracks", "strap is not among them", "add it, or leave out exoskeleton = true")
    chain = two_chains(subject) if study.exoskeleton else leg_chain(subject)
    sites = strap_sites(tuple(site for each in study.trials for site in each.elsewhere))
    names = tuple(site.name for site in sites[1:])
    trials = with_chairs([channels_of(each, chain, tracks, file, record, names, c3d_unit) for each in study.trials])
    return StandingUpTrials(subject, StandingNoise(**study.noise), trials, study.exoskeleton, free, tracks, sites)


def with_chairs(trials: Sequence[StandingTrial]) -> tuple[StandingTrial, ...]:
    """Where one begins on the chair, the others have one that carries nothing."""
    if all(trial.chair is None for trial in trials):
        return tuple(trials)
    return tuple(
        trial if trial.chair is not None else replace(trial, chair=np.zeros((len(trial.time), COMPONENTS)))
        for trial in trials
    )


def _known(
    study: Path, key: str, told: tuple[str, ...] | None, usual: tuple[str, ...], names: tuple[str, ...]
) -> tuple[str, ...]:
    """In the order of all names; the usual ones where nothing is told."""
    if told is None:
        return usual
    odd = [name for name in told if name not in names]
    if odd or not told:
        what = f"{odd[0]!r} is not known here" if odd else "names nothing"
        raise InputError(study, key, what, f"names are {', '.join(names)}")
    return tuple(name for name in names if name in told)
