"""The set-up with which OpenSim's own tool finds the same moments, and the files that it names."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_dynamics.read import Loaded
from geocontact.analyses.motion.printed import printed
from geocontact.io.opensim.external_loads_writer import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.opensim.tool_setup_writer import write_id_setup

COORDINATES, LOADS = "coordinates.mot", "loads"


def write_setup(folder: Path, o: IdOptions, given: Loaded) -> None:
    """setup_id.xml; the coordinates without filter; what acts on bodies, about the ground's origin, if anything does.

    Loads are those at the times of the motion: plates in other axes, below the threshold and several on one body are
    as they count here.
    """
    names, values = [c.name for c in given.model.coordinates], printed(given.model.coordinates, given.unfiltered)
    write_storage(folder / COORDINATES, given.recorded, names, values, title="Coordinates", degrees=True)
    write_id_setup(
        folder / "setup_id.xml",
        str(o.model.absolute()),
        COORDINATES,
        _loads(folder, given),
        (float(given.time[0]), float(given.time[-1])),
        cutoff=o.cutoff,
        exclude=o.exclude,
        out="opensim_id.sto",
    )


def _loads(folder: Path, given: Loaded) -> str:
    """Name of the file of external loads; "" where there are none."""
    if not given.loads:
        return ""
    names, columns, bodies = [], [], {}
    for body, wrench in given.loads.items():
        stem = f"{body}_force"
        bodies[stem] = body
        names += [f"{stem}_{kind}{axis}" for kind in "vp" for axis in "xyz"]
        names += [f"{stem.replace('force', 'torque')}_{axis}" for axis in "xyz"]
        there = wrench.moved_to(np.zeros(3))
        columns += [there.force, there.origin, there.moment]
    write_storage(
        folder / f"{LOADS}.mot", given.time, names, np.hstack(columns), title="Loads on bodies", degrees=False
    )
    write_external_loads(folder / f"{LOADS}.xml", f"{LOADS}.mot", bodies, torques=True)
    return f"{LOADS}.xml"
