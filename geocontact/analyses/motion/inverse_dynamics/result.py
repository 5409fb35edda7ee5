"""Joint moments and forces of a recorded motion: `geocontact id`, `gc.inverse_dynamics`.

>>> import geocontact as gc
>>> result = gc.inverse_dynamics("meshes/leg_swing.mot", model="meshes/leg.osim")
>>> result.sentences[0]
'101 frames; largest at hip_z_moment, 26.8 N m; residual force 264 N at 0.93 s = 117 % of the weight (only
gravity acts)'
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import contradicted, judge, reserve, results, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import plain, write_json
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.motion.gait_cycles import cycles_table
from geocontact.analyses.motion.goodness import goodness_of_loads
from geocontact.analyses.motion.inverse_dynamics.forces import warn_of_residuals, words, write_setup
from geocontact.analyses.motion.inverse_dynamics.loads import Loaded, read, warn_of_other_feet
from geocontact.analyses.motion.inverse_dynamics.muscles import EstimatedMuscles, estimated_muscles, muscle_tables
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_dynamics.show import forces_curves, forces_page
from geocontact.data.multibody.model import PassiveForces
from geocontact.data.wrench import Wrench
from geocontact.dynamics.inverse_dynamics import forces_along
from geocontact.dynamics.residuals import GeneralisedForces, largest_net_force, mean_height
from geocontact.dynamics.tree import tree_of
from geocontact.identify.signals.gait_cycles import GaitCycles, gait_cycles
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.tables import listed
from geocontact.view.curves.drawn import drawn

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class IdResult(Result):
    """Moments and forces along the coordinates of a model.

    Parameters
    ----------
    forces
        Over time [N m, N].
    given
        Model, recording and loads.
    coordinates
        At the same times, filtered [rad, m].
    loads
        Measured ones by body, about the ground's origin.
    cycles
        Moments and forces by mass [N m/kg, N/kg] over the gait cycle, where there are heel strikes.
    summary
        Numbers of the whole motion, with units in their names.
    muscles
        Muscle forces and the contact force of a joint, where they were asked for.
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset({"forces"})

    options: IdOptions
    forces: GeneralisedForces
    given: Loaded
    coordinates: Float[np.ndarray, "t n"]
    loads: Mapping[str, Wrench]
    cycles: GaitCycles
    summary: dict[str, Any]
    muscles: EstimatedMuscles | None = None

    @property
    def time(self) -> Float[np.ndarray, " t"]:
        """Time of the frames [s]."""
        return self.forces.time

    @property
    def moments(self) -> dict[str, Float[np.ndarray, " t"]]:
        """Moment [N m] or force [N] along each coordinate over time, by its name in OpenSim: "knee_angle_r_moment"."""
        return dict(zip(self.forces.names, np.asarray(self.forces.values).T, strict=True))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`forces`: a column for each coordinate, as OpenSim calls it, with its unit; `cycles`, `muscles`, `contact`
        where there are some.
        """
        f = self.forces
        units = ["N m" if name.endswith("_moment") else "N" for name in f.names]
        columns = {f"{n} [{unit}]": v for n, unit, v in zip(f.names, units, np.asarray(f.values).T, strict=True)}
        found = {"forces": pd.DataFrame({"time [s]": f.time, **columns})}
        if self.muscles is not None:
            found |= muscle_tables(self.muscles, f.time)
        return {**found, "cycles": cycles_table(self.cycles)} if self.cycles else found

    def figure(self) -> Figure:
        """Moments and forces over time, without those at the ground."""
        return drawn(forces_curves(self.forces))

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moments and forces over time, and residuals."""
        title = f"Inverse dynamics of {self.options.coordinates.name}"
        return {
            REPORT: forces_page(
                title, self.forces, self.coordinates, self.loads, self.cycles, self.sentences, self.muscles
            ),
        }

    def write_files(self, folder: Path) -> None:
        """id.sto for OpenSim, its set-up and id.json besides."""
        f, title = self.forces, "Inverse Dynamics Generalized Forces"
        write_storage(folder / "id.sto", f.time, f.names, f.values, title=title, degrees=False)
        write_json(folder / "id.json", self.summary)
        write_setup(folder, self.options, self.given)
        super().write_files(folder)


