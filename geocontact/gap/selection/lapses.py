"""Probabilities as they are stated: some answers are wrong for reasons that no likelihood knows.

The evidence takes the models, the noise and the rules as given. Where one of these is wrong it is sure of what is not
so, and an effect that is too small to be seen leaves no evidence at all. Both happen at a rate that is counted, not
computed, on cases whose truth is known: the lapse rate of an observer (Wichmann & Hill 2001, Perception &
Psychophysics 63: 1293-1313). What is stated is (1 - rate) of what was computed and `rate` of a guess: one half in equal
parts to the effects in question, or to all where none is, the other half in equal parts to every answer there is. The
verdict, its effects and their order stay as they are.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from geocontact.gap.selection.verdict import Answer

NAMED = 0.1  # rate where an effect is named
QUESTIONED = 0.65  # of "no gap" where effects are in question: at home nothing was missing in 6 of 17 such cases
SILENT = 0.3  # of every other answer that names nothing


def with_lapses(said: Answer, offered: Iterable[str]) -> Answer:
    """The answer with its probabilities as they are stated.

    Parameters
    ----------
    said
        Its probabilities are computed from evidence, and sum to 1.
    offered
        Effects that the system has candidates for, each once or more.
    """
    questioned = said.verdict == "no_gap" and bool(said.ambiguity)
    rate = NAMED if said.effects else QUESTIONED if questioned else SILENT
    every = dict.fromkeys(["none", "unknown", *offered, *said.probabilities])
    likely = said.ambiguity or tuple(every)
    blind = {name: 0.5 / len(every) + (0.5 / len(likely) if name in likely else 0.0) for name in every}
    stated = {name: (1.0 - rate) * said.probabilities.get(name, 0.0) + rate * blind[name] for name in every}
    return replace(said, probabilities=dict(sorted(stated.items(), key=lambda each: -each[1])))
