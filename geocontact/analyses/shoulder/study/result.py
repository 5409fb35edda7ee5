"""What a study finds: errors, differences of both groups, figure, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.shoulder.study.case import StudyCase
from geocontact.analyses.shoulder.study.figure import study_figure
from geocontact.analyses.shoulder.study.options import StudyOptions
from geocontact.analyses.shoulder.study.tables import difference_table, error_table, passive_table, summary_table
from geocontact.shoulder_exoskeleton.device import Device
from geocontact.view.page.content import Page, Picture, Words
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CAPTION = "Elevation of the exoskeleton's arm and force that lifts the human one: recorded, and simulated twice."
PASSIVE = (
    "What turns the passive joints is the sphere's push sideways; about the third direction only friction, stops and "
    "joint damping hold them, so their angles hang on numbers that are invented."
)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StudyResult(Result):
    """Every arm in every trial of a study, simulated along both motions."""

    options: StudyOptions
    cases: tuple[StudyCase, ...]
    device: Device

    def tables(self) -> dict[str, pd.DataFrame]:
        """`summary` over all arms and trials, `errors` of each, `differences` of both groups, `passive` joints."""
        return {
            "summary": summary_table(self.cases),
            "errors": error_table(self.cases),
            "differences": difference_table(self.cases),
            "passive": passive_table(self.cases),
        }

    def figures(self) -> dict[str, Figure]:
        """`study`: elevation and supporting force of each arm, recorded, and simulated along both motions."""
        return {"study": study_figure(self.cases)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Figure and tables."""
        tables = self.tables()
        words = {
            "summary": "Errors over all arms",
            "differences": "Motion recorded in the device less that without it, screw-in",
            "passive": "Passive joints and slip",
            "errors": "Errors by trial and arm",
        }
        page = Page(
            title=f"Study of {len({each.trial.name for each in self.cases})} trials with {self.device.name}",
            subtitle="Shoulder exoskeleton driven by human motion, beside its logger and a pressure mat",
            time=np.zeros(1),
            time_label="",
            headline=headline(self.sentences, most=2),
            sections=(
                Picture("Every arm in its trial", CAPTION, drawings["study"], wide=True),
                *(frame_table(title, tables[name], 3) for name, title in words.items() if len(tables[name])),
                INPUTS,
                OPTIONS,
                Words("What the numbers do not contain", [PASSIVE, NOT_A_DEVICE]),
            ),
        )
        return {REPORT: page}
