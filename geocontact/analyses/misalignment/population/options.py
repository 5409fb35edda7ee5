"""What a population may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.options import Options
from geocontact.analyses.misalignment.shared_options import (
    Angles,
    Drift,
    Stroke,
    require_at_least_0,
    require_drift,
    require_span,
    require_stroke,
    require_within,
)
from geocontact.data.plausible import LIMIT

SAMPLES = 100, 20_000_000
"""Fewest and most people."""


@dataclass(frozen=True)
class PopulationOptions(Options):
    """Distribution of the largest force over people whose offsets and attachment differ.

    Parameters
    ----------
    description
        A .toml with [k], [l], [z], [x] and [y], each a value, a normal or a uniform distribution with its unit, or a
        table of people; correlations in [correlation].
    range
        Angles of the exoskeleton, with their unit: 0:120deg.
    limit
        |F| [N] whose probability of exceedance is computed.
    stroke
        Ends between which a compensation joint slides freely: -20:35. Locked by default.
    drift
        How the joint's axis moves with the angle, as for a design; the same for everybody.
    samples
        People that are drawn.
    seed
        Seed of the draw.
    keep
        Also write samples.csv: the quantities, the force and the state of every one.
    """

    writes: ClassVar[str] = """
    Writes population.json, quantiles.csv, exceedance.csv, influence.csv, population.png, population.svg, report.html
    and run.json into OUT. All samples are synthetic: drawn, not measured.
    """

    description: Path
    _: KW_ONLY
    range: Angles
    limit: Annotated[float, LIMIT]
    stroke: Stroke | None = None
    drift: Drift | None = None
    samples: int = 1_000_000
    seed: int = 1
    keep: bool = False

    def refuse_impossible(self) -> None:
        """Too few or too many people, angles that are no range."""
        require_within(self.samples, "`samples`", SAMPLES, 1_000_000)
        require_at_least_0(self.seed, "`seed`")
        require_span(self.range)
        require_stroke(self.stroke)
        require_drift(self.drift)
