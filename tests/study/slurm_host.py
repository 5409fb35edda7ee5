"""SLURM on this machine: its three programs, started with a configuration of their own and ended."""

from __future__ import annotations

import os
import platform
import secrets
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "sinfo")
ELSEWHERE = "/usr/sbin:/usr/bin:/sbin:/bin"
READY = 40.0  # s

CONFIGURATION = """ClusterName=one
SlurmctldHost={host}(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmctldPort={control}
SlurmdPort={node}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
KillWait=2
NodeName={host} NodeAddr=127.0.0.1 CPUs={cores} RealMemory=4000 State=UNKNOWN
PartitionName=short Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


def missing() -> str:
    """Why SLURM cannot be started here; "" where it can."""
    found = [name for name in PROGRAMS if shutil.which(name, path=f"{os.environ['PATH']}:{ELSEWHERE}") is None]
    if found:
        return f"needs {', '.join(found)}: apt-get install slurmctld slurmd slurm-client munge"
    return "" if os.geteuid() == 0 else "only root starts slurmd"


def free_port() -> int:
    """One that nobody listens on."""
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return int(found.getsockname()[1])


@contextmanager
def slurm(folder: Path) -> Iterator[dict[str, str]]:
    """A cluster of one node, for as long as the block lasts; the environment in which its commands find it."""
    folder.chmod(0o755)
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(secrets.token_bytes(1024))
    key.chmod(0o600)
    file = folder / "slurm.conf"
    ports = {"control": free_port(), "node": free_port()}
    host = platform.node().partition(".")[0]
    text = CONFIGURATION.format(host=host, folder=folder, cores=os.cpu_count(), **ports)
    file.write_text(text, encoding="utf-8")
    environment = os.environ | {"SLURM_CONF": str(file), "PATH": f"{os.environ['PATH']}:{ELSEWHERE}"}
    own = {name: str(folder / f"munge.{name}") for name in ("socket", "pid", "log", "seed")}
    files = [f"--socket={own['socket']}", f"--pid-file={own['pid']}", f"--log-file={own['log']}"]
    commands = (
        ["munged", "--foreground", "--force", f"--key-file={key}", f"--seed-file={own['seed']}", *files],
        ["slurmctld", "-D", "-f", str(file)],
        ["slurmd", "-D", "-f", str(file)],
    )
    started = []
    try:
        for command in commands:
            with (folder / f"{command[0]}.said").open("wb") as said:
                started.append(subprocess.Popen(command, env=environment, stdout=said, stderr=said))
            if command[0] == "munged":
                wait_for(lambda: Path(own["socket"]).exists())
        wait_for(lambda: "idle" in said_by(environment, "sinfo", "-h", "-o", "%T"))
        yield environment
    finally:
        said_by(environment, "scancel", "--me")
        for one in reversed(started):
            one.terminate()
            try:
                one.wait(10.0)
            except subprocess.TimeoutExpired:
                one.kill()
                one.wait()


def said_by(environment: dict[str, str], *command: str) -> str:
    """What one of SLURM's commands prints; "" where it fails."""
    try:
        done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=20)
    except subprocess.TimeoutExpired:
        return ""
    return done.stdout if done.returncode == 0 else ""


def wait_for(ready: object, seconds: float = READY) -> None:
    """Until a function answers yes; TimeoutError where it does not."""
    assert callable(ready)
    end = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > end:
            raise TimeoutError
        time.sleep(0.2)
