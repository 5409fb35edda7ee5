"""Badges of README.md, from pyproject.toml: `python -m benchmarks.page_pictures.badges` writes docs/pictures/badges."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDER = ROOT / "docs" / "pictures" / "badges"
LETTER = 6.6  # px, of DejaVu Sans at 11 px
SVG = """\
<svg xmlns="http://www.w3.org/2000/svg" width="{whole}" height="20" role="img" aria-label="{name}: {value}">
<rect width="{whole}" height="20" rx="3" fill="#444"/>
<path d="M{left} 0h{rest}a3 3 0 0 1 3 3v14a3 3 0 0 1-3 3h-{rest}z" fill="#2a6f97"/>
<g fill="#fff" font-family="DejaVu Sans,Verdana,sans-serif" font-size="11" text-anchor="middle">
<text x="{at_name}" y="14">{name}</text>
<text x="{at_value}" y="14">{value}</text>
</g>
</svg>
"""


def badges() -> dict[str, str]:
    """Text of each badge by the name of its file."""
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project = settings["project"]
    said = {
        "python": ("Python", f"{project['requires-python'].removeprefix('>=')} or newer"),
        "licence": ("licence", project["license"]),
        "version": ("version", project["version"]),
        "types": ("types", "mypy --strict" if settings["tool"]["mypy"]["strict"] else "not checked"),
    }
    return {f"{file}.svg": drawn(*words) for file, words in said.items()}


def drawn(name: str, value: str) -> str:
    """An SVG with a name on grey and its value on blue."""
    left, right = (round(LETTER * len(word)) + 12 for word in (name, value))
    places = {"at_name": left / 2, "at_value": left + right / 2}
    return SVG.format(name=name, value=value, whole=left + right, left=left, rest=right - 3, **places)


def main() -> int:
    """Write them."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for file, text in badges().items():
        (FOLDER / file).write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
