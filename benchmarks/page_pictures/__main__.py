"""Make a page of every kind and photograph it, on a desktop and on a phone, in light and in dark.

    python -m benchmarks.page_pictures FOLDER
    python -m benchmarks.page_pictures FOLDER --only area pressure --again

The runs lie in FOLDER/runs, the pictures beside them: KIND-1280.png and KIND-390.png, the same with -dark, and each
with -whole for what comes below the first screen. Needs chromium and playwright.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from benchmarks.page_pictures.kinds import KINDS, make_pages
from benchmarks.page_pictures.shots import shoot


def main() -> int:
    """Exit code: 0 when every page could be made."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="new or existing folder of the pictures")
    parser.add_argument("--only", nargs="+", default=list(KINDS), choices=list(KINDS), metavar="KIND")
    parser.add_argument("--again", action="store_true", help="make pages that are there already again")
    parser.add_argument("--jobs", type=int, default=2, help="child processes at a time (%(default)s)")
    given = parser.parse_args()
    pages = make_pages(given.folder / "runs", given.only, given.again, given.jobs)
    shoot(given.folder, pages)
    return 0 if len(pages) == len(given.only) else 1


if __name__ == "__main__":
    sys.exit(main())
