"""Jobs of a queueing system: a real SLURM on this machine, and the scripts that all four are given."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest

from geocontact.data.errors import InputError
from geocontact.study import cluster as clusters
from geocontact.study import workers
from geocontact.study.cluster import SYSTEMS, ClusterSettings, Jobs, job_options, job_size
from geocontact.study.description import read_study_file
from geocontact.study.limits import TrialLimits
from geocontact.study.options import QUEUES, CohortOptions
from tests.cli.calls import ROOT, call
from tests.study import slurm_host
from tests.study.quick import study, tables

dask = pytest.importorskip("dask", reason="needs the extra `cohort`")
pytest.importorskip("dask_jobqueue", reason="needs the extra `cohort`")

CLUSTER = ("[cluster]", "jobs = 2", 'memory = "1GB"', 'walltime = "00:10:00"')
GB = 1_000_000_000


@pytest.fixture(scope="module")
def slurm(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """A SLURM of its own, ended with the tests."""
    if why := slurm_host.missing():
        pytest.skip(why)
    with slurm_host.slurm(tmp_path_factory.mktemp("slurm")) as environment:
        yield environment


def start(file: Path, out: Path, environment: dict[str, str], *more: str) -> subprocess.Popen[str]:
    """A study in a process of its own."""
    command = [sys.executable, "cli.py", "cohort", str(file), "--run-simulator", "--out", str(out), *more]
    own = environment | {"PYTHONPATH": str(ROOT)}
    return subprocess.Popen(command, cwd=ROOT, env=own, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def nannies(folder: Path) -> list[psutil.Process]:
    """Processes that jobs of a study have started."""
    found = []
    for one in psutil.process_iter(["cmdline"]):
        words = one.info["cmdline"] or []
        if "distributed.cli.dask_worker" in words and str(folder) in " ".join(words):
            found.append(one)
    return found


@pytest.mark.slow
def test_a_study_on_slurm_whose_workers_are_killed_has_the_tables_of_an_undisturbed_one(
    tmp_path: Path, slurm: dict[str, str]
) -> None:
    """Of two jobs the processes of one are killed, and the other is cancelled; none is left at the end."""
    file, out = study(tmp_path, {f"S{k:02d}": f"{k} slow" for k in range(30)}, *CLUSTER), tmp_path / "out"
    running, disturbed = start(file, out, slurm, "--scheduler", "slurm"), []

    def disturb() -> None:
        slurm_host.wait_for(lambda: len(list(out.glob("results/*/trial.json"))) > 3 and len(nannies(out)) > 1, 300.0)
        job = nannies(out)[0]
        killed = job.environ()["SLURM_JOB_ID"]
        for one in [*job.children(recursive=True), job]:
            one.kill()
        disturbed.append("killed")
        ids = slurm_host.said_by(slurm, "squeue", "-h", "-o", "%i").split()
        slurm_host.said_by(slurm, "scancel", next(each for each in ids if each != killed))
        disturbed.append("cancelled")

    other = threading.Thread(target=disturb)
    other.start()
    said, complaints = running.communicate(timeout=500)
    other.join()
    assert running.returncode == 0 and disturbed == ["killed", "cancelled"], complaints
    assert "30 of 30 trials" in said and len(list((out / "jobs").glob("*.out"))) > 2
    slurm_host.wait_for(lambda: not slurm_host.said_by(slurm, "squeue", "-h", "-o", "%i"))
    plain = start(file, tmp_path / "plain", dict(os.environ), "--workers", "1")
    _, complaints = plain.communicate(timeout=300)
    assert plain.returncode == 0 and tables(out) == tables(tmp_path / "plain"), complaints


@pytest.mark.slow
def test_slurm_says_why_it_takes_no_job(tmp_path: Path, slurm: dict[str, str]) -> None:
    file = study(tmp_path, {"A": "1"}, *CLUSTER, 'queue = "nowhere"')
    running = start(file, tmp_path / "out", slurm, "--scheduler", "slurm")
    _, complaints = running.communicate(timeout=200)
    assert running.returncode == 2, complaints
    assert "--scheduler: no job was taken: sbatch: error: " in complaints
    assert "invalid partition" in complaints.lower()


SUBMITS = """#!/bin/bash
file=$1; [ -n "$file" ] || {{ file={folder}/piped.$$; cat > $file; }}
cp "$file" {folder}/script.$$; echo $$ >> {folder}/ids
setsid bash {folder}/script.$$ > {folder}/said.$$ 2>&1 &
echo $! > {folder}/pid.$$
echo "Submitted batch job $$"
"""
LISTS = "#!/bin/bash\ncat {folder}/ids\n"
CANCELS = "#!/bin/bash\nkill -- -$(cat {folder}/pid.$1)\n"
STAND_INS = {
    **dict.fromkeys(("sbatch", "qsub", "bsub"), SUBMITS),
    **dict.fromkeys(("squeue", "qstat", "bjobs"), LISTS),
    **dict.fromkeys(("scancel", "qdel", "bkill"), CANCELS),
}
"""Programs that run at once what is submitted."""


@pytest.fixture
def stand_ins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Their folder, which the path begins with."""
    folder = tmp_path / "bin"
    folder.mkdir()
    for name, text in STAND_INS.items():
        (folder / name).write_text(text.format(folder=folder), encoding="utf-8")
        (folder / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")
    return folder


def jobs(system: str, folder: Path, limits: TrialLimits, **more: Any) -> Jobs:
    """What a study submits."""
    settings = {"jobs": 3, "memory": "8GB", "queue": "short", "account": "knees", "walltime": "01:30:30"} | more
    return Jobs(system, ClusterSettings(**settings), limits, folder / "study.toml", folder)


DIRECTIVES = {
    "slurm": ("#SBATCH -p short", "#SBATCH -A knees", "#SBATCH --cpus-per-task=4", "#SBATCH --mem=8G", "-t 01:30:30"),
    "pbs": ("#PBS -q short", "#PBS -A knees", "select=1:ncpus=4:mem=7630MB", "#PBS -l walltime=01:30:30"),
    "lsf": ("#BSUB -q short", '#BSUB -P "knees"', "#BSUB -n 4", "#BSUB -M 8000000", "#BSUB -W 01:31"),
    "sge": ("#$ -q short", "#$ -P knees", "#$ -l h_rt=01:30:30"),
}
"""What the system's own manual calls 4 cores, 8 GB and 90.5 min; memory of LSF in kB, of the others in 2^30 or 2^20."""
posix = pytest.mark.skipif(sys.platform == "win32", reason="queueing systems are not there")


@posix
@pytest.mark.parametrize("system", list(SYSTEMS))
def test_a_job_asks_for_what_the_description_says(tmp_path: Path, stand_ins: Path, system: str) -> None:
    """4 cores for two trials of two cores each; the key is there for the user alone as long as the cluster is."""
    with dask.config.set({f"jobqueue.{system}.job-script-prologue": ["module load knees"]}):
        own = jobs(system, tmp_path, TrialLimits(None, 2 * GB, 2), cores=4)
    with own.started() as made:
        script, names = made.job_script(), list((tmp_path / "jobs").iterdir())
        modes, address = {file.stat().st_mode & 0o777 for file in names}, made.scheduler_address
    for line in DIRECTIVES[system]:
        assert line in script, (line, script)
    worker = next(line for line in script.splitlines() if "distributed.cli.dask_worker" in line)
    assert address.startswith("tls://") and "--tls-key" in worker and f"{tmp_path}/jobs/" in worker
    assert re.findall(r"--nthreads (\d)", worker)[-1] == "1" and "--nworkers 2 " in worker
    assert "--memory-limit 3.73GiB" in worker and "--no-dashboard" in worker  # 4 GB are 3.725 of 2^30
    assert " -P -m distributed.cli.dask_worker" in worker  # no module of the folder of the study
    assert script.index("unset PYTHONSAFEPATH") < script.index(worker)
    assert "module load knees" in script and "export OMP_NUM_THREADS=2 NUMBA_NUM_THREADS=2" in script
    assert modes == {0o600} and names and not list((tmp_path / "jobs").glob(".dask*"))


@posix
@pytest.mark.slow
@pytest.mark.parametrize("system", ["pbs", "lsf", "sge"])
def test_a_study_runs_by_jobs_of_other_systems(tmp_path: Path, stand_ins: Path, system: str) -> None:
    """Stand-ins for their programs run what is submitted; a job of two processes, since there are two cores in it."""
    file, out = study(tmp_path, {"A": "1", "B": "2"}, *CLUSTER, "cores = 2"), tmp_path / "out"
    found = call("cohort", file, "--run-simulator", "--scheduler", system, "--out", out, folder=out)
    assert found.code == 0 and "2 of 2 trials" in found.out, found.err
    assert len(list(stand_ins.glob("script.*"))) in (1, 2)


class Client:
    """One that has no worker."""

    scheduler = None

    def nthreads(self) -> dict[str, int]:
        return {}


class Queue:
    """Jobs that are listed or not."""

    refused = ""

    def __init__(self, *, listed: bool) -> None:
        self.listed, self.started = listed, 0

    def queued(self, cluster: object) -> bool:
        return self.listed


@pytest.mark.parametrize("listed", [True, False])
def test_a_study_waits_for_jobs_as_long_as_the_queue_lists_them(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], listed: bool
) -> None:
    monkeypatch.setattr(workers, "COUNTED", -1.0)
    queue: Any = Queue(listed=listed)
    found = workers.Workers(CohortOptions(Path("s.toml"), scheduler="slurm"), None, TrialLimits(), queue)
    found.client = Client()
    for _ in range(3):
        found._seen = time.monotonic() - workers.WORKERLESS - 1.0
        assert found.gone is not listed
        assert found.gone is not listed  # the next time within a minute
    found._seen = time.monotonic() - workers.WORKERLESS + 5.0
    assert not found.gone
    queue.refused = "sbatch: error: no"
    with pytest.raises(InputError, match="no job was taken: sbatch: error: no"):
        found.threads()


