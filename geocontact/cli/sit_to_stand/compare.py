"""`geocontact sit-to-stand compare`."""

from __future__ import annotations

from geocontact.analyses.sit_to_stand.compare.options import StandingCompareOptions
from geocontact.cli.command import Command

HELP = """Predictions of trials that were not used beside their recordings, and beside predictors without a model.

Writes comparison.csv (mean absolute error, root mean square and R² of every channel of every trial: with all given,
without ground reaction, without torques, by the mean and by the nearest of the calibration's trials), certificate.csv,
numbers.csv and mesh.csv (all that ran), a figure, report.html and run.json into OUT.
"""

compare = Command("geocontact.analyses.sit_to_stand.compare.result:compare", StandingCompareOptions, HELP)
