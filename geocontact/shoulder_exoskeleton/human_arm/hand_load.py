"""What the hands carry and push against: the tool's weight on one side, the push force on one or both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.shoulder_exoskeleton.arm_motion import Side


@dataclass(frozen=True)
class HandLoad:
    """Load of one hand, at its grip.

    Parameters
    ----------
    mass
        Of the tool, a point that moves with the grip [kg].
    force
        What the hand exerts on the work in an inertial frame [N]; the work exerts the opposite on the hand.
    """

    mass: float
    force: Float[np.ndarray, "t 3"]


@dataclass(frozen=True)
class ToolWork:
    """A tool and how it is pushed.

    Parameters
    ----------
    tool
        Mass [kg], in the dominant hand.
    push
        Force on the work while the tool runs [N].
    direction
        Of the push in the laboratory, of any length.
    dominant_share
        Part of the push that the dominant hand exerts, 0 to 1. The paper gives all to it, as it could not measure the
        split, though both hands push in its task T2 (sec. 5.3).
    """

    tool: float
    push: float
    direction: tuple[float, float, float] = (0.0, 1.0, 0.0)
    dominant_share: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.dominant_share <= 1.0:
            raise ValueError(f"the dominant hand cannot exert {self.dominant_share:.0%} of the push")
        if self.tool < 0.0 or self.push < 0.0:
            raise ValueError("tool and push must not be negative")


def hand_load(work: ToolWork, side: Side, dominant: Side, running: Bool[np.ndarray, " t"]) -> HandLoad:
    """Load of one hand while the tool runs or not, frame by frame."""
    leads = side == dominant
    share = work.dominant_share if leads else 1.0 - work.dominant_share
    direction = np.array(work.direction) / np.linalg.norm(work.direction)
    return HandLoad(work.tool if leads else 0.0, share * work.push * running[:, None] * direction)
