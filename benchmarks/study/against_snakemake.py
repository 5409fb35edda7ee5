"""The chained study of `leg_chain` as a Snakefile: results, what is evaluated again after changes, what it costs.

`python -m benchmarks.study.against_snakemake --snakemake PATH` writes results/cohort_snakemake.json; Snakemake is
installed into an environment of its own, it is no dependency. The rules of `Snakefile` call the same commands. Both are
run from nothing; then, for each change, both are asked by a dry run what they would evaluate: after one subject's file,
after its time alone, after an option of the last step, after a line in a module that only `id` imports, and after a
digit of a kept file of an earlier step (its size and time stay). Overhead of Snakemake is that of its jobs beside the
same commands typed.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pandas as pd

from benchmarks.machine import write_results
from benchmarks.robustness.chain_faults import flipped
from benchmarks.study.leg_chain import MODEL, ROOT, STEPS, made, measured, name, swing

RULES = ROOT / "benchmarks" / "study" / "Snakefile"
OF_ID = "geocontact/analyses/motion/inverse_dynamics/result.py"
"""A module that of the three steps only `id` imports."""
SUBJECT = name(1)


def timed(words: Sequence[str], folder: Path) -> tuple[float, float, str]:
    """Wall and CPU seconds of a program and what it started, and what it wrote."""
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    done = subprocess.run(words, cwd=folder, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        raise SystemExit(f"{words[0]} ended with {done.returncode}: {done.stdout[-2000:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return time.perf_counter() - started, cpu, done.stdout


class Rules:
    """The study in Snakemake."""

    def __init__(self, program: Path, folder: Path) -> None:
        self._folder = folder
        self._words = [str(program), "--cores", "2", "--snakefile", "Snakefile"]
        self._tool = ["--config", f"geocontact={sys.executable} {ROOT / 'cli.py'}"]

    def run(self) -> tuple[float, float, str]:
        """Evaluate all."""
        return timed([*self._words, *self._tool], self._folder)

    def asked(self) -> dict[str, int]:
        """Jobs of each rule that a run would start."""
        _, _, told = timed([*self._words, "--dry-run", *self._tool], self._folder)
        counts = dict(re.findall(rf"^({'|'.join(STEPS)}) +(\d+)$", told, re.MULTILINE))
        return {step: int(counts.get(step, 0)) for step in STEPS}


def asked(file: Path, root: Path = ROOT) -> dict[str, int]:
    """Evaluations that are known to be missing; those that take from them are not known yet, and are counted too."""
    words = [sys.executable, str(root / "cli.py"), "cohort", str(file), "--out", str(file.parent / "out"), "--dry-run"]
    environment = {**os.environ, "PYTHONPATH": str(root)}
    told = subprocess.run(words, cwd=root, check=True, capture_output=True, text=True, env=environment).stdout
    return {step: int((re.findall(rf"^{step}\b.*?(\d+) to evaluate", told, re.MULTILINE) or [0])[0]) for step in STEPS}


def changes(study: Path, rules: Path) -> dict[str, Callable[[], Path]]:
    """What is changed in both, by name; each gives the checkout that our study is asked from."""

    def one_file() -> Path:
        for home in (study.parent, rules):
            swing(home / f"{SUBJECT}.mot", 1.5)
        return ROOT

    def its_time() -> Path:
        for home in (study.parent, rules):
            os.utime(home / f"{SUBJECT}.mot")
        return ROOT

    def an_option() -> Path:
        for file, old, new in (
            (study, 'ik.mot}", model', 'ik.mot}", cutoff = 5, model'),
            (rules / "Snakefile", "cutoff=6", "cutoff=5"),
        ):
            file.write_text(file.read_text(encoding="utf-8").replace(old, new), encoding="utf-8")
        return ROOT

    def a_module() -> Path:
        root = study.parent.with_name("checkout")
        shutil.copytree(ROOT / "geocontact", root / "geocontact")
        shutil.copy(ROOT / "cli.py", root)
        with (root / OF_ID).open("a", encoding="utf-8") as file:
            file.write("# changed\n")
        return root

    def a_digit() -> Path:
        rows = pd.read_csv(study.parent / "out" / "trials.csv")
        (place,) = rows[(rows["step"] == "ik") & (rows["name"] == SUBJECT)]["folder"]
        for file in (study.parent / "out" / str(place) / "ik.mot", rules / "ik" / SUBJECT / "ik.mot"):
            times = file.stat()
            flipped(file)
            os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))
        return ROOT

    return {
        "nothing": lambda: ROOT,
        "time of one subject's file": its_time,
        "one subject's file": one_file,
        "an option of the last step": an_option,
        "a module of the last step": a_module,
        "a digit of a kept file": a_digit,
    }


def compared(scratch: Path, snakemake: Path, subjects: int, tell: Callable[[dict[str, Any]], None]) -> None:
    """Both from nothing, the commands alone, then what each change asks for; each change is undone."""
    before, whole = scratch / "study", {}
    before.mkdir()
    whole["study"] = made(before, subjects)
    rules = scratch / "rules"
    shutil.copytree(before, rules)
    shutil.copy(RULES, rules)
    (rules / "study.toml").unlink()
    run = measured(whole["study"], before / "out", 2)
    found: dict[str, Any] = {"cohort": {"seconds": run.seconds, "cpu_seconds": run.cpu_seconds, "new": run.new}}
    seconds, cpu, _ = Rules(snakemake, rules).run()
    found["snakemake"] = {"seconds": seconds, "cpu_seconds": cpu}
    found["commands_typed_cpu_seconds"] = typed(rules, scratch / "typed")
    found["overhead_of_a_job_cpu_seconds"] = cpu / (len(STEPS) * subjects) - found["commands_typed_cpu_seconds"] / 3
    found["same"] = same(before / "out", rules)
    found["lines"] = {
        "study.toml": lines(whole["study"]),
        "Snakefile": lines(RULES),
    }
    tell(found)
    found["again"] = {}
    for change in changes(whole["study"], rules):
        copy = scratch / "changed"
        for place in (before, rules):
            shutil.copytree(place, copy / place.name)  # with the times of all files
        root = changes(copy / "study" / "study.toml", copy / "rules")[change]()
        ours = asked(copy / "study" / "study.toml", root)
        found["again"][change] = {"cohort": ours, "snakemake": Rules(snakemake, copy / "rules").asked()}
        shutil.rmtree(copy)
        tell(found)


def typed(rules: Path, scratch: Path) -> float:
    """CPU seconds of the three commands of one subject, typed."""
    tool = [sys.executable, str(ROOT / "cli.py")]
    scratch.mkdir()
    one = {
        "markers": (rules / f"{name(0)}.mot", []),
        "ik": (scratch / "markers" / "markers.trc", []),
        "id": (scratch / "ik" / "ik.mot", ["--cutoff=6"]),
    }
    return sum(
        timed(
            [*tool, step, str(file), f"--model={rules / MODEL}", "--parquet", f"--out={scratch / step}", *more], ROOT
        )[1]
        for step, (file, more) in one.items()
    )


def same(out: Path, rules: Path) -> bool:
    """Whether the moments of all subjects are the same numbers."""
    rows = pd.read_csv(out / "trials.csv")
    rows = rows[rows["step"] == "id"]
    pairs = [(out / str(row.folder), rules / "id" / str(row.subject)) for row in rows.itertuples()]
    return all(
        pd.read_parquet(a / "forces.parquet").equals(pd.read_parquet(b / "forces.parquet")) for a, b in pairs
    ) and bool(pairs)


def lines(file: Path) -> int:
    """Lines that somebody writes, without blank ones and comments."""
    text = [line.strip() for line in file.read_text(encoding="utf-8").splitlines()]
    return sum(bool(line) and not line.startswith("#") for line in text)


def main() -> None:
    """Both, on so many subjects."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--snakemake", type=Path, required=True)
    parser.add_argument("--subjects", type=int, default=3)
    asked_for = parser.parse_args()
    version = subprocess.run([asked_for.snakemake, "--version"], check=True, capture_output=True, text=True).stdout

    def tell(found: dict[str, Any]) -> None:
        print(found, flush=True)
        told = {"subjects": asked_for.subjects, "snakemake": version.strip()}
        write_results("cohort_snakemake", told, found, {"dask", "distributed"})

    with tempfile.TemporaryDirectory() as scratch:
        compared(Path(scratch), asked_for.snakemake, asked_for.subjects, tell)


if __name__ == "__main__":
    main()
