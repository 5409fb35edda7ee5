"""Build the site: `python -m website`; with `--execute` the notebooks are run first."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from sphinx.cmd.build import build_main

from website.api.pages import api_pages
from website.notebooks import execute
from website.stage import INDEX, ROOT, stage

REDIRECT = (
    '<!doctype html><meta charset="utf-8"><meta http-equiv="refresh" content="0; url={0}"><a href="{0}">docs</a>\n'
)


def main(words: list[str]) -> int:
    """Build it; the exit code is that of Sphinx."""
    parser = argparse.ArgumentParser(prog="python -m website", description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "docs", help="folder of the site")
    parser.add_argument("--execute", action="store_true", help="run the notebooks anew, with live pages")
    given = parser.parse_args(words)
    sources, html = given.out / "sources", given.out / "html"
    stage(sources, api_pages())
    if given.execute:
        os.environ["GEOCONTACT_DATA"] = str(given.out / "none")
        execute(sources)
    told = ["-b", "html", "-W", "--keep-going", "-n", "-q", "-d", str(given.out / "cache"), "-c", str(ROOT / "website")]
    failed = build_main([*told, str(sources), str(html)])
    (html / "index.html").write_text(REDIRECT.format(INDEX.replace(".md", ".html")), encoding="utf-8")
    return failed


sys.exit(main(sys.argv[1:]))
