"""The case whose trials are asked about, and the effects that are asked about."""

from __future__ import annotations

from dataclasses import dataclass

from geocontact.analyses.gap.case_with_model import CaseWithModel, read_case
from geocontact.analyses.gap.discriminability.options import DiscriminabilityOptions
from geocontact.analyses.run_record import Record
from geocontact.chain.system import System
from geocontact.data.errors import InputError
from geocontact.gap.identifiability.discriminability import known, offered


@dataclass(frozen=True)
class Question:
    """A case with its base model, and names of effects; none of them for all."""

    given: CaseWithModel
    effects: tuple[str, ...]


def read(o: DiscriminabilityOptions, record: Record) -> Question:
    """Case, base model and effects."""
    given = read_case(o.case, o.run_simulator, record)
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
