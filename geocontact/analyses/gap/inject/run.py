"""A known effect in somebody's own trials: plants, writes the case, diagnoses it, says whether it was found."""

from __future__ import annotations

import json
import shutil
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

from geocontact.analyses.gap.diagnose.run import add_inputs, diagnosed
from geocontact.analyses.gap.diagnose.words import names, verdict_sentences
from geocontact.analyses.json_file import plain
from geocontact.analyses.progress import stages
from geocontact.analyses.results_folder import written_whole
from geocontact.analyses.run_record import Record
from geocontact.chain.candidate import Candidate
from geocontact.cli.gap_diagnose import DiagnoseOptions
from geocontact.cli.gap_plant import PlantOptions
from geocontact.data.diagnosis import Diagnosis
from geocontact.data.errors import InputError
from geocontact.data.gap_case import GapCase
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.admission import admitted
from geocontact.gap.case.problem import problem_of
from geocontact.gap.inject import Injected, chosen, inject
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.cases.gap_case_writer import write_trials
from geocontact.systems.catalogue import system_of

LEAST = 0.5  # of the size that was asked for, from which a bound of the amplitude deserves a word
IMITATED = 0.05  # times the noise floor that a gap of what base parameters imitate may have


def planted(folder: Path, o: PlantOptions) -> int:
    """Run the whole planting."""
    record = Record("gap plant", {"case": folder, **asdict(o)})
    if not (np.isfinite(o.size) and o.size > 0.0):
        raise InputError("", "--size", f"{o.size:g} is not a gap above 0", "give for example 1")
    if folder.resolve() in (o.out.resolve(), *o.out.resolve().parents):
        raise InputError(o.out, "", "lies inside the case that is copied there", "--out names a folder beside the case")
    with record.catching_warnings(), written_whole(o.out) as draft:
        case = read_gap_case(folder, run_programs=o.run_simulator)
        add_inputs(record, folder, case)
        one, made = _planted(case, o)
        home = draft / "case"
        _copied(folder, home, case, record)
        write_trials(made.case, home)
        (draft / "diagnosis").mkdir()
        own = Record("gap diagnose", {"case": o.out / "case", "out": o.out / "diagnosis", "bare": o.bare})
        options = DiagnoseOptions(out=draft / "diagnosis", bare=o.bare, run_simulator=o.run_simulator)
        with own.catching_warnings(), stages(f"{folder.resolve().name} with {o.effect}") as at:
            found = diagnosed(own, home, draft / "diagnosis", options, at)
        said = _said(one, made, found.diagnosis)
        (draft / "planted.json").write_text(json.dumps(plain(said), indent=2) + "\n", encoding="utf-8")
        record.results["planted"] = said
        record.write(draft)
    _tell(record, one, made, found.diagnosis, o)
    record.say(verdict_sentences(found.diagnosis, found.cells)[0])
    record.say(f"results in {o.out}: case, diagnosis, planted.json")
    record.speak()
    return 0


def _planted(case: GapCase, o: PlantOptions) -> tuple[Candidate, Injected]:
    system = system_of(case)
    with threadpool_limits(limits=1):
        case = admitted(case, system)
        problem = problem_of(case, system)
        try:
            one = chosen(candidates(problem.system), o.effect)
        except ValueError as error:
            raise InputError("", "--effect", str(error), "see docs/reference/gap_effects.md") from error
        trials = _trials(case, one, o)
        return one, inject(case, problem, one, _values(one, o), o.size, trials)


def _values(one: Candidate, o: PlantOptions) -> Mapping[str, float]:
    known = {p.name: p for p in one.parameters}
    found = {}
    for text in o.value:
        name, _, number = text.partition("=")
        if name not in known:
            there = ", ".join(known) or "it has none"
            raise InputError("", "--value", f"{name!r} is no parameter of {one.label}", f"parameters: {there}")
        try:
            found[name] = float(number)
        except ValueError:
            raise InputError("", "--value", f"{number!r} is no number", f"write {name}=1.5") from None
        p = known[name]
        if not p.lower <= found[name] <= p.upper:
            what = f"{name} = {found[name]:g} {p.unit} is outside of {p.lower:.4g} … {p.upper:.4g}"
            raise InputError("", "--value", what, "its bounds are physical")
    return found


def _trials(case: GapCase, one: Candidate, o: PlantOptions) -> frozenset[str] | None:
    if not o.trial:
        return None
    if one.somewhere is None:
        raise InputError("", "--trial", f"{one.label} is in every trial or in none", "leave it out")
    there = [trial.name for trial in (*case.calibration, *case.evaluation)]
    for name in o.trial:
        if name not in there:
            raise InputError("", "--trial", f"there is no trial {name!r}", f"trials are {', '.join(there)}")
    return frozenset(o.trial)


def _copied(folder: Path, home: Path, case: GapCase, record: Record) -> None:
    """The folder of the case; trials are written over."""
    shutil.copytree(folder, home)
    if case.cells:
        record.warn("cells of mats are left as they were: they do not show the effect")


def _said(one: Candidate, made: Injected, d: Diagnosis) -> dict[str, object]:
    return {
        "effect": one.name,
        "variant": one.variant,
        "parameters": {p.name: {"value": made.values[p.name], "unit": p.unit} for p in one.parameters},
        "gap_over_floor": made.size,
        "verdict": d.verdict,
        "effects": list(d.effects),
        "named": one.name in d.effects,
        "among_possible": one.name in d.ambiguity,
        "absorbed": _imitated(one.name, made.size, d.absorbed),
    }


def _imitated(name: str, size: float, absorbed: Sequence[str]) -> bool:
    """Whether base parameters take what was planted: other variants of its name may be absorbed where it is not."""
    return name in absorbed and not size > IMITATED


def _tell(record: Record, one: Candidate, made: Injected, d: Diagnosis, o: PlantOptions) -> None:
    values = ", ".join(f"{p.name} = {made.values[p.name]:.4g} {p.unit}" for p in one.parameters)
    gap = "" if np.isnan(made.size) else f"; it makes a gap of {made.size:.2g} times the noise floor"
    record.say(f"planted {one.label}{f' ({values})' if values else ''}{gap}")
    if made.size < LEAST * o.size and not any(text.startswith(f"{one.parameters[0].name}=") for text in o.value):
        record.warn("the amplitude is as large as its bounds admit; base parameters imitate the rest")
    if one.name in d.effects:
        told = [(p.name, d.parameters[p.name]) for p in one.parameters if p.name in d.parameters]
        sizes = ", ".join(f"{name} = {e.value:.4g} [{e.ci95[0]:.4g}, {e.ci95[1]:.4g}] {e.unit}" for name, e in told)
        record.say(f"found: {names(d.effects)}{f'; {sizes}' if sizes else ''}")
    elif one.name in d.ambiguity:
        record.say(f"among what is possible: {names(d.ambiguity, 'or')}")
    else:
        record.say(f"not found{', base parameters imitate it' if _imitated(one.name, made.size, d.absorbed) else ''}")
