"""`geocontact gap inject`, also `gap plant`."""

from __future__ import annotations

from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.cli.command import Command

HELP = """Put a known effect into the measured trials of a case, diagnose it, and tell whether it was found.

Writes case/ (the case with the effect in it), diagnosis/ (as `gap diagnose` does), planted.json and run.json into
OUT. What the trials miss already stays in them.
"""

inject = Command("geocontact.analyses.gap.inject.result:inject", InjectOptions, HELP)
