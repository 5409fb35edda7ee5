"""Studies run, are run again, and say what became of every trial."""

from __future__ import annotations

import errno
import json
import os
import platform
import re
import shutil
import sys
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.io import netcdf_file

import geocontact as gc
from geocontact.study import workers
from geocontact.study.curves import StudyCurves
from geocontact.study.result import CohortResult
from geocontact.study.show import study_curves, study_page
from geocontact.study.store import LOCK, Store, sole_writer
from geocontact.study.tables import ensemble_table, means_by_condition
from geocontact.view.page.content import Curves, Table
from tests.cli.calls import Call, call
from tests.study.quick import compared, study, tables, told

NUMBERS = {"A": "1", "B": "2", "C": "3"}


STARTS = "starts the module of 'tests.study.quick:quick'"


def cohort(file: Path, out: Path, scheduler: str) -> Call:
    """The study with leave to import its analysis, which is named first; without that line."""
    found = call("cohort", file, "--run-simulator", "--scheduler", scheduler, "--out", out, folder=out)
    first, _, rest = found.err.partition("\n")
    return replace(found, err=rest) if first == STARTS else found


def test_tables_of_all_trials_stand_together_in_both_forms(tmp_path: Path, scheduler: str) -> None:
    file = study(tmp_path, NUMBERS, "[sweep]", "gain = [1, 2]")
    done = cohort(file, tmp_path / "out", scheduler)
    assert done.code == 0, done.err
    table = pd.read_parquet(tmp_path / "out" / "tables" / "sine.parquet")
    names = [f"{subject} {gain}" for subject in NUMBERS for gain in (1, 2)]
    assert list(table["name"].unique()) == names == list(done.table("trials.csv")["name"])
    for (subject, gain), rows in table.groupby(["subject", "gain"]):
        number = float(NUMBERS[subject])
        assert len(rows) == 5 + number
        np.testing.assert_array_equal(rows["force [N]"], number * float(gain) * np.sin(rows["time [s]"]))
    with netcdf_file(str(tmp_path / "out" / "tables" / "sine.nc"), mmap=False) as found:
        v = found.variables
        np.testing.assert_array_equal(v["force"][:], table["force [N]"])
        np.testing.assert_array_equal(v["rows"][:], table.groupby("name", sort=False).size())
        assert v["rows"].sample_dimension == b"row" and v["force"].units == b"N"
        assert [b"".join(each).rstrip(b"\0").decode() for each in v["side"][:]] == list(table["side"])


def test_only_what_is_missing_is_evaluated_again(tmp_path: Path, scheduler: str) -> None:
    file, out = study(tmp_path, NUMBERS), tmp_path / "out"
    assert "3 of 3 trials" in cohort(file, out, scheduler).out
    first = tables(out)
    assert ", 0 of them new" in cohort(file, out, scheduler).out and tables(out) == first
    shutil.rmtree(out / pd.read_csv(out / "trials.csv")["folder"][1])
    assert ", 1 of them new" in cohort(file, out, scheduler).out and tables(out) == first
    (tmp_path / "B.txt").write_text("7", encoding="utf-8")
    assert ", 1 of them new" in cohort(file, out, scheduler).out and tables(out) != first
    (tmp_path / "B.txt").write_text("2", encoding="utf-8")
    assert ", 0 of them new" in cohort(file, out, scheduler).out and tables(out) == first, (
        "the old results are still there"
    )


def test_a_file_that_only_another_file_names_counts_too(tmp_path: Path, scheduler: str) -> None:
    (tmp_path / "more.dat").write_text("1", encoding="utf-8")
    file, out = study(tmp_path, {"A": "1 and more.dat"}), tmp_path / "out"
    cohort(file, out, scheduler)
    assert ", 0 of them new" in cohort(file, out, scheduler).out
    (tmp_path / "more.dat").write_text("2", encoding="utf-8")
    assert ", 1 of them new" in cohort(file, out, scheduler).out


