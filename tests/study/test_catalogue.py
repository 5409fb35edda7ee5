"""The one list of analyses: what is made from it is there, and nothing that is there is missing in it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from cyclopts import App

import geocontact
from geocontact.analyses.catalogue import ENTRIES, GROUPS, HOME, Entry, entry_of, job_named, names_of_room
from geocontact.analyses.frame.job import Job
from geocontact.cli.command import Command
from geocontact.cli.main import OWN, app
from geocontact.cli.suggestions import commands
from geocontact.data.errors import InputError

FRAME = "frame"
PACKAGE = Path(geocontact.__file__).parent
TYPED = [each for each in ENTRIES if each.command]


def analyses(of: App, words: tuple[str, ...] = ()) -> Iterator[tuple[str, Command]]:
    for name in commands(of):
        found = of[name].default_command
        if isinstance(found, Command):
            yield " ".join((*words, name)), found
        yield from analyses(of[name], (*words, name))


def test_the_command_line_has_its_analyses_by_both_names() -> None:
    names = {each.command for each in TYPED}
    former = {f"{each.command.rpartition(' ')[0]} {each.also}" for each in TYPED if each.also}
    assert {name for name, _ in analyses(app)} == names | former
    assert set(commands(app)) == set(OWN) | {name.partition(" ")[0] for name in names}
    assert commands(app) == sorted(commands(app)) and len(names) == len(TYPED)


def test_every_folder_with_options_is_in_it() -> None:
    folders = {file.parent.relative_to(PACKAGE / "analyses") for file in (PACKAGE / "analyses").rglob("options.py")}
    listed = {each.package for each in ENTRIES if each.package.startswith(HOME)}
    assert {
        f"{HOME}.{'.'.join(folder.parts)}" for folder in folders if folder.parts and folder.parts[0] != FRAME
    } == listed


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda each: each.command or each.name)
def test_its_places_hold_what_they_should(entry: Entry) -> None:
    options, job = entry.load_options(), entry.load_job()
    assert isinstance(job, Job) and issubclass(options, job.options)
    former = f"{entry.command.rpartition(' ')[0]} {entry.also}"
    assert job.command in (entry.command or "area", former if entry.also else entry.command)
    if entry.command:
        assert options.writes.strip().startswith(("Writes", "Cases", "For the elbow")), "what its files are"
    if entry.many:
        assert entry.load_job(many=True).options is options


def test_a_command_runs_the_job_of_its_options(tmp_path: Path) -> None:
    (tmp_path / "case.toml").touch()
    command = dict(analyses(app))["gap diagnose"]
    one, many = (command.job(command.options(tmp_path, many=many)) for many in (False, True))
    assert (one, many) == tuple(entry_of("gap diagnose").load_job(many=many) for many in (False, True))
    assert one is not many


def test_python_has_its_names() -> None:
    assert set(names_of_room("")) <= set(geocontact.__all__)
    for group in GROUPS:
        if group.room:
            room = getattr(geocontact, group.room)
            assert room.__all__ == names_of_room(group.room) and set(room.__all__) <= set(dir(room))
    assert "benchmark" not in geocontact.__all__


def test_a_study_can_be_of_every_analysis_but_of_a_study() -> None:
    assert job_named("gap diagnose").command == "gap diagnose" and job_named("cop").command == "cop"
    with pytest.raises(InputError, match="there is no analysis 'cohort'"):
        job_named("cohort")


def test_a_study_can_be_of_an_analysis_of_ones_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = "from geocontact.analyses.catalogue import job_named\nown = job_named('cop')\nnone = 3\n"
    (tmp_path / "own_analysis.py").write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(str(tmp_path))
    assert job_named("own_analysis:own") is job_named("cop")
    with pytest.raises(InputError, match=r"'own_analysis:none' is a int; name a geocontact.analyses.frame.job.Job"):
        job_named("own_analysis:none")


def test_a_name_that_is_none_gets_the_nearest() -> None:
    with pytest.raises(InputError, match="there is no analysis 'aera'; did you mean 'area'"):
        job_named("aera")
    with pytest.raises(InputError, match="no analysis 'zzz'; there are area, cop, elbow compare, elbow design"):
        job_named("zzz")
    with pytest.raises(InputError, match=r"no analysis at 'no.module:job' \(ModuleNotFoundError"):
        job_named("no.module:job")
