"""What of a stance is compared with its plate, by the values of the option `score`."""

from __future__ import annotations

from geocontact.below_knee_prosthesis.evaluation import AS_STUDY, OVER_STANCE, Scoring

OVER = {"stance": "", "study": " over the stance alone"}
"""What doubts about a fit add to a quantity's name: the fit is tested over the stance, whatever is compared."""
SCORES: dict[str, Scoring] = {"stance": OVER_STANCE, "study": AS_STUDY}
ROOM = 0.01
"""s that are simulated beyond what is compared of the swing."""
