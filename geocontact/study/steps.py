"""Steps of a study: what each takes from which other, and how often each is evaluated.

A step is evaluated for each trial, for each combination of the values of some names, or once. `{STEP:FILE}` in its
options is a file of another step: of the same trial, of the evaluation that has the same values, or, in a list, of all
evaluations of that step that have trials in common with it.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from graphlib import CycleError, TopologicalSorter
from pathlib import Path, PurePosixPath
from typing import Any

from geocontact.analyses.frame.options import leads_nowhere
from geocontact.data.errors import InputError
from geocontact.io.documents import Value
from geocontact.study.description import StepSettings, StudyFile
from geocontact.study.trials import CohortTrial, Several, TrialRow, filled, trials_of

TAKEN = re.compile(r"\{([A-Za-z0-9_-]+):([^{}:]+)\}")
"""`{STEP:FILE}`."""
STEP = re.compile(r"\{([A-Za-z0-9_-]+):")
"""The step of it."""
NAMED = 5
"""How many evaluations that are not there are named."""
_Places = dict[Hashable, int]
"""Places of a step's evaluations by what `_key` says of trials."""


@dataclass(frozen=True)
class StepRun:
    """One evaluation of a step.

    Parameters
    ----------
    step
        Name of the step.
    analysis
        As its command is typed.
    trial
        Its name, what it is of, and its options, which hold `{STEP:FILE}`.
    trials
        Numbers of the trials that it is of.
    takes
        Places of the evaluations that it takes from in the list of all, by the name of their step.
    needs
        Files without which it is left out, as paths from the study's folder.
    without
        Evaluations that lack such a file, and whose trials are not among its own therefore.
    """

    step: str
    analysis: str
    trial: CohortTrial
    trials: frozenset[int]
    takes: Mapping[str, tuple[int, ...]]
    needs: tuple[str, ...] = ()
    without: tuple[str, ...] = ()

    def missing(self, home: Path) -> str | None:
        """The first file that it needs and that is not there."""
        return next((each for each in self.needs if leads_nowhere(home / each)), None)

    @property
    def without_words(self) -> str:
        """The first of what it is evaluated without: "without sine of B 1 and 3 more"."""
        more = f" and {len(self.without) - NAMED} more" if len(self.without) > NAMED else ""
        return f"without {', '.join(self.without[:NAMED])}{more}" if self.without else ""


def runs_of(study: StudyFile) -> list[StepRun]:
    """All evaluations of all steps: each after those that it takes from, those of the study's own analysis last."""
    trials = trials_of(study)
    made = {
        name: [_run(study, name, step, *group) for group in _groups(study, name, step, trials)]
        for name, step in study.all_steps.items()
    }
    found: list[StepRun] = []
    places: dict[str, _Places] = {}
    lacking: dict[int, StepRun] = {}
    for name in _in_order(study, made):
        step, own = study.all_steps[name], made[name]
        twice = next((each for each, count in Counter(run.trial.name for run in own).items() if count > 1), None)
        if twice is not None:
            raise InputError(study.path, "", f"two trials are {twice!r}", "name what they differ in, as in {trial}")
        places[name] = {_key(k, step, trials): len(found) + at for at, run in enumerate(own) for k in run.trials}
        for run in own:
            one = _with_what_is_there(study, run, places, trials, lacking)
            if one.missing(study.home) is not None or any(k in lacking for some in one.takes.values() for k in some):
                lacking[len(found)] = one
            found.append(one)
    return found


def _with_what_is_there(
    study: StudyFile,
    run: StepRun,
    places: Mapping[str, _Places],
    trials: Sequence[TrialRow],
    lacking: Mapping[int, StepRun],
) -> StepRun:
    """An evaluation with what it takes, of the trials whose lists lack nothing; of all where a list is empty.

    Trials are left out whole, so that lists of several steps stay side by side.
    """
    whole = replace(run, takes=_takes(study, run, places, trials))
    absent = [lacking[k] for some in whole.takes.values() for k in some if k in lacking]
    rest = sorted(run.trials.difference(*(each.trials for each in absent)))
    there = all(_places_of(study, name, rest, places, trials) for name in whole.takes)
    if not absent or not rest or not there or {each.step for each in absent} & _in_words(run):
        return whole
    less = _run(study, run.step, study.all_steps[run.step], rest, [trials[k] for k in rest])
    less = replace(less, without=tuple(f"{each.step} of {each.trial.name}" for each in absent))
    return replace(less, takes=_takes(study, less, places, trials))


