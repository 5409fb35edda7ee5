"""`geocontact gap discriminability`, also `gap confuse`."""

from __future__ import annotations

from geocontact.analyses.gap.discriminability.options import DiscriminabilityOptions
from geocontact.cli.command import Command

HELP = """What the trials of a case can tell: which effects they would show, from which size on, and which look alike.

Writes confuse.json, separability.csv, detectability.csv, report.html, figures (.png, .svg) and run.json into OUT.
"""

discriminability = Command(
    "geocontact.analyses.gap.discriminability.result:discriminability", DiscriminabilityOptions, HELP
)