@pytest.mark.parametrize(
    ("wrong", "state", "line", "code"),
    [
        ("wrong", "input error", "B.txt: is wrong; mend it", 2),
        ("fails", "failed", "ZeroDivisionError: it fails (quick.py ", 1),
        pytest.param("kills", "set aside", "its worker was killed 3 times", 1, marks=pytest.mark.slow),
    ],
)
def test_a_trial_that_cannot_be_evaluated_is_one_line(
    tmp_path: Path, scheduler: str, wrong: str, state: str, line: str, code: int
) -> None:
    out = tmp_path / "out"
    done = cohort(study(tmp_path, {**NUMBERS, "B": f"2 {wrong}", "D": "4"}), out, scheduler)
    assert done.code == code and len(done.complaints) == 1
    assert done.complaints[0].startswith("B: ") and line in done.complaints[0]
    assert list(done.table("trials.csv")["state"]) == ["done", state, "done", "done"]
    assert set(pd.read_parquet(out / "tables" / "sine.parquet")["subject"]) == {"A", "C", "D"}
    assert told(out)["results"]["trials"] == {"all": 4, "done": 3}


@pytest.mark.parametrize(("second", "code"), [("2 wrong", 2), ("2 fails", 1)])
def test_a_study_without_any_results_is_an_input_mistake_only_where_no_trial_failed(
    tmp_path: Path, scheduler: str, second: str, code: int
) -> None:
    done = cohort(study(tmp_path, {"A": "1 wrong", "B": second}), tmp_path / "out", scheduler)
    assert done.code == code and done.complaints[-1].endswith(
        "study.toml: none of the 2 trials could be evaluated; see the lines above"
    )


def test_a_trial_that_failed_leaves_its_whole_traceback_until_it_is_evaluated(tmp_path: Path, scheduler: str) -> None:
    file, out = study(tmp_path, {"A": "1", "B": "2 fails"}), tmp_path / "out"
    line = cohort(file, out, scheduler).complaints[0]
    log = out / (re.search(r"all of it: (\S+)\)", line) or [""])[1]
    text = log.read_text(encoding="utf-8")
    assert text.startswith("Traceback") and 'raise ZeroDivisionError("it fails")' in text
    Store(out / "results").forget(log.stem)
    assert not log.exists()


def test_no_room_ends_the_study_and_loses_nothing(tmp_path: Path, scheduler: str) -> None:
    file, out = study(tmp_path, {**dict.fromkeys("ABCDEF", "1"), "G": "2 full"}), tmp_path / "out"
    ended = cohort(file, out, scheduler)
    assert ended.code == 1 and len(ended.complaints) == 1
    assert ended.complaints[0].startswith(f"{out / 'results'}: No space left on device; finished trials stay")
    (tmp_path / "G.txt").write_text("2", encoding="utf-8")
    done = cohort(file, out, scheduler)
    assert done.code == 0 and "7 of 7" in done.out and ", 7 of them new" not in done.out


def test_only_one_study_at_a_time_writes_into_a_folder(tmp_path: Path, scheduler: str) -> None:
    """A lock file that a dead process left is taken over; the lock goes with the run, also where that fails."""
    file, out = study(tmp_path, {"A": "1"}), tmp_path / "out"
    (out / "results").mkdir(parents=True)
    left = out / "results" / LOCK
    left.write_text("process 1 on elsewhere", encoding="utf-8")
    with sole_writer(out / "results"):
        refused = cohort(file, out, scheduler)
        assert refused.code == 2 and refused.err == (
            f"{out / 'results'}: another study writes here (process {os.getpid()} on {platform.node()}); "
            "wait until it has ended, or choose another --out\n"
        )
    left.write_text("process 1 on elsewhere", encoding="utf-8")
    assert cohort(file, out, scheduler).code == 0 and not left.exists()
    (tmp_path / "A.txt").write_text("1 wrong", encoding="utf-8")
    assert cohort(file, out, scheduler).code == 2 and not left.exists()


