"""`geocontact gap benchmark`."""

from __future__ import annotations

from geocontact.analyses.gap.benchmark.options import BenchmarkOptions
from geocontact.cli.command import Command

HELP = """Diagnose synthetic cases whose effect is known and withheld, and score the answers.

Cases are made by code that shares nothing with the candidates. Writes benchmark.md and benchmark.json (figures with
exact intervals, beside two residual regressions, a constant answer and an oracle), cases.csv, reliability.png,
reliability.svg and run.json into OUT, and prints the table. The default takes an hour and a half on two cores.
"""

benchmark = Command("geocontact.analyses.gap.benchmark.result:benchmark", BenchmarkOptions, HELP)
