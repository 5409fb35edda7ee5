"""`geocontact gap`: where a model misses the measurement, which effect it lacks, how far the gap shrinks with it."""

from __future__ import annotations

from cyclopts import App

gap = App(
    name="gap",
    help="Where a model misses the measurement, which effect it lacks, and how far the gap shrinks with it.",
)
gap.command("geocontact.cli.gap.diagnose:diagnose", name="diagnose")
gap.command("geocontact.cli.gap.discriminability:discriminability", name=("discriminability", "confuse"))
gap.command("geocontact.cli.gap.gather:gather", name="gather")
gap.command("geocontact.cli.gap.inject:inject", name=("inject", "plant"))
gap.command("geocontact.cli.gap.benchmark:benchmark", name="benchmark")
