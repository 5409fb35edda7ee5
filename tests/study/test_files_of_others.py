"""A study, a run.json or another user of the machine cannot start code, nor keep a study waiting."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pandas as pd
import psutil
import pytest

from geocontact.analyses.frame.consent import require_consent
from geocontact.analyses.frame.table_forms import TableForms
from geocontact.data.errors import InputError
from geocontact.study import workers
from geocontact.study.options import CohortOptions
from tests.cli.calls import ROOT, Call, call
from tests.study.quick import study

STRANGER = """import asyncio, os, sys
from distributed.comm import connect
from distributed.security import Security
async def tried(address, security):
    try:
        await asyncio.wait_for(connect(address, timeout=3, **security.get_connection_args("client")), 5)
    except Exception:
        return
    print("open", flush=True)
async def main():
    own = Security.temporary()
    for address in sys.argv[1:]:
        await tried(address.replace("tls", "tcp"), Security())
        await tried(address, own if address.startswith("tls") else Security())
asyncio.run(main())
os._exit(0)
"""
"""What another user of the machine would do: connect without certificates, then with some of its own."""


def listening() -> set[int]:
    """Ports on which this process and its children wait for others."""
    me = psutil.Process()
    return {
        each.laddr.port
        for one in (me, *me.children(recursive=True))
        for each in one.net_connections("tcp")
        if each.status == psutil.CONN_LISTEN
    }


def intruder(*addresses: str) -> str:
    """What a stranger's program finds open of schedulers and workers at these addresses."""
    command = [sys.executable, "-W", "ignore", "-c", STRANGER, *addresses]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=200).stdout


@pytest.mark.slow
def test_processes_of_a_study_refuse_other_users_of_the_machine(scheduler: str) -> None:
    """Each port of scheduler, worker and nanny; the fixture's scheduler, which is open, shows that the attack works."""
    assert intruder(scheduler) == "open\nopen\n"
    before = listening()
    with workers.workers_of(CohortOptions(Path("s.toml"), workers=1)) as found:
        assert found.client.submit(sum, [20, 22]).result() == 42
        ports = listening() - before
        assert len(ports) >= 3
        assert intruder(*(f"tls://127.0.0.1:{port}" for port in ports)) == ""


