"""Two predictors without a model, which stand beside every figure: what they get right, no model can be praised for.

With the pelvis free upwards the impulse of any simulation is nearly body weight times time, and every stance looks like
the next: R² alone says little. Both know the length of the plate's stance, which a simulation has to find.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

MEAN, ANOTHER = "mean of the others", "another setting"


@dataclass(frozen=True, eq=False)
class MeasuredCurve:
    """One quantity over a stance as the plate saw it, and whose it is on which setting of the foot."""

    name: str
    person: str
    setting: str
    values: Float[np.ndarray, " s"]


def trivial_curves(measured: Sequence[MeasuredCurve], one: MeasuredCurve) -> dict[str, Float[np.ndarray, " s"]]:
    """Curves of both predictors for one of the stances; one that there is nothing for is missing.

    Mean of the other trials: of the same person, else of all others. Another setting: the person's first trial on
    another foot.
    """
    others = [each for each in measured if each.name != one.name]
    own = [each for each in others if each.person == one.person]
    found = {}
    if others:
        found[MEAN] = np.mean([each.values for each in own or others], axis=0)
    strange = next((each for each in own if each.setting != one.setting), None)
    if strange is not None:
        found[ANOTHER] = strange.values
    return found
