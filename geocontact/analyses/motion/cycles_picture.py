"""The gait cycle as a page shows it."""

from __future__ import annotations

from geocontact.analyses.frame.pages import drawing
from geocontact.analyses.motion.gait_cycles import GaitCycles, cycles_figure
from geocontact.view.page.content import Picture, Section


def cycles_pictured(cycles: GaitCycles) -> list[Section]:
    """Mean and SD over the cycles of both sides; nothing without cycles."""
    if not cycles:
        return []
    counts = " and ".join(f"{count} of the {side} side" for side, count in cycles.counts.items())
    words = (
        f"From one heel strike of a side to its next: mean as a line, mean ± SD as a band, {counts}. What has no side "
        f"is cut at the heel strikes of the {next(iter(cycles.starts))} side."
    )
    return [Picture("Over the gait cycle", words, drawing(cycles_figure(cycles)), wide=True)]
