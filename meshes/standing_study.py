"""A synthetic person and three passive trials: the model itself stands up, three times differently.

Not recordings, and no test of the model's form: calibration and truth share their equations. Speeds, postures,
parameters and noise are invented.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.chain import EVERY_PLANTED, Subject, feet_on_ground
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, strapped, with_exoskeleton
from geocontact.standing_up.standing_model import StandingModel
from geocontact.standing_up.strap_sites import PELVIS_STRAP, SHANK_STRAP, STRAP_SITES, searched
from geocontact.standing_up.trials import StandingNoise, StandingTrial, recorded, standing_up

RATE = 100.0
SECONDS = (1.5, 1.3, 1.8)
SEATED = np.radians([[22.0, 70.0, 45.0], [18.0, 75.0, 50.0], [25.0, 68.0, 35.0]])
"""Lean of shank, thigh and trunk at seat-off in each trial [rad]."""
OTHER_SECONDS, OTHER_SEATED, ASSISTANCE = 1.4, np.radians([20.0, 72.0, 48.0]), 0.25
"""Of a held-out trial: its duration [s], its leans, and what the exoskeleton's torques are of the person's."""
SITES_PLANTED = np.r_[
    searched(SHANK_STRAP.parameters, [6.0e3, 1.5e3, 20.0, 0.28]),
    searched(PELVIS_STRAP.parameters, [8.0e3, 4.0e3, 60.0, 0.12]),
]
"""Of straps at shank and pelvis, invented."""
MATS = ({"pelvis"}, {"pelvis"}, {"thigh", "shank"})
"""Where mats lie in each trial: both configurations of the paper's study."""


@dataclass(frozen=True, eq=False)
class SyntheticStudy:
    """Trials and what was planted.

    Parameters
    ----------
    planted
        What is searched of the model's parameters.
    """

    model: StandingModel

    subject: Subject
    noise: StandingNoise
    planted: Float[np.ndarray, " p"]
    trials: tuple[StandingTrial, ...]


def synthetic_study(
    *,
    seed: int = 34,
    exoskeleton: bool = False,
    held_out: bool = False,
    sites: bool = False,
    intervals: int = 50,
    count: int = 3,
) -> SyntheticStudy:
    """Trials of a person of 70 kg and 1.75 m, up to three passive ones, or an assisted one that was not used.

    With `sites` an exoskeleton has straps at thigh, shank and pelvis, and mats as in `MATS`.

    ArithmeticError where a motion is not found.
    """
    subject, noise = Subject(), StandingNoise()
    model = with_exoskeleton(subject) if exoskeleton else feet_on_ground(subject)
    planted = np.r_[EVERY_PLANTED, STRAP_PLANTED] if exoskeleton else EVERY_PLANTED
    if sites:
        model, planted = strapped(subject, STRAP_SITES), np.r_[EVERY_PLANTED, STRAP_PLANTED, SITES_PLANTED]
    trials = []
    kinds = zip(SECONDS[:count], SEATED[:count], strict=True)
    for k, (seconds, seated) in enumerate([(OTHER_SECONDS, OTHER_SEATED)] if held_out else kinds):
        _, true = standing_up(
            model,
            subject,
            seconds=seconds,
            seated=seated,
            planted=planted,
            assistance=ASSISTANCE if held_out else 0.0,
            intervals=intervals,
        )
        if not true.solved:
            raise ArithmeticError(f"trial {k + 1}: {true.ending}")
        name = "P1" if held_out else f"T{k + 1}"
        trial = recorded(model, true.motions[0], true.p, RATE, noise, 100 * seed + k, name)
        trials.append(_with_mats(trial, MATS[k]) if sites else trial)
    return SyntheticStudy(model, subject, noise, planted, tuple(trials))


def _with_mats(trial: StandingTrial, at: Collection[str]) -> StandingTrial:
    """The trial with mats at some sites only; no number where there is none."""
    none = np.full(len(trial.time), np.nan)
    elsewhere = {name: force if name in at else none for name, force in trial.elsewhere.items()}
    return replace(trial, strap=trial.strap if "thigh" in at else none, elsewhere=elsewhere)