@pytest.mark.slow
def test_workers_that_end_at_once_do_not_keep_a_study_waiting(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One worker, whose process two of the trials end at once: it is started anew, and the other trials are done."""
    monkeypatch.setattr(workers, "WORKERLESS", 3.0)
    file = study(tmp_path, {"A": "1", "B": "2 kills", "C": "3 kills", "D": "4"})
    started = time.monotonic()
    done = call("cohort", file, "--run-simulator", "--workers", "1", "--out", tmp_path / "out", folder=tmp_path / "out")
    assert list(done.table("trials.csv")["state"]) == ["done", "set aside", "set aside", "done"], done.err
    assert time.monotonic() - started < 240.0


class Lost:
    """A client whose workers are all gone, and which gives out tasks that never end."""

    scheduler = None

    def nthreads(self) -> dict[str, int]:
        return {}

    def submit(self, *task: Any, **_: Any) -> object:
        return object()


def test_without_workers_they_are_started_anew_then_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    started = []

    def start(self: workers.Workers) -> None:
        self.client = Lost()
        self._seen = time.monotonic()
        started.append(self)

    monkeypatch.setattr(workers, "WORKERLESS", 0.0)
    monkeypatch.setattr(workers, "_ended", lambda client, futures: time.sleep(0.01) or [])
    monkeypatch.setattr(workers.Workers, "start", start)
    task: Any = object()
    with (
        workers.workers_of(CohortOptions(Path("s.toml"), workers=1)) as found,
        pytest.raises(OSError, match="no worker is left; finished trials stay: run it again"),
    ):
        list(workers.outcomes(found, [task]))
    assert len(started) == 1 + workers.STARTS


CASE = """format = 1
system = "command"
simulate = "{python} {script} {{params}} {{trial}} {{out}}"
inputs = ["angle"]
outputs = ["torque"]
calibration = ["t1", "t2"]
evaluation = ["t3", "t4"]
[parameters.k]
start = 50.0
lower = 10.0
upper = 200.0
unit = "N m/rad"
"""


def case(folder: Path, system: str = "") -> tuple[Path, Path]:
    """A stranger's case whose program, or module, leaves a file behind; that file."""
    left, script = folder / "started", folder / "program.py"
    script.write_text(f"open({str(left)!r}, 'w').close()\n", encoding="utf-8")
    home = folder / "case"
    (home / "trials").mkdir(parents=True)
    for k in range(1, 5):
        rows = "\n".join(f"{0.1 * i:.1f},{0.1 * i * k % 0.7:.3f},{5.0 * (0.1 * i * k % 0.7):.3f}" for i in range(40))
        (home / f"trials/t{k}.csv").write_text(f"time [s],angle [rad],torque [N m]\n{rows}\n", encoding="utf-8")
    text = CASE.format(python=sys.executable, script=script)
    if system:
        (folder / "strangers_module.py").write_text(script.read_text(encoding="utf-8"), encoding="utf-8")
        lines = [line for line in text.splitlines() if not line.startswith(("simulate", "inputs", "outputs"))]
        text = "\n".join(lines).replace('"command"', f'"{system}"') + "\n"
    (home / "case.toml").write_text(text, encoding="utf-8")
    return home, left


SYSTEMS = ("", "strangers_module:MODEL")


def tried(folder: Path, *more: str) -> dict[str, Call]:
    """A study and a run.json that would start what the case names, with whatever they say about it themselves."""
    file, run = folder / "study.toml", folder / "run.json"
    options = {"case": "case", "bare": True, "run_simulator": True}
    listed = "\n".join(f"{name} = {json.dumps(value)}" for name, value in options.items())
    file.write_text(f'analysis = "gap diagnose"\n[options]\n{listed}\n', encoding="utf-8")
    told = {"command": "gap diagnose", "options": options, "options_si": options, "inputs": []}
    run.write_text(json.dumps(told), encoding="utf-8")
    out = folder / "out"
    return {
        "rerun": call("rerun", run, *more),
        "cohort": call("cohort", file, *more, "--workers", "1", "--out", out, folder=out),
    }


@pytest.mark.parametrize("system", SYSTEMS, ids=["program", "module"])
def test_no_file_starts_what_it_names_by_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, system: str) -> None:
    monkeypatch.chdir(tmp_path)
    _, left = case(tmp_path, system)
    for name, found in tried(tmp_path).items():
        assert found.code == 2 and "would start the " in found.err, (name, found.err)
        assert "pass --run-simulator if you trust it" in found.err and found.err.count("\n") == 1
    assert not left.exists() and not (tmp_path / "out").exists()


@pytest.mark.slow
@pytest.mark.parametrize("system", SYSTEMS, ids=["program", "module"])
def test_what_the_call_allows_is_named_and_started(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, system: str
) -> None:
    """The program writes nothing, the module has no model: both are refused, after they were started."""
    monkeypatch.chdir(tmp_path)
    _, left = case(tmp_path, system)
    found = tried(tmp_path, "--run-simulator")
    assert left.exists()
    for name, one in found.items():
        assert "starts the " in one.out + one.err and "would start" not in one.err, (name, one.err)


def test_an_analysis_in_a_module_of_others_is_not_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "strangers_analysis.py").write_text("raise SystemExit('imported')\n", encoding="utf-8")
    (tmp_path / "study.toml").write_text('analysis = "strangers_analysis:JOB"\n', encoding="utf-8")
    refused = call("cohort", tmp_path / "study.toml", "--out", tmp_path / "out")
    assert refused.code == 2 and "would start the module of 'strangers_analysis:JOB'" in refused.err


