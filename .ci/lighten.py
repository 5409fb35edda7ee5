"""Remove from a virtual environment what its packages brought and no program reads: their own tests, and what serves to
build C++ against them.

`.venv/bin/python .ci/lighten.py` goes through the files that pip has listed for each package. `make demo` runs it, `pip
install .` does not. Packages stay whole for pip: it removes and replaces them as before.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from importlib.metadata import Distribution, distributions
from pathlib import Path, PurePosixPath

TESTS = "tests"
BUILT_AGAINST = ("include", "lib64", "share")
"""Folders beside the packages, where a wheel puts headers, static libraries and their documentation."""
STATIC = (".a", ".lib")


def unread(name: PurePosixPath) -> bool:
    """Whether a file of a wheel, from the folder of the packages, is a test or serves to build against the package."""
    folders = name.parts[:-1]
    inside = bool(folders) and ".." not in folders
    return inside and (TESTS in folders[1:] or folders[0] in BUILT_AGAINST or name.suffix in STATIC)


def files_of(package: Distribution) -> Iterator[Path]:
    """Places of the files that can go."""
    for name in package.files or ():
        if unread(PurePosixPath(name.as_posix())):
            yield Path(str(package.locate_file(name)))


def main() -> None:
    """Remove them, and say how much that was."""
    removed, folders = 0, set[Path]()
    for package in distributions():
        for file in files_of(package):
            if file.is_relative_to(sys.prefix) and file.is_file():
                removed += file.stat().st_size
                file.unlink()
                folders.add(file.parent)
    above = {each for folder in folders for each in (folder, *folder.parents) if each.is_relative_to(sys.prefix)}
    for folder in sorted(above, key=lambda each: -len(each.parts)):  # what lies in another one before it
        if not any(folder.iterdir()):
            folder.rmdir()
    print(f"{removed / 1e6:.0f} MB of tests and build files of packages are removed", file=sys.stderr)


if __name__ == "__main__":
    main()
