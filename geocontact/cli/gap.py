"""`geocontact gap`: where a model misses the measurement, which effect it lacks, how far the gap shrinks with it."""

from __future__ import annotations

from cyclopts import App

gap = App(
    name="gap",
    help="Where a model misses the measurement, which effect it lacks, and how far the gap shrinks with it.",
)
gap.command("geocontact.cli.gap_diagnose:diagnose", name="diagnose")
gap.command("geocontact.cli.gap_discriminability:discriminability", name=("discriminability", "confuse"))
gap.command("geocontact.cli.gap_gather:gather", name="gather")
gap.command("geocontact.cli.gap_inject:inject", name=("inject", "plant"))
gap.command("geocontact.cli.gap_benchmark:benchmark", name="benchmark")
