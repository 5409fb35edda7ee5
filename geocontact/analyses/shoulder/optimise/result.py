"""What the choice of a support profile finds: factors, what they do, fronts, held-out persons."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.shoulder.optimise.figure import profile_figure
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.page import profile_page
from geocontact.analyses.shoulder.support_profiles import factors_written
from geocontact.shoulder_exoskeleton.support.arm_scales import scales_of
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport
from geocontact.shoulder_exoskeleton.support.outcome import Factors, SupportOutcome
from geocontact.shoulder_exoskeleton.support.support_case import SupportCase

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True)
class NamedProfile:
    """Factors, what they are called, and for which persons."""

    name: str
    factors: Factors
    of: tuple[str, ...]


@dataclass(frozen=True)
class FrontPoint:
    """Share of the torque that is taken away under a limit of interface force [N] and with a reserve."""

    force: float
    reserve: float
    value: float


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
    """

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

    def figures(self) -> dict[str, Figure]:
        """`profile`: torque that the shoulder needs and torque of the support, as the paper's fig. 14."""
        return {"profile": profile_figure(self.corrected, self.elevations, self.profiles[0].factors)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Torques, factors, what they do, held-out persons, fronts."""
        return {REPORT: profile_page(drawings["profile"], self.tables(), self.sentences)}

    def _rows(self, outcomes: Mapping[str, Mapping[str, SupportOutcome]]) -> pd.DataFrame:
        rows = []
        for profile, found in outcomes.items():
            for case in self.cases:
                if case.name in found:
                    told = {"profile": profile, "person": case.person, "task": case.task, "hand": case.hand}
                    rows.append(told | _told(found[case.name]))
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


def _told(found: SupportOutcome) -> dict[str, float]:
    return {
        "taken away [-]": found.reduction,
        "pushed up [-]": found.pushed_up,
        "excess [N m]": found.excess,
        "force [N]": found.force,
        "rate [N m/s]": found.rate,
    }
