"""A form stands for the words of the command line, which its own parser reads, and for the same call in Python."""

from __future__ import annotations

import csv
import math
import shlex
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.catalogue import ENTRIES, entry_of
from geocontact.analyses.frame import quantities
from geocontact.analyses.frame.marks import Requires
from geocontact.analyses.frame.options import Options, declared
from geocontact.app import calls, samples
from geocontact.app.fields import UNITS_OF, Form, fields_of, shown
from geocontact.app.study import study_of, written_study
from geocontact.cli import folders, opensim_setup
from geocontact.cli.command import spelling
from geocontact.cli.folders import calls_in_folder
from geocontact.cli.main import app
from geocontact.cli.opensim_setup import with_setup
from geocontact.data.errors import InputError
from tests.cli.calls import SPHERE, call, done
from tests.cli.test_tool_folders import leg, opencap, put

__all__ = ["leg"]
COMMANDS = sorted(each.command for each in ENTRIES if each.command)


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Files of samples; results that others read are there in name only."""
    return tmp_path_factory.mktemp("samples")


def words_of(command: str, home: Path) -> list[str]:
    """The sample's own words; what it reads of other samples is a file without content."""
    one = samples.sample(command, home)
    for word in one.words:
        for part in word.split("="):
            path = Path(part)
            if any(path.is_relative_to(samples.results_of(each, home)) for each in one.before) and not path.exists():
                (path if not path.suffix else path.parent).mkdir(parents=True, exist_ok=True)
                if path.suffix:
                    path.touch()
    return [*one.words, "--out", str(home / "out")]


def parsed(words: list[str]) -> Options:
    """Options as the command line reads them, found without the form."""
    command, bound, _ = app.parse_args(words, exit_on_error=False, print_error=False)
    found: Options = command.read(*bound.args, **bound.kwargs)  # type: ignore[attr-defined]
    return found


def test_every_analysis_has_a_sample_and_a_place_on_the_start_page() -> None:
    assert sorted(samples.SAMPLES) == COMMANDS
    assert sorted(command for commands in samples.START.values() for command in commands) == COMMANDS


@pytest.mark.parametrize("command", COMMANDS)
def test_a_sample_through_the_form_is_the_same_call(command: str, home: Path) -> None:
    """Words typed, filled into the form and taken out again have the same options."""
    words = words_of(command, home)
    form = Form.of_words(words)
    assert form.command == command
    again = form.words(home / "out")
    assert parsed(again) == parsed(words)
    assert shlex.split(shown(again))[1:] == again
    assert calls.checked(again, command, home)[1] == ""


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_is_a_field(command: str) -> None:
    options = entry_of(command).load_options()
    names = {one.name for one in fields_of(command)}
    assert {one.name for one in declared(options) if one.settable} < names
    assert all(one.words and one.label for one in fields_of(command))


@pytest.mark.parametrize("command", COMMANDS)
def test_python_lines_are_the_same_call(command: str, home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """They are run with jobs that only make their options: equal to those of the command line."""
    words = words_of(command, home)
    lines = calls.python_lines(words, command, home / "out")
    entry = entry_of(command)
    if not entry.exported:
        assert lines == ""
        return
    job = entry.load_job()
    made: list[Options] = []

    class Ran:
        def write(self, out: str) -> None:
            assert out == str(home / "out")

    def noted(*inputs: Any, **given: Any) -> Ran:
        names = [one.name for one in declared(job.options) if one.positional]
        made.append(job.options(**dict(zip(names, inputs, strict=False)), **given))
        return Ran()

    place = gc if not entry.room else getattr(gc, entry.room)
    monkeypatch.setitem(vars(place), entry.name, noted)
    if entry.room:
        monkeypatch.setattr(
            type(place),
            "__getattribute__",
            lambda self, name: vars(self)[name] if name != "__dict__" else object.__getattribute__(self, name),
        )
    exec(compile(lines, "lines", "exec"), {"__name__": "__main__"})
    (python,), typed = made, parsed(words)
    assert vars(python) == {name: value for name, value in vars(typed).items() if name in vars(python)}
    assert not any(typed.given(name) for name in vars(typed).keys() - vars(python).keys())


def test_units_are_chosen_and_texts_that_say_theirs_stay() -> None:
    form = Form("area", {"threshold": "1, 4", "congruence": "5 cm"}, {"threshold": "cm", "congruence": "in"})
    assert {"--threshold=1cm,4cm", "--congruence=5 cm"} <= set(form.words("out"))
    back = Form.of_words(["area", "--threshold", "4mm", "--out", "x"])
    assert (back.values["threshold"], back.units["threshold"]) == ("4", "mm")


@pytest.mark.parametrize("read", UNITS_OF)
def test_every_unit_that_can_be_chosen_is_read(read: str) -> None:
    """And no reader of another name takes them for something else: 1 in each unit is as much as its SI value."""
    factors = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "in": 0.0254, "kg": 1.0, "g": 1e-3, "lb": 0.45359237, "%": 0.01}
    factors |= {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "bar": 1e5, "psi": 6894.757293168361}
    factors["mmHg"] = 133.322387415
    for unit in filter(None, UNITS_OF[read]):
        found = getattr(quantities, read)(f"0.5{unit}", "x")
        assert np.ravel(found) == pytest.approx([0.5 * factors[unit]], rel=1e-9), unit


