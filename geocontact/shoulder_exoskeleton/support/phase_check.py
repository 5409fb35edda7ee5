"""How well phases are detected: share of the time in a wrong one, latency of each change, chatter."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.shoulder_exoskeleton.support.phases import LIFT, LOWER, REST

ONSET = 0.1
"""Share of a movement's peak rate at which it begins and ends; 5 and 10 % are usual for reaching movements."""


@dataclass(frozen=True)
class PhaseCheck:
    """Of one detection beside the true phases.

    Parameters
    ----------
    wrong
        Share of the samples in a wrong phase.
    changes, true_changes
        How often the phase changes; more than in truth is chatter.
    latencies
        How late each change is [s]; empty where the order of phases is another one.
    """

    wrong: float
    changes: int
    true_changes: int
    latencies: tuple[float, ...]

    @property
    def chatter(self) -> bool:
        """Whether phases change more often than they do in truth."""
        return self.changes > self.true_changes


def phase_check(
    time: Float[np.ndarray, " t"], detected: Int[np.ndarray, " t"], true: Int[np.ndarray, " t"]
) -> PhaseCheck:
    """Detected beside true phases of the same samples."""
    found, wanted = (np.flatnonzero(np.diff(each)) + 1 for each in (detected, true))
    same = len(found) == len(wanted) and np.array_equal(detected[found], true[wanted])
    late = tuple(float(time[a] - time[b]) for a, b in zip(found, wanted, strict=True)) if same else ()
    return PhaseCheck(float(np.mean(detected != true)), len(found), len(wanted), late)


def phases_by_onset(
    time: Float[np.ndarray, " t"],
    elevation: Float[np.ndarray, " t"],
    planned: Int[np.ndarray, " t"],
    onset: float = ONSET,
) -> Int[np.ndarray, " t"]:
    """Phases whose movements begin and end at a share of their peak rate, within the planned ones.

    Parameters
    ----------
    elevation
        Without noise [rad].
    planned
        Phases as a trial was planned, movements from standstill to standstill.
    onset
        That share.
    """
    rate, found = np.gradient(elevation, time), planned.copy()
    first = np.flatnonzero(planned == LIFT)
    if len(first):
        up = first[: int(np.argmax(np.diff(first, append=len(time) + 1) > 1)) + 1]
        begun = up[np.argmax(rate[up] > onset * rate[up].max())]
        found[up[up < begun]] = REST
    down = np.flatnonzero(planned == LOWER)
    if len(down):
        fast = down[rate[down] < onset * rate[down].min()]
        found[down[down < fast[0]]] = LIFT
        found[down[down > fast[-1]]] = REST
    return found
