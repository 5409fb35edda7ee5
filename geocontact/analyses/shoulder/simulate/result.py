"""A shoulder exoskeleton along human motion: `geocontact shoulder simulate`, `gc.shoulder.simulate`.

>>> import geocontact as gc
>>> result = gc.shoulder.simulate("meshes/overhead_P1T1S100/markers.trc", level=1.0, side="right")
>>> print(result)
right arm: elevation up to 113.9 deg (shoulder 120.9), supporting force 6.7 … 56.5 N, slip 179 mm
warning: no `person`: the device is adjusted to an upper arm of 300 mm and shoulders 400 mm wide (invented)
warning: T10 is taken to lie straight below Lucy_MC: no span of upright stance was named
warning: lucy: 54 of 63 numbers are invented, see numbers.csv
warning: right arm: passive_1 is at a stop for 66% of the time, first at 0.00 s
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import note, reserve
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.shoulder.simulate.arms import (
    Worn,
    arm_table,
    at_elevation_table,
    lever_table,
    numbers_table,
    read,
    say_reached,
    sensitivity_table,
    simulated_along,
    summary_of,
)
from geocontact.analyses.shoulder.simulate.exports import write_angles, write_external_loads, write_lines, write_plane
from geocontact.analyses.shoulder.simulate.marker_band import ArmBand, band_table, marker_bands
from geocontact.analyses.shoulder.simulate.options import ShoulderSimulateOptions
from geocontact.analyses.shoulder.simulate.person_answers import (
    PersonAnswers,
    person_answers,
    person_curves,
    person_table,
)
from geocontact.analyses.shoulder.simulate.show import arm_curves, simulation_page
from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.device import Device, Wearer
from geocontact.shoulder_exoskeleton.device_frame import DeviceFrame
from geocontact.shoulder_exoskeleton.sensitivity import Influence, influences
from geocontact.shoulder_exoskeleton.working_arm import SimulatedArm

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
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
    person
        What the person carries without and with the device; None where the mass is not stated.
    bands
        Of each arm under errors of its markers, where they were asked for.
    """

    options: ShoulderSimulateOptions
    arms: tuple[SimulatedArm, ...]
    frame: DeviceFrame
    markers: Float[np.ndarray, "t m 3"]
    device: Device
    wearer: Wearer
    influences: Mapping[Side, tuple[Influence, ...]]
    person: PersonAnswers | None = None
    bands: tuple[ArmBand, ...] = ()

    @property
    def time(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Time of the frames by side [s]."""
        return {each.side: each.simulation.motion.time for each in self.arms}

    @property
    def elevation(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Elevation of the upper arm over time by side [rad]."""
        return {each.side: each.simulation.motion.elevation for each in self.arms}

    @property
    def force(self) -> dict[str, Float[np.ndarray, "t 3"]]:
        """Force of the cuff on the arm over time by side, in the frame of the device [N]."""
        return {each.side: each.simulation.outputs["force"] for each in self.arms}

    @property
    def support_torque(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Support torque over time by side [N m]."""
        return {each.side: each.simulation.outputs["support"][:, 0] for each in self.arms}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`right` and `left` over time, `numbers` of the device, `levers` of its cylinder, `sensitivity`,
        `at_elevation`, `person` and `marker_band` where they were asked for.
        """
        told: dict[str, pd.DataFrame] = {each.side: arm_table(each) for each in self.arms}
        told["numbers"] = numbers_table(self.device, controlled=self.options.profile is not None)
        told["levers"] = lever_table(self.device)
        if self.options.elevations is not None:
            told["at_elevation"] = at_elevation_table(self.arms, self.options.elevations)
        if self.influences:
            parts = [sensitivity_table(side, each) for side, each in self.influences.items()]
            told["sensitivity"] = pd.concat(parts, ignore_index=True)
        if self.bands:
            told["marker_band"] = band_table(self.bands)
        if self.person is not None:
            told["person"] = person_table(self.person)
        return told

    def curves(self) -> dict[str, CurveSheet]:
        """`shoulder`: elevations, forces, support and passive joints of the arms over time; `person`: loads and motion
        of the person by what is kept, where the mass is stated.
        """
        found = {"shoulder": arm_curves(self.arms)}
        return found if self.person is None else {**found, "person": person_curves(self.person)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moving arms with the forces in their cuffs, curves, tables."""
        person = None if self.person is None else person_curves(self.person)
        page = simulation_page(
            self.options, self.arms, self.markers, self.wearer, self.tables(), self.sentences, person
        )
        return {REPORT: page}

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


def run(worn: Worn, o: ShoulderSimulateOptions) -> ShoulderSimulateResult:
    """Each arm by itself; they share the device's frame only."""
    invented = sum(number.source == "invented" for number in worn.device.numbers.values())
    reserve(f"{worn.device.name}: {invented} of {len(worn.device.numbers)} numbers are invented, see numbers.csv")
    note(
        "device",
        {
            "name": worn.device.name,
            "peak_force_N": worn.device.peak_force,
            "peak_torque_N_m": worn.device.peak_torque,
        },
    )
    arms = tuple(simulated_along(worn, arm, o) for arm in worn.arms)
    say_reached(arms, o.elevations or ())
    note("arms", plain({each.side: summary_of(each) for each in arms}))
    person, bands = person_answers(worn, arms, o), marker_bands(worn, arms, o)
    found = {
        each.side: tuple(influences(each.simulation.motion, worn.device, worn.wearer, o.level, o.cuff, each.factor))
        for each in (arms if o.sensitivity else ())
    }
    return ShoulderSimulateResult(
        options=o,
        arms=arms,
        frame=worn.frame,
        markers=worn.markers,
        device=worn.device,
        wearer=worn.wearer,
        influences=found,
        person=person,
        bands=bands,
    )


simulate = Job("shoulder simulate", ShoulderSimulateOptions, read, run)