@pytest.mark.parametrize(
    ("settings", "limits", "said"),
    [
        ({"memory": None}, TrialLimits(), '[cluster] memory: is missing; add it: memory = "4GB"'),
        ({}, TrialLimits(cores=2), "[cluster] cores: a job has 1 of the 2 cores of a trial; write 2 or more"),
        ({}, TrialLimits(memory=5 * GB), "8 GB are less than 1 trials may take at their second try; write 10 GB"),
        (
            {},
            TrialLimits(time=3600.0),
            "[cluster] walltime: is shorter than the 7200 s that a trial may take at its second",
        ),
    ],
)
def test_limits_that_do_not_fit_into_a_job_are_refused(
    settings: dict[str, Any], limits: TrialLimits, said: str
) -> None:
    asked = ClusterSettings(**{"jobs": 1, "memory": "8GB", "walltime": "01:00:00"} | settings)
    with pytest.raises(InputError, match=re.escape(said)):
        job_size(asked, limits, Path("study.toml"))


def test_memory_of_a_job_has_room_for_second_tries_where_it_is_not_given(tmp_path: Path) -> None:
    """Dask ends a process at 95 % of its share: that is more than twice the limit, or Dask does not."""
    size = job_size(ClusterSettings(jobs=1, cores=9), TrialLimits(memory=GB, cores=3), Path("study.toml"))
    assert size.processes == 3 and 0.95 * size.memory > 6 * GB > 0.85 * size.memory
    for memory, ends in ((None, True), ("6GB", False), ("6.4GB", True)):
        asked, limits = ClusterSettings(jobs=1, cores=9, memory=memory), TrialLimits(memory=GB, cores=3)
        found = job_options("slurm", asked, limits, job_size(asked, limits, Path("study.toml")), tmp_path)
        said = "export DASK_DISTRIBUTED__WORKER__MEMORY__TERMINATE=False" in found["job_script_prologue"]
        assert said is not ends, memory


