"""`geocontact prosthesis calibrate`."""

from __future__ import annotations

from geocontact.analyses.prosthesis.calibrate.options import ProsthesisCalibrateOptions
from geocontact.cli.command import Command

HELP = """Stiffness, damping and friction of five zones of a variable-stiffness foot from one recorded stance.

Writes numbers.csv (value, interval, and whether the stance tells it), stance.csv (plate and model), law.toml (the
calibrated force law, as `geocontact cop` reads it, and how the foot is beside its standing trial), a figure,
report.html and run.json into OUT.
"""

calibrate = Command("geocontact.analyses.prosthesis.calibrate.result:calibrate", ProsthesisCalibrateOptions, HELP)