def _in_words(run: StepRun) -> set[str]:
    """Steps that an evaluation takes one file from: `{STEP:FILE}` is no item of a list there."""
    return {
        name
        for value in run.trial.options.values()
        for text in _texts(value)
        if isinstance(value, str) or not TAKEN.fullmatch(text)
        for name in STEP.findall(text)
    }


def taken_by(run: StepRun) -> dict[str, str]:
    """Names of the steps that an evaluation takes from, each with the option that names it."""
    options = run.trial.options.items()
    return {name: option for option, value in options for text in _texts(value) for name in STEP.findall(text)}


def _texts(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, list):
        for each in value:
            yield from _texts(each)


def _place(study: StudyFile, name: str) -> str:
    return "[options]" if name == study.own_name else f"[steps.{name}.options]"


def _in_order(study: StudyFile, made: Mapping[str, Sequence[StepRun]]) -> list[str]:
    """Names of steps, each after those that it takes from, else as they are written, the study's own last."""
    steps = study.all_steps
    before: dict[str, list[str]] = {}
    for name in steps:
        taken = {each: option for run in made[name] for each, option in taken_by(run).items()}
        odd = next((each for each in taken if each not in study.steps), None)
        if odd is not None:
            known = ", ".join(each for each in study.steps if each != name) or "none"
            place = f"{_place(study, name)} {taken[odd]}"
            raise InputError(study.path, place, f"there is no step {odd!r} before it", f"steps are {known}")
        before[name] = list(taken)
    before[study.own_name] = [*study.steps]
    try:
        TopologicalSorter(before).prepare()
    except CycleError as error:
        circle = " → ".join(reversed(error.args[1]))
        raise InputError(study.path, "[steps]", f"{circle} go in a circle", "take from earlier steps only") from error
    found: dict[str, None] = {}

    def visit(name: str) -> None:
        for each in before[name] if name not in found else ():
            visit(each)
        found[name] = None

    for name in steps:
        visit(name)
    return list(found)


def _groups(
    study: StudyFile, name: str, step: StepSettings, trials: Sequence[TrialRow]
) -> list[tuple[Sequence[int], Sequence[TrialRow]]]:
    """Trials of each evaluation of a step, with their numbers."""
    place = "" if name == study.own_name else f"[steps.{name}] "
    for key, names in (("per", step.per or ()), ("where", step.where)):
        odd = next((each for each in names if each not in trials[0].factors), None)
        if odd is not None:
            known = ", ".join(trials[0].factors) or "none"
            raise InputError(study.path, f"{place}{key}", f"no trial has {odd!r}", f"names are {known}")
    groups: dict[Hashable, list[int]] = {}
    for k, trial in enumerate(trials):
        if all(str(trial.factors[each]) in map(str, values) for each, values in step.where.items()):
            groups.setdefault(_key(k, step, trials), []).append(k)
    if not groups:
        raise InputError(study.path, f"{place}where", "no trial has these values", "see [vary], files and table")
    return [(own, [trials[k] for k in own]) for own in groups.values()]


def _run(study: StudyFile, name: str, step: StepSettings, numbers: Sequence[int], group: Sequence[TrialRow]) -> StepRun:
    """An evaluation of trials, with what all of them have in common."""
    given = {each: _shared([trial.given[each] for trial in group]) for each in group[0].given}
    factors = {each: value for each in group[0].factors if not isinstance(value := given[each], Several)}
    own = [trial.options for trial in group] if name == study.own_name else [{}]
    if any(each != own[0] for each in own):
        what = f"{group[0].name} and other trials of one evaluation have different options"
        raise InputError(study.path, "[[trials]]", what, "give them once, in [options]")
    place = _place(study, name)
    options = {key: filled(study, key, value, given, place) for key, value in {**step.options, **own[0]}.items()}
    swept = {} if name != study.own_name else {each: given[each] for each in group[0].swept}
    apart = next((each for each, value in swept.items() if isinstance(value, Several)), None)
    if apart is not None:
        raise InputError(study.path, f"[sweep] {apart}", "differs within one evaluation", f"add {apart!r} to `per`")
    twice = next((each for each in swept if each in options), None)
    if twice is not None:
        raise InputError(study.path, f"[sweep] {twice}", "is in [options] too", "give it once")
    words = [str(value) for each, value in factors.items() if step.per is None or each in step.per]
    title = " ".join(words) or ("all" if step.per is not None else study.path.stem)
    needs = _needs(study, name, step, given)
    return StepRun(
        name, step.analysis, CohortTrial(title, factors, {**options, **swept}), frozenset(numbers), {}, needs
    )


