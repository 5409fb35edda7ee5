"""What a choice of a foot finds: bands over what is varied, the best value for every aim, roll-over shapes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.prosthesis.design.figure import design_figure, stance_share
from geocontact.analyses.prosthesis.design.intact_side import intact_table
from geocontact.analyses.prosthesis.design.options import ProsthesisDesignOptions
from geocontact.analyses.prosthesis.design.page import design_page
from geocontact.analyses.prosthesis.design.sensitivities_table import sensitivities_table
from geocontact.analyses.prosthesis.design.sweep import SHOWN, UNITS, AimAnswer, Sweep, answers_table
from geocontact.analyses.prosthesis.design.together import Together
from geocontact.analyses.prosthesis.simulate.tables import numbers_table
from geocontact.analyses.result import REPORT, Result
from geocontact.below_knee_prosthesis.design.carried_load import CarriedLoad
from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.below_knee_prosthesis.design.knob import Knob, Response
from geocontact.below_knee_prosthesis.design.outcomes import Aim, shank_path
from geocontact.below_knee_prosthesis.design.sensitivities import FootSensitivity
from geocontact.data.sourced_number import Number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisDesignResult(Result):
    """A foot varied for one person.

    Parameters
    ----------
    answers
        By aim.
    ends, shapes
        First, present and last value, and the foot along the stance at each, with the numbers as they are.
    task
        What the foot carries.
    held
        How long joint torques alone hold the leg at each of the ends [s].
    hangs_on
        How far outcomes on the present foot hang on each number.
    together
        Alignment varied together with the value; None where it was not asked for.
    numbers
        Of leg and foot as the trial is read with.
    intact
        Outcomes that the intact foot has, in SI; None where its step is not given.
    """

    options: ProsthesisDesignOptions
    sweep: Sweep
    answers: tuple[AimAnswer, ...]
    ends: Knob
    shapes: Mapping[Response, tuple[CarriedLoad, ...]]
    task: FootTask
    held: tuple[float, ...]
    hangs_on: tuple[FootSensitivity, ...]
    together: Together | None = None
    numbers: Mapping[str, Number]
    intact: Mapping[Aim, float] | None = None

    def tables(self) -> dict[str, pd.DataFrame]:
        """`answers`, `ranges`, `sensitivities`, `sweep`, `shapes`, `numbers`; `intact`; `pairs` and `together`."""
        vary = self.sweep.knob.vary
        told = {
            "answers": answers_table(self.answers, vary),
            "ranges": self.sweep.ranges(),
            "sensitivities": sensitivities_table(self.hangs_on),
            "sweep": self.sweep.table(),
            "shapes": self._shapes(),
            "numbers": numbers_table(self.numbers),
        }
        if self.intact is not None:
            told["intact"] = intact_table(self.intact)
        if self.together is not None:
            told |= {"pairs": self.together.pairs(vary, self.answers), "together": self.together.table(vary)}
        return told

    def figures(self) -> dict[str, Figure]:
        """`design`: outcomes with bands, roll-over shapes."""
        return {"design": design_figure(self.sweep, self.answers, self.ends, self.shapes)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Outcomes, answers, what they hang on, numbers."""
        return {REPORT: design_page(drawings["design"], self.sweep, self.tables(), self.sentences)}

    def _shapes(self) -> pd.DataFrame:
        vary = self.ends.vary
        frames = []
        for response, carried in self.shapes.items():
            for value, found in zip(self.ends.settings, carried, strict=True):
                forward, up = shank_path(found).T
                columns = {
                    f"{vary} [{UNITS[vary]}]": SHOWN[vary][0] * float(value),
                    "response": response,
                    "stance [-]": stance_share(found),
                    "forward of ankle [mm]": 1e3 * forward,
                    "above ankle [mm]": 1e3 * up,
                    "ankle moment [N m]": found.ankle_moment,
                    "stored [J]": found.stored,
                    "turned [deg]": found.tilt * SHOWN["alignment"][0],
                }
                frames.append(pd.DataFrame(columns))
        return pd.concat(frames, ignore_index=True)
