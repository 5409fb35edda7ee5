"""What the areas of several pairs of bodies may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

from geocontact.analyses.frame.marks import Fraction, Lengths, Spelled
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.shared_options import refuse_thresholds
from geocontact.data.errors import InputError
from geocontact.data.plausible import SHARE, THRESHOLD


@dataclass(frozen=True)
class PairsOptions(Options):
    """Contact areas, and pressures where a layer is described, of several pairs of bodies in one motion.

    Parameters
    ----------
    description
        Bodies with their meshes and motions, and the pairs of them (.toml).
    threshold
        Largest distance that counts as contact, such as 4mm, or several: 0.1,0.5,1,4 (mm). 0 counts what is inside the
        other body.
    rule
        How area is counted; the crude rules are for comparing with papers.
    bounds
        Refine until (upper - lower) / upper is below: 0.02 or 2%; 10% by default.
    workers
        Threads; all cores by default. Results do not depend on it.
    """

    over_time: ClassVar[bool] = True
    first_frame: ClassVar[str] = "geocontact.analyses.area.pairs.first_frame"
    writes: ClassVar[str] = """
    Writes totals.csv, pairs.csv, report.html (all bodies together), pairs.png, pairs.svg and run.json into OUT, and for
    each pair a folder with what `area` writes; loads.csv and pair_loads.csv (force and moment on each body, of all
    pairs and of each) where a pair has a layer.
    """

    description: Path
    _: KW_ONLY
    threshold: Annotated[Lengths, Spelled(default="4"), THRESHOLD] = (4e-3,)
    rule: Literal["refined", "clip", "all-vertices", "any-vertex", "centroid"] = "refined"
    bounds: Annotated[Fraction | None, SHARE] = None
    workers: int | None = None

    def refuse_impossible(self) -> None:
        """Numbers that cannot be."""
        if self.workers is not None and self.workers < 1:
            raise InputError("", "`workers`", f"{self.workers} is less than one thread", "give 1 or more")
        refuse_thresholds(self.threshold)


@dataclass(frozen=True)
class SettlePairsOptions(Options):
    """Contact equilibrium of several bodies: those that are free come to rest on the elastic layers of all pairs.

    Parameters
    ----------
    description
        Bodies with their meshes and motions, pairs with layers, and the bodies that are free, each with its force
        (.toml).
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes bodies.csv (coordinates and residual force), contacts.csv (force, moment, pressure of each pair), loads.csv
    (force and moment on each body), poses_BODY.csv (a motion for `geocontact pairs`), a figure, report.html (all bodies
    together) and run.json into OUT.
    """

    description: Path
