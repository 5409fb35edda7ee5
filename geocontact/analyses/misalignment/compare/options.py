"""What a comparison may be asked for."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Degrees, Requires, Spelled
from geocontact.analyses.frame.words import counted
from geocontact.analyses.misalignment.shared_options import ColumnOptions, Stroke, require_stroke
from geocontact.data.errors import InputError
from geocontact.data.plausible import BIN

TWO_DEGREES = math.radians(2.0)


@dataclass(frozen=True)
class CompareOptions(ColumnOptions):
    """Errors of a model of the elbow against recordings: mean absolute, root mean square, R², by channel and trial.

    Parameters
    ----------
    recordings
        Tables of angle and force (.csv .mot .sto .c3d), and the free joint's displacement if it is to be compared.
    fit
        elbow.json of an identification: its law is simulated along each recording's angle.
    simulated
        Simulated recording instead of `fit`, one for each recording, in the same order.
    stroke
        Stroke of the compensation joint with `fit`, such as -10:40; locked without.
    bin
        Width of the bins of the picture.
    """

    writes: ClassVar[str] = """
    Writes comparison.csv, a figure for each channel, report.html and run.json into OUT.
    """

    recordings: tuple[Path, ...]
    _: KW_ONLY
    fit: Path | None = None
    simulated: tuple[Path, ...] | None = None
    stroke: Annotated[Stroke | None, Requires("fit")] = None
    bin: Annotated[Degrees, Spelled("bin-deg", "bin_deg", default=2.0), BIN] = TWO_DEGREES

    def refuse_impossible(self) -> None:
        """Not exactly one model for each recording; a stroke that ends before it begins."""
        if (self.fit is None) == (self.simulated is None):
            raise InputError("", "`fit`", "or `simulated`: exactly one is compared with", "give one")
        if self.simulated is not None and len(self.simulated) != len(self.recordings):
            what = f"is given {len(self.simulated)} times for {counted(len(self.recordings), 'recording')}"
            raise InputError("", "`simulated`", what, "give one for each, in the same order")
        require_stroke(self.stroke)
