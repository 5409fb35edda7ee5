"""Stated probabilities against how often they came true."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.gap.benchmark.outcome import BenchmarkOutcome
from geocontact.gap_benchmark.rates import Rate
from geocontact.gap_benchmark.score import reliability
from geocontact.view.curves.diagnosis.reliability import Stated, reliability_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DRAWN = {"diagnosis": "diagnosis", "regression_aware": "residual regression"}
"""Whose reliability is drawn."""


def stated_figure(outcome: BenchmarkOutcome) -> Figure:
    """Of the diagnosis and of the better opponent."""
    return reliability_figure({words: _stated(outcome, who) for who, words in DRAWN.items()})


def _stated(outcome: BenchmarkOutcome, who: str) -> Stated:
    bins, _ = reliability([(label, outcome.given[who][name]) for name, label in outcome.labels.items()])
    spans = [Rate(round(one.came_true * one.count), one.count).interval() for one in bins]
    return Stated(
        np.array([one.stated for one in bins]),
        np.array([one.came_true for one in bins]),
        np.array([low for low, _ in spans]),
        np.array([high for _, high in spans]),
        [one.count for one in bins],
    )
