r"""What trials can tell: `geocontact gap discriminability`, `gc.discriminability`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> from pathlib import Path
>>> Path("case/trials").mkdir(parents=True)
>>> time, noise = 0.04 * np.arange(160), np.random.default_rng(3)
>>> for k in range(1, 6):
...     angle = 0.3 * np.sin((2.0 + 0.4 * k) * time) + 0.08 * np.sin((5.0 + k) * time)
...     torque = 60.0 * angle + 3.0 * np.gradient(angle, time) + noise.normal(0.0, 0.2, 160)
...     trial = pd.DataFrame({"time [s]": time, "angle [rad]": angle, "torque [N m]": torque})
...     trial.to_csv(f"case/trials/t{k}.csv", index=False)
>>> text = 'format = 1\nsystem = "geocontact.systems.elastic_joint:JOINT"\n'
>>> text += 'calibration = ["t1", "t2", "t3"]\nevaluation = ["t4", "t5"]\n[noise]\ntorque = 0.2\n'
>>> text += '[parameters.k]\nstart = 50.0\nlower = 10.0\nupper = 200.0\nunit = "N m/rad"\n'
>>> _ = Path("case/case.toml").write_text(text)
>>> result = gc.discriminability("case", effects="damping,time_shift")
>>> list(result.table("detectability").columns)[:3]
['effect', 'parameter', 'smallest']
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.frame.collector import listener, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import write_json
from geocontact.analyses.frame.result import PARTS, REPORT, Part, Result
from geocontact.analyses.gap.case import CaseWithModel
from geocontact.analyses.gap.discriminability.answer import (
    answer,
    confusion_sentences,
    detectability_table,
    separability_table,
    sizes_sentence,
)
from geocontact.analyses.gap.discriminability.options import DiscriminabilityOptions
from geocontact.analyses.gap.discriminability.protocol import protocol_table, protocol_text
from geocontact.analyses.gap.discriminability.show import confusion_figures, confusion_page
from geocontact.analyses.gap.thinning import read_thinned
from geocontact.chain.system import System
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.gap.identifiability.discriminability import Discriminability, known, offered
from geocontact.gap.identifiability.discriminability import discriminability as compared
from geocontact.io.text.results import CASES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DiscriminabilityResult(Result):
    """Which effects trials would show, from which size on, and which look alike.

    Parameters
    ----------
    case
        Whose trials, SI units.
    found
        Separations of effects, smallest amplitudes, and the diagnosis that noise is known from.
    """

    options: DiscriminabilityOptions
    case: GapCase
    found: Discriminability

    @property
    def title(self) -> str:
        """Heading that names the case."""
        return f"Effects that the trials of {self.case.name} show"

    @property
    def parts(self) -> frozenset[Part]:
        """Tables alone where no more is wanted."""
        return frozenset(("tables",)) if self.options.bare else PARTS

    def units(self, table: str) -> Mapping[str, str]:
        """SI, as in the case."""
        return CASES

    @property
    def smallest(self) -> dict[str, float]:
        """Smallest amplitude of each effect that is seen [SI unit of its parameter]; NaN where none is."""
        found = self.found.detectabilities
        return {one.candidate.label: math.nan if one.smallest is None else one.smallest for one in found}

    @property
    def separation(self) -> dict[tuple[str, str], float]:
        """By how much trials separate an effect from the one that imitates it [nats]."""
        return {(one.true, one.confounder): one.nats for one in self.found.separations}

    def tables(self) -> dict[str, pd.DataFrame]:
        """`separability`: a row per pair of effects; `detectability`: the smallest amplitude of each; `protocol`: the
        inputs of a trial to be recorded next, where one is proposed.
        """
        tables = {"separability": separability_table(self.found), "detectability": detectability_table(self.found)}
        course = protocol_table(self.found)
        return tables if course is None else tables | {"protocol": course}

    def figures(self) -> dict[str, Figure]:
        """`separability`: nats between every two effects; `detectability`: from which size on effects are seen."""
        return confusion_figures(self.found)

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Sentences, matrix, smallest amplitudes."""
        return {REPORT: confusion_page(self.title, self.found)}

    def write_files(self, folder: Path) -> None:
        """Also the answer, and the sheet for the laboratory."""
        super().write_files(folder)
        text = protocol_text(self.case, self.found)
        (folder / "protocol.md").write_text(text, encoding="utf-8", newline="\n")
        write_json(folder / "confuse.json", answer(self.case, self.found, self.options.nats))


@dataclass(frozen=True)
class Question:
    """A case with its base model, and names of effects; none of them for all."""

    given: CaseWithModel
    effects: tuple[str, ...]


def read(o: DiscriminabilityOptions) -> Question:
    """Case, base model and effects."""
    given = read_thinned(o.case, o.run_simulator)
    return Question(given, asked(o.effects, given.system))


def asked(text: str | None, system: System) -> tuple[str, ...]:
    """Names in a list; InputError where the system has no such effect, or none of them has a size to speak of."""
    if text is None:
        return ()
    names = tuple(name.strip() for name in text.split(",") if name.strip())
    every = {name for one in known(system) for name in (one.name, one.label)}
    wrong = [name for name in names if name not in every]
    if wrong or not names:
        effects = ", ".join(dict.fromkeys(one.name for one in known(system)))
        raise InputError("", "`effects`", f"no effect '{wrong[0] if wrong else text}'", f"{system.name} has {effects}")
    if not offered(system, names):
        raise InputError("", "`effects`", f"no size to compare has {' or '.join(names)}", "name an effect beside it")
    return names


def run(question: Question, o: DiscriminabilityOptions) -> DiscriminabilityResult:
    """Every effect on top of the base model, and what is found in words."""
    case, system, names = question.given.case, question.given.system, question.effects
    with listener().stages(o.case.resolve().name) as at:
        found = compared(case, system, names, o.nats, _steps(at, 2 * len(offered(system, names))), at)
    for sentence in (*confusion_sentences(found), sizes_sentence(found)):
        if sentence:
            say(sentence)
    return DiscriminabilityResult(options=o, case=case, found=found)


def _steps(at: Callable[[str], None], count: int) -> Callable[[], None]:
    """Says after each step how many are done."""
    done = itertools.count(1)
    return lambda: at(f"effects, step {next(done)} of {count}")


discriminability = Job("gap confuse", DiscriminabilityOptions, read, run)
