"""What is said of the residuals at the ground, and OpenSim's set-up for the same forces."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import reserve, seen_from_results
from geocontact.analyses.motion.inverse_dynamics.loads import Loaded
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.panels import printed
from geocontact.data.multibody.model import GROUND
from geocontact.dynamics.residuals import FORCE, MOMENT, GeneralisedForces, force_residual, moment_residual
from geocontact.io.opensim.external_loads import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.opensim.tool_setup_writer import write_id_setup


def words(forces: GeneralisedForces) -> str:
    """Residuals, in one clause; empty where no body is free."""
    if not forces.at_ground.any():
        return ""
    force, moment = force_residual(forces), moment_residual(forces)
    text = f"residual force {force.size:.3g} N at {force.time:.3g} s = {share_words(force.share)} of the"
    if forces.peak == 0.0:
        return f"{text} weight (only gravity acts)"
    return (
        f"{text} largest plate force (limit {100.0 * FORCE:g} %); residual moment {moment.size:.3g} N m at "
        f"{moment.time:.3g} s = {share_words(moment.share)} of force × height of the mass centre (limit "
        f"{100.0 * MOMENT:g} %; Hicks 2015)"
    )


def share_words(share: float) -> str:
    """A share in per cent, to what tells it from limits of 5 and 1 %."""
    return f"{100.0 * share:.{0 if share >= 0.1 else 1}f} %"


def warn_of_residuals(forces: GeneralisedForces) -> None:
    """One line where residuals are larger than Hicks et al. allow, or where none can be checked."""
    if not forces.at_ground.any():
        reserve(f"no joint of six coordinates connects a body to the {GROUND}: there is no residual to check")
    elif forces.peak == 0.0 and force_residual(forces).too_large:
        reserve(f"{words(forces)}: give `loads`, or `plates` with `plate`; moments are computed without ground contact")
    elif force_residual(forces).too_large or moment_residual(forces).too_large:
        reserve(
            f"{words(forces)}: check which plate acts on which body, masses, whether plates and markers have "
            "one clock, and `cutoff`"
        )


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
        seen_from_results(o.model),
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
