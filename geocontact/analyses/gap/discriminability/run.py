"""What the trials of a gap case can tell: reads, computes, writes, says it."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from geocontact.analyses.gap.diagnose.run import add_inputs
from geocontact.analyses.gap.discriminability.page import confusion_figures, write_confusion_report
from geocontact.analyses.gap.discriminability.words import confusion_sentences, sizes_sentence
from geocontact.analyses.json_file import plain
from geocontact.analyses.options_table import options_table
from geocontact.analyses.progress import progress
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.chain.system import System
from geocontact.cli.gap_confuse import ConfuseOptions
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.data.version import VERSION
from geocontact.gap.identifiability.detectability import POWER, Detectability
from geocontact.gap.identifiability.discriminability import Discriminability, discriminability, known, offered
from geocontact.gap.identifiability.separability import APART, table
from geocontact.gap.identifiability.signatures import rest_of
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.text.results import write_table
from geocontact.systems.catalogue import system_of
from geocontact.view.curves.save import save
from geocontact.view.page.tables import inputs_table

COMMAND = "gap confuse"


def confused(folder: Path, o: ConfuseOptions) -> int:
    """Run the whole command."""
    if not 0.0 < o.nats < np.inf:
        raise InputError("", "--nats", f"is {o.nats:g}", "give a number above 0")
    record = Record(COMMAND, {"case": folder, **asdict(o)})
    with record.catching_warnings(), written_whole(o.out) as draft:
        case = read_gap_case(folder, run_programs=o.run_simulator)
        system = system_of(case)
        add_inputs(record, folder, case)
        names = asked(o.effects, system)
        with progress("effects", 2 * len(offered(system, names))) as step:
            found = discriminability(case, system, names, o.nats, step)
        sentences = confusion_sentences(found)
        _write(record, case, found, sentences, o, draft)
        record.write(draft)
        written = sorted(file.name for file in draft.iterdir())
    for sentence in [*sentences, sizes_sentence(found)]:
        if sentence:
            record.say(sentence)
    record.say(f"results in {o.out}: {', '.join(written)}")
    record.speak()
    return 0


def asked(text: str | None, system: System) -> tuple[str, ...]:
    """Names in `--effects`; InputError where the system has no such effect, or none of them has a size to speak of."""
    if text is None:
        return ()
    names = tuple(name.strip() for name in text.split(",") if name.strip())
    every = {name for one in known(system) for name in (one.name, one.label)}
    wrong = [name for name in names if name not in every]
    if wrong or not names:
        effects = ", ".join(dict.fromkeys(one.name for one in known(system)))
        raise InputError("", "--effects", f"no effect '{wrong[0] if wrong else text}'", f"{system.name} has {effects}")
    if not offered(system, names):
        raise InputError("", "--effects", f"no size to compare has {' or '.join(names)}", "name an effect beside it")
    return names


def _write(
    record: Record, case: GapCase, found: Discriminability, sentences: list[str], o: ConfuseOptions, folder: Path
) -> None:
    text = json.dumps(plain(answer(case, found, o.nats)), indent=2, ensure_ascii=False, allow_nan=False)
    (folder / "confuse.json").write_text(text + "\n", encoding="utf-8")
    write_table(separability_table(found), folder, parquet=False, name="separability")
    write_table(detectability_table(found), folder, parquet=False, name="detectability")
    if o.bare:
        return
    drawings = {}
    for name, figure in confusion_figures(found).items():
        for ending in ("png", "svg"):
            save(figure, folder / f"{name}.{ending}")
        drawings[name] = (folder / f"{name}.svg").read_bytes()
    tables = [inputs_table(record.inputs), options_table(record)]
    write_confusion_report(folder / "report.html", case.name, found, sentences, drawings, tables, record.warnings)


def answer(case: GapCase, found: Discriminability, nats: float) -> dict[str, Any]:
    """confuse.json, SI units."""
    labels, matrix = table(found.separations)
    said = found.found.answer
    return {
        "case": case.name,
        "system": case.system,
        "verdict": said.verdict,
        "effects": said.effects,
        "visible_nats": nats,
        "power": POWER,
        "apart_nats": APART,
        "absorbed": found.absorbed,
        "mistakes": found.mistakes,
        "classes": found.classes,
        "separability": {
            label: dict(zip(["none", *labels], row, strict=True)) for label, row in zip(labels, matrix, strict=True)
        },
        "detectability": {one.candidate.label: _seen(one) for one in found.detectabilities},
        "next_experiment": None if found.proposal is None else found.proposal.as_dict(),
        "version": VERSION,
    }


def _seen(one: Detectability) -> dict[str, Any]:
    p = one.candidate.parameters[0]
    return {
        "parameter": p.name,
        "smallest": one.smallest,
        "unit": p.unit,
        "rest": rest_of(one.candidate),
        "power": one.power,
        "visible_nats": one.at.visible,
        "absorbed_nats": one.at.absorbed,
    }


def separability_table(found: Discriminability) -> pd.DataFrame:
    """A row per pair: who is there, at which amplitude, who is fitted instead, what that leaves, how it was found."""
    own = {one.candidate.label: one for one in found.effects}
    rows = [
        {
            "effect": each.true,
            "parameter": own[each.true].candidate.parameters[0].name,
            "amplitude": own[each.true].amplitude,
            "unit": own[each.true].candidate.parameters[0].unit,
            "visible [nats]": own[each.true].visible,
            "imitator": each.confounder,
            "separation [nats]": each.nats,
            "way": each.way,
        }
        for each in found.separations
    ]
    return pd.DataFrame(rows)


def detectability_table(found: Discriminability) -> pd.DataFrame:
    """A row per effect: the smallest amplitude that is seen, empty where none is, and what is visible of it there."""
    rows = [
        {
            "effect": one.candidate.label,
            "parameter": one.candidate.parameters[0].name,
            "smallest": np.nan if one.smallest is None else one.smallest,
            "unit": one.candidate.parameters[0].unit,
            "power [-]": one.power,
            "visible [nats]": one.at.visible,
            "absorbed [nats]": one.at.absorbed,
        }
        for one in found.detectabilities
    ]
    return pd.DataFrame(rows)
