"""Trunk and head of the wearer in the device's frame: drawn to see where the person is, and used for nothing else."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int

from geocontact.shoulder_exoskeleton.device import Wearer
from geocontact.view.page.scene import Linkage

THICK = 0.10
"""Diameter of the rods that the trunk is drawn with [m]."""
RODS = 14
TOP, BOTTOM = (0.60, 0.045), (0.50, 0.035)
"""Half of the trunk between the rods' axes at the shoulders and at the hips: across, as a share of half the distance of
the shoulders, and from front to back [m]."""
NECK, HEAD = 0.40, 0.20
"""Height of the head's middle above the shoulders, and radius of the head, over the height of the shoulders above the
hips."""
DRAWN = "drawn only"


def wearer_body(wearer: Wearer, shoulder: Float[np.ndarray, " 3"]) -> list[Linkage]:
    """Trunk and head of a wearer whose shoulder is there, x to the left, y backwards, z up [m]; the same in all frames.

    The trunk is as long as `wearer.torso`, between shoulders as far apart as the one is from the middle.
    """
    half, depth, height = abs(float(shoulder[0])), float(shoulder[1]), float(shoulder[2])
    hips = height - wearer.torso
    around = np.linspace(0.0, 2.0 * np.pi, RODS, endpoint=False)
    rings = [
        np.column_stack([share * half * np.cos(around), depth + deep * np.sin(around), np.full(RODS, level)])
        for (share, deep), level in ((TOP, height - 0.5 * THICK), (BOTTOM, hips + 0.5 * THICK))
    ]
    neck, head = np.array([0.0, depth, height]), np.array([0.0, depth, height + NECK * wearer.torso])
    yoke = np.array([[-0.9 * half, depth, height - 0.5 * THICK], [0.9 * half, depth, height - 0.5 * THICK]])
    trunk = np.concatenate([*rings, yoke, [neck, head]])[None]
    lines: Int[np.ndarray, "k 2"] = np.array(
        [*((k, RODS + k) for k in range(RODS)), (2 * RODS, 2 * RODS + 1), (2 * RODS + 2, 2 * RODS + 3)], np.int64
    )
    return [
        Linkage(f"trunk ({DRAWN})", trunk, lines, "floor", 0.5 * THICK, THICK),
        Linkage(f"head ({DRAWN})", head[None, None], np.zeros((0, 2), np.int64), "floor", HEAD * wearer.torso, 0.0),
    ]
