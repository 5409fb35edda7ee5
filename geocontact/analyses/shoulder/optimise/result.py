"""Support profiles by linear programs: `geocontact shoulder optimise`, `gc.shoulder.optimise`.

>>> import geocontact as gc
>>> result = gc.shoulder.optimise()
>>> result.sentences[0]
"36.1% of the shoulders' torque is removed in the simulation (36.1% planned) without ever pushing an arm up,
nor in 95% of the draws of the model's errors that it was chosen with; one factor for all tasks, hands and phases
takes 19.2%"
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import note
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.shoulder.devices import factors_written
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.profiles import (
    OTHERS,
    WorkersAndDevice,
    closed_loop,
    judged_held_out,
    read,
    sound,
)
from geocontact.analyses.shoulder.optimise.show import (
    profile_curves,
    profile_page,
    say_held_out,
    say_profiles,
    say_simulated,
)
from geocontact.shoulder_exoskeleton.support.arm_trial import scales_of, support_case
from geocontact.shoulder_exoskeleton.support.group_profiles import (
    GROUP,
    FrontPoint,
    NamedProfile,
    front_points,
    made_profiles,
    planned_outcomes,
    with_sensors,
)
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport
from geocontact.shoulder_exoskeleton.support.outcome import SupportOutcome
from geocontact.shoulder_exoskeleton.support.profile_limits import SupportCase

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ShoulderOptimiseResult(Result):
    """Support profiles.

    Parameters
    ----------
    cases
        One arm in one trial each, the device's arm where the human one is.
    corrected
        The same with what of the cylinder's torque reaches the arm in the simulation of the group's profile.
    elevations
        Of the arms by the cases' names [rad].
    profiles
        The group's first.
    moments, scales
        By person: of the arm's weight [N m], and what the profile by arm weight is multiplied by; no scales where all
        factors are the same.
    outcomes
        By profile and case as planned: linear around the simulation of the group's profile.
    simulated
        By profile and case, the device moving by its own dynamics, with exact sensors.
    noisy
        The same with noisy, late sensors: the group's profile, and the one that the others make for each person.
    held_out
        By person; empty where there is one only.
    front
        Reserve by reserve.
    taken
        What the group's profile and one factor take away, by the aim and in the mean over persons; "with sensors".
    """

    claims: ClassVar[frozenset[str]] = frozenset({"gain beyond the model's error"})

    options: ShoulderOptimiseOptions
    cases: tuple[SupportCase, ...]
    corrected: tuple[SupportCase, ...]
    elevations: Mapping[str, Float[np.ndarray, " t"]]
    profiles: tuple[NamedProfile, ...]
    moments: Mapping[str, float]
    scales: Mapping[str, float]
    outcomes: Mapping[str, Mapping[str, SupportOutcome]]
    simulated: Mapping[str, Mapping[str, SupportOutcome]]
    noisy: Mapping[str, Mapping[str, SupportOutcome]]
    held_out: Mapping[str, HeldOutSupport]
    front: tuple[FrontPoint, ...]
    taken: Mapping[str, float]

    @property
    def factors(self) -> dict[tuple[str, str, str, str], float]:
        """Factor of the support by profile, task, hand and phase [-]."""
        return {(p.name, k.task, k.hand, k.phase): value for p in self.profiles for k, value in p.factors.items()}

    @property
    def reduction(self) -> dict[tuple[str, str], float]:
        """Share of the shoulder's torque that the support takes away, by profile and case [-]."""
        return {(name, case): one.reduction for name, found in self.outcomes.items() for case, one in found.items()}

    @property
    def force(self) -> dict[tuple[str, str], float]:
        """Largest force at the interface by profile and case [N]."""
        return {(name, case): one.force for name, found in self.outcomes.items() for case, one in found.items()}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`factors`, `scales`, `outcomes`, `simulated`, `held_out`, `front`."""
        return {
            "factors": factors_written({each.name: each.factors for each in self.profiles}),
            "scales": pd.DataFrame(
                [
                    {"person": person, "moment of the arm's weight [N m]": self.moments[person], "scale [-]": scale}
                    for person, scale in self.scales.items()
                ]
            ),
            "outcomes": self._rows(self.outcomes),
            "simulated": pd.concat(
                [
                    self._rows(found).assign(sensors=name)
                    for name, found in (("exact", self.simulated), ("noisy and late", self.noisy))
                ],
                ignore_index=True,
            ),
            "held_out": self._held_out(),
            "front": pd.DataFrame(
                [{"force limit [N]": p.force, "reserve [-]": p.reserve, "taken away [-]": p.value} for p in self.front]
            ),
        }

    def curves(self) -> dict[str, CurveSheet]:
        """`profile`: torque that the shoulder needs and torque of the support, as the paper's fig. 14."""
        return {"profile": profile_curves(self.corrected, self.elevations, self.profiles[0].factors)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Torques, factors, what they do, held-out persons, fronts."""
        return {REPORT: profile_page(self.curves()["profile"], self.tables(), self.taken)}

    def _rows(self, outcomes: Mapping[str, Mapping[str, SupportOutcome]]) -> pd.DataFrame:
        rows = []
        for profile, found in outcomes.items():
            for case in self.cases:
                if case.name in found:
                    told = {"profile": profile, "person": case.person, "task": case.task, "hand": case.hand}
                    rows.append(told | _outcome_row(found[case.name]))
        return pd.DataFrame(rows)

    def _held_out(self) -> pd.DataFrame:
        rows = []
        for person, found in self.held_out.items():
            numbers = {
                "scale [-]": self._scale_of_others(person),
                "taken away [-]": found.reduction,
                "taken away, lower [-]": found.interval[0],
                "taken away, upper [-]": found.interval[1],
                "gain over one factor [-]": found.gain,
                "gain, lower [-]": found.gain_interval[0],
                "gain, upper [-]": found.gain_interval[1],
                "pushed up [-]": found.pushed_up[0],
                "pushed up, 95 % of draws [-]": found.pushed_up[1],
            }
            rows.append(
                {
                    "person": person,
                    **numbers,
                    "excess [N m]": found.excess[0],
                    "excess, 95 % of draws [N m]": found.excess[1],
                    "gain beyond the model's error": found.gain_is_beyond_the_error,
                }
            )
        return pd.DataFrame(rows)

    def _scale_of_others(self, person: str) -> float:
        """Scale of a person's arm among those of the others, who made the profile."""
        makers = set(self.held_out) - {person}
        return scales_of(self.moments, makers)[person] if self.scales else 1.0


def _outcome_row(found: SupportOutcome) -> dict[str, float]:
    return {
        "taken away [-]": found.reduction,
        "pushed up [-]": found.pushed_up,
        "excess [N m]": found.excess,
        "force [N]": found.force,
        "rate [N m/s]": found.rate,
    }


def run(workers: WorkersAndDevice, o: ShoulderOptimiseOptions) -> ShoulderOptimiseResult:
    """Profiles, what they do, their fronts, and how they fare with a person held out."""
    trials, loop = workers.trials, closed_loop(workers, o)
    made = sound(o, lambda: made_profiles(trials, loop, workers.unseen, by_arm=o.scale == "arm"))
    judged = sound(o, lambda: judged_held_out(workers, loop, o))
    corrected = tuple(support_case(each, workers.support, transfer=made.group.transfers[each.name]) for each in trials)
    by_person = {GROUP: dict.fromkeys((each.person for each in trials), made.group.profile.factors)}
    if judged:
        by_person[OTHERS] = {person: each.factors for person, each in judged.items()}
    noisy = sound(o, lambda: {name: with_sensors(trials, workers.device, f, o.seed) for name, f in by_person.items()})
    taken = say_profiles(made, loop, trials)
    say_held_out(judged, noisy.get(OTHERS, {}))
    taken["with sensors"] = say_simulated(noisy, loop.limits)
    note("optimise", plain({"device": workers.device.name, **taken}))
    return ShoulderOptimiseResult(
        options=o,
        cases=tuple(support_case(each, workers.support) for each in trials),
        corrected=corrected,
        elevations={trial.name: trial.elevation for trial in trials},
        profiles=made.profiles,
        moments=made.moments,
        scales=made.scales,
        outcomes=planned_outcomes(made.profiles, corrected),
        simulated=made.simulated,
        noisy=noisy,
        held_out=judged,
        front=front_points(corrected, loop),
        taken=taken,
    )


optimise = Job("shoulder optimise", ShoulderOptimiseOptions, read, run)