def test_units_on_the_page_are_as_in_print(tmp_path: Path) -> None:
    one = StudyCurves("area [mm^2]", ("A",), ("A",), ("all",), np.ones((1, 101)))
    page = study_page("areas", [one], {"trials": pd.DataFrame({"name": ["A"], "folder": [""]})})
    assert [part.unit for part in page.sections if isinstance(part, Curves)] == ["mm²"]


@pytest.mark.parametrize("trials", [1, 201, 500, 501])
def test_the_page_of_many_trials_links_to_those_that_it_shows(tmp_path: Path, trials: int) -> None:
    manifest = pd.DataFrame({"name": [f"S{k}" for k in range(trials)], "folder": "results/0"})
    (tmp_path / "results" / "0").mkdir(parents=True)
    for there in (False, True):
        page = study_page("many", [], {"trials": manifest}, home=tmp_path)
        (table,) = (part for part in page.sections if isinstance(part, Table))
        assert len(table.rows) == len(table.links) == min(trials, 500)
        assert set(table.links) == {"results/0/report.html" if there else ""}, "only to a page that is there"
        (tmp_path / "results" / "0" / "report.html").touch()


@pytest.mark.skipif(not Path("/proc/self").is_dir(), reason="no /proc here")
def test_a_folder_that_takes_no_files_is_refused(tmp_path: Path) -> None:
    refused = call("cohort", study(tmp_path, NUMBERS), "--run-simulator", "--out", "/proc/none")
    assert refused.code == 2 and len(refused.complaints) == 1 and "cannot be written to" in refused.err


