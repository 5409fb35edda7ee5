"""What inverse kinematics finds: coordinates for OpenSim, distances of the markers, clinical knee angles, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import pandas as pd

from geocontact.analyses.json_file import write_json
from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.motion.gait_cycles import GaitCycles
from geocontact.analyses.motion.inverse_kinematics.knees import knee_table
from geocontact.analyses.motion.inverse_kinematics.options import IkOptions
from geocontact.analyses.motion.inverse_kinematics.page import kinematics_page
from geocontact.analyses.motion.inverse_kinematics.read import KinematicsInputs
from geocontact.analyses.motion.printed import printed
from geocontact.analyses.result import REPORT, Result
from geocontact.dynamics.inverse_kinematics import Poses
from geocontact.io.mocap.trc_writer import write_trc
from geocontact.io.opensim.osim_scaler import write_scaled_model
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.opensim.tool_setup_writer import write_ik_setup

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class IkResult(Result):
    """Coordinates of a model over time.

    Parameters
    ----------
    seen
        Model, markers and weights.
    poses
        Coordinates [rad, m] and distances of the markers [m] of every frame.
    cycles
        Coordinates [deg, m] over the gait cycle, where there are heel strikes.
    summary
        Numbers of the whole recording, with units in their names.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"coordinates"})

    options: IkOptions
    seen: KinematicsInputs
    poses: Poses
    cycles: GaitCycles
    summary: dict[str, Any]

    @property
    def rms_mm(self) -> float:
        """Distance of the markers from the model, root mean square over markers and frames [mm]."""
        return float(self.summary["rms_mm"])

    @property
    def markers_mm(self) -> dict[str, dict[str, float]]:
        """Root mean square and largest distance of each marker that was seen [mm]."""
        return dict(self.summary["markers"])

    def tables(self) -> dict[str, pd.DataFrame]:
        """`coordinates` [deg, m], `markers` with the distance of each; `knees` and `cycles` where there are some."""
        p = self.poses
        units = ["deg" if c.kind == "rotational" else "m" for c in self.seen.model.coordinates]
        values = printed(self.seen.model.coordinates, p.values).T
        angles = {f"{name} [{unit}]": v for name, unit, v in zip(p.names, units, values, strict=True)}
        found = {"coordinates": pd.DataFrame({"time [s]": p.time, **angles}), "markers": self._distances()}
        if self.seen.knees:
            found["knees"] = knee_table(self.seen.model, p, self.seen.knees)
        return {**found, "cycles": self.cycles.table()} if self.cycles else found

    def figure(self) -> Figure:
        """Angles of all joints over time, and how far the markers are from the model."""
        angles = self.table("coordinates").filter(like="[deg]")
        return curves_figure(
            self.poses.time, {"angle [deg]": angles, "markers [mm]": self.table("markers").iloc[:, 1:]}
        )

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Coordinates over time, and how far each marker is from the model."""
        title, seen = f"Inverse kinematics of {self.options.markers.name}", self.seen
        return {REPORT: kinematics_page(title, seen.model, self.poses, seen.markers, self.cycles, self.sentences)}

    def write_files(self, folder: Path) -> None:
        """ik.mot for OpenSim, its set-up with the markers as read and ik.json besides; analog.sto if asked for."""
        values = printed(self.seen.model.coordinates, self.poses.values)
        file = folder / "ik.mot"
        write_storage(file, self.poses.time, self.poses.names, values, title="Coordinates", degrees=True)
        self._write_setup(folder)
        if (analog := self.seen.analog) is not None:
            names = [name.replace(" ", "_") for name in analog.channels]
            write_storage(folder / "analog.sto", analog.time, names, analog.values, title="Analog", degrees=False)
        write_json(folder / "ik.json", self.summary)
        super().write_files(folder)

    def _write_setup(self, folder: Path) -> None:
        """With which OpenSim's own tool finds the same."""
        o, seen = self.options, self.seen
        model = str(o.model.absolute())
        if o.marker_set is not None:  # OpenSim's tool takes the model's own markers only
            model = "model.osim"
            write_scaled_model(o.model, folder / model, seen.model, {})
        write_trc(folder / "seen.trc", seen.markers)
        span = float(self.poses.time[0]), float(self.poses.time[-1])
        follow = "" if o.follow is None else str(o.follow.absolute())
        write_ik_setup(folder / "setup_ik.xml", model, "seen.trc", follow, seen.tasks, span, out="opensim_ik.mot")

    def _distances(self) -> pd.DataFrame:
        off = {f"{name} [mm]": 1e3 * d for name, d in zip(self.poses.markers, self.poses.distances.T, strict=True)}
        return pd.DataFrame({"time [s]": self.poses.time, **off})
