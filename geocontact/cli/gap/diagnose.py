"""`geocontact gap diagnose`."""

from __future__ import annotations

from geocontact.analyses.gap.diagnose.options import ManyOptions
from geocontact.analyses.options import Options
from geocontact.cli.command import Command

HELP = """Diagnose a gap case: which effect the model lacks, where it shows, how far the gap shrinks with it.

Writes diagnosis.json, report.html, gap_map.csv, ranking.csv, held_out.csv, trials.csv where something is named,
figures (.png, .svg) and run.json into OUT. With `many` a case that cannot be used is one line on stderr and exit 2;
the others are diagnosed all the same.
"""


def _job(given: Options) -> str:
    return f"geocontact.analyses.gap.diagnose.{'many:diagnose_many' if given.given('many') else 'result:diagnose'}"


diagnose = Command(_job, ManyOptions, HELP)
