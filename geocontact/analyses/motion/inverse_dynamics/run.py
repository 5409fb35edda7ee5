"""Joint moments and forces of a motion under loads."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.json_file import plain
from geocontact.analyses.motion.inverse_dynamics.forces import Forces
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_dynamics.read import Loaded
from geocontact.analyses.motion.inverse_dynamics.result import IdResult
from geocontact.analyses.run_record import Record
from geocontact.data.multibody.model import GROUND
from geocontact.data.wrench import Wrench
from geocontact.dynamics.forces_along import forces_along
from geocontact.dynamics.tree import tree_of


def run(given: Loaded, o: IdOptions, record: Record) -> IdResult:
    """Forces along all coordinates, and what motion, masses and plates leave over at the ground."""
    found = forces_along(tree_of(given.model), given.recorded, given.values, given.time, given.loads)
    forces = Forces(given.time, given.model, found, _peak(given.loads))
    summary = _summary(forces)
    record.results.update(plain(summary))
    _tell(record, forces)
    return IdResult(record=record, options=o, forces=forces, summary=summary)


def _peak(loads: dict[str, Wrench]) -> float:
    return max((float(np.linalg.norm(wrench.force, axis=1).max()) for wrench in loads.values()), default=0.0)


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
        "residuals": [name for name, there in zip(forces.names, forces.at_ground, strict=True) if there],
        "coordinates": left,
    }


def _tell(record: Record, forces: Forces) -> None:
    base = forces.at_ground
    if not base.any():
        record.warn(f"no joint frees a body from the {GROUND} with six coordinates: nothing tells what is left over")
    largest = int(np.argmax(np.abs(np.where(base, 0.0, forces.values)).max(axis=0)))
    said = f"{len(forces.time)} frames; most at {forces.names[largest]}, {np.abs(forces.values[:, largest]).max():.4g}"
    if forces.peak > 0.0 and np.isfinite(forces.residual):
        said += (
            f"; left over at the joint to the {GROUND}: {forces.residual:.3g} N, root mean square, "
            f"{forces.residual / forces.peak:.1%} of the largest measured force"
        )
    record.say(said)
