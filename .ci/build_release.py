"""Build wheel and sdist of a commit, and show that they can be built again byte for byte.

`python .ci/build_release.py FOLDER` builds both of HEAD, in a folder of their own and with the time of the commit as
SOURCE_DATE_EPOCH; then both again elsewhere, and the wheel from the unpacked sdist. FOLDER gets the two files and
SHA256SUMS. Exit code 1 where one of them differs. Needs hatchling, which `make test` installs.
"""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SUMS = "SHA256SUMS"
BOTH = ("wheel", "sdist")


def built(source: Path, target: Path, kinds: tuple[str, ...] = BOTH, epoch: int | None = None) -> list[Path]:
    """Files of these kinds, built from a folder of sources into `target`, in the order of their names."""
    options = [word for kind in kinds for word in ("-t", kind)]
    dated = {} if epoch is None else {"SOURCE_DATE_EPOCH": str(epoch)}
    command = [sys.executable, "-m", "hatchling", "build", *options, "-d", str(target.resolve())]
    done = subprocess.run(command, check=False, cwd=source, env=os.environ | dated, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"building {', '.join(kinds)} in {source}: {done.stdout}{done.stderr}")
    return sorted(file for file in target.iterdir() if file.suffix in (".whl", ".gz"))


def unpacked(archive: Path, folder: Path) -> Path:
    """The one folder that an sdist holds."""
    extract(archive, folder)
    (found,) = folder.iterdir()
    return found


def extract(archive: Path, folder: Path) -> None:
    """Unpack an archive that was built here; Python's filter is there from 3.11.4 on, Debian 12 has 3.11.2."""
    with tarfile.open(archive) as content:
        if hasattr(tarfile, "data_filter"):
            content.extraction_filter = staticmethod(tarfile.data_filter)
        content.extractall(folder)  # noqa: S202 - of our own sources


def sums(files: list[Path]) -> dict[str, str]:
    """SHA-256 by name."""
    return {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}


def checked_out(folder: Path) -> Path:
    """What HEAD holds, without anything that lies about in the checkout."""
    archive = folder.with_suffix(".tar")
    git("archive", "-o", str(archive), "HEAD")
    folder.mkdir()
    extract(archive, folder)
    return folder


def git(*words: str) -> str:
    """What git says of this checkout."""
    command = [shutil.which("git") or "git", *words]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout


def main() -> int:
    """Build, build again, compare, and write down what came of it."""
    if len(sys.argv) != 2:
        sys.exit("usage: python .ci/build_release.py FOLDER")
    target = Path(sys.argv[1])
    target.mkdir(parents=True, exist_ok=True)
    if any(target.iterdir()):
        sys.exit(f"{target} is not empty; name another folder")
    epoch = int(git("log", "-1", "--format=%ct"))
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        first = sums(built(checked_out(scratch / "one"), target, epoch=epoch))
        again = sums(built(checked_out(scratch / "other"), scratch / "again", epoch=epoch))
        (scratch / "sdist").mkdir()
        source = unpacked(next(target.glob("*.tar.gz")), scratch / "sdist")
        from_sdist = sums(built(source, scratch / "from_sdist", ("wheel",), epoch))
    for file, digest in first.items():
        print(f"{digest}  {file}")
    (target / SUMS).write_text("".join(f"{d}  {f}\n" for f, d in first.items()), encoding="utf-8")
    differs = [file for found in (again, from_sdist) for file in found if found[file] != first[file]]
    if differs:
        print(f"built again, {', '.join(differs)} differs", file=sys.stderr)
        return 1
    print("built twice, and the wheel from the sdist: the same bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
