"""What a simulation finds: tables for each arm, files for OpenSim and ParaView, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.shoulder.simulate.exports import write_angles, write_external_loads, write_lines
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulate.page import simulation_page
from geocontact.analyses.shoulder.simulate.plane_files import write_plane
from geocontact.analyses.shoulder.simulate.simulated_arm import SimulatedArm
from geocontact.analyses.shoulder.simulate.tables import arm_table, numbers_table, sensitivity_table
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.from_markers.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.sensitivity import Influence

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ShoulderSimulateResult(Result):
    """Motion of both arms of an exoskeleton, and the forces in its cuffs.

    Parameters
    ----------
    arms
        Right before left.
    frame
        The device in the laboratory.
    markers
        All that were recorded, in the device's frame [m]; NaN where they were not seen.
    influences
        By side, where they were asked for.
    """

    options: ShoulderSimulateOptions
    arms: tuple[SimulatedArm, ...]
    frame: DeviceFrame
    markers: Float[np.ndarray, "t m 3"]
    device: Device
    wearer: Wearer
    influences: Mapping[Side, tuple[Influence, ...]]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`right` and `left` over time, `numbers` of the device, `sensitivity` where it was asked for."""
        told: dict[str, pd.DataFrame] = {each.side: arm_table(each) for each in self.arms}
        told["numbers"] = numbers_table(self.device)
        if self.influences:
            parts = [sensitivity_table(side, each) for side, each in self.influences.items()]
            told["sensitivity"] = pd.concat(parts, ignore_index=True)
        return told

    def figures(self) -> dict[str, Figure]:
        """`shoulder`: elevations, supporting force and shear of both arms over time."""
        time = self.arms[0].simulation.motion.time
        elevation, force = {}, {}
        for each in self.arms:
            s, side = each.simulation, each.side
            elevation[f"shoulder, {side}"] = np.degrees(s.motion.elevation)
            elevation[f"exoskeleton, {side}"] = np.degrees(s.elevation)
            force[f"supporting, {side}"] = s.supporting
            force[f"shear, {side}"] = s.shear
        panels = {"elevation [deg]": pd.DataFrame(elevation), "interface force [N]": pd.DataFrame(force)}
        return {"shoulder": curves_figure(time, panels)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moving arms with the forces in their cuffs, curves, tables."""
        return {REPORT: simulation_page(self.options, self.arms, self.markers, self.tables(), self.sentences)}

    def write_files(self, folder: Path) -> None:
        """Angles and external loads for OpenSim, lines for ParaView, a case in the plane besides."""
        simulations = [each.simulation for each in self.arms]
        write_angles(folder, simulations)
        write_external_loads(folder, simulations, self.frame)
        write_lines(folder / "paraview", simulations)
        for each in self.arms:
            if each.factor is None:  # the base model's support has a level for the whole trial
                write_plane(folder / "plane", each)
        super().write_files(folder)
