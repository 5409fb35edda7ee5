"""Which simulator and which recordings a case begins with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from pathlib import Path
from typing import Annotated, ClassVar

from geocontact.analyses.frame.marks import Missing, Spelled, Texts, Typed
from geocontact.analyses.frame.options import Options

NamedStarts = Annotated[
    Mapping[str, float],
    Typed("-", "named_numbers", '{"k": 100.0}', kind=tuple[str, ...]),
    Spelled(default=(), each=True),
]
Recordings = Annotated[Path, Missing("there is no such folder", "name the folder that holds a .csv file per trial")]

QUESTIONS = "open questions"
"""Key of the questions of a begun case among its settings; none of case.toml has it without quotes."""


@dataclass(frozen=True)
class InitOptions(Options):
    """Begin a gap case: your simulator, your recordings, and the questions that remain.

    The simulator is called once on every trial; the page shows measured beside simulated curves.

    Parameters
    ----------
    simulator
        A Python file with `run(time, inputs, numbers)` or a `gc.simulator_base`, "mine.py:NAME" where it has several;
        an .fmu file; the command of a program that simulates one trial, "prog {params} {trial} {out}"; or elbow, foot,
        shoulder, knee or sit_to_stand, models of this package. It is run.
        PARAMETERS, a tuple of `gc.Parameter` in the Python file, are written into case.toml.
    data
        Folder with a .csv file per trial: time, inputs and outputs, units in the header.
    outputs
        Columns that the simulator predicts, "torque,force"; those in N, N m or Pa by default, where it does not say.
    inputs
        Columns that drive it, in the order of the rows that `run` gets; all others by default.
    number
        Start value of a number that the simulator needs, SI unit; may be repeated: k=100. After the name of a trial
        it is that trial's own: t01.level=0.5.
    acts_on
        Input that the law of a `run(time, inputs, numbers, law)` acts on; the only input by default.
    table
        Table that a model needs: spheres=spheres.csv of the foot, support=support.csv of the shoulder; may be repeated.
    """

    over_time: ClassVar[bool] = True
    writes: ClassVar[str] = """
    Writes case.toml with its open questions as comments, trials/<id>.csv, first_run.csv (measured and simulated), an
    adapter <name>_adapter.py where the simulator needs one, report.html and run.json into OUT. What cannot be known is
    "?" there, and `geocontact gap diagnose OUT` refuses the case until it is answered. <table>.csv is a copy in SI.
    """
    folder_help: ClassVar[str] = "Folder for the case."
    last_line: ClassVar[str] = (
        "next: answer the questions in {out}/case.toml, then geocontact gap diagnose {out} `out` …"
    )

    _: KW_ONLY
    simulator: str
    data: Recordings
    outputs: str | None = None
    inputs: str | None = None
    number: NamedStarts = field(default_factory=dict)
    acts_on: str | None = None
    table: Texts = ()
