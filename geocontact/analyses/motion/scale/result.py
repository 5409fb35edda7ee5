"""A model made to measure: a file for OpenSim, and how well it fits the static trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.json_file import write_json
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.plain_page import write_plain_page
from geocontact.analyses.result import Result
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.io.opensim.osim_scaler import write_scaled_model


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ScaleResult(Result):
    """A scaled model and its static pose.

    Parameters
    ----------
    factors
        Of the bodies that were scaled.
    model
        The scaled model.
    pose
        Coordinates of the static pose [rad, m], and how far the markers are from it [m].
    summary
        Numbers of the scaling, with units in their names.
    """

    options: ScaleOptions
    factors: Mapping[str, float]
    model: Multibody
    pose: Poses
    summary: dict[str, Any]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`markers`, how far each is from the scaled model; `factors` by body."""
        off = {"marker": list(self.pose.markers), "distance [mm]": 1e3 * self.pose.distances[0]}
        by = {"body": list(self.factors), "factor [-]": list(self.factors.values())}
        return {"markers": pd.DataFrame(off), "factors": pd.DataFrame(by)}

    def write_files(self, folder: Path) -> None:
        """scaled.osim and scale.json."""
        by = {name: factor * np.ones(3) for name, factor in self.factors.items()}
        values = np.asarray(self.pose.values)[0].tolist()
        standing = {name: v for name, v in zip(self.pose.names, values, strict=True) if np.isfinite(v)}
        write_scaled_model(self.options.model, folder / "scaled.osim", self.model, by, standing)
        write_json(folder / "scale.json", self.summary)

    def write_page(self, file: Path) -> None:
        """Markers and factors."""
        write_plain_page(self, f"Model scaled to {self.options.static.name}", file)