def test_an_address_keeps_a_form_and_a_foreign_one_is_an_empty_form() -> None:
    form = Form("area", {"threshold": "1, 4", "pressure": True, "motion": "a b\n\u00e4&=%.csv"}, {"threshold": "cm"})
    assert Form.of_kept("area", form.kept()) == form
    foreign = '{"values": {"threshold": true, "pressure": "x", "gone": "1"}, "units": {"threshold": 1}}'
    for text in ("", "[", "1", "[1]", '{"values": 1}', '{"values": {}, "units": []}', foreign):
        assert Form.of_kept("area", text) == Form("area"), text


def test_fields_without_effect_are_neither_enabled_nor_typed() -> None:
    form = Form("area", {"modulus": "500MPa"})
    field = next(one for one in form.fields if one.name == "modulus")
    assert form.without_effect(field) == "needs --pressure" and "--modulus=500MPa" not in form.words("out")
    form.values["pressure"] = True
    assert form.without_effect(field) == "" and "--modulus=500MPa" in form.words("out")
    rate = next(one for one in form.fields if one.name == "rate")
    assert form.without_effect(rate) == ""
    form.values["sweep"] = "flexion=0:90:1"
    assert form.without_effect(rate) == "has no effect with --sweep"


def test_a_mistake_stands_at_the_field_that_it_names(home: Path) -> None:
    form = Form.of_words(words_of("area", home))
    for name, wrong in (("threshold", "4 parsec"), ("side", "above"), ("moving", "no.stl"), ("draws", "many")):
        filled = Form("area", form.values | {name: wrong} | ({"pose_sd": "t=1"} if name == "draws" else {}))
        lines, message = calls.checked(filled.words("out"), "area", "out")
        at = filled.at(message)
        assert message and not lines and at is not None and at.name == name, (name, message)
    with pytest.raises(InputError, match="4 parsec"):
        calls.python_lines(Form("area", form.values | {"threshold": "4 parsec"}).words("out"), "area", "out")


def test_an_input_that_is_missing_is_not_taken_by_the_next_one(home: Path) -> None:
    form = Form.of_words(words_of("area", home))
    del form.values["moving"]
    message = calls.checked(form.words("out"), "area", "out")[1]
    at = form.at(message)
    assert "MOVING is missing" in message and at is not None and at.name == "moving"


def test_a_path_is_found_whole_before_by_its_name(home: Path) -> None:
    form = Form("area", {"moving": ".", "fixed": "b/m.stl", "motion": "a/m.stl"})
    for message, name in (("a/m.stl: is no motion", "motion"), ("b/m.stl: is damaged", "fixed"), ("x.csv: is", "")):
        at = form.at(message)
        assert (at.name if at is not None else "") == name, message


def reached(form: Form, name: str, on_the_way: tuple[str, ...] = ()) -> bool:
    """Whether somebody who fills in only what is enabled can fill in this field; what it needs is filled in."""
    one = next(each for each in form.fields if each.name == name)
    for rule in one.one.rules:
        if form.without_effect(one) and isinstance(rule, Requires):
            for other in filter(None, (rule.other, rule.alternative)):
                if other not in on_the_way and reached(form, other, (*on_the_way, name)):
                    kind = next(each.kind for each in form.fields if each.name == other)
                    form.values[other] = True if kind == "flag" else "x"
                    break
    return not form.without_effect(one)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_field_can_be_reached_from_an_empty_form(command: str) -> None:
    """Those for files of a kind need such a file."""
    names = [one.name for one in fields_of(command) if not one.one.endings]
    assert [name for name in names if not reached(Form(command), name)] == []


