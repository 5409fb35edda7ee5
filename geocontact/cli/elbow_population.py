"""`geocontact elbow population`: the options of the command; the work is in `elbow_population_analysis`."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

Dashed = Parameter(allow_leading_hyphen=True)
Flag = Parameter(negative="")


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class PopulationOptions:
    """Options of a population as typed.

    Parameters
    ----------
    range
        Angles of the exoskeleton, with their unit: 0:120deg.
    limit
        |F| [N] whose exceeding is asked for.
    out
        Folder for the results.
    stroke_mm
        Ends between which a compensation joint slides freely: -20:35. Locked unless given.
    drift
        How the joint's axis wanders with the angle, as for `elbow design`; the same for everybody.
    samples
        People that are drawn.
    seed
        Of the draw.
    keep
        Also write samples.csv: the quantities, the force and the state of every one.
    parquet
        Also write the tables as .parquet.
    """

    range: Annotated[str, Dashed]
    limit: float
    out: Path
    stroke_mm: Annotated[str | None, Dashed] = None
    drift: Annotated[str | None, Dashed] = None
    samples: int = 1_000_000
    seed: int = 1
    keep: Annotated[bool, Flag] = False
    parquet: Annotated[bool, Flag] = False


def population(description: Path, /, *, options: PopulationOptions) -> int:
    """Distribution of the largest force over people whose offsets and attachment differ.

    Writes population.json, quantiles.csv, exceedance.csv, influence.csv, population.png, population.svg, report.html
    and run.json into OUT. All samples are synthetic: drawn, not measured.

    Parameters
    ----------
    description
        A .toml with [k], [l], [z], [x] and [y], each a value, a normal or a uniform distribution with its unit, or a
        table of people; correlations in [correlation].
    """
    from geocontact.analyses.misalignment.population.run import analyse  # numpy and friends: not for --help

    return analyse(description, options)
