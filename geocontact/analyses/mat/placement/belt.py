"""A mat that goes once around a body: what is said when it does not, and how well it closes when it does."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.mat.options import MatOptions
from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.geometry.drape.belt import NotAroundError
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.drape.mat import Mat


def open_belt(o: MatOptions, error: NotAroundError) -> InputError:
    """The line for a belt that does not close."""
    remedy = "check landmarks, pitch and unit; a mat with two ends, or one that overlaps itself, is no `belt`"
    return InputError("", f"`belt` {o.belt}", str(error), remedy)


def say_how_it_closes(record: Record, mat: Mat, laid: Drape, o: MatOptions) -> None:
    """Length of the belt and of the way around that it took; cells share the difference."""
    if o.belt is None:
        return
    along = 0 if o.belt == "rows" else 1
    length = (mat.rows, mat.columns)[along] * mat.pitch[along]
    stretch = laid.stretch[..., along]
    around = length * (1.0 + np.nanmean(stretch))
    record.results["belt"] = {"around": o.belt, "length_mm": length * 1e3, "way_around_mm": float(around) * 1e3}
    record.say(f"belt of {length * 1e3:.0f} mm closes around {around * 1e3:.0f} mm of the body")