def test_a_machine_without_room_or_files_is_no_mistake_of_the_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Before the first trial: where the folder of results cannot be made, or its lock cannot be opened."""
    file, makes = study(tmp_path, NUMBERS), Path.mkdir
    for place, error in (("results", errno.ENOSPC), (".geocontact-", errno.ENOSPC), ("results", errno.EMFILE)):

        def mkdir(folder: Path, *given: Any, place: str = place, error: int = error, **named: Any) -> None:
            if folder.name.startswith(place):
                raise OSError(error, os.strerror(error), str(folder))
            makes(folder, *given, **named)

        monkeypatch.setattr(Path, "mkdir", mkdir)
        ended = call("cohort", file, "--run-simulator", "--out", tmp_path / "out")
        assert ended.code == 1 and os.strerror(error) in ended.complaints[-1], ended.err


def test_means_of_a_study_are_those_of_its_table_in_si() -> None:
    matrix = np.outer([1.0, 3.0, 10.0], np.arange(101.0))
    one = StudyCurves("area [mm^2]", ("A", "B", "C"), ("A", "B", "C"), ("slow", "slow", "fast"), matrix)
    means: Any = CohortResult.means.fget(SimpleNamespace(ensembles=(one,)))
    assert list(means) == [("area", "slow"), ("area", "fast")]
    table = ensemble_table([one]).set_index("condition")
    for condition in ("slow", "fast"):
        np.testing.assert_allclose(means["area", condition], 1e-6 * table.loc[condition, "mean"])
    np.testing.assert_allclose(means["area", "slow"], 2e-6 * np.arange(101.0))


def test_a_quantity_that_no_trial_has_whole_is_not_drawn() -> None:
    names = ("A",), ("A",), ("all",)
    whole, gaps = (StudyCurves("area [mm^2]", *names, np.full((1, 101), value)) for value in (1.0, np.nan))
    (panel,) = study_curves([gaps, whole]).panels
    assert panel.unit == "mm²" and [curve.name for curve in panel.curves] == ["all (n = 1)"]
    assert not study_curves([gaps]).panels


def test_results_are_those_of_one_by_one(tmp_path: Path, scheduler: str, monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.study.quick import quick

    out = tmp_path / "out"
    manifest = cohort(study(tmp_path, NUMBERS), out, scheduler).table("trials.csv")
    monkeypatch.chdir(tmp_path)
    for name, folder in zip(manifest["name"], manifest["folder"], strict=True):
        quick(f"{name}.txt").write(tmp_path / name)
        assert (tmp_path / name / "sine.csv").read_bytes() == (out / folder / "sine.csv").read_bytes()


def test_conditions_are_compared_and_the_page_leads_to_every_trial(tmp_path: Path, scheduler: str) -> None:
    out = tmp_path / "out"
    done = cohort(compared(tmp_path), out, scheduler)
    assert done.code == 0 and done.warnings == ["F fast 2 lies apart from the other trials of its condition"]
    assert "force, fast against slow: p is at most 5 % at 100 of 101 places, 1 to 100 %" in done.out
    values = done.table("values.csv")
    largest = values[(values["value"] == "largest") & (values["condition"] == "slow")]["mean"].item()
    assert largest == pytest.approx(21.0 * np.sin(1.0), rel=1e-9)
    differences = done.table("differences.csv")
    assert differences["p [-]"][1:].to_numpy() == pytest.approx(2 / 64) and differences["p [-]"][0] == 1.0
    assert r"icc\_agreement [-]" in (out / "agreement.tex").read_text(encoding="utf-8")
    page = (out / "report.html").read_text(encoding="utf-8")
    links = re.findall(r'<a href="(results/[0-9a-f]{32}/report\.html)">', page)
    assert len(links) == 24 and all((out / link).is_file() for link in links)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--memory", "lots"), "--memory: 'lots' is not a size of memory; write for example 4GB"),
        (("--workers", "0"), "--workers: 0 is less than one; give 1 or more"),
        (
            ("--scheduler", "here"),
            "--scheduler: 'here' is not an address; write tcp://host:8786, slurm, pbs, lsf, sge, or local",
        ),
        (("--scheduler", "tcp://h:1", "--workers", "2"), "--workers: has no effect with --scheduler"),
    ],
)
def test_options_that_cannot_be_are_refused_before_any_work(
    tmp_path: Path, options: tuple[str, ...], said: str
) -> None:
    refused = call("cohort", study(tmp_path, NUMBERS), "--run-simulator", *options, "--out", tmp_path / "out")
    assert refused.code == 2 and refused.err.startswith(said) and not (tmp_path / "out").exists()


@pytest.mark.parametrize("library", ["distributed", "pyarrow"])
def test_without_the_extra_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, library: str) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    refused = call("cohort", study(tmp_path, NUMBERS), "--run-simulator", "--out", tmp_path / "out")
    assert refused.code == 2 and refused.err.removeprefix(f"{STARTS}\n") == (
        f"cohort: needs {library}, which is not installed; pip install 'geocontact[cohort]'\n"
    )


def test_a_library_that_cannot_be_loaded_is_no_mistake_of_the_input(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the machine has no memory to map it the error has no name of a module, and a second run may go well."""
    line = "libssl.so: failed to map segment from shared object"
    (tmp_path / "cryptography.py").write_text(f"raise ImportError({line!r})\n", encoding="utf-8")
    monkeypatch.delitem(sys.modules, "cryptography", raising=False)
    monkeypatch.syspath_prepend(tmp_path)
    failed = call("cohort", study(tmp_path, NUMBERS), "--run-simulator", "--out", tmp_path / "out")
    assert failed.code == 1 and line in failed.err and "not installed" not in failed.err, failed


