"""Write the part of requirements.lock that the core package and its build need: pins and hashes unchanged.

pip resolves the direct requirements of pyproject.toml against the versions of the lock, without installing anything,
and reports what it would install; these entries of the lock go to standard output.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterable, Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ONLY_TO_BUILD = frozenset({"cython"})
"""Required by a package of the core that does not import it: python-fcl is compiled with it, and its wheel is that."""


def normalised(name: str) -> str:
    """Project name as comparisons want it."""
    return re.sub(r"[-_.]+", "-", name).lower()


def entries(lock: str) -> Iterator[tuple[str, str]]:
    """Name and text of each entry: a line with the pin, indented lines with its hashes."""
    for text in re.findall(r"^\S.*\n(?:[ \t]+.*\n)*", lock, re.MULTILINE):
        if name := re.match(r"[A-Za-z0-9][A-Za-z0-9._-]*", text):
            yield normalised(name[0]), text


def pins(lock: str) -> str:
    """The lock without hashes, as constraints."""
    return "".join(text.split("\\\n")[0].rstrip() + "\n" for _, text in entries(lock))


def subset(lock: str, wanted: Iterable[str]) -> str:
    """Entries of these names; one that is missing is an error."""
    names = {normalised(name) for name in wanted}
    if missing := names - {name for name, _ in entries(lock)}:
        sys.exit(f"requirements.lock lacks {', '.join(sorted(missing))}: make lock")
    return "".join(text for name, text in entries(lock) if name in names)


def needed(requirements: list[str], constraints: str) -> list[str]:
    """Names of all packages that these requirements bring with them on this machine."""
    with tempfile.TemporaryDirectory() as folder:
        file, report = Path(folder, "pins.txt"), Path(folder, "report.json")
        file.write_text(constraints, encoding="utf-8")
        command = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--no-input", "install", "--quiet"]
        options = [
            "--dry-run",
            "--ignore-installed",
            "--only-binary=:all:",
            f"--report={report}",
            f"--constraint={file}",
        ]
        subprocess.run([*command, *options, *requirements], check=True, stdout=sys.stderr)
        found = json.loads(report.read_text(encoding="utf-8"))["install"]
    return [package["metadata"]["name"] for package in found]


def main() -> None:
    """Print the core's part of the lock."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    direct = [*project["project"]["dependencies"], *project["dependency-groups"]["build"]]
    lock = (ROOT / "requirements.lock").read_text(encoding="utf-8")
    wanted = {normalised(name) for name in needed(direct, pins(lock))} - ONLY_TO_BUILD
    sys.stdout.write(subset(lock, wanted))


if __name__ == "__main__":
    main()
