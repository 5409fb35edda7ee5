"""Contact forces between two bodies as external loads for OpenSim."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.io.opensim.external_loads import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.loads.pressure_load import PressureLoad

CONTACT_LOADS = "contact_loads"
"""Name of both files, without ending."""


def write_contact_loads(
    folder: Path,
    time: Float[np.ndarray, " t"],
    loads: Mapping[str, Sequence[PressureLoad]],
    moving_body: str,
    fixed_body: str,
) -> None:
    """contact_loads.mot and .xml: force of each compartment on FIXED at its centre of pressure, and back on MOVING.

    Forces, points and torques are expressed in FIXED's body, so that they hold in any motion of the model. The torque
    is what the pressures turn about their centre; where nothing presses all are 0 at the body's origin.

    Parameters
    ----------
    loads
        Load on FIXED in its body's frame at each time, by compartment.
    moving_body, fixed_body
        Names of the bodies in the model.
    """
    names: list[str] = []
    columns, bodies = [], {}
    for side, over_time in loads.items():
        force = np.array([load.wrench.force for load in over_time])
        moment = np.array([load.wrench.moment for load in over_time])
        centre = np.nan_to_num(np.array([load.centre for load in over_time]))
        torque = moment - np.cross(centre, force)
        for stem, body, sign in ((f"contact_{side}", fixed_body, 1.0), (f"contact_back_{side}", moving_body, -1.0)):
            names += [f"{stem}_force_{kind}{axis}" for kind in "vp" for axis in "xyz"]
            names += [f"{stem}_torque_{axis}" for axis in "xyz"]
            columns += [sign * force, centre, sign * torque]
            bodies[f"{stem}_force"] = body
    data, title = f"{CONTACT_LOADS}.mot", f"Contact forces between {moving_body} and {fixed_body}"
    write_storage(folder / data, time, names, np.hstack(columns), title=title, degrees=False)
    write_external_loads(folder / f"{CONTACT_LOADS}.xml", data, bodies, torques=True, frame=fixed_body)