def test_a_study_that_is_refused_leaves_no_folder(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text('analysis = "arae"\n', encoding="utf-8")
    told = call("cohort", tmp_path / "study.toml", "--out", tmp_path / "out")
    assert told.code == 2 and "did you mean 'area'?" in told.err
    assert not (tmp_path / "out").exists()


def test_the_page_answers_with_the_means_by_condition_and_their_difference() -> None:
    """A subject in two conditions; then two subjects, whose SD is by hand."""
    step = np.linspace(0.0, 2.0, 101)
    manifest = {
        "trials": pd.DataFrame({"name": ["a", "b"], "folder": ["", ""], "words": ["", ""], "state": ["done"] * 2})
    }
    one = StudyCurves("area_fixed [mm^2]", ("a", "b"), ("A", "A"), ("flat", "bent"), np.stack([step + 9.0, step + 6.0]))
    assert means_by_condition([one]) == [
        "area_fixed, mean over the curve: flat 10 mm^2, bent 7 mm^2: difference 3 mm^2"
    ]
    page = study_page("study", [one], manifest)
    assert page.headline[0] == "area_fixed, mean over the curve: flat 10 mm², bent 7 mm²: difference 3 mm²."
    titles = [section.title for section in page.sections if isinstance(section, Curves)]
    assert titles == ["area fixed over the cycle"], "no mean of one subject"
    table = next(section for section in page.sections if isinstance(section, Table) and section.title == "Trials")
    assert list(table.header) == ["name", "state"], "no column without a word in it"
    names = ("a", "b", "c", "d"), ("A", "A", "B", "B"), ("flat", "bent", "flat", "bent")
    two = StudyCurves("angle [deg]", *names, np.array([[4.0], [1.0], [6.0], [5.0]]) + np.zeros(101))
    sd = np.sqrt(2.0)
    (line,) = means_by_condition([two])
    assert line.startswith(f"angle, mean over the curve: flat 5 (SD {sd:.3g}) deg, bent 3 (SD {2.0 * sd:.3g}) deg")
    assert line.endswith(f"difference 2 (SD {sd:.3g}) deg")


def test_warnings_of_trials_are_those_of_the_study(tmp_path: Path, scheduler: str) -> None:
    """A ball 0.5 mm inside the plate warns once in each trial: one line on the terminal, both in run.json."""
    from tests.cli.calls import PLATE, SPHERE, poses

    motion = poses(tmp_path, (0, -30.0, 0), (0, -31.0, 0))
    text = (
        f'analysis = "area"\n[options]\nmoving = "{SPHERE}"\nfixed = "{PLATE}"\nunit = "mm"\nmotion = "{motion.name}"\n'
    )
    (tmp_path / "study.toml").write_text(text + "[sweep]\nthreshold = [1, 2]\n", encoding="utf-8")
    done = cohort(tmp_path / "study.toml", tmp_path / "out", scheduler)
    kept = json.loads((tmp_path / "out" / "run.json").read_text("utf-8"))["warnings"]
    manifest = done.table("trials.csv")
    assert manifest["warnings [-]"].sum() == 2 and len(kept) == 1  # that of the other trial is in trials.csv in words
    assert "mm" in manifest["warnings"][1] and kept[0].endswith("(and alike in 1 other trial)")
    assert done.warnings == kept


def test_curves_of_several_thresholds_say_which_is_theirs(tmp_path: Path, scheduler: str) -> None:
    """A ball of 20 mm, 0.5 mm above a plate: the area below 2 mm is a cap's, 2 pi 20 mm 1.5 mm."""
    from tests.cli.calls import PLATE, SPHERE, poses

    motion = poses(tmp_path, (0, 20.5, 0), (0, 20.5, 0))
    text = f'analysis = "area"\n[options]\nmoving = "{SPHERE}"\nfixed = "{PLATE}"\nunit = "mm"\n'
    text += f'motion = "{motion.name}"\nthreshold = [1, 2]\n[[trials]]\nsubject = "A"\n[summary]\n'
    text += 'columns = ["area_moving [mm^2]"]\n'
    for more, at, said in (("", 1.0, True), ('where = { "threshold [mm]" = 2 }\n', 2.0, False)):
        (tmp_path / "study.toml").write_text(text + more, encoding="utf-8")
        done = cohort(tmp_path / "study.toml", tmp_path / "out", scheduler)
        line = "curves are at threshold 1 mm, the first of several values; `where` of [summary] names others"
        assert done.code == 0 and (line in done.out) == said, done.out + done.err
        assert done.table("ensemble.csv")["mean"].to_numpy() == pytest.approx(
            40.0 * np.pi * (at - 0.5), rel=0.07
        )  # facets
        page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
        assert f"area moving over the cycle, threshold {at:g} mm" in page


def test_warnings_and_fits_of_trials_travel(tmp_path: Path, scheduler: str) -> None:
    """Two warn of two numbers each, one contradicts its data: a line for each kind, and the trials in words."""
    numbers = {"A": "1", "B": "2 contradicts", "C": "3 warns", "D": "4 warns"}
    done = cohort(study(tmp_path, numbers), tmp_path / "out", scheduler)
    manifest = pd.read_csv(tmp_path / "out" / "trials.csv", keep_default_na=False).set_index("name")
    assert list(manifest["fit"]) == ["", "contradicts", "", ""] and list(manifest["warnings [-]"]) == [0, 0, 1, 1]
    assert manifest["warnings"]["D"] == "rms 4 mm, 8 mm at most"
    said = "C: rms 3 mm, 6 mm at most (and alike in 1 other trial)"
    contradict = "1 of 1 trials contradict their data: B"
    record = done.record()
    assert record["warnings"][-1] == said and record["fit"]["outcome"] == "contradicts"
    assert done.code == 1 and said in done.warnings and done.out.startswith("the result contradicts its data")
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert said in page and contradict in page


def test_a_summary_that_no_trial_has_is_refused_after_the_first(tmp_path: Path, scheduler: str) -> None:
    """Of thirty trials of 0.3 s each hardly one more than there are workers is evaluated."""
    numbers = {f"S{k:02d}": f"{k} slow" for k in range(30)}
    for line, said in (
        ('columns = ["forze [N]"]', "has no column 'forze [N]'"),
        ('table = "sinus"', "no trial has a table 'sinus'"),
    ):
        out = tmp_path / line[:5]
        done = cohort(study(tmp_path, numbers, "[summary]", line), out, scheduler)
        assert done.code == 2 and said in done.err
        assert len(list(out.glob("results/*/trial.json"))) < 15
        again = cohort(tmp_path / "study.toml", out, scheduler)
        assert again.code == 2 and len(list(out.glob("results/*/trial.json"))) < 15


def test_curves_are_over_the_gait_cycles_of_a_table_of_events(tmp_path: Path, scheduler: str) -> None:
    """Two cycles of each trial, 0 to 0.5 and 0.5 to 1 s: at their ends the mean of two sines, times the number."""
    file = compared(tmp_path)
    names = [one.stem for one in tmp_path.glob("*_*_*.txt")]
    rows = [f"{name},right,heel strike,{at}" for name in names for at in (0.0, 0.5, 1.0)]
    events = tmp_path / "events.csv"
    events.write_text("recording,side,event,time [s]\n" + "\n".join(rows) + "\n", encoding="utf-8")
    with pytest.warns(gc.InputWarning, match="F fast 2 lies apart"):
        found = gc.cohort(file, run_simulator=True, scheduler=scheduler, events=events)
    with pytest.warns(gc.InputWarning, match="F fast 2 lies apart"):
        part = gc.cohort(file, run_simulator=True, scheduler=scheduler, events=events, part="60%").table("ensemble")
    ensemble = found.table("ensemble").set_index(["condition", "cycle [%]"])["mean"]
    number = 21.0  # mean of 20, 21 and 22, twice
    assert ensemble["slow", 100.0] == pytest.approx(number * 0.5 * (np.sin(0.5) + np.sin(1.0)), rel=5e-3)
    (row,) = found.table("shifts").to_dict(orient="records")
    assert {row["style"], row["reference"]} == {"slow", "fast"} and row["cycles [-]"] == 6
    assert np.isfinite(row["peak_difference_lower"]) and row["rmse"] > 1.0
    shorter = part.set_index(["condition", "cycle [%]"])["mean"]["slow", 100.0]
    assert shorter == pytest.approx(number * 0.5 * (np.sin(0.3) + np.sin(0.8)), rel=5e-3)


def test_settings_of_the_workers_are_ones_that_dask_has() -> None:
    """A name that it does not know would do nothing; nannies of this version show no pages."""
    import dask
    import distributed  # noqa: F401  its defaults come with it

    unknown = {each for each in workers.SETTINGS if dask.config.get(each, "unknown") == "unknown"}
    assert unknown <= {"distributed.nanny.http.routes"}
