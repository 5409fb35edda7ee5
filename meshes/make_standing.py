"""Write the synthetic trials of standing up that the documentation runs on: `python meshes/make_standing.py`.

It takes some seconds, for the truth is a motion that is found by collocation.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # so that the script runs from anywhere

from geocontact.standing_up.chain import Subject
from meshes.standing_files import shipped_description, synthetic_files, unloaded_files
from meshes.standing_study import synthetic_study

FOLDERS = {
    "standing_up": {},
    "standing_up_exoskeleton": {"exoskeleton": True},
    "standing_up_sites": {"exoskeleton": True, "sites": True, "seed": 36},
    "standing_up_held_out": {"exoskeleton": True, "held_out": True, "seed": 35},
}
"""What is made, by folder."""
ALONE = "standing_up_exoskeleton"
"""Folder of the exoskeleton that moves alone."""


def standing_files() -> dict[str, bytes]:
    """The studies, by name."""
    files = {
        f"{folder}/{name}": text.encode("ascii")
        for folder, what in FOLDERS.items()
        for name, text in synthetic_files(synthetic_study(**what)).items()
    }
    alone = {**unloaded_files(Subject()), "exoskeleton.toml": shipped_description()}
    return files | {f"{ALONE}/{name}": text.encode("ascii") for name, text in alone.items()}


def main() -> None:
    """Write the files beside this script."""
    for name, data in standing_files().items():
        path = Path(__file__).parent / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


if __name__ == "__main__":
    main()
