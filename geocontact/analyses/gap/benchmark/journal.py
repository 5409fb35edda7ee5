"""Cases of a benchmark kept as they come, in a file that is only added to: an end in between costs the case at hand."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path

from geocontact.analyses.gap.benchmark.case import Worked
from geocontact.analyses.source_digest import digest
from geocontact.data.errors import InputError
from geocontact.gap_benchmark.drawing import Lot


class Journal:
    """What was worked by the same sources; of any seed, so that runs can be put together.

    Parameters
    ----------
    path
        The file; begun where it is not there. InputError where other sources wrote it.
    """

    def __init__(self, path: Path) -> None:
        self.path, here = path, digest()
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True) if path.is_file() else []
        whole = [json.loads(line) for line in lines if line.endswith("\n")]  # one that was cut off is no case
        if whole and whole[0] != {"sources": here}:
            what = f"was written by sources {whole[0].get('sources')}, these are {here}"
            raise InputError(path, "line 1", what, "take the same version, or another file")
        if lines and not lines[-1].endswith("\n"):
            path.write_text("".join(lines[:-1]), encoding="utf-8")
        if not whole:
            self._add({"sources": here})
        self.done = {one.lot: one for one in map(_worked, whole[1:])}

    def keep(self, one: Worked) -> None:
        """Add a case."""
        self.done[one.lot] = one
        self._add(asdict(one))

    def _add(self, line: dict[str, object]) -> None:
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(line) + "\n")


def _worked(row: dict[str, object]) -> Worked:
    given = dict(row)
    return Worked(**{**given, "lot": Lot(**given["lot"]), "trouble": tuple(given["trouble"])})  # type: ignore[arg-type]
