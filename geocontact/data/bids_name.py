"""Names of recordings after the Brain Imaging Data Structure (BIDS): subject, task and what else tells them apart."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from geocontact.data.errors import InputError

ENTITIES = ("sub", "ses", "task", "acq", "run")
"""Parts of a name in their order; sub and task are needed."""
LONGEST = 180
"""Characters of a name: with tracking system and ending its files must stay below the 255 that file systems take."""


@dataclass(frozen=True)
class BidsName:
    """Subject, task and, where there are several, session, acquisition and run of a recording.

    Parameters
    ----------
    labels
        Label of each entity, letters and digits; a run's is a number.
    """

    labels: Mapping[str, str]

    @classmethod
    def of(cls, text: str) -> BidsName:
        """The name that sub-P1_task-walk_run-1 stands for; InputError with what is wrong."""
        if len(text) > LONGEST:
            raise _wrong(f"has {len(text)} characters, more than {LONGEST}")
        labels: dict[str, str] = {}
        for part in text.split("_"):
            key, _, label = part.partition("-")
            if key not in ENTITIES:
                raise _wrong(f"'{part[:40]}' does not begin with one of {', '.join(f'{e}-' for e in ENTITIES)}")
            if key in labels:
                raise _wrong(f"{key}- is there twice")
            if not re.fullmatch("[0-9]+" if key == "run" else "[0-9A-Za-z]+", label):
                raise _wrong(f"'{label[:40]}' of {key}- is not {'a number' if key == 'run' else 'letters and digits'}")
            labels[key] = label
        if missing := [key for key in ("sub", "task") if key not in labels]:
            raise _wrong(f"{missing[0]}- is missing")
        return cls(labels)

    @property
    def folder(self) -> Path:
        """Folder of the recording inside the dataset."""
        above = Path(f"sub-{self.labels['sub']}")
        return (above / f"ses-{self.labels['ses']}" if "ses" in self.labels else above) / "motion"

    def file(self, tracksys: str, suffix: str) -> str:
        """Name of a file of a tracking system."""
        order = ("sub", "ses", "task", "tracksys", "acq", "run")
        labels = {**self.labels, "tracksys": tracksys}
        return "_".join([*(f"{key}-{labels[key]}" for key in order if key in labels), suffix])


def _wrong(what: str) -> InputError:
    return InputError("", "`bids`", what, "for example sub-P1_task-walk")
