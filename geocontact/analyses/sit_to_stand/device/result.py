"""What the exoskeleton's own dynamics are: parameters with intervals, fit of the motors' torque, torque in a trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.sit_to_stand.device.figure import device_figure
from geocontact.analyses.sit_to_stand.device.options import StandingDeviceOptions
from geocontact.analyses.sit_to_stand.device.read import DeviceRecordings
from geocontact.analyses.sit_to_stand.standing_page import motion_page
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.standing_up.chain import JOINTS
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.exoskeleton_torque import UNITS, ExoskeletonDynamics, human_torque
from geocontact.view.page.content import Picture, Section
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page

MEANT = [
    "The motors' torque is linear in the parameters, and least squares find them; bodies are those of both legs.",
    "By itself: the motion tells that parameter.",
    "Not at all: it does not act on the motors, so that 0 is shown.",
    "In sums only: the motion tells it together with others; the shortest answer is shown, torques are those of all.",
    "Angles and torques went through the same filter, so that the fit is not bent by it.",
    "In a trial the torque at a hinge is that of its motor less its friction.",
]
TORQUES = "torques.sto"


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingDeviceResult(Result):
    """Parameters and torques."""

    options: StandingDeviceOptions
    given: DeviceRecordings
    dynamics: ExoskeletonDynamics

    @property
    def trial_torque(self) -> Float[np.ndarray, "t 3"]:
        """Of the exoskeleton in the trial [N m]; no row without one."""
        trial = self.given.trial
        if trial is None:
            return np.zeros((0, 3))
        return self.dynamics.torque(trial.smooth(trial.motors, self.options.cutoff), trial.u)

    @property
    def smooth(self) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, "t 3"], Float[np.ndarray, "t 3"]]:
        """Without a person, without the ends: times [s], torques of the motors and of the fit [N m], both smoothed."""
        of, cutoff = self.given.unloaded, self.options.cutoff
        inner, again = of.inner(cutoff), self.dynamics.unloaded(of.q, of.u, of.a)
        return of.time[inner], of.smooth(of.motors, cutoff)[inner], of.smooth(again, cutoff)[inner]

    @property
    def person_torque(self) -> Float[np.ndarray, "t 3"] | None:
        """Of the person in the trial [N m]; None without moments of both."""
        both = self.given.together
        return None if both is None else human_torque(both, self.trial_torque)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`parameters`, `unloaded`, and `torque` where there is a trial."""
        fit = self.dynamics
        time, motors, again = self.smooth
        columns = {"time [s]": time}
        for k, name in enumerate(EXO_JOINTS):
            columns |= {f"{name} motor [N m]": motors[:, k], f"{name} fitted [N m]": again[:, k]}
        found = {"parameters": self._parameters(), "unloaded": pd.DataFrame(columns)}
        if (trial := self.given.trial) is not None:
            friction, motors = fit.friction(trial.u), trial.smooth(trial.motors, self.options.cutoff)
            columns = {"time [s]": trial.time}
            for k, name in enumerate(EXO_JOINTS):
                columns |= {f"{name} motor [N m]": motors[:, k], f"{name} friction [N m]": friction[:, k]}
                columns[f"{name} torque [N m]"] = self.trial_torque[:, k]
            if (person := self.person_torque) is not None:
                columns |= {f"{name} torque [N m]": person[:, k] for k, name in enumerate(JOINTS)}
            found["torque"] = pd.DataFrame(columns)
        return found

    def _parameters(self) -> pd.DataFrame:
        from scipy.stats import norm

        fit, reach = self.dynamics, float(norm.ppf(0.5 + 0.5 * self.options.level))
        found, off = fit.values, np.where(fit.alone, reach * fit.deviations, np.nan)  # noqa: PD011
        return pd.DataFrame(
            {
                "parameter": fit.names,
                "unit": UNITS,
                "value": found,
                "lower": found - off,
                "upper": found + off,
                "told": np.where(fit.alone, "by itself", np.where(found == 0.0, "not at all", "in sums only")),
            }
        )

    def figures(self) -> dict[str, Figure]:
        """`device`: the motors' torque and the fit."""
        return {"device": device_figure(*self.smooth)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The fit over time, parameters."""
        sections: list[Section] = [
            Picture("Torques of the motors without a person", "Grey as recorded.", drawings["device"], wide=True),
            frame_table("Dynamic parameters", self.table("parameters"), 4),
        ]
        titles = ("Dynamics of the exoskeleton", "identified from a motion without a person")
        return {REPORT: motion_page(titles, self.sentences, sections, MEANT)}

    def write_files(self, folder: Path) -> None:
        """torques.sto of a trial as a study reads them; tables, figure, page."""
        if (trial := self.given.trial) is not None:
            person = self.person_torque
            names = (*(() if person is None else JOINTS), *EXO_JOINTS)
            values = self.trial_torque if person is None else np.hstack([person, self.trial_torque])
            write_storage(folder / TORQUES, trial.time, names, values, title="Torques of both legs", degrees=False)
        super().write_files(folder)
