"""Compressions of a prosthetic foot that its keel is identified from: how they were done, and their curves."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from jaxtyping import Float
from pydantic import model_validator

from geocontact.data.errors import InputError
from geocontact.io.document_errors import refusal
from geocontact.io.documents import Document, File, Word
from geocontact.io.recordings.foot_quantities import (
    GAUGE,
    PRESSED,
    SPREAD,
    TILTED,
    Length,
    Stiffness,
    quantity,
)
from geocontact.io.recordings.shoulder_device import StatedNumber
from geocontact.io.text.side_table import read_side_table


class Compression(Document):
    """A static compression of the forefoot.

    Parameters
    ----------
    name
        Its own for each.
    setting, fulcrum
        Setting of the foot, or place of its fulcrum; one of both.
    sought
        Whether the fulcrum's place is identified with the keel.
    curve
        Table with `force [N]` and `deflection [mm]`.
    stiffness, sd
        In place of a curve: force over deflection, and its standard deviation.
    """

    name: Word
    setting: Word | None = None
    fulcrum: Length | None = None
    sought: bool = False
    curve: File | None = None
    stiffness: Stiffness | None = None
    sd: Annotated[StatedNumber, quantity(SPREAD)] | None = None

    @model_validator(mode="after")
    def _require_one_of_each(self) -> Compression:
        if (self.setting is None) == (self.fulcrum is None):
            raise refusal("needs a setting or a fulcrum", "write one of both")
        if (self.curve is None) == (self.stiffness is None):
            raise refusal("needs a curve or a stiffness", 'write curve = "soft.csv", or stiffness and sd')
        if (self.stiffness is None) != (self.sd is None):
            raise refusal("needs sd beside stiffness", "it is the standard deviation of the stiffness, for both")
        return self


class Bench(Document):
    """How the compressions were done.

    Parameters
    ----------
    at
        Where the plate presses on the keel; its tip by default.
    noise
        Standard deviation of one measured deflection; 0.05 mm by default.
    series
        Stiffness of all that gives besides the keel, where it is known; identified by default.
    tilt
        Of the plate against the sole, toes first; 20 degrees by default.
    travel
        Of the sole when its numbers are fitted; 5 mm by default.
    """

    at: Length | None = None
    noise: Annotated[StatedNumber, quantity(GAUGE)] | None = None
    series: Stiffness | None = None
    tilt: Annotated[StatedNumber, quantity(TILTED)] | None = None
    travel: Annotated[StatedNumber, quantity(PRESSED)] | None = None


@dataclass(frozen=True, eq=False)
class CompressionCurve:
    """A measured compression: force [N] and deflection [m], as recorded."""

    force: Float[np.ndarray, " n"]
    deflection: Float[np.ndarray, " n"]


FEWEST = 5
"""Rows of a curve."""
HIGHEST = 2e4, 0.1
"""Force [N] and deflection [m] of a foot, at most."""


def read_compression_curve(path: Path) -> CompressionCurve:
    """A table with `force [N]` and `deflection [mm]`, in any units of theirs; InputError for what is none."""
    wanted = ("force [N]", "deflection [m]")
    table = read_side_table(path, wanted)
    for name in wanted:
        if name not in table:
            what = f"no column for {name.split()[0]} with its unit; columns are: {', '.join(map(str, table.columns))}"
            raise InputError(path, "line 1", what, "write force [N], deflection [mm]")
    force, deflection = (table[name].to_numpy(float) for name in wanted)
    if len(force) < FEWEST:
        raise InputError(path, "", f"{len(force)} rows are no curve", f"give {FEWEST} or more")
    for name, values, most in zip(wanted, (force, deflection), HIGHEST, strict=True):
        if not np.isfinite(values).all():
            raise InputError(path, name, "has an empty cell or one that is no number", "fill it or take its row out")
        if np.abs(values).max() > most:
            what = f"goes up to {np.abs(values).max():.4g}; a foot has {most:g} at most"
            raise InputError(path, name, what, "check the unit of the column")
    if not np.ptp(deflection) > 0.0 or np.corrcoef(force, deflection)[0, 1] <= 0.0:
        remedy = "give a compression with both positive; is a sign turned?"
        raise InputError(path, "", "force does not rise with deflection", remedy)
    return CompressionCurve(force, deflection)
