"""Trials of a study from patterns of files, tables and lists; what cannot be is one line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from geocontact.data.errors import InputError
from geocontact.study.address import Digests, address_of
from geocontact.study.code_version import CodeSources, code_version
from geocontact.study.description import read_study_file
from geocontact.study.steps import runs_of
from geocontact.study.trials import CohortTrial, literal
from tests.study.quick import QuickOptions, quick


def trials(folder: Path, text: str) -> list[CohortTrial]:
    (folder / "study.toml").write_text(f'analysis = "area"\n{text}', encoding="utf-8")
    return [one.trial for one in runs_of(read_study_file(folder / "study.toml"))]


@pytest.fixture
def data(tmp_path: Path) -> Path:
    for name in ("P1/slow_1.csv", "P1/fast_1.csv", "P2/slow_1.csv", "P2/notes.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).touch()
    (tmp_path / "people.csv").write_text("subject,side,mass [kg]\nP1,left,70\nP2,right,80\n", encoding="utf-8")
    return tmp_path


def test_files_a_table_and_lists_come_together(data: Path) -> None:
    found = trials(
        data,
        'files = "{subject}/{condition}_{trial}.csv"\ntable = "people.csv"\n'
        '[options]\nmotion = "{file}"\nside = "{side}"\nplace = ["{subject}.a", "b"]\nrate = 5\n'
        '[sweep]\nthreshold = [1, 4]\n[[leave_out]]\nsubject = "P1"\ncondition = "fast"\nthreshold = 4\n',
    )
    assert [one.name for one in found] == [
        f"{name} {side} {mass} {threshold}"
        for name, side, mass, threshold in (
            ("P1 fast 1", "left", 70.0, 1),
            ("P1 slow 1", "left", 70.0, 1),
            ("P1 slow 1", "left", 70.0, 4),
            ("P2 slow 1", "right", 80.0, 1),
            ("P2 slow 1", "right", 80.0, 4),
        )
    ]
    assert found[1].options == {
        "motion": "P1/slow_1.csv",
        "side": "left",
        "place": ["P1.a", "b"],
        "rate": 5,
        "threshold": 1,
    }


def test_lists_alone_give_all_combinations_and_numbers_stay_numbers(tmp_path: Path) -> None:
    found = trials(tmp_path, '[options]\nrate = "{rate}"\n[vary]\nsubject = ["A", "B"]\nrate = [1, 2.5]\n')
    assert [one.options["rate"] for one in found] == [1, 2.5, 1, 2.5]


def test_trials_that_are_listed_have_options_of_their_own(data: Path) -> None:
    found = trials(
        data,
        'table = "people.csv"\n[options]\nmotion = "{subject}/{walk}.csv"\nrate = 5\n[sweep]\nthreshold = [1, 4]\n'
        '[[trials]]\nsubject = "P1"\nwalk = "a"\n'
        '[[trials]]\nsubject = "P2"\nwalk = "b"\noptions = { rate = 2, map = "rz={side}" }\n',
    )
    assert [(one.name, one.options["threshold"]) for one in found] == [
        (f"{name} {threshold}", threshold) for name in ("P1 a left 70.0", "P2 b right 80.0") for threshold in (1, 4)
    ]
    assert found[0].options == {"motion": "P1/a.csv", "rate": 5, "threshold": 1}
    assert found[2].options == {"motion": "P2/b.csv", "rate": 2, "map": "rz=right", "threshold": 1}


def test_braces_of_paths_are_doubled(tmp_path: Path) -> None:
    """Beside names, around them, and in the pattern of files; other signs of patterns are those of the path."""
    for name in ("run {1}/[a]?/P1_x.csv", "run {1}/[a]?/P2_x.csv", "run {2}/[a]?/P3_x.csv", "run {1}/ab/P4_x.csv"):
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).touch()
    found = trials(
        tmp_path,
        'files = "run {{1}}/[a]?/{subject}_x.csv"\n[options]\nmotion = "{file}"\nrate = 5\n'
        'names = ["{{subject}}", "{{{subject}}}", "{{}}", "{ {{a}"]\n',
    )
    assert [one.name for one in found] == ["P1", "P2"]
    assert found[0].options["motion"] == "run {1}/[a]?/P1_x.csv"
    assert found[0].options["names"] == ["{subject}", "{P1}", "{}", "{ {a}"]


@pytest.mark.parametrize("pattern", ["{subject}*.csv", "{subject}_{trial}*", "**_{subject}.csv", "*{subject}.csv"])
def test_a_wildcard_may_stand_beside_a_name(tmp_path: Path, pattern: str) -> None:
    (tmp_path / "P_1.csv").touch()
    found = trials(tmp_path, f'files = "{pattern}"\n[options]\nmotion = "{{file}}"\n')
    assert [one.options["motion"] for one in found] == ["P_1.csv"]


@pytest.mark.parametrize("text", ["a{b}c", "{", "}{", "{{x}}", "{{{", "plain", "{a}{b}", "{ a:b }"])
def test_a_literal_text_is_what_an_option_gets(tmp_path: Path, text: str) -> None:
    option = json.dumps([literal(text)])
    assert trials(tmp_path, f'[options]\nnames = {option}\n[vary]\na = ["1"]\n')[0].options["names"] == [text]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("option = 1", "option: is not known here; perhaps options"),
        ('files = "{subject}/none_{trial}.csv"', "`files`: no file fits '{subject}/none_{trial}.csv'"),
        ('files = "{subject}/*.csv"\n', "two trials are 'P1'; name what they differ in"),
        ('[options]\nmotion = "{who}.csv"\n[vary]\nsubject = ["A"]', "[options] motion: no trial has {who}; names are"),
        ('[vary]\nsubject = "A"', "[vary] subject: is not a list of values"),
        ('[vary]\nsubject = ["A", "A"]', "[vary] subject: has a value twice"),
        ('[vary]\nstate = ["A"]', "`state`: is a name that every study has"),
        ('[vary]\nsubject = ["A"]\n[[leave_out]]\nsubject = "A"', "every trial is left out"),
        ("[options]\nrate = 1\n[sweep]\nrate = [1, 2]", "[sweep] rate: is in [options] too"),
        ('[[trials]]\nsubject = "A"\n[[trials]]\nwalk = 2', "[[trials]] 2: 'subject' is not in all of them"),
        ('[[trials]]\nsubject = ["A"]', "[[trials]] 1 subject: ['A'] is not a value"),
        ("[[trials]]\noptions = 3", "[[trials]] 1 options: is not a table"),
        ("trials = 2", "trials: is not a list of tables; write it in double brackets"),
        ("[sweep]\nrate = [1, 2]\n[[trials]]\noptions = { rate = 1 }", "[sweep] rate: is in [options] too"),
        ('[summary]\nwho = "subject"', "[summary] who: is not known here"),
        ('files = "{subject}/{condition}_{trial}.csv"\ntable = "one.csv"', "one.csv: has no row for subject P2"),
        ('[options]\nsave_map = true\n[surface]\nparticles = "a"\nunit = []', "[surface] unit: [] is not a text"),
        ('[[leave_out]]\nsubject = ["A"]', "[[leave_out]] 1 subject: ['A'] is not a value"),
    ],
)
def test_what_cannot_be_is_one_line(data: Path, text: str, said: str) -> None:
    (data / "one.csv").write_text("subject,side\nP1,left\n", encoding="utf-8")
    with pytest.raises(InputError) as refused:
        trials(data, text)
    assert said in str(refused.value) and str(refused.value).startswith(str(data / "study.toml"))


def test_what_all_trials_share_is_looked_up_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """CodeSources and libraries: half a second that every trial would pay."""
    asked: list[str] = []
    code_version.cache_clear()
    monkeypatch.setattr(CodeSources, "digest", lambda self, module: asked.append(module) or "abc")
    (tmp_path / "a.txt").write_text("1")
    found = {address_of(quick, QuickOptions(Path("a.txt"), gain=gain), tmp_path, Digests()) for gain in (1.0, 2.0, 2.0)}
    code_version.cache_clear()
    assert len(found) == 2 and asked == ["tests.study.quick"]
