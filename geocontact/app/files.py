"""Contents of files, found in a process of its own: a large or damaged file stops nothing."""

from __future__ import annotations

import json
import subprocess
import sys
import warnings
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from geocontact.analyses.frame.file_content import Content, content_of
from geocontact.data.errors import InputError

PATIENCE = 60.0
"""s that reading may last before the file is said to be too large to be looked at."""
PAGE = "--page"


def contents(paths: Sequence[Path], patience: float = PATIENCE) -> list[Content]:
    """Content of each file, in their order."""
    command = [sys.executable, "-P", "-m", __name__, *map(str, paths)]
    try:
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8", timeout=patience, check=False
        )
        why = f"its reader ended with {done.returncode}"
    except subprocess.TimeoutExpired:
        done, why = None, f"reading lasts more than {patience:g} s"
    if done is not None and done.returncode == 0:
        return [Content(**each) for each in json.loads(done.stdout)]
    if len(paths) > 1:  # by themselves, so that one costs the others nothing
        return [content for path in paths for content in contents([path], patience)]
    return [Content(wrong=f"{path.name}: not looked at, {why}") for path in paths]


def write_page(surface: Path, unit: str, out: Path) -> str:
    """Write the page of a surface, which turns it in 3-D; why it cannot be written, "" where it is."""
    command = [sys.executable, "-P", "-m", __name__, PAGE, str(surface), unit, str(out)]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8", check=False)
    if done.returncode:
        return f"no page: the process that writes it ended with {done.returncode}"
    return str(json.loads(done.stdout))


def _page(surface: str, unit: str, out: str) -> str:
    """Write the page in this process; why it cannot be written."""
    from geocontact.analyses.frame.surface_page import write_surface_page

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # stand beside the file already
        try:
            write_surface_page(Path(surface), unit, Path(out))
        except InputError as error:
            return str(error)
    return ""


if __name__ == "__main__":
    given = sys.argv[1:]
    json.dump(_page(*given[1:]) if given[0] == PAGE else [asdict(content_of(Path(each))) for each in given], sys.stdout)