LISTINGS = {
    "slurm": "4711\n4712_3\n",
    "pbs": "Job id            Name    User\n----------------  ------  ----\n4711.node17       run_99  ann 12:30:00 R\n",
    "lsf": "JOBID   USER  STAT  QUEUE  SUBMIT_TIME\n4711    ann   RUN   short  Nov 28 12:30\n          16*host99\n",
    "sge": "job-ID  prior   name  user  submit/start at\n-----\n   4711 0.55500 run_99  ann  r  11/28/2026 12:30:00\n",
}


@pytest.mark.parametrize("system", list(SYSTEMS))
def test_only_the_first_column_of_a_queue_names_jobs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, system: str
) -> None:
    own = jobs(system, tmp_path, TrialLimits(None, 2 * GB))
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: SimpleNamespace(stdout=LISTINGS[system]))
    for number in ("4711", "99", "12", "28", "16", "17", "0", "2026", "55500", "30"):
        cluster = SimpleNamespace(workers={"0": SimpleNamespace(job_id=number)})
        assert own.queued(cluster) is (number == "4711"), number


ROWS = {
    "slurm": "4711 {}\n",
    "pbs": "4711.node17  geocontact  ann  00:00:00 {} short\n",
    "lsf": "4711    ann   {}   short  node1  node17  geocontact  Nov 28 12:30\n",
    "sge": "   4711 0.55500 geocontact ann  {}  11/28/2026 12:30:00  short@node17  1\n",
}
ALIVE = {"slurm": "PD CF R S", "pbs": "Q R H S W T", "lsf": "PEND RUN USUSP UNKWN", "sge": "qw hqw r t Rr s"}
DEAD = {"slurm": "CG F NF TO", "pbs": "E C F X", "lsf": "EXIT DONE ZOMBI", "sge": "Eqw EhRqw dr dRt"}
"""States by the manuals: a node that does not answer leaves its jobs completing, exiting or being deleted."""


