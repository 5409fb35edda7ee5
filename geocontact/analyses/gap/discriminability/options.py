"""What may be asked of the trials of a case."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from typing import ClassVar

from geocontact.analyses.frame.marks import CaseFolder
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError


@dataclass(frozen=True)
class DiscriminabilityOptions(Options):
    """Which effects the trials of a case can detect, from which size on, and which they can separate.

    Parameters
    ----------
    case
        Folder with case.toml and trials, see docs/reference/gap_case.md.
    effects
        Effects asked about, by name ("damping,time_shift") or candidate ("end_stop.upper"); all by default. Mistakes
        in the data have no size: for them, only whether base parameters hide them is reported.
    nats
        Size of each effect in the comparison: the evidence that it would leave in the trials [nats].
    bare
        Write tables, confuse.json and run.json only: no page, no figures.
    run_simulator
        Allow a case of the system "command" to run the program that it names.
    """

    writes: ClassVar[str] = """
    Writes confuse.json, separability.csv, detectability.csv, protocol.md (a sheet for the laboratory: what to record
    next), protocol.csv (its inputs over time) where trials are proposed, report.html, figures (.png, .svg) and run.json
    into OUT.
    """

    case: CaseFolder
    _: KW_ONLY
    effects: str | None = None
    nats: float = 50.0
    bare: bool = False
    run_simulator: bool = False

    def programs(self) -> tuple[str, ...]:
        """The program or the module that the case names."""
        from geocontact.analyses.gap.case import programs_of

        return programs_of(self.case)

    def refuse_impossible(self) -> None:
        """Nothing that is visible."""
        if not 0.0 < self.nats < math.inf:
            raise InputError("", "`nats`", f"is {self.nats:g}", "give a number above 0")