@pytest.mark.parametrize("name", ["parquet", "excel_safe", "no_figures", "no_overwrite"])
def test_forms_of_tables_are_written_in_python_too(name: str, home: Path, tmp_path: Path) -> None:
    """The lines are run: they write what the command line writes with the same words."""
    form = Form.of_words(words_of("elbow design", home))
    form.values[name] = True
    out = tmp_path / "out"
    lines = calls.python_lines(form.words(out), "elbow design", out)
    exec(compile(lines, "lines", "exec"), {"__name__": "__main__"})
    assert (name == "parquet") == bool(list(out.glob("*.parquet")))
    if name == "no_overwrite":
        with pytest.raises(InputError, match="holds results already"):
            exec(compile(lines, "lines", "exec"), {"__name__": "__main__"})
    elif name == "no_figures":
        assert "figures=False" in lines and not list(out.glob("*.png"))
    else:
        assert f"{name}=True" in lines


def test_a_folder_takes_the_place_of_the_recording(leg: Path, tmp_path: Path) -> None:
    """What the command line finds in it is not missing in the form; each trial has its lines and its folder."""
    folder, out = opencap(leg, tmp_path / "session"), tmp_path / "out"
    put(leg, folder, ("walk.mot", "OpenSimData/Kinematics/walk2.mot"), ("walk.trc", "MarkerData/walk2.trc"))
    words = Form("ik", {fields_of("ik")[0].name: str(folder)}).words(out)
    found = calls_in_folder(words, spelling)
    lines, wrong = calls.checked(words, "ik", out)
    assert wrong == "" and len(found) > 1 and lines.count("gc.inverse_kinematics(") == len(found)
    assert all(str(Path("MarkerData") / name) in lines and str(out / name) in lines for name in ("walk1", "walk2"))
    assert lines.count("leg_scaled.osim") == len(found)
    (folder / "OpenSimData" / "Model" / "leg_scaled.osim").unlink()
    assert calls.checked(words, "ik", out)[0] == ""


@pytest.mark.parametrize("command", [*opensim_setup.COMMANDS, *folders.COMMANDS])
def test_what_stands_for_options_is_a_field(command: str) -> None:
    names = {one.name for one in fields_of(command)}
    assert {"setup"} & names == ({"setup"} if command in opensim_setup.COMMANDS else set())
    assert ("trial" in names) == (command in folders.COMMANDS)
    assert not names & {"setup", "trial"} or command not in ("area", "joint")


def test_a_set_up_file_takes_the_place_of_the_recording(leg: Path, tmp_path: Path) -> None:
    """Its field closes that of the recording; lines in Python and the study have what the file asks for."""
    done(call("ik", leg / "walk.trc", "--model", leg / "leg.osim", "--out", tmp_path / "ik"))
    file = tmp_path / "ik" / "setup_ik.xml"
    form = Form("ik", {"markers": "typed.trc", "setup": str(file)})
    recording = next(one for one in form.fields if one.name == "markers")
    assert form.without_effect(recording) == "has no effect with --setup"
    words = form.words("out")
    assert words == ["ik", f"--setup={file}", "--out=out"] and Form.of_words(words).values == {"setup": str(file)}
    lines, wrong = calls.checked(words, "ik", "out")
    assert wrong == "" and "seen.trc" in lines and "leg.osim" in lines and "setup=" not in lines
    told = with_setup(words)
    found = calls.expanded(form, "out")
    assert list(found) == [""] and parsed(found[""].words("out")) == parsed(told)
    study = tmp_path / "study.toml"
    study.write_text(study_of(found, tmp_path), encoding="utf-8")
    options = tomllib.loads(study.read_text("utf-8"))["options"]
    assert "setup" not in options and options["model"].endswith("leg.osim")
    form.values["setup"] = str(tmp_path / "none.xml")
    lines, wrong = calls.checked(form.words("out"), "ik", "out")
    at = form.at(wrong)
    assert lines == "" and at is not None and at.name == "setup"


def test_the_names_of_options_are_not_found_in_longer_ones() -> None:
    form = Form("area")
    at = form.at("--unit-moving: 'x' is not a unit")
    assert at is not None and at.name == "unit_moving"


@pytest.mark.parametrize("command", [each.command for each in ENTRIES if each.of_trials])
def test_a_study_of_a_form_is_read_by_cohort(command: str, home: Path, tmp_path: Path) -> None:
    """The options of its one trial are those of the form."""
    from geocontact.study.description import read_study_file

    words = words_of(command, home)
    form = Form.of_words(words)
    file = tmp_path / "study.toml"
    file.write_text(study_of({"": form}, tmp_path), encoding="utf-8")
    study = read_study_file(file)
    options = entry_of(command).load_options()
    known = {one.spelled.key or one.name: one for one in declared(options)}
    given = {known[name].name: known[name].read(value) for name, value in study.options.items()}
    assert study.analysis == command and options(**given) == parsed(words)


