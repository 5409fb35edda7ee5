"""Two predictors without a model, which stand beside every figure: what they get right, no model can be praised for.

With the pelvis free upwards the impulse of any simulation is nearly body weight times time, and every stance looks like
the next: R² alone says little. Both know the length of the plate's stance, which a simulation has to find.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.evaluation.judged_stance import JudgedStance

MEAN, ANOTHER = "mean of the others", "another setting"
PREDICTORS = (MEAN, ANOTHER)


def trivial_curves(
    stances: Sequence[JudgedStance], one: JudgedStance, quantity: str
) -> dict[str, Float[np.ndarray, " s"]]:
    """Curves of both predictors over the stance; one that there is nothing for is missing.

    Mean of the other trials: of the same person, else of all others. Another setting: the person's first trial on
    another foot.
    """
    others = [each for each in stances if each.name != one.name]
    own = [each for each in others if each.person == one.person]
    found = {}
    if others:
        found[MEAN] = np.mean([each.measured(quantity) for each in own or others], axis=0)
    strange = next((each for each in own if each.setting != one.setting), None)
    if strange is not None:
        found[ANOTHER] = strange.measured(quantity)
    return found
