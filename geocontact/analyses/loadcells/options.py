"""What the load cells may be asked for."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Excludes, Expression, ForceUnit, Requires
from geocontact.analyses.frame.options import Options
from geocontact.analyses.frame.shared_options import CyclePart, Side
from geocontact.data.errors import InputError
from geocontact.data.plausible import MASS, N, Plausible
from geocontact.data.text import cannot_be_named, same_place

STRIDE, STANCE = "stride", "stance"
FOUND = (STRIDE, STANCE)
"""Cycles that are found in the total force; all others are named by their times."""
GRAVITY = 9.80665  # m/s^2, standard

LEVEL = Plausible("the force at which load sets in", N, (1e-3, 1e5), (1.0, 5000.0))
Cycles = Requires("cycles", "say what a cycle is")


@dataclass(frozen=True)
class LoadcellOptions(Options):
    """Medial and lateral contact force of a tibial tray from its load cells, and their mean over cycles.

    Parameters
    ----------
    recordings
        Table of the cells over time (.csv .mot .sto): time, PM, AM, AL, PL.
    unit
        Unit of the cells' forces, unless each column says it: PM [lbf].
    map
        Columns by cell, where they have other names: PM=posterior_medial,AM=-F2 (a minus turns the sign).
    matrix
        Weights of the cells in the medial and the lateral force (.toml or .csv) instead of the published ones.
    cycles
        stride (onset of load to onset), stance (onset to end of load), 1.7:2.8,2.8:3.9 in seconds, or a table
        style, recording, start [s], end [s].
    events
        Instead of `cycles`: a table side, event, time [s] (heel strike, toe off), with recording and style where there
        are several, or a .c3d of the same clock; cycles from heel strike to heel strike.
    cycle_side
        Side of the tray, where the events are of both.
    part
        Use only this first part of each cycle: 60% is the stance of a gait cycle. stance, with `events`: up to the toe
        off.
    level
        Total force [N] at which the load begins, for stride and stance; a quarter of the largest by default.
    body_mass
        Mass of the subject [kg]: the page then offers forces in per cent of body weight as well.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes forces.csv, loadcells.png, loadcells.svg, report.html and run.json into OUT; with `cycles` also cycles.csv,
    ensemble.csv, ensemble.png, ensemble.svg, and styles.csv where there are several gait styles.
    """

    recordings: tuple[Path, ...]
    _: KW_ONLY
    unit: ForceUnit | None = None
    map: Expression | None = None
    matrix: Path | None = None
    cycles: Expression | None = None
    events: Annotated[Path | None, Excludes("cycles", "says the cycles again", "give one")] = None
    cycle_side: Annotated[Side | None, Requires("events")] = None
    part: Annotated[CyclePart | None, Requires("cycles", "say what a cycle is", alternative="events")] = None
    level: Annotated[float | None, Cycles, LEVEL] = None
    body_mass: Annotated[float | None, MASS] = None

    def refuse_impossible(self) -> None:
        """A level that no cycle needs, sub-folders of one name."""
        if self.level is not None and str(self.cycles).strip() not in FOUND:
            raise InputError("", "`level`", "has no effect here: the cycles are given", "leave it out")
        if self.part == STANCE and self.events is None:
            raise InputError("", "`part`", "stance needs toe offs", "give `events`, or `cycles` stance")
        self._refuse_names()

    @property
    def body_weight(self) -> float | None:
        """Weight of the subject [N]; None where the mass is not given."""
        return None if self.body_mass is None else self.body_mass * GRAVITY

    def _refuse_names(self) -> None:
        if not self.recordings:
            raise InputError("", "`recordings`", "names no file", "give one or several")
        names = [path.stem for path in self.recordings]
        for name in names if len(names) > 1 else []:
            if cannot_be_named(name) or name == same_place(names) or name.lower() == "run.json":
                raise InputError("", "", f"recording {name!r} cannot have a sub-folder of its own", "rename its file")

    @property
    def folders(self) -> dict[Path, str]:
        """Recordings and their sub-folders; none where there is one recording."""
        several = len(self.recordings) > 1
        return {path: path.stem if several else "" for path in self.recordings}
