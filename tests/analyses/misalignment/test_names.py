"""The five analyses by their names, whatever was imported before."""

from __future__ import annotations

from importlib import import_module

import pytest

import geocontact as gc
from geocontact.analyses.frame.job import Job

NAMES = {
    "simulate": "simulate",
    "identify": "fit",
    "compare": "compare",
    "design": "design",
    "population": "population",
}


@pytest.mark.parametrize("name", NAMES)
def test_an_analysis_is_not_hidden_by_its_sub_package(name: str) -> None:
    package = import_module(f"geocontact.analyses.misalignment.{name}")
    for _ in range(2):
        job = getattr(gc.misalignment, name)
        assert isinstance(job, Job) and job.command == f"elbow {NAMES[name]}"
    assert import_module(package.__name__) is package


def test_what_is_not_there_is_not_found() -> None:
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = gc.misalignment.nothing
