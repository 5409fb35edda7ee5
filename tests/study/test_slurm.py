"""The SLURM script of the documentation, with a program in place of sbatch that keeps what is submitted."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SBATCH = '#!/bin/sh\ncp "$1" "$(dirname "$0")/submitted.sh"\necho "Submitted batch job 7"\n'
GEOCONTACT = '#!/bin/sh\necho "$@" > "$(dirname "$0")/called.txt"\nsleep 1\n'


@pytest.mark.skipif(sys.platform == "win32", reason="SLURM is not there")
@pytest.mark.slow
def test_what_is_submitted_starts_one_worker_of_one_thread(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "how-to" / "cohort.md").read_text(encoding="utf-8")
    script = next(
        code for code in re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL) if "SLURMCluster" in code
    )
    for name, text in (("sbatch", SBATCH), ("scancel", "#!/bin/sh\n"), ("geocontact", GEOCONTACT)):
        (tmp_path / name).write_text(text, encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    environment = os.environ | {"PATH": f"{tmp_path}:{os.environ['PATH']}", "PYTHONWARNINGS": "ignore"}
    done = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    submitted = tmp_path / "submitted.sh"
    for _ in range(50):
        if submitted.exists():
            break
        time.sleep(0.1)
    job = submitted.read_text(encoding="utf-8")
    assert {"#SBATCH --cpus-per-task=1", "#SBATCH --mem=4G", "#SBATCH -t 04:00:00"} <= set(job.splitlines())
    worker = next(line for line in job.splitlines() if "tcp://" in line)
    called = (tmp_path / "called.txt").read_text(encoding="utf-8").split()
    assert called[3] in worker and called[2] == "--scheduler" and re.search(r"--nthreads 1\b", worker)
    assert "--nworkers" not in worker or re.search(r"--nworkers 1\b", worker)
    assert "export OMP_NUM_THREADS=1 NUMBA_NUM_THREADS=1" in job