@pytest.mark.parametrize("system", list(SYSTEMS))
def test_a_study_does_not_wait_for_jobs_that_are_listed_and_dead(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, system: str
) -> None:
    own, cluster = jobs(system, tmp_path, TrialLimits(None, 2 * GB)), {"0": SimpleNamespace(job_id="4711")}
    for states, expected in ((ALIVE, True), (DEAD, False)):
        for state in states[system].split():
            said = SimpleNamespace(stdout=ROWS[system].format(state))
            monkeypatch.setattr(subprocess, "run", lambda *_, said=said, **__: said)
            assert own.queued(SimpleNamespace(workers=cluster)) is expected, state


def test_a_queue_that_says_nothing_is_not_waited_for_longer_than_ten_minutes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def silent(*_: object, **__: object) -> None:
        raise subprocess.TimeoutExpired("squeue", 30.0)

    own, cluster = jobs("slurm", tmp_path, TrialLimits(None, 2 * GB)), {"0": SimpleNamespace(job_id="4711")}
    answers = subprocess.run
    monkeypatch.setattr(subprocess, "run", silent)
    now = time.monotonic() + 7200.0  # it is asked only where workers are gone, here after two hours of work
    for after, expected in ((0.0, True), (590.0, True), (610.0, False)):
        monkeypatch.setattr(time, "monotonic", lambda after=after: now + after)
        assert own.queued(SimpleNamespace(workers=cluster)) is expected, after
    monkeypatch.setattr(subprocess, "run", lambda *_, **__: SimpleNamespace(stdout="4711 R\n"))
    assert own.queued(SimpleNamespace(workers=cluster))
    monkeypatch.setattr(subprocess, "run", silent)
    assert own.queued(SimpleNamespace(workers=cluster))  # it has answered a moment ago
    monkeypatch.setattr(subprocess, "run", answers)


@posix
def test_a_queue_that_never_takes_a_job_ends_the_study_with_its_name(
    tmp_path: Path, stand_ins: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (stand_ins / "sbatch").write_text("#!/bin/bash\nexec sleep 60\n", encoding="utf-8")
    monkeypatch.setattr("geocontact.study.cluster.TAKES", 1.0)
    file = study(tmp_path, {"A": "1"}, *CLUSTER)
    found = call("cohort", file, "--run-simulator", "--scheduler", "slurm", "--out", tmp_path / "out")
    assert found.code == 2 and "no job was taken: sbatch has not answered for 1 s" in found.err


@pytest.mark.parametrize("key", ["queue", "account", "walltime"])
@pytest.mark.parametrize("text", ["a\nrm -rf ~", "$(rm)", "a; rm", "a b", "`rm`", '"', ""])
def test_no_text_of_a_description_reaches_a_shell(tmp_path: Path, key: str, text: str) -> None:
    shown = text.replace("\n", "\\n").replace('"', '\\"')
    file = study(tmp_path, {"A": "1"}, *[line for line in CLUSTER if key not in line], f'{key} = "{shown}"')
    with pytest.raises(InputError, match=rf"cluster[\] .]+{key}: "):
        read_study_file(file)


def test_jobs_need_a_description_and_the_programs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    given = ("--run-simulator", "--scheduler", "slurm", "--out", tmp_path / "out")
    refused = call("cohort", study(tmp_path, {"A": "1"}), *given)
    assert refused.code == 2 and "[cluster]: is missing, for slurm; add it: [cluster] jobs = 10" in refused.err
    monkeypatch.setenv("PATH", str(tmp_path))
    refused = call("cohort", study(tmp_path, {"A": "1"}, *CLUSTER), *given)
    assert refused.code == 2 and "--scheduler: sbatch is not on this machine" in refused.err
    refused = call("cohort", study(tmp_path, {"A": "1"}, *CLUSTER), *given, "--workers", "2")
    assert refused.code == 2 and "--workers: has no effect with --scheduler; write `jobs` into [cluster]" in refused.err


def test_options_name_every_queueing_system() -> None:
    assert set(QUEUES) == set(SYSTEMS)


@pytest.mark.parametrize(("posix", "command"), [(True, "timeout 60 sbatch "), (False, "sbatch")])
def test_timeout_is_a_program_of_posix(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, posix: bool, command: str
) -> None:
    """That of Windows waits for a key."""
    own = jobs("slurm", tmp_path, TrialLimits(None, 2 * GB))
    monkeypatch.setattr(clusters, "POSIX", posix)
    monkeypatch.setattr(clusters.shutil, "which", lambda name: f"/bin/{name}")
    noting = clusters._noting(own, type("Slurm", (), {"submit_command": "sbatch"}))
    assert noting.submit_command == command.replace("60", f"{clusters.TAKES:g}")  # type: ignore[attr-defined]
