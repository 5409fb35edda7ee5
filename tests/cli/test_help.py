"""Help and version are there at once; tests/house/test_light_imports.py keeps them light."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path

import pytest

from geocontact import __version__
from geocontact.analyses.catalogue import ENTRIES, GROUPS
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import declared
from geocontact.cli.main import OWN, app
from geocontact.cli.suggestions import commands
from tests.analyses.jobs import JOBS
from tests.cli.calls import ROOT, call

MOST_TOGETHER = 16

HELP = ("--help", "--version", "area --help", "gap diagnose --help", "shoulder simulate --help")


@pytest.mark.parametrize("arguments", HELP)
def test_help_takes_less_than_half_a_second_of_the_processor(arguments: str) -> None:
    pytest.importorskip("resource", reason="processor time of a child is measured on Unix")
    child = subprocess.Popen([sys.executable, "cli.py", *arguments.split()], cwd=ROOT, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0
    assert usage.ru_utime + usage.ru_stime < 0.5


def test_help_names_the_commands_and_every_option_of_the_contract() -> None:
    first = [line.strip("│ ").partition(" ")[0] for line in call("--help").out.splitlines()]
    assert {*OWN, *(entry.command.partition(" ")[0] for entry in ENTRIES if entry.command)} <= set(first)
    promised = (
        "motion unit threshold out osim joint moving map order angles sweep axis place-moving place-fixed convention "
        "side split medial region region-moving compare tolerance bounds save-map assume-closed parquet"
    )
    told = call("area", "--help").out
    assert not [option for option in promised.split() if f"--{option}" not in told]


def flat(text: str) -> str:
    """Help as one line, without frames."""
    return " ".join(text.replace("│", " ").split())


def test_help_shows_what_stands_between_angles_and_brackets() -> None:
    assert "trials/<id>.csv" in flat(call("gap", "gather", "--help").out)
    assert "[from.<trial>]" in flat(call("gap", "gather", "--help").out)
    assert "k [N/m^n] of every sphere" in flat(call("cop", "--help").out)


@pytest.mark.parametrize("group", [(), *((group.name,) for group in GROUPS)], ids=" ".join)
def test_every_command_says_what_it_does(group: tuple[str, ...]) -> None:
    told = flat(call(*group, "--help").out)
    of = app
    for name in group:
        of = of[name]
    for name in commands(of):
        assert of[name].help.splitlines()[0] in told, name
    assert flat(call(*group).out) == told


def test_options_stand_under_headings() -> None:
    told = call("area", "--help").out
    before, _, after = told.partition("─ Motion ─")
    assert "--unit" in before and "--osim" not in before
    motion, _, rest = after.partition("╭─")
    assert "--osim" in motion and "--modulus" not in motion
    assert "─ Pressure of an elastic layer ─" in rest


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.command)
def test_many_options_are_never_one_heap(job: Job) -> None:
    sections = Counter(one.section for one in declared(job.options))
    assert max(sections.values()) <= MOST_TOGETHER


@pytest.mark.parametrize("job", JOBS, ids=lambda job: job.command)
def test_help_names_no_other_unit_than_the_one_that_is_typed(job: Job) -> None:
    """A foot's length had [m] and, behind it, "mm unless a unit is written"."""
    for one in declared(job.options):
        typed = None if one.typed is None else re.match(r"(\w+) unless a unit is written", one.typed.hint)
        if typed is not None:
            assert set(re.findall(r"\[(\w+)\]", one.words)) <= {typed[1]}, f"{one.name}: {one.words}"


@pytest.mark.parametrize(
    ("typed", "line"),
    [
        ("aera", "aera is not a command; did you mean area?"),
        ("gap dignose x", "dignose is not a command of gap; did you mean diagnose?"),
        ("area --unti mm", "--unti is not an option of area; did you mean --unit?"),
        ("elbow fit a.csv --bootstrp=7 --out x", "--bootstrp is not an option of elbow fit; did you mean --bootstrap?"),
        ("area --zzzz mm", "--zzzz is not an option of area; see geocontact area --help"),
        ("--verison", "--verison is not an option of geocontact; did you mean --version?"),
        (
            "gap --sze 2",
            "--sze is not an option of geocontact gap; name the command before its options, see geocontact gap --help",
        ),
        ("elbow zzzz", "zzzz is not a command of elbow; there are simulate, fit, compare, design, population"),
        (
            "cop a.csv --out x",
            (
                "--motion is missing: poses of the foot in the ground's frame (.csv), or coordinates (.mot .sto) with "
                "--osim and --joint, or --map; see geocontact cop --help"
            ),
        ),
        (
            "id a.mot --out x",
            "--model is missing: OpenSim model (.osim): masses, inertias, joints; see geocontact id --help",
        ),
        ("fit a.stl --unit mm --out x", "--shape is missing: what is fitted; see geocontact fit --help"),
    ],
)
def test_what_was_mistyped_is_told_in_one_line(typed: str, line: str) -> None:
    result = call(*typed.split())
    assert (result.code, result.err.splitlines(), result.out) == (2, [line], "")


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish", "powershell"])
def test_shells_complete_commands_and_options(shell: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    file = tmp_path / "completion"
    assert call("--install-completion", "--shell", shell, "--output", file).code == 0
    script = file.read_text(encoding="utf-8")
    assert all(word in script for word in ("loadcells", "discriminability", "assume-closed", "grood-suntay"))


@pytest.mark.skipif(shutil.which("bash") is None, reason="asks a shell")
def test_bash_completes_a_choice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    file = tmp_path / "completion"
    call("--install-completion", "--shell", "bash", "--output", file)
    asked = f"source {file}; COMP_WORDS=(geocontact area --rule cl); COMP_CWORD=3; COMP_TYPE=9; _geocontact; "
    told = subprocess.run(["bash", "-c", asked + 'echo "${COMPREPLY[@]}"'], capture_output=True, text=True)
    assert told.stdout.split() == ["clip"], told.stderr


def test_version() -> None:
    result = call("--version")
    assert (result.code, result.out.strip(), result.err) == (0, __version__, "")
