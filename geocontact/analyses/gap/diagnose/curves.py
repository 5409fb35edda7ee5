"""Held-out trials as a diagnosis saw them: measured, predicted by the base model, and with what was named."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.gap.diagnose import Findings
from geocontact.gap.reduction.raw_input_errors import raw_input_errors


@dataclass(frozen=True, eq=False)
class HeldOut:
    """One held-out trial, SI units; NaN where nothing was measured.

    Parameters
    ----------
    name
        Of the trial.
    time
        Of each sample [s].
    measured, base
        As recorded, and as the base model, refitted to the calibration trials, predicts it.
    named
        With the effects of the answer, or of the most probable candidate where there are too many; None without.
    """

    name: str
    time: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, "t c"]
    base: Float[np.ndarray, "t c"]
    named: Float[np.ndarray, "t c"] | None

    @property
    def phase(self) -> Float[np.ndarray, " t"]:
        """Time as a fraction of the trial."""
        return np.asarray((self.time - self.time[0]) / (self.time[-1] - self.time[0]))


def held_out(findings: Findings) -> tuple[HeldOut, ...]:
    """Every held-out trial, with the predictions that the errors of the diagnosis are of."""
    found = findings.attribution
    named = bool(findings.diagnosis.effects) or findings.diagnosis.verdict == "unresolved"
    residuals = raw_input_errors(found.problem, found.clean, found.answer.chosen.judged, found.data_error)
    first = len(found.problem.calibration.trials)
    trials = []
    for k in range(first, len(found.problem.recorded.trials)):
        trial, measured = found.problem.recorded.trials[k], found.problem.recorded.outputs[k]
        there = np.isfinite(measured)
        base, after = (np.where(there, measured - part[k], np.nan) for part in (residuals.before, residuals.after))
        trials.append(HeldOut(trial.name, trial.time, measured, base, after if named else None))
    return tuple(sorted(trials, key=lambda trial: trial.name))


def resampled(
    trial: HeldOut, values: Float[np.ndarray, "t c"], phase: Float[np.ndarray, " p"]
) -> Float[np.ndarray, "p c"]:
    """Columns of a trial at other phases, by linear interpolation; NaN next to what is not there."""
    return np.stack([np.interp(phase, trial.phase, column) for column in values.T], axis=1)
