"""What a choice gives: designs with certificates, sensitivities, front and draws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.sit_to_stand.design.chosen import CertifiedDesign, DrawnGain
from geocontact.analyses.sit_to_stand.design.figure import design_figure
from geocontact.analyses.sit_to_stand.design.numbers import design_numbers
from geocontact.analyses.sit_to_stand.design.options import StandingDesignOptions
from geocontact.analyses.sit_to_stand.design.page import choice_page
from geocontact.analyses.sit_to_stand.design.read import TrialsToHelp
from geocontact.analyses.sit_to_stand.design.tables import (
    certificates_table,
    chosen_table,
    designs_table,
    draws_table,
    sensitivity_table,
)
from geocontact.analyses.sit_to_stand.exports import write_motion
from geocontact.analyses.sit_to_stand.model_file import write_standing_model
from geocontact.analyses.sit_to_stand.numbers_table import mesh_table, ran_table
from geocontact.standing_up.assistance.assisted_model import ASSISTED_PARAMETERS, AssistedModel
from geocontact.standing_up.assistance.peaks import MEASURES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingDesignResult(Result):
    """Exoskeletons for one person.

    Parameters
    ----------
    model
        What moved.
    designs
        Without help, share alone, chosen, and chosen for the draws where that was asked for.
    front
        Best ones at further limits of the knee, the loosest first.
    draws
        What the gain is with drawn parameters.
    """

    options: StandingDesignOptions
    given: TrialsToHelp
    model: AssistedModel
    designs: tuple[CertifiedDesign, ...]
    front: tuple[CertifiedDesign, ...]
    draws: tuple[DrawnGain, ...]

    @property
    def best(self) -> CertifiedDesign:
        """The last that was chosen."""
        return self.designs[-1]

    @property
    def reference(self) -> CertifiedDesign:
        """What the gain is told over: share alone, or no help where nothing else was sought."""
        return self.designs[1] if len(self.designs) > 2 else self.designs[0]

    @property
    def gain(self) -> float:
        """Part of the reference's aim that is saved."""
        k = MEASURES.index(self.options.aim)
        return 1.0 - float(self.best.movement.asked.sizes[k] / self.reference.movement.asked.sizes[k])

    @property
    def true_gain(self) -> float:
        """The same of true peaks, or of the largest energy."""
        k = MEASURES.index(self.options.aim)
        return 1.0 - float(self.best.movement.asked.largest[k] / self.reference.movement.asked.largest[k])

    @property
    def accepted(self) -> bool:
        """Whether every search found its answer, none was left out, and every motion is certified."""
        each, o = (*self.designs, *self.front), self.options
        wanted = (2 if o.varied == ("share",) else 3) + int(o.robust) + o.front
        return len(each) == wanted and all(one.certified and (one.design is None or one.design.met) for one in each)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`designs`, `chosen`, `sensitivity`, `certificate`, `numbers`, `mesh`; `front` and `draws` if asked for."""
        every = (*self.designs, *self.front)
        found = {
            "designs": designs_table(self.designs),
            "chosen": chosen_table(self.best),
            "sensitivity": sensitivity_table(self.best, self.given.sd),
            "certificate": certificates_table(every),
            "numbers": ran_table(design_numbers(self.model, every, self.given.trials.trials)),
            "mesh": mesh_table("design", [(one.name, one.movement.found.motions) for one in every]),
        }
        if self.front:
            found["front"] = designs_table((self.designs[0], *self.front, self.best))
        if self.draws:
            found["draws"] = draws_table(self.draws, self.options.aim)
        return found

    def figures(self) -> dict[str, Figure]:
        """`design`: strap and knee over the movement, and the front."""
        return {"design": design_figure(self.designs, self.front, self.options.aim)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The chosen exoskeleton moving, curves of all, tables."""
        subject, drawn = self.given.trials.subject, drawings["design"]
        return {REPORT: choice_page(self.sentences, subject, self.designs, drawn, self.tables())}

    def write_files(self, folder: Path) -> None:
        """Trajectories and model; tables, figure, page."""
        p = self.best.movement.found.p
        values = {of.name: of.value(float(value)) for of, value in zip(ASSISTED_PARAMETERS, p, strict=True)}
        for trial in self.best.trials:
            write_motion(folder, self.given.trials.subject, trial, values, self.best.movement.found.solved)
        write_standing_model(folder / "model.osim", self.given.trials.subject, values, worn=True)
        super().write_files(folder)
