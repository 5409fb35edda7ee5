"""What is put into measured trials."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import CaseFolder, Spelled, Typed
from geocontact.analyses.frame.options import Options
from geocontact.data.errors import InputError

NamedNumbers = Annotated[
    Mapping[str, float],
    Typed("-", "named_numbers", '{"damping.b": 25.0}', kind=tuple[str, ...]),
    Spelled(default=(), each=True),
]


@dataclass(frozen=True)
class InjectOptions(Options):
    """Put a known effect into the measured trials of a case, diagnose it, and report whether it was found.

    Parameters
    ----------
    case
        Folder with case.toml and trials, see docs/reference/gap_case.md.
    effect
        Name of the vocabulary, with its variant where there are several: damping, sensor_gain.force_x.
    value
        Value of a parameter of the effect, SI unit; may be repeated: damping.b=25.
    size
        Gap that the effect makes where its amplitude is not given, root mean square over the noise floor, after the
        base parameters were refitted.
    trial
        For a mistake in the data: a trial that has it; may be repeated; all of them by default.
    bare
        Write no page and no figures.
    run_simulator
        Allow a case of the system "command" to run the program that it names.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes case/ (the case with the effect in it), diagnosis/ (as `gap diagnose` does), planted.json and run.json into
    OUT. Effects that the model already lacks stay in the trials.
    """

    case: CaseFolder
    _: KW_ONLY
    effect: str
    value: NamedNumbers = field(default_factory=dict)
    size: float = 1.0
    trial: tuple[str, ...] = ()
    bare: bool = False
    run_simulator: bool = False

    def programs(self) -> tuple[str, ...]:
        """The program or the module that the case names."""
        from geocontact.analyses.gap.case import programs_of

        return programs_of(self.case)

    def refuse_impossible(self) -> None:
        """A gap that is none."""
        if not (math.isfinite(self.size) and self.size > 0.0):
            raise InputError("", "`size`", f"{self.size:g} is not a gap above 0", "give for example 1")
