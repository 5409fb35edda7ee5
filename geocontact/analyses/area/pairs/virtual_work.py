"""Virtual work of all forces at rest: the forces that pressure makes against those that were applied.

The equilibrium is where the energy of the layers is least; the loads that are written are the sum of pressure times
area over each layer. The two are one in the limit of small pieces. Where a free coordinate grows by a little, the
applied forces work by F . dx, springs take k off dx, and the contacts work by the sum over all bodies of f . v + m . w,
with their force f and moment m about the origin and the body's velocities v of that point and w. At rest the sum is
nothing (principle of virtual work; Lanczos, The variational principles of mechanics, ch. III). Velocities are central
differences of the poses; turns count over 20 mm, as residual forces do.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.analyses.area.pairs.equilibrium import RestingBodies
from geocontact.loads.settling import scales
from geocontact.loads.settling_bodies import Assembly

STEP = 1e-5
"""m, and turns of as much over 20 mm, to both sides: velocities are exact to 1e-7 of themselves."""


def imbalance(r: RestingBodies) -> Float[np.ndarray, " t"]:
    """Largest sum of works over the displacement, in parts of what the body bears; not a number without rest.

    A body that bears less than the smallest applied force is measured by that, of the frame or else of the motion;
    nothing works on one whose sum is nothing.
    """
    found = np.full(len(r.frames), np.nan)
    least = min(load for frame in r.frames if (load := frame.assembly.load) > 0.0)
    for k in r.kept:
        frame = r.frames[k]
        loads = {name: rows[k] for name, rows in r.loads.items()}
        left = np.abs(_forces(frame.assembly, frame.rest.total.values, loads)).reshape(-1, 6).max(axis=1)
        size = np.maximum(frame.assembly.borne(frame.rest.total), frame.assembly.load or least)
        found[k] = float((left / size).max())
    return found


def _forces(
    assembly: Assembly, values: Float[np.ndarray, " n"], loads: dict[str, Float[np.ndarray, " 6"]]
) -> Float[np.ndarray, " n"]:
    """Generalised forces of contacts, applied forces and springs along the free coordinates, turns over 20 mm [N]."""
    steps, off = STEP * scales(len(values)), values - assembly.recorded
    found = np.zeros(len(values))
    for j in np.flatnonzero(assembly.free):
        body = list(assembly.bodies)[j // 6]
        one, step = assembly.bodies[body], np.zeros(len(values))
        step[j] = steps[j]
        after, before = (assembly.placed(values + sign * step)[body] for sign in (1.0, -1.0))
        twist = _moved(before, after) / (2.0 * STEP)
        point = (after.apply(one.point) - before.apply(one.point)) / (2.0 * STEP)
        applied = assembly.axes[body].rotation.apply(one.force)
        spring = one.springs[j % 6] * off[j] * scales(len(values))[j]
        found[j] = float(loads[body] @ twist) + float(applied @ point) - spring
    return found


def _moved(before: RigidTransform, after: RigidTransform) -> Float[np.ndarray, " 6"]:
    """Displacement of the point of a body that is at the origin, and its turn."""
    by = after * before.inv()
    return np.concatenate([by.translation, by.rotation.as_rotvec()])