def test_consent_names_what_is_started() -> None:
    assert require_consent([], False, "run.json") == ""
    assert require_consent(["a", "b", "a", "c", "d"], True, "run.json") == "starts a, b, c and 1 more"
    with pytest.raises(InputError, match=r"^run\.json: would start a; pass `run_simulator` if you trust it$"):
        require_consent(["a"], False, "run.json")


FORMULAS = ["=1+1", "+cmd|' /C calc'!A0", "-2+3", "@x", "\tHELLO"]


def test_texts_that_a_spreadsheet_would_run_are_quoted_on_request(tmp_path: Path) -> None:
    """Names of trials, by the csv module; numbers, negative ones too, stay numbers; without the option, texts too."""
    rows = [{"name [-]": text, "force [N]": -1.5 - k, text: "a, b"} for k, text in enumerate(FORMULAS)]
    table = pd.DataFrame(rows).fillna("")
    file = tmp_path / "t.csv"
    table.to_csv(file, index=False)
    plain = file.read_bytes()
    TableForms().write({}, tmp_path, "area")
    assert file.read_bytes() == plain
    TableForms(excel_safe=True).write({}, tmp_path, "area")
    with file.open(encoding="utf-8", newline="") as stream:
        head, *found = csv.reader(stream)
    assert head[2:] == [f"'{text}" for text in FORMULAS] and head[:2] == ["name [-]", "force [N]"]
    assert [row[0] for row in found] == [f"'{text}" for text in FORMULAS]
    assert [float(row[1]) for row in found] == [-1.5, -2.5, -3.5, -4.5, -5.5]
    again = file.read_bytes()
    TableForms(excel_safe=True).write({}, tmp_path, "area")
    assert file.read_bytes() == again  # what is quoted stays


def test_a_command_quotes_them(tmp_path: Path, scheduler: str) -> None:
    """A subject whose name, that of a file, is a formula."""
    file, out = study(tmp_path, {"=1+1": "1", "B": "2"}), tmp_path / "out"
    given = ("--run-simulator", "--scheduler", scheduler, "--out", out)
    assert call("cohort", file, *given, folder=out).code == 0
    assert "\n=1+1,=1+1," in (out / "trials.csv").read_text(encoding="utf-8")
    assert call("cohort", file, *given, "--excel-safe", folder=out).code == 0
    text = (out / "trials.csv").read_text(encoding="utf-8")
    assert "\n'=1+1,'=1+1," in text and "\n=" not in text and ",=" not in text
    assert json.loads((out / "run.json").read_text(encoding="utf-8"))["options"]["excel_safe"] is True


def refused_in_a_line(*words: object) -> str:
    """What a command says that refuses its input in one line."""
    found = call(*words)
    assert found.code == 2 and len(found.complaints) == 1 and found.err.count("\n") == 1, found.err
    return found.err


LAUGHS = "".join(f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 12))
BOMB = f'<?xml version="1.0"?><!DOCTYPE a [<!ENTITY l0 "ha">{LAUGHS}]><OpenSimDocument>&l11;</OpenSimDocument>'
OUTSIDE = (
    '<?xml version="1.0"?><!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]><OpenSimDocument>&x;</OpenSimDocument>'
)


@pytest.mark.parametrize("text", [BOMB, OUTSIDE], ids=["bomb", "external entity"])
def test_entities_of_models_and_set_ups_are_refused(tmp_path: Path, text: str) -> None:
    file = tmp_path / "stranger.osim"
    file.write_text(text, encoding="utf-8")
    out = ("--out", tmp_path / "out")
    assert "stranger.osim" in refused_in_a_line("markers", ROOT / "meshes/leg_swing.mot", "--model", file, *out)
    assert "stranger.osim" in refused_in_a_line("ik", "--setup", file, *out)
    assert not (tmp_path / "out").exists()