def run(given: Loaded, o: IdOptions) -> IdResult:
    """Forces along all coordinates, and what motion, masses and plates leave over at the ground."""
    tree, passive = tree_of(given.model), given.passive
    found = forces_along(tree, given.recorded, given.values, given.time, given.loads, passive.acting)
    peak, height = largest_net_force(given.loads), mean_height(given.model, given.values)
    forces = GeneralisedForces(given.time, given.model, found, peak, height)
    summary = {**_summary(forces), **_of_the_model(passive)}
    cycles = _cycles(forces, given)
    if cycles:
        summary["gait_cycles"] = cycles.counts
    results().update(plain(summary))
    single = tuple(name for name in o.exclude if name in passive.excluded)
    if single:
        reserve(f"OpenSim leaves out groups of forces only: with setup_id.xml it lets {listed(single)} act")
    misplaced = warn_of_other_feet(given.model, given.shown, given.loads)
    if forces.at_ground.any() and forces.peak > 0.0:
        judge(goodness_of_loads(forces, words(forces), misplaced), warned=True)
    _report(forces)
    muscles = estimated_muscles(given, tree, forces, o)
    return IdResult(
        options=o,
        forces=forces,
        given=given,
        coordinates=given.shown,
        loads=given.loads,
        cycles=cycles,
        summary=summary,
        muscles=muscles,
    )


def _of_the_model(passive: PassiveForces) -> dict[str, object]:
    """Names of passive forces that act and of those left out; a warning for kinds that are not read."""
    if passive.unread:
        names = listed(passive.unread)
        reserve(f"forces of the model of kinds that are not read do not act here, in OpenSim they do: {names}")
    acting = [force.name for force in passive.acting]
    if acting:
        say(f"Passive forces of the model act together with muscles: {listed(tuple(acting))}.")
    return {"passive_forces": acting, "passive_forces_left_out": [*passive.excluded, *passive.unread]}


def _cycles(forces: GeneralisedForces, given: Loaded) -> GaitCycles:
    """Cycles of all but the residuals, by the mass of the model."""
    model = forces.model
    if not model.mass > 0.0:
        return GaitCycles({}, {}, {})
    chosen = np.flatnonzero(~forces.at_ground)
    coordinates = [model.coordinates[k] for k in chosen]
    units = ["N m/kg" if c.kind == "rotational" else "N/kg" for c in coordinates]
    values = np.asarray(forces.values)[:, chosen] / model.mass
    return gait_cycles(forces.time, [c.name for c in coordinates], units, values, given.strikes)


def _summary(forces: GeneralisedForces) -> dict[str, object]:
    """Numbers of the whole motion, as `id.json` holds them."""
    units = ["N_m" if name.endswith("_moment") else "N" for name in forces.names]
    left = {
        name: {f"rms_{unit}": float(np.sqrt(np.mean(column**2))), f"max_{unit}": float(np.abs(column).max())}
        for name, unit, column in zip(forces.names, units, np.asarray(forces.values).T, strict=True)
    }
    return {
        "frames": len(forces.time),
        "peak_external_force_N": forces.peak,
        "residual_force_rms_N": forces.residual,
        "residual_share_of_peak": forces.residual / forces.peak if forces.peak > 0.0 else float("nan"),
        "residual_force_max_N": float(forces.residual_forces.max()),
        "residual_moment_max_N_m": float(forces.residual_moments.max()),
        "mass_centre_height_m": forces.height,
        "residuals": [name for name, there in zip(forces.names, forces.at_ground, strict=True) if there],
        "coordinates": left,
    }


def _report(forces: GeneralisedForces) -> None:
    warn_of_residuals(forces)
    frame, largest = forces.largest(~forces.at_ground)
    name = forces.names[largest]
    unit = "N m" if name.endswith("_moment") else "N"
    said = f"{len(forces.time)} frames"
    if not contradicted():
        said += f"; largest at {name}, {abs(np.asarray(forces.values)[frame, largest]):.4g} {unit}"
    say("; ".join(each for each in (said, words(forces)) if each))


inverse_dynamics = Job("id", IdOptions, read, run)
