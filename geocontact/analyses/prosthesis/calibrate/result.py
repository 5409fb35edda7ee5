"""What a calibration gives: numbers with intervals, curves, and the law as a file."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import fspath
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float
from numpy import ndarray

from geocontact.analyses.prosthesis.calibrate.figure import stance_figure
from geocontact.analyses.prosthesis.calibrate.law_file import law_toml
from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.analyses.prosthesis.calibrate.page import calibration_page
from geocontact.analyses.result import REPORT, Result
from geocontact.below_knee_prosthesis.calibration.calibrate import SoleCalibration
from geocontact.below_knee_prosthesis.calibration.known_numbers import KnownNumber
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.below_knee_prosthesis.calibration.whole_calibration import WholeCalibration
from geocontact.identify.signals.agreement import Agreement

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page

LAW = "law.toml"


def known_of(found: SoleCalibration | WholeCalibration) -> tuple[KnownNumber, ...]:
    """Numbers of the zones, then height and pitch of the foot beside its standing trial."""
    return *found.knowledge.numbers, *found.knowledge.beside


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisCalibrateResult(Result):
    """Numbers of the zones, and the stance with them.

    Parameters
    ----------
    stance
        As it was recorded.
    calibration
        What was found along the recorded poses.
    whole
        What was found from there on the whole model, where that was asked for.
    predicted
        Force in the ground's frame [N] and centre of pressure from the heel (share of the foot) with the numbers found
        last, by the model that found them.
    slip
        Along the floor, beside the recorded speed [m/s].
    vertical, centre
        Agreement of the vertical force over body weight, and of the centre, with the plate's.
    """

    options: ProsthesisCalibrateOptions
    stance: RecordedStance
    calibration: SoleCalibration
    whole: WholeCalibration | None
    predicted: Float[ndarray, "t 4"]
    slip: Float[ndarray, "t 2"]
    vertical: Agreement
    centre: Agreement

    @property
    def residual(self) -> float:
        """Of the data at the numbers found last, over their noise, root mean square."""
        return float(np.sqrt(np.mean(self.last.residuals.of_data(self.last.at) ** 2)))

    @property
    def last(self) -> SoleCalibration | WholeCalibration:
        """What was found last."""
        return self.calibration if self.whole is None else self.whole

    def tables(self) -> dict[str, pd.DataFrame]:
        """`numbers`, `stance`."""
        s = self.stance
        columns = {"time [s]": s.time}
        for k, axis in enumerate("xyz"):
            columns |= {f"force_{axis} [N]": self.predicted[:, k], f"plate_force_{axis} [N]": s.force[:, k]}
        columns |= {"centre in the foot [-]": self.predicted[:, 3], "plate centre in the foot [-]": s.centre}
        rows = [
            {
                "number": each.name,
                "unit": each.unit,
                "value": each.value,
                "lower": each.lower,
                "upper": each.upper,
                "verdict": each.verdict,
                "prior lower": each.prior[0],
                "prior upper": each.prior[1],
            }
            for each in known_of(self.last)
        ]
        if self.whole is not None:
            for row, before in zip(rows, known_of(self.calibration), strict=True):
                row |= {"along poses": before.value, "along poses verdict": before.verdict}
        return {"numbers": pd.DataFrame(rows), "stance": pd.DataFrame(columns)}

    def figures(self) -> dict[str, Figure]:
        """`stance`: measured and modelled force and centre of pressure."""
        return {"stance": stance_figure(self.stance, self.predicted)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Curves, numbers, and what they mean."""
        numbers, walked = self.tables()["numbers"], self.whole is not None
        page = calibration_page(drawings["stance"], self.stance, self.predicted, numbers, self.sentences, walked)
        return {REPORT: page}

    def write_files(self, folder: Path) -> None:
        """law.toml besides."""
        named = fspath(self.options.static)
        standing = next(str(each["sha256"]) for each in self.record.inputs if each["file"] == named)
        (folder / LAW).write_text(law_toml(self.last, standing), encoding="utf-8", newline="\n")
        super().write_files(folder)
