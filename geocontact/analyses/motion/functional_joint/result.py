"""A joint from markers: its place in both segments, and a file of markers that has it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.json_file import write_json
from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.motion.functional_joint.options import JointOptions
from geocontact.analyses.motion.functional_joint.page import joint_page
from geocontact.analyses.motion.functional_joint.read import MovedPair
from geocontact.analyses.result import REPORT, Result
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.dynamics.joint_points import JointPoints
from geocontact.io.mocap.trc_writer import write_trc

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class JointResult(Result):
    """Centre or axis of a joint.

    Parameters
    ----------
    pair
        Both segments along the trial.
    points
        Of the joint, in both segments' frames [m].
    markers
        Of the standing trial, else of the trial, with the joint's own [m].
    summary
        What `joint.json` holds, with units in the names.
    """

    options: JointOptions
    pair: MovedPair
    points: JointPoints
    markers: MarkerTrajectories
    summary: dict[str, Any]

    def places(self) -> tuple[Float[np.ndarray, "t 3"], Float[np.ndarray, "t 3"]]:
        """Middle of the joint in the laboratory, as the first and as the second segment have it [m]."""
        one = self.pair.first_poses.apply(self.points.middle)
        return one, self.pair.second_poses.apply(self.points.second.mean(axis=0))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`joint` over the frames of the trial that show both segments [mm]."""
        one, other = self.places()
        columns = {
            f"{which}_{axis} [mm]": 1e3 * places[:, k]
            for which, places in (("first", one), ("second", other))
            for k, axis in enumerate("xyz")
        }
        apart = 1e3 * np.linalg.norm(one - other, axis=1)
        return {"joint": pd.DataFrame({"time [s]": self.pair.time, **columns, "apart [mm]": apart})}

    def figure(self) -> Figure:
        """Distance between what both segments say, over time."""
        return curves_figure(self.pair.time, {"apart [mm]": self.table()[["apart [mm]"]]})

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Both segments and the joint as they move, and how far it is off itself."""
        title, apart = f"Joint from {self.options.trial.name}", self.table()["apart [mm]"].to_numpy()
        return {REPORT: joint_page(title, self.sentences, self.pair, self.points, apart)}

    def write_files(self, folder: Path) -> None:
        """joint.json and markers.trc [mm] besides."""
        write_json(folder / "joint.json", self.summary)
        write_trc(folder / "markers.trc", self.markers)
        super().write_files(folder)
