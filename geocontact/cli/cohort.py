"""`geocontact cohort`."""

from __future__ import annotations

from geocontact.cli.command import Command
from geocontact.study.options import CohortOptions

HELP = """One analysis of many subjects, trials, conditions and settings, on this machine or a cluster.

Writes results/… (a folder for each trial), trials.csv (what became of each), tables/… (the tables of all trials as
.parquet and .nc), report.html and run.json into OUT. It can be interrupted and run again at any time: only what is
missing is evaluated, and the tables are the same. A trial that cannot be evaluated is one line, the others go on.
"""

cohort = Command("geocontact.study.result:cohort", CohortOptions, HELP)
