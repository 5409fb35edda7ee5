"""Pictures of docs/gallery.md and README.md: each block of commands of the gallery is run, its page photographed.

    python -m benchmarks.page_pictures.gallery FOLDER
    python -m benchmarks.page_pictures.gallery FOLDER --only area gap_diagnose --again

The runs lie in FOLDER, the pictures in docs/pictures. A block whose page is there is not run again unless asked for.
The page that a block ends with is that of its last `--out`. Needs bash, chromium and playwright.
"""

from __future__ import annotations

import argparse
import os
import re
import resource
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from benchmarks.page_pictures.shots import browser_page

if TYPE_CHECKING:
    from PIL.Image import Image

ROOT = Path(__file__).resolve().parents[2]
GALLERY = ROOT / "docs" / "gallery.md"
PICTURES = ROOT / "docs" / "pictures"
ENTRY = re.compile(r"^!\[[^\]]*\]\(pictures/(\w+)\.webp\)\n\n```sh\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SCREEN = (1280, 800)
SMALL = (640, 400)
HERO = "area"
"""Entry that README shows, in light and dark, at the size of the screen."""
LARGEST = 60_000  # bytes of a picture of the gallery


@dataclass(frozen=True)
class Shown:
    """An entry of the gallery: name of its picture, and the commands below it."""

    name: str
    code: str

    @property
    def folder(self) -> str:
        """Folder of the results of its last command."""
        return re.findall(r"--out (\S+)", self.code)[-1]


def entries() -> list[Shown]:
    """All of them, in the order of the page."""
    return [Shown(*found) for found in ENTRY.findall(GALLERY.read_text(encoding="utf-8"))]


def run(shown: Shown, folder: Path) -> None:
    """Type its commands in the folder, with `geocontact` of this checkout."""
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PATH": f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(
        ["bash", "-eu", "-c", shown.code], cwd=folder, env=environment, check=False, capture_output=True, text=True
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    taken = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    sys.stdout.write(
        f"{shown.name}: exit {done.returncode}, {taken:.1f} CPU s\n{done.stderr if done.returncode else ''}"
    )
    sys.stdout.flush()


def prepare(folder: Path) -> None:
    """A folder with the samples and the program in it."""
    (folder / "bin").mkdir(parents=True, exist_ok=True)
    program = folder / "bin" / "geocontact"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{ROOT / "cli.py"}" "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    if not (folder / "meshes").exists():
        (folder / "meshes").symlink_to(ROOT / "meshes")


def shoot(folder: Path, shown: Sequence[Shown]) -> None:
    """First screens of the pages, small; of the one that README shows also in full, light and dark."""
    with browser_page(SCREEN) as photograph:
        for one in shown:
            page = next(iter(sorted((folder / one.folder).rglob("report.html"))), None)
            if page is None:
                sys.stdout.write(f"{one.name}: no page\n")
                continue
            save_small(opened(photograph(page, "light")), PICTURES / f"{one.name}.webp")
            if one.name == HERO:
                for scheme in ("light", "dark"):
                    save_full(opened(photograph(page, scheme)), PICTURES / f"{one.name}-{scheme}.png")


def opened(png: bytes) -> Image:
    """A photograph as an image."""
    from io import BytesIO

    import PIL.Image

    return PIL.Image.open(BytesIO(png)).convert("RGB")


def save_small(image: Image, file: Path) -> None:
    """Half of its width and height, at the best quality that is small enough."""
    small = image.resize(SMALL)
    for quality in range(85, 20, -10):
        small.save(file, quality=quality, method=6)
        if file.stat().st_size <= LARGEST:
            return


def save_full(image: Image, file: Path) -> None:
    """As PNG with 128 colours."""
    image.quantize(128, dither=0).save(file, optimize=True)


def main() -> int:
    """Exit code: 0 when every entry has a picture."""
    names = [one.name for one in entries()]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="new or existing folder of the runs")
    parser.add_argument("--only", nargs="+", default=names, choices=names, metavar="NAME")
    parser.add_argument("--again", action="store_true", help="run commands again whose page is there")
    given = parser.parse_args()
    folder = given.folder.resolve()
    prepare(folder)
    PICTURES.mkdir(exist_ok=True)
    wanted = [one for one in entries() if one.name in given.only]
    for one in wanted:
        if given.again or not (folder / one.folder).is_dir():
            run(one, folder)
    shoot(folder, wanted)
    return 0 if all((PICTURES / f"{one.name}.webp").is_file() for one in wanted) else 1


if __name__ == "__main__":
    sys.exit(main())
