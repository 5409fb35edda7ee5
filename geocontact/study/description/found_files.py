"""The files that a study's pattern fits, and what the names in the pattern stand for."""

from __future__ import annotations

import re
from pathlib import Path, PurePath, PureWindowsPath

from geocontact.data.errors import InputError

NAME = re.compile(r"\{(\w+)\}")


def split_pattern(pattern: str, kind: type[PurePath] = PurePath) -> tuple[str, str]:
    """Where a pattern starts, "" for the study's folder, and the rest, with / between folders on every system.

    Parameters
    ----------
    kind
        Whose paths these are: of this system, unless said. A drive or a server's share is a start on Windows only.
    """
    path = kind(pattern)
    rest = path.relative_to(path.anchor) if path.anchor else path
    return kind(path.anchor).as_posix() if path.anchor else "", rest.as_posix()


def expression_of(pattern: str, kind: type[PurePath] = PurePath) -> re.Pattern[str]:
    """What the text of a path must fit: `{name}` a part without /, the same one wherever it stands, * anything."""
    expression, seen = "", set[str]()
    for k, part in enumerate(NAME.split(pattern)):
        if k % 2 == 0:
            expression += "[^/]*".join(map(re.escape, part.split("*")))
        else:
            expression += f"(?P={part})" if part in seen else f"(?P<{part}>[^/]+?)"
            seen.add(part)
    alike = issubclass(kind, PureWindowsPath)  # where A.csv and a.csv are one file
    return re.compile(expression, re.IGNORECASE if alike else re.NOFLAG)


def found_files(home: Path, pattern: str, study: Path) -> list[tuple[str, dict[str, str]]]:
    """Path of each file that fits, from `home` or from where the pattern starts, with what the names stand for.

    InputError where there is none.
    """
    start, rest = split_pattern(pattern, type(home))
    base = Path(start) if start else home
    expression = expression_of(rest, type(home))
    matches = sorted(each.relative_to(base).as_posix() for each in base.glob(NAME.sub("*", rest)))
    fits = [(path, fit) for path in matches if (fit := expression.fullmatch(path))]
    if not fits:
        remedy = "write / between folders" if "\\" in rest else f"paths start from {base}"
        raise InputError(study, "`files`", f"no file fits {pattern!r}", remedy)
    return [((base / path).as_posix() if start else path, fit.groupdict()) for path, fit in fits]
