"""What of a stance is compared with its plate, by the values of the option `score`."""

from __future__ import annotations

from geocontact.below_knee_prosthesis.evaluation import AS_STUDY, OVER_STANCE, Scoring

SCORES: dict[str, Scoring] = {"stance": OVER_STANCE, "study": AS_STUDY}
ROOM = 0.01
"""s that are simulated beyond what is compared of the swing."""
