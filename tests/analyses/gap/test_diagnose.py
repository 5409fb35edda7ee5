"""The diagnosis called from Python: what it finds of a damped elbow, and that files only show it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.job import Call, execute
from geocontact.analyses.frame.record import Listener
from geocontact.analyses.gap.diagnose.many import diagnose_many
from geocontact.analyses.gap.diagnose.options import ManyOptions
from geocontact.analyses.gap.diagnose.result import DiagnoseResult
from tests.cli.calls import call, done
from tests.cli.gap_cases import DAMPING, TOLD, damped_elbow, diagnosed_elbow, known, spoilt
from tests.unchecked import unchecked


@pytest.fixture(scope="module")
def found() -> DiagnoseResult:
    return diagnosed_elbow()


@pytest.fixture(scope="module")
def case(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return damped_elbow(tmp_path_factory.mktemp("case") / "elbow_7")


def test_the_damper_is_found_and_measured(found: DiagnoseResult) -> None:
    d = found.diagnosis
    assert d.effects == ("damping",) and d.where[0].stage == "constitutive"
    assert d.gap["force"].reduction > 0.8
    low, high = d.parameters["damping.b"].ci95
    assert 0.7 * DAMPING < low < high < 1.3 * DAMPING


def test_the_verdict_is_said_in_one_sentence(found: DiagnoseResult) -> None:
    gap = found.diagnosis.gap["force"]
    low, high = (100.0 * edge for edge in found.diagnosis.where[0].phase)
    said = found.sentences[0]
    assert said.startswith(f"damping is missing; it sits in force (phase {low:.0f}–{high:.0f} %, fast part of beta); ")
    part = 100.0 * (1.0 - gap.rmse_after / gap.rmse_before)
    assert f"on the 2 held-out trials adding it removes {part:.0f} % of the error (" in said
    interval = " to ".join(f"{100.0 * edge:.0f}" for edge in gap.ci95).replace("-", "−")
    expected = f"on a new trial: {100.0 * gap.reduction:.0f} % expected, 95 % interval {interval} %"
    assert found.diagnosis.gap["force"].unit == "N" and found.sentences[1].startswith(expected)
    assert said.endswith("% stays unexplained")
    assert str(found).splitlines() == [*found.sentences, *(f"warning: {line}" for line in found.warnings)]
    assert "<img src=" in found._repr_html_()


def test_tables_agree_with_the_answer(found: DiagnoseResult) -> None:
    answer, tables = found.diagnosis, found.tables()
    assert list(tables) == ["gap_map", "ranking", "held_out", "budget", "trials"]
    ranking = tables["ranking"]
    assert ranking["gain [nats]"].is_monotonic_decreasing
    told = ranking.dropna(subset="probability [-]").set_index("answer")["probability [-]"]
    assert {name: told[name] for name in told.index} == pytest.approx(
        {name: answer.probabilities.get(name, 0.0) for name in told.index}, abs=1e-9
    )
    assert told.sum() <= 1.0 + 1e-9
    cells = tables["gap_map"]
    assert {"phase", "beta", "beta'", "load", "band", "fast phase"} == set(cells["axis"])
    sums = cells.groupby(["channel", "axis"])["share [-]"].sum()
    assert all(value == pytest.approx(1.0) or value == 0.0 for value in sums)
    least = cells["p_value [-]"].min()  # of two families of cells
    assert answer.where[0].p_value == pytest.approx(min(1.0, 2.0 * least))


def test_held_out_curves_have_the_errors_of_the_answer(found: DiagnoseResult) -> None:
    table, gap = found.table("held_out"), found.diagnosis.gap["force"]
    assert sorted(set(table["trial"])) == ["t03", "t04"]
    for column, rmse in (("force_base [N]", gap.rmse_before), ("force_with_effects [N]", gap.rmse_after)):
        off = table["force [N]"] - table[column]
        assert np.sqrt(np.mean(off**2)) == pytest.approx(rmse, rel=1e-6)


@contextmanager
def nothing_is_computed() -> Iterator[None]:
    """Whatever predicts, fits or maps fails."""
    places = ["geocontact.chain.system.System.simulate", "geocontact.chain.system.System.demand"]
    places += ["geocontact.gap.case.refit.refit", "geocontact.gap.reduction.raw_input_errors.refit"]
    places += [f"geocontact.gap.diagnose.{name}" for name in ("attribute", "confirmed", "gap_map", "ranking")]
    with ExitStack() as stack:
        for place in places:
            stack.enter_context(mock.patch(place, side_effect=AssertionError(f"{place} is called")))
        yield


def test_files_and_page_only_show_what_was_found(found: DiagnoseResult, tmp_path: Path) -> None:
    with nothing_is_computed(), unchecked():
        found.write(tmp_path / "out")
        found.page(tmp_path / "page.html")
    assert (tmp_path / "out" / "report.html").is_file() and (tmp_path / "page.html").stat().st_size > 1e5


def test_python_and_command_write_the_same_tables(case: Path, tmp_path: Path) -> None:
    with known():
        typed = done(call("gap", "diagnose", case, "--bare", "--out", tmp_path / "typed", folder=tmp_path / "typed"))
        called = gc.diagnose(case, bare=True).write(tmp_path / "called")
    tables = {file.name for file in called.glob("*.csv")}
    assert tables == {f"{name}.csv" for name in ("gap_map", "ranking", "held_out", "budget", "trials")}
    for name in (*tables, "diagnosis.json"):
        assert typed.bytes(name) == (called / name).read_bytes(), name


def test_stages_are_told_as_they_begin(found: DiagnoseResult) -> None:
    assert [
        ("elbow_7", stage)
        for stage in (
            "the base model and the noise",
            "every effect alone",
            "two effects together",
            "whatever else it may be",
            "whether held-out trials are predicted better",
            "residuals",
            "what the error consists of",
            "what would be invisible",
            "what is one law with it",
            "the experiment to run next",
            "where it misses, and how far that shrinks",
        )
    ] == TOLD


class Stops(Listener):
    """Ends the run once one case is done, as Ctrl-C does."""

    @contextmanager
    def progress(self, label: str, total: int) -> Iterator[Callable[[], None]]:
        """The block of all cases."""

        def stop() -> None:
            raise KeyboardInterrupt

        yield stop


def test_what_is_done_when_a_run_is_ended_stays(case: Path, tmp_path: Path) -> None:
    for name in "ab":
        spoilt(case, tmp_path / "cases" / name, "case.toml", "format = 1", "format = 1 ")
    options = ManyOptions(tmp_path / "cases", many=True, bare=True, workers=1)
    with known(), pytest.raises(KeyboardInterrupt):
        execute(diagnose_many, options, tmp_path / "out", Call({}, Stops()))
    assert [p.name for p in (tmp_path / "out").iterdir()] == ["a"]
    assert (tmp_path / "out" / "a" / "diagnosis.json").is_file() and (tmp_path / "out" / "a" / "run.json").is_file()


def test_many_cases_are_a_row_each_and_a_wrong_one_is_told(case: Path, tmp_path: Path) -> None:
    spoilt(case, tmp_path / "cases" / "a", "case.toml", "format = 1", "format = 1 ")
    spoilt(case, tmp_path / "cases" / "b", "case.toml", "[constants]", "[constant]")
    with known():
        result = diagnose_many(tmp_path / "cases", many=True, bare=True, workers=1)
    assert [one.code for one in result.outcomes] == [0, 2] and not result.accepted and result.exit_code == 2
    assert "unknown key 'constant'" in result.outcomes[1].line
    assert result.table()["effects"].tolist() == ["damping"]
    assert result.sentences[-1] == "1 of 2 cases diagnosed"
    out = result.write(tmp_path / "out")
    assert pd.read_csv(out / "summary.csv")["case"].tolist() == ["elbow_7"]  # of the findings that are given here
    assert (out / "a" / "diagnosis.json").is_file() and not (out / "b").exists()
