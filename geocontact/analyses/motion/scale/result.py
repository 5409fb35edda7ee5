"""A model made to measure: a file for OpenSim, and how well it fits the static trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.json_file import write_json
from geocontact.analyses.motion.scale.factors import labelled
from geocontact.analyses.motion.scale.options import ScaleOptions
from geocontact.analyses.motion.scale.page import scaling_page
from geocontact.analyses.motion.scale.read import Standing
from geocontact.analyses.result import REPORT, Result
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.dynamics.scaling import Factors
from geocontact.io.mocap.trc_writer import write_trc
from geocontact.io.opensim.osim_scaler import write_scaled_model
from geocontact.io.opensim.tool_setup_writer import write_scale_setup

if TYPE_CHECKING:
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ScaleResult(Result):
    """A scaled model and its static pose.

    Parameters
    ----------
    standing
        The trial and what each marker counts.
    factors
        Of the bodies that were scaled, along their axes.
    model
        The scaled model.
    pose
        Coordinates of the static pose [rad, m], and how far the markers are from it [m].
    seen, modelled
        Markers of the pose as they were seen and as scaling put them, in the ground's frame [m].
    summary
        Numbers of the scaling, with units in their names.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"markers", "factors"})

    options: ScaleOptions
    standing: Standing
    factors: Factors
    model: Multibody
    pose: Poses
    seen: Float[np.ndarray, "m 3"]
    modelled: Float[np.ndarray, "m 3"]
    summary: dict[str, Any]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`markers`, how far each is from the scaled model; `factors` by body, or by body and axis."""
        off = {"marker": list(self.pose.markers), "distance [mm]": 1e3 * self.pose.distances[0]}
        told = labelled(self.factors)
        by = {"body": list(told), "factor [-]": list(told.values())}
        return {"markers": pd.DataFrame(off), "factors": pd.DataFrame(by)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The static pose with its markers, factors, distances."""
        title, both = f"Model scaled to {self.options.static.name}", (self.seen, self.modelled)
        return {REPORT: scaling_page(title, self.model, labelled(self.factors), self.pose, both)}

    def write_files(self, folder: Path) -> None:
        """scaled.osim, scale.json and OpenSim's set-up with the static trial as it was read besides."""
        values = np.asarray(self.pose.values)[0].tolist()
        standing = {name: v for name, v in zip(self.pose.names, values, strict=True) if np.isfinite(v)}
        defaults = None if self.options.keep_markers else standing
        write_scaled_model(self.options.model, folder / "scaled.osim", self.model, self.factors, defaults)
        write_json(folder / "scale.json", self.summary)
        self._write_setup(folder)
        super().write_files(folder)

    def _write_setup(self, folder: Path) -> None:
        """With which OpenSim's own tool makes the same model."""
        o, standing = self.options, self.standing
        write_trc(folder / "seen.trc", standing.recorded)
        write_scale_setup(
            folder / "setup_scale.xml",
            str(o.model.absolute()),
            "" if o.marker_set is None else str(o.marker_set.absolute()),
            "seen.trc",
            self.factors,
            standing.tasks,
            (float(standing.recorded.time[0]), float(standing.recorded.time[-1])),
            mass=o.mass,
            by_volume=o.mass_by_volume,
            place=not o.keep_markers,
            out="opensim_scaled.osim",
        )
