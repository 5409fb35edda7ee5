"""Generalised forces, what is left over at the ground, and OpenSim's set-up for the same."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.frame.collector import reserve
from geocontact.analyses.motion.inverse_dynamics.loads import Loaded
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.panels import printed
from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.io.opensim.external_loads import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.opensim.tool_setup_writer import write_id_setup


@dataclass(frozen=True)
class Forces:
    """Generalised forces over time.

    Parameters
    ----------
    time
        [s].
    model
        Whose coordinates they are.
    values
        In its order [N m, N].
    peak
        Largest measured net force, the sum of all plates [N]; 0 without any.
    height
        Of the mass centre above the ground's origin, mean over time [m].
    """

    time: Float[np.ndarray, " t"]
    model: Multibody
    values: Float[np.ndarray, "t n"]
    peak: float
    height: float

    @property
    def at_ground(self) -> Bool[np.ndarray, " n"]:
        """Coordinates of joints to the ground that free a body of it, six at one joint."""
        joints = [joint for joint in self.model.joints for _ in joint.coordinates]
        return np.array([joint.parent == GROUND and len(joint.coordinates) == 6 for joint in joints], dtype=bool)

    @property
    def weight(self) -> float:
        """Weight of all bodies [N]."""
        return self.model.mass * float(np.linalg.norm(self.model.gravity))

    @property
    def residual_forces(self) -> Float[np.ndarray, " t"]:
        """Size of the force left over there [N]; 0 where no body is free."""
        return self._left("translational")

    @property
    def residual_moments(self) -> Float[np.ndarray, " t"]:
        """Root of the sum of squares of the moments along the coordinates there [N m]; 0 where no body is free."""
        return self._left("rotational")

    @property
    def residual(self) -> float:
        """Size of the force left over there, root mean square [N]; NaN where no body is free."""
        return float(np.sqrt(np.mean(self.residual_forces**2))) if self.at_ground.any() else float("nan")

    def _left(self, kind: str) -> Float[np.ndarray, " t"]:
        which = np.array([c.kind == kind for c in self.model.coordinates], dtype=bool)
        return np.asarray(np.linalg.norm(self.values[:, self.at_ground & which], axis=1))

    @property
    def names(self) -> tuple[str, ...]:
        """Columns as OpenSim calls them: knee_angle_r_moment, pelvis_tx_force."""
        return tuple(f"{c.name}_{'moment' if c.kind == 'rotational' else 'force'}" for c in self.model.coordinates)


FORCE, MOMENT = 0.05, 0.01
"""Shares of the largest net external force, and of that times the height of the mass centre."""
GOOD, OKAY = 10.0, 25.0
"""N that OpenSim calls good and okay after residual reduction."""


@dataclass(frozen=True)
class Peak:
    """The largest size of a residual, when it is [s], and what it is measured by, in the same unit; 0 for nothing."""

    size: float
    time: float
    whole: float
    allowed: float

    @property
    def share(self) -> float:
        """Share of what it is measured by; NaN where that is nothing."""
        return self.size / self.whole if self.whole > 0.0 else float("nan")

    @property
    def too_large(self) -> bool:
        """Whether it is beyond what is allowed."""
        return self.share > self.allowed


def force_left(forces: Forces) -> Peak:
    """Residual of the force [N], by the largest measured force, or by the weight where nothing was measured."""
    whole = forces.peak if forces.peak > 0.0 else forces.weight
    return _peak(forces, forces.residual_forces, whole, FORCE)


def moment_left(forces: Forces) -> Peak:
    """Residual of the moments along the coordinates [N m], by the largest measured force at the height of the mass
    centre.
    """
    return _peak(forces, forces.residual_moments, forces.peak * forces.height, MOMENT)


def _peak(forces: Forces, sizes: Float[np.ndarray, " t"], whole: float, allowed: float) -> Peak:
    frame = int(np.argmax(sizes))
    return Peak(float(sizes[frame]), float(forces.time[frame]), whole, allowed)


def words(forces: Forces) -> str:
    """What is left over, in one clause; empty where no body is free."""
    if not forces.at_ground.any():
        return ""
    force, moment = force_left(forces), moment_left(forces)
    text = f"left over at the joint to the {GROUND}: {force.size:.3g} N at most, {force.share:.1%} of the"
    if forces.peak == 0.0:
        return f"{text} weight, as nothing but gravity acts"
    return (
        f"{text} largest measured force (below {FORCE:.0%} is asked for), and {moment.size:.3g} N m, "
        f"{moment.share:.1%} of that force at the height of the mass centre (below {MOMENT:.0%})"
    )


def warn_of_residuals(forces: Forces) -> None:
    """One line where more is left over than Hicks et al. allow, or where nothing tells."""
    if not forces.at_ground.any():
        reserve(f"no joint frees a body from the {GROUND} with six coordinates: nothing tells what is left over")
    elif forces.peak == 0.0 and force_left(forces).too_large:
        reserve(
            f"{words(forces)} ({force_left(forces).time:.3g} s): give `loads`, or `plates` with `plate`; moments are "
            "those of a body in the air"
        )
    elif force_left(forces).too_large or moment_left(forces).too_large:
        when = f"at {force_left(forces).time:.3g} and {moment_left(forces).time:.3g} s, limits of Hicks et al. 2015"
        reserve(
            f"{words(forces)}, {when}: check which plate acts on which body, masses, whether plates and markers have "
            "one clock, and `cutoff`"
        )


def verdict(size: float) -> str:
    """What OpenSim calls a largest residual force [N] after residual reduction."""
    return "good" if size <= GOOD else "okay" if size <= OKAY else "bad"


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
