"""Checks of a recorded trial, and tests of fit: docs/reference/trial_checks.md, from the tables that they run by."""

from __future__ import annotations

from geocontact.analyses.mat.goodness import LOST, PALPATED
from geocontact.analyses.motion.goodness import SLIDING
from geocontact.analyses.motion.marker_tasks import FAR
from geocontact.analyses.shape.goodness import POOR
from geocontact.gap.levels import LEFT_OVER
from geocontact.identify import goodness_of_fit as fit
from geocontact.trial_checks.table import CHECKS

PAGE = "docs/reference/trial_checks.md"

HEAD = """# What is checked on the way in and out

## On the way in: a trial against itself

Whatever reads markers or plates (`ik`, `id`, `scale`, `joint`, `shoulder`, `prosthesis`, `sit-to-stand`) compares the
inputs of a trial with each other before it computes anything. What cannot be right is refused, exit 2; anything else is
a warning, which names the likely cause. A check is silent where one of its two inputs is not there. Labels of markers
are recognised in the sets of Plug-in Gait, Helen Hayes, Cleveland and OpenSim's models.

| check | compares | speaks from |
|---|---|---|
"""

OUT = f"""
Six real recordings pass without a warning but one: in a `.trc` of a published set two markers of the left foot jump by
43 and 54 mm within one frame, in the file itself. The tests make each check speak, and nearly speak, on a walker in
closed form, and damage the shipped trials in 68 ways, none of which is silent.

`--axes` turns markers and plates alike: forces, moments, points. A table of plates whose forces are upwards before that
turn and not after it is in the model's axes already: it stays as it is, with a warning.

## On the way out: a result against its data

A result that was compared with data says so in `run.json` (`fit`), and in Python as `result.fit_outcome`: `fits`,
`doubtful`, or `contradicts`. With `contradicts` that is the first sentence, the command ends with 1, no parameter is
called known and no interval is written. A doubt is a warning. What is fitted, or simulated beside a recording, has it;
`cohort` and `gap diagnose --many` list it for every trial.

| compares | doubtful | contradicts |
|---|---|---|
| residual r with its noise s | z > {fit.SURE:g}, rms > {fit.LARGER:g} s | z > {fit.SURE:g}, rms > {fit.FAR:g} s |
| a model with the mean of what it describes | | R² < 0 |
| a parameter with the bounds of its search | on one of them | |
| an interval with what is physical | | wholly outside |
| samples outside of what the model describes | any | {fit.MUCH:.0%} or more |
| markers with the model, `ik` and `scale` | beyond what OpenSim advises | rms > {1e3 * FAR:g} mm |
| residual force of `id` | beyond Hicks et al. | > 1/3 of the weight, {fit.MUCH:.0%} of the time |
| load of `id` with the foot under it | | nearer to the other foot |
| joint of one segment with that of the other | rms > {2e3 * SLIDING:g} mm | rms > {1e3 * FAR:g} mm |
| cylinder or sphere with a plane, `fit` | rms > {POOR:.0%} of the radius | the plane is as near |
| what `gap diagnose` names with held-out trials | {LEFT_OVER:.0%} of the squared error stay | {fit.MUCH:.0%} stay |
| landmarks of `mat` | rms > {1e3 * PALPATED:g} mm | rms > {1e3 * LOST:g} mm |

z = (mean r²/s² − 1) / √(2/n (1 + 2 Σρ²)), with ρ the residual's autocorrelation up to its first negative value, which
makes the excess of a slow residual less sure (Bartlett 1946).
"""


def trial_checks() -> str:
    """The whole page."""
    rows = "".join(f"| {check.name} | {check.compares} | {check.limit} |\n" for check in CHECKS)
    return HEAD + rows + OUT