def test_a_set_up_that_is_not_utf_8_is_refused_in_a_line(tmp_path: Path) -> None:
    file = tmp_path / "setup.xml"
    file.write_bytes(b"<OpenSimDocument><name>Ger\xe4t</name><a/></OpenSimDocument>")
    found = call("ik", "--setup", file, "--out", tmp_path / "out")
    first, *rest = found.err.splitlines()
    assert found.code == 2 and len(rest) == 1 and "osim_xml.py" not in found.err, found.err
    assert first.startswith("warning: ") and first.endswith("byte 26 is not UTF-8; the file is read as Latin-1")


def test_a_c3d_that_claims_much_takes_little(tmp_path: Path) -> None:
    """65535 points in 65534 frames, in 2 kB."""
    head = bytearray(2048)
    head[0:2] = bytes([2, 0x50])
    head[2:4] = head[4:6] = (65535).to_bytes(2, "little")
    head[6:8], head[8:10] = (1).to_bytes(2, "little"), (65534).to_bytes(2, "little")
    file = tmp_path / "claims.c3d"
    file.write_bytes(head)
    before = psutil.Process().memory_info().rss
    refused_in_a_line("ik", file, "--model", ROOT / "meshes/leg.osim", "--out", tmp_path / "out")
    assert psutil.Process().memory_info().rss - before < 300e6


def test_a_file_behind_a_link_in_the_results_is_kept(tmp_path: Path) -> None:
    """The link is replaced, what it leads to stays."""
    mesh, out, other = ROOT / "meshes/sphere_r18.stl", tmp_path / "out", tmp_path / "other.json"
    words = ("fit", mesh, "--unit", "mm", "--shape", "sphere", "--out", out)
    assert call(*words).code == 0
    other.write_text("mine", encoding="utf-8")
    (out / "fit.json").unlink(missing_ok=True)
    (out / "fit.json").symlink_to(other)
    call(*words)
    assert other.read_text(encoding="utf-8") == "mine"


def test_a_summary_names_a_table_and_no_path(tmp_path: Path, scheduler: str) -> None:
    given = ("--run-simulator", "--scheduler", scheduler, "--out", tmp_path / "out")
    pd.DataFrame({"secret": [1.0]}).to_parquet(tmp_path / "elsewhere.parquet")
    file = study(tmp_path, {"A": "1"}, "[summary]", 'table = "../../../elsewhere"')
    refused = call("cohort", file, *given)
    assert refused.code == 2 and "'../../../elsewhere' is not the name of a table" in refused.err
    assert "secret" not in refused.err


def test_names_of_trials_are_no_paths(tmp_path: Path, scheduler: str) -> None:
    """Folders have the names of digests, whatever a trial is called."""
    out = tmp_path / "deep" / "out"
    listed = '[[trials]]\nsubject = "../../../escaped"\noptions = { file = "A.txt" }'
    (tmp_path / "A.txt").write_text("1", encoding="utf-8")
    file = tmp_path / "study.toml"
    file.write_text(f'analysis = "tests.study.quick:quick"\n{listed}\n', encoding="utf-8")
    done = call("cohort", file, "--run-simulator", "--scheduler", scheduler, "--out", out, folder=out)
    assert done.code == 0, done.err
    assert {each.name for each in tmp_path.iterdir()} == {"A.txt", "study.toml", "deep"}
    assert [each.name for each in (tmp_path / "deep").iterdir()] == ["out"]