@pytest.mark.parametrize(
    "text", ["05", "5.", "-.5", ".5", "+5", "-5", "1e3", "1_000", "7", "0.25", "inf", "nan", "0x1F", "five"]
)
def test_numbers_in_a_study_are_those_that_were_typed(text: str) -> None:
    """Spellings that TOML does not know as well; what is no finite number stays as it was typed."""
    one = next(each for each in fields_of("area") if each.one.kind is float or str(each.one.kind).startswith("float"))
    found = tomllib.loads(study_of({"": Form("area", {one.name: text})}, Path()))["options"]
    value = found.get(one.spelled.removeprefix("--").replace("-", "_"), found.get(one.name))
    try:
        expected: float | str = float(text) if math.isfinite(float(text)) else text
    except ValueError:
        expected = text
    assert value == expected


def test_a_path_that_the_file_system_refuses_is_one_line(tmp_path: Path) -> None:
    """A name of 5000 letters, with which the command line ends in the same words."""
    form = Form("ik", {"model": "leg.osim", "markers": "x" * 5000})
    lines, wrong = calls.checked(form.words("out"), "ik", "out")
    assert lines == "" and "File name too long" in wrong and "Traceback" not in wrong
    assert f'"{"x" * 5000}"' in study_of({"": form}, tmp_path)


def test_a_study_of_paths_with_braces_is_run_by_cohort(tmp_path: Path) -> None:
    """As somebody's folder is called; the same options as the form's."""
    from geocontact.study.description import read_study_file
    from geocontact.study.steps import runs_of

    odd = tmp_path / "scans {left} [1]"
    odd.mkdir()
    file, mesh = tmp_path / "study.toml", odd / "{ball}.stl"
    mesh.write_bytes(SPHERE.read_bytes())
    form = Form("fit", {"mesh": str(mesh), "shape": "sphere", "unit": "mm"})
    file.write_text(study_of({"": form}, tmp_path), encoding="utf-8")
    assert runs_of(read_study_file(file))[0].trial.options["mesh"] == mesh.as_posix()
    done(call("cohort", file, "--workers", "1", "--out", tmp_path / "study", folder=tmp_path / "study"))


@pytest.mark.parametrize(("command", "table"), [("ik", "ik.mot"), ("markers", "markers.trc")])
def test_a_study_of_a_folder_has_all_of_its_trials(command: str, table: str, leg: Path, tmp_path: Path) -> None:
    """It is run: each trial has what the command writes of it, and no trial is missing or written twice."""
    folder = opencap(leg, tmp_path / "session")
    put(leg, folder, ("still.trc", "MarkerData/walk2.trc"), ("walk.mot", "OpenSimData/Kinematics/walk2.mot"))
    form = Form(command, {fields_of(command)[0].name: str(folder), "trial": "walk1\nwalk2"})
    file = written_study(tmp_path / "s" / "study.toml", study_of(calls.expanded(form, "out"), tmp_path))
    done(call("cohort", file, "--workers", "1", "--out", tmp_path / "study", folder=tmp_path / "study"))
    done(call(*form.words(tmp_path / "own"), folder=tmp_path / "own"))
    with (tmp_path / "study" / "trials.csv").open(encoding="utf-8") as rows:
        studied = {row["trial"]: tmp_path / "study" / row["folder"] / table for row in csv.DictReader(rows)}
    assert sorted(studied) == ["walk1", "walk2"]
    for trial, there in studied.items():
        assert there.read_bytes() == (tmp_path / "own" / trial / table).read_bytes()
    if command == "ik":
        assert studied["walk1"].read_bytes() != studied["walk2"].read_bytes()
    options = tomllib.loads(file.read_text("utf-8"))["options"]
    assert options["model"].endswith("leg_scaled.osim") and "trial" not in options


def test_a_study_that_was_edited_stays(tmp_path: Path) -> None:
    file = tmp_path / "new" / "area-1-study.toml"
    assert written_study(file, "a = 1\n") == written_study(file, "a = 1\n") == file
    file.write_text("mine", encoding="utf-8")
    again = written_study(file, "a = 1\n")
    assert again.name == "area-1-study-2.toml" and again.read_text("utf-8") == "a = 1\n"
    assert file.read_text("utf-8") == "mine" and written_study(file, "a = 1\n") == again
