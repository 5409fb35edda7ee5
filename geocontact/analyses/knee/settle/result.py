"""What a contact equilibrium finds, with its files, figure and page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.contact_loads import write_contact_loads
from geocontact.analyses.finished_page import Thinned
from geocontact.analyses.knee.settle.options import SettleOptions
from geocontact.analyses.knee.settle.page import thinned_page
from geocontact.analyses.knee.settle.settled import SIDES, Settled
from geocontact.analyses.knee.settle.tables import pose_table, settle_table
from geocontact.analyses.pressure_figure import PressureMap, pressure_figure
from geocontact.analyses.result import REPORT, Result
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.loads.settling.energy_balance import EnergyBalance
from geocontact.view.surfaces.pressure_series import PressureSeries, write_pressure_series

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COORDINATES = ("flexion", "adduction", "rotation", "tx", "ty", "tz")
"""Columns of settled.mot, as `area` reads them by the convention of Grood and Suntay."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SettleResult(Result):
    """Contact equilibrium over a motion.

    Parameters
    ----------
    settled
        Every frame.
    balance
        Work of the load and stored energy in the frame with the largest load; None where that was not found.
    """

    options: SettleOptions
    settled: Settled
    balance: EnergyBalance | None

    def tables(self) -> dict[str, pd.DataFrame]:
        """`settle`, a row per frame, and `poses` of those at rest."""
        return {"settle": settle_table(self.settled), "poses": pose_table(self.settled)}

    def figures(self) -> dict[str, Figure]:
        """`settle`: forces and largest pressure over the motion, and the pressures at the largest load."""
        s, k = self.settled, self.settled.heaviest
        pressure = s.face_pressure(k)
        largest = max(float(s.face_pressure(int(j)).max()) for j in s.kept)
        at = PressureMap(s.inputs.fixed.vertices, s.inputs.fixed.faces, pressure, s.centres("total"), k, largest)
        forces = {side: s.forces(side) for side in SIDES}
        return {"settle": pressure_figure(s.inputs.motion.course, forces, s.peaks, at)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Thinned]:
        """Both bodies with pressures, curves and numbers over time."""
        return {REPORT: thinned_page(self.settled, self.sentences)}

    def write_files(self, folder: Path) -> None:
        """settled.mot besides, and what was asked for: loads for OpenSim, a series for ParaView."""
        s = self.settled
        time, poses = s.inputs.motion.time[s.kept], s.poses
        values = np.hstack([np.degrees(s.knee_angles[s.kept]), poses.translation])
        write_storage(folder / "settled.mot", time, COORDINATES, values, title=s.inputs.title, degrees=True)
        if self.options.bodies is not None:
            found = [load for load in s.loads if load is not None]
            loads = {side: [load[side] for load in found] for side in SIDES[:2]}
            write_contact_loads(folder, time, loads, *self.options.bodies)
        if self.options.paraview:
            write_pressure_series(self._series(), folder / "paraview")
        super().write_files(folder)

    def _series(self) -> PressureSeries:
        s = self.settled
        fixed, moving, kept = s.inputs.fixed, s.inputs.bed.moving, s.kept
        return PressureSeries(
            s.inputs.motion.time[kept],
            (fixed.vertices, fixed.faces),
            (moving.vertices, moving.faces),
            s.poses,
            lambda k: s.face_pressure(int(kept[k])),
        )