PAGE = {
    "name a program": "tests/io/test_gap_case.py::test_a_program_is_not_run_unasked",
    "name a module of Python": "tests/systems/test_own_model.py::test_code_in_the_folder_of_a_case_is_not_run",
    "allow it itself": "tests/study/test_files_of_others.py::test_no_file_starts_what_it_names_by_itself",
    "lead out of their folder": "tests/study/test_store.py::test_a_table_elsewhere_is_refused",
    "a pipe, a device": "tests/io/test_preflight.py::test_commands_refuse_pipes_and_devices",
    "a script or an address": "tests/view/page/test_write.py::test_hostile_texts_change_no_element",
    "cells that begin with": "tests/study/test_files_of_others.py::test_a_command_quotes_them",
    "show folders of your machine": "tests/cli/test_opensim_setup.py::test_what_is_written_is_read_back",
}
"""Words of each row of the page, and the test that holds it."""


HERE = "tests/study/test_files_of_others.py::"
ATTACKS = {
    "rerun starts the program of a case": f"{HERE}test_no_file_starts_what_it_names_by_itself",
    "cohort starts it": f"{HERE}test_no_file_starts_what_it_names_by_itself",
    "a case names a program": "tests/io/test_gap_case.py::test_a_program_is_not_run_unasked",
    "a module beside the study": f"{HERE}test_an_analysis_in_a_module_of_others_is_not_imported",
    "a signal.py in the current folder": "tests/study/test_current_folder.py::test_workers_of_a_study",
    "other users reach the workers": f"{HERE}test_processes_of_a_study_refuse_other_users_of_the_machine",
    "they reach jobs": "tests/study/test_jobs.py::test_a_job_asks_for_what_the_description_says",
    "[cluster] speaks to a shell": "tests/study/test_jobs.py::test_no_text_of_a_description_reaches_a_shell",
    "tables of a kept result": "tests/study/test_store.py::test_a_table_elsewhere_is_refused",
    "a kept result that is none": "tests/study/test_store.py::test_what_describes_no_trial_is_refused_in_a_line",
    "inputs of a kept result": "tests/study/test_store.py::test_inputs_that_would_be_waited_for_are_not_opened",
    "the table of a summary": f"{HERE}test_a_summary_names_a_table_and_no_path",
    "a name is a path": "tests/analyses/test_written_results.py::test_a_name_that_leads_elsewhere_is_refused",
    "a trial's name is a path": f"{HERE}test_names_of_trials_are_no_paths",
    "XML bomb, external entity": f"{HERE}test_entities_of_models_and_set_ups_are_refused",
    "pipe as .osim, set-up, run.json, .csv": "tests/io/test_preflight.py::test_commands_refuse_pipes_and_devices",
    "/dev/zero as .osim, run.json": "tests/io/test_preflight.py::test_commands_refuse_pipes_and_devices",
    ".c3d that claims much": f"{HERE}test_a_c3d_that_claims_much_takes_little",
    "out is a link": f"{HERE}test_a_file_behind_a_link_in_the_results_is_kept",
    "script in a name": "tests/view/page/test_write.py::test_hostile_texts_change_no_element",
    "cells that begin with =": f"{HERE}test_a_command_quotes_them",
    ".xlsx that unpacks to much": "tests/io/test_preflight.py::test_a_workbook_that_unpacks_to_too_much_is_refused",
    "set-up that is not UTF-8": f"{HERE}test_a_set_up_that_is_not_utf_8_is_refused_in_a_line",
    "absolute paths in set-ups": "tests/cli/test_opensim_setup.py::test_what_is_written_is_read_back",
}
"""What was tried in the study of security, and the test that shows what happens."""


@pytest.mark.parametrize("attack", ATTACKS)
def test_every_attack_has_its_test(attack: str) -> None:
    file, _, name = ATTACKS[attack].partition("::")
    assert f"def {name}(" in (ROOT / file).read_text(encoding="utf-8")


def test_every_line_of_the_page_has_its_test() -> None:
    text = (ROOT / "docs/reference/files_of_others.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| ")][1:]
    assert len(rows) == len(PAGE)
    for row, (words, place) in zip(rows, PAGE.items(), strict=True):
        file, _, name = place.partition("::")
        assert words in row and f"def {name}(" in (ROOT / file).read_text(encoding="utf-8"), row
