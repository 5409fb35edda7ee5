"""Published contact areas beside those of a run, and what is said of them."""

from __future__ import annotations

import pandas as pd

from geocontact.analyses.frame.collector import note, say
from geocontact.geometry.contact_area.published import YES, KneeRun, beside_published, published_sentences


def beside_published_areas(run: KneeRun, name: str = "") -> pd.DataFrame:
    """A row for each published area; `name` is that of the motion, among several."""
    table = beside_published(run)
    for line in published_sentences(table):
        say(f"{name}: {line}" if name else line)
    counts = {"published": len(table), "comparable": int((table["comparable"] == YES).sum())}
    note(f"{name} literature".lstrip(), counts)
    return table
