"""Joint moments and forces of a motion under loads."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.motion.gait_cycles import GaitCycles, gait_cycles
from geocontact.analyses.motion.inverse_dynamics.feet_and_plates import warn_of_other_feet
from geocontact.analyses.motion.inverse_dynamics.forces import Forces
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_dynamics.read import Loaded
from geocontact.analyses.motion.inverse_dynamics.residuals import warn_of_residuals, words
from geocontact.analyses.motion.inverse_dynamics.result import IdResult
from geocontact.analyses.run_record import Record
from geocontact.data.multibody.passive_forces import PassiveForces
from geocontact.data.wrench import Wrench
from geocontact.dynamics.forces_along import forces_along
from geocontact.dynamics.tree import tree_of
from geocontact.io.text.tables import listed


def run(given: Loaded, o: IdOptions, record: Record) -> IdResult:
    """Forces along all coordinates, and what motion, masses and plates leave over at the ground."""
    tree, passive = tree_of(given.model), given.passive
    found = forces_along(tree, given.recorded, given.values, given.time, given.loads, passive.acting)
    forces = Forces(given.time, given.model, found, _peak(given.loads), _height(given))
    summary = {**_summary(forces), **_of_the_model(record, passive)}
    cycles = _cycles(forces, given)
    if cycles:
        summary["gait_cycles"] = cycles.counts
    record.results.update(plain(summary))
    single = tuple(name for name in o.exclude if name in passive.excluded)
    if single:
        record.warn(f"OpenSim leaves out groups of forces only: with setup_id.xml it lets {listed(single)} act")
    warn_of_other_feet(record, given.model, given.shown, given.loads)
    _tell(record, forces)
    return IdResult(
        record=record,
        options=o,
        forces=forces,
        given=given,
        coordinates=given.shown,
        loads=given.loads,
        cycles=cycles,
        summary=summary,
    )


def _of_the_model(record: Record, passive: PassiveForces) -> dict[str, object]:
    """Names of passive forces that act and of those left out; a warning for kinds that are not read."""
    if passive.unread:
        names = listed(passive.unread)
        record.warn(f"forces of the model of kinds that are not read do not act here, in OpenSim they do: {names}")
    acting = [force.name for force in passive.acting]
    if acting:
        record.say(f"Passive forces of the model act beside muscles: {listed(tuple(acting))}.")
    return {"passive_forces": acting, "passive_forces_left_out": [*passive.excluded, *passive.unread]}


def _cycles(forces: Forces, given: Loaded) -> GaitCycles:
    """Of all but what is left over, by the mass of the model."""
    model = forces.model
    if not model.mass > 0.0:
        return GaitCycles({}, {}, {})
    chosen = np.flatnonzero(~forces.at_ground)
    coordinates = [model.coordinates[k] for k in chosen]
    units = ["N m/kg" if c.kind == "rotational" else "N/kg" for c in coordinates]
    values = np.asarray(forces.values)[:, chosen] / model.mass
    return gait_cycles(forces.time, [c.name for c in coordinates], units, values, given.strikes)


def _peak(loads: dict[str, Wrench]) -> float:
    """Of the net force: all loads together."""
    net = sum((wrench.force for wrench in loads.values()), start=np.zeros((1, 3)))
    return float(np.linalg.norm(net, axis=1).max())


def _height(given: Loaded) -> float:
    """Of the mass centre above the ground's origin, mean over the whole recording [m]; 0 without gravity."""
    size = float(np.linalg.norm(given.model.gravity))
    up = -given.model.gravity / size if size > 0.0 else np.zeros(3)
    return float(np.mean(given.model.mass_centre(given.values) @ up))


def _summary(forces: Forces) -> dict[str, object]:
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


def _tell(record: Record, forces: Forces) -> None:
    warn_of_residuals(record, forces)
    sizes = np.abs(np.where(forces.at_ground, 0.0, forces.values))
    frame, largest = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
    name = forces.names[int(largest)]
    unit = "N m" if name.endswith("_moment") else "N"
    said = f"{len(forces.time)} frames; most at {name}, {sizes[frame, largest]:.4g} {unit}"
    record.say("; ".join(each for each in (said, words(forces)) if each))