def _needs(study: StudyFile, name: str, step: StepSettings, given: Mapping[str, Value | Several]) -> tuple[str, ...]:
    """Files without which a step is left out; InputError for those of other steps, which are never there before."""
    place = "" if name == study.own_name else f"[steps.{name}]"
    made = next((found[0] for each in step.needs if (found := TAKEN.search(each))), None)
    if made is not None:
        what = f"{made} is made by the study itself"
        raise InputError(
            study.path, f"{place} needs".strip(), what, "name files that are given; what lacks input waits"
        )
    return tuple(str(filled(study, "needs", each, given, place)) for each in step.needs)


def _shared(values: Sequence[Value]) -> Value | Several:
    """A value that all have, or all of them."""
    known = list(dict.fromkeys(values))
    return known[0] if len(known) == 1 else Several(tuple(known))


def _takes(
    study: StudyFile, run: StepRun, places: Mapping[str, _Places], trials: Sequence[TrialRow]
) -> dict[str, tuple[int, ...]]:
    """Evaluations of other steps that an evaluation takes from."""
    found = {}
    for name, option in taken_by(run).items():
        these = _places_of(study, name, run.trials, places, trials)
        if not these:
            place = f"{_place(study, run.step)} {option}"
            raise InputError(study.path, place, f"{name} is not evaluated for {run.trial.name}", "see its `where`")
        found[name] = tuple(sorted(these))
    return found


def _places_of(
    study: StudyFile, name: str, numbers: Iterable[int], places: Mapping[str, _Places], trials: Sequence[TrialRow]
) -> set[int]:
    """Places of a step's evaluations of some trials."""
    found = (places[name].get(_key(k, study.steps[name], trials)) for k in numbers)
    return {k for k in found if k is not None}


def _key(trial: int, step: StepSettings, trials: Sequence[TrialRow]) -> Hashable:
    """What of a trial says to which evaluation of a step it belongs: its number, or the values that that is of."""
    return trial if step.per is None else tuple(str(trials[trial].factors[name]) for name in step.per)


def with_files(run: StepRun, places: Mapping[str, Sequence[str]], study: StudyFile) -> dict[str, Any]:
    """Options with the paths of the files that they take from other steps.

    Parameters
    ----------
    places
        Folders of the results that it takes from, by step, as paths from the study's folder.
    """
    where = _place(study, run.step)

    def value_of(option: str, value: Any) -> Any:
        if isinstance(value, list):
            return [each for item in value for each in in_list(option, item)]
        return text_of(option, value) if isinstance(value, str) else value

    def in_list(option: str, item: Any) -> list[Any]:
        alone = TAKEN.fullmatch(item) if isinstance(item, str) else None
        if alone is None:
            return [value_of(option, item)]
        return [_joined(study, f"{where} {option}", place, alone[2]) for place in places[alone[1]]]

    def text_of(option: str, text: str) -> str:
        for name, _ in TAKEN.findall(text):
            if len(places[name]) > 1:
                what = f"{{{name}:…}} stands for {len(places[name])} files in {run.trial.name}"
                remedy = f'write it in a list, ["{{{name}:…}}"], or choose fewer by `where` of [steps.{name}]'
                raise InputError(study.path, f"{where} {option}", what, remedy)
        return TAKEN.sub(lambda found: _joined(study, f"{where} {option}", places[found[1]][0], found[2]), text)

    return {option: value_of(option, value) for option, value in run.trial.options.items()}


def _joined(study: StudyFile, where: str, place: str, file: str) -> str:
    """Path of a file among results; InputError for one that leads out of them."""
    path = PurePosixPath(file)
    if path.is_absolute() or ".." in path.parts or "\\" in file:
        raise InputError(study.path, where, f"{file!r} leads out of the results of the step", "name a file in them")
    return f"{place}/{path}"
