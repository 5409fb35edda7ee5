"""Every command that is an analysis can be that of a study."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from cyclopts import App

from geocontact.analyses.catalogue import PLACES, job_named
from geocontact.cli.command import Command
from geocontact.cli.main import app
from geocontact.cli.suggestions import commands
from geocontact.data.errors import InputError


def analyses(of: App, words: tuple[str, ...] = ()) -> Iterator[tuple[str, Command]]:
    for name in commands(of):
        found = of[name].default_command
        if isinstance(found, Command):
            yield " ".join((*words, name)), found
        yield from analyses(of[name], (*words, name))


def test_it_has_every_analysis_of_the_command_line() -> None:
    seen: dict[int, str] = {}
    for name, command in analyses(app):
        seen.setdefault(id(command), name)  # some have a former name too
    assert set(seen.values()) - {"cohort"} == set(PLACES)


def test_its_places_are_those_of_the_commands() -> None:
    places = {name: command.job for name, command in analyses(app) if isinstance(command.job, str)}
    told = {name: f"geocontact.analyses.{place}" for name, place in PLACES.items()}
    assert {name: places.get(name, told[name]) for name in PLACES} == told
    assert job_named("gap diagnose").command == "gap diagnose" and job_named("cop").command == "cop"


def test_a_name_that_is_none_gets_the_nearest() -> None:
    with pytest.raises(InputError, match="there is no analysis 'aera'; did you mean 'area'"):
        job_named("aera")
    with pytest.raises(InputError, match=r"no analysis at 'no.module:job' \(ModuleNotFoundError"):
        job_named("no.module:job")
