"""What is said of a socket's motion that could not be taken out of its markers."""

from __future__ import annotations

import numpy as np

from geocontact.below_knee_prosthesis.limb_in_socket import LimbInSocket


def counted_twice(limb: LimbInSocket) -> str:
    """What is left of the socket's motion in the leg's angles, where taking it out did not settle."""
    if limb.turns == 0:
        turned = np.degrees(np.abs(limb.stance.found.q[:, 2:5]).max())
        piston = 1e3 * np.abs(limb.stance.pistoning).max()
        return (
            f"the socket's motion, up to {turned:.1f} degrees and {piston:.0f} mm, is counted twice: in the leg's "
            "angles and in the bushing"
        )
    return (
        f"fit and simulated socket do not agree yet: the last of {limb.turns} turns changed the force by "
        f"{limb.change:.1%} of body weight"
    )
