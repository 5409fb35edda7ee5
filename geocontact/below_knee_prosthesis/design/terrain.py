"""Ground that a foot is judged on though the stance was recorded on level ground: a slope, or the edge of a step.

What the person does there is bounded as on another foot. With the angles kept the socket turns in the laboratory as
recorded, so that on a slope the foot meets the ground turned by it; with the torque kept the foot turns until the ankle
has the moment of the recorded foot on level ground. The force that the ground returns is the recorded one: it carries
the same body along the same path.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.below_knee_prosthesis.design.foot_task import FootTask
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Ground, Stairs

FLAT = HalfSpace()
BELOW = 0.17
"""m; from a step down to the one behind: a usual riser, too far for the heel to reach."""


@dataclass(frozen=True)
class Terrain:
    """Ground under one foot.

    Parameters
    ----------
    slope
        By which it rises forwards [rad].
    edge
        Of a step, ahead of the keel's posterior end while the foot stands flat [m]: what is behind hangs in the air.
        None for no step.
    """

    slope: float = 0.0
    edge: float | None = None

    def met(self, task: FootTask) -> FootTask:
        """A stance of level ground in the frame of this one: pitch against it, load along its normal."""
        s, c = np.sin(self.slope), np.cos(self.slope)
        return replace(
            task,
            pitch=task.pitch - self.slope,
            load=c * task.load - s * task.forward,
            forward=c * task.forward + s * task.load,
        )

    @property
    def ground(self) -> Ground:
        """In its own frame, a level tread at y = 0; the keel's posterior end stands at x = 0."""
        return FLAT if self.edge is None else Stairs((self.edge,), (-BELOW, 0.0))

    def standing(self, poses: RigidTransform, held: Float[np.ndarray, " 3"]) -> RigidTransform:
        """Moved along the ground so that a point of the keel stays above where it is while the foot is flat."""
        shift = held[0] - poses.apply(held)[:, 0]
        return RigidTransform.from_translation(np.column_stack([shift, 0.0 * shift, 0.0 * shift])) * poses


LEVEL = Terrain()


def words(terrain: Terrain) -> str:
    """Where the foot is judged; nothing for level ground."""
    told = []
    if terrain.slope:
        told.append(
            f"on ground that {'rises' if terrain.slope > 0.0 else 'falls'} by {np.degrees(abs(terrain.slope)):g}°"
        )
    if terrain.edge is not None:
        told.append(f"on a step whose edge is {1e3 * terrain.edge:.0f} mm ahead of the heel")
    return ", ".join(told)
