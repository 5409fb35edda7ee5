"""The extra of this package that brings a library which is not installed."""

from __future__ import annotations

import re
from importlib.metadata import PackageNotFoundError, requires

FOR_WORK = ("all", "test", "oracle")
"""Extras that bring several or are for those who work on the package."""


def remedy_for(library: str) -> str:
    """What to install for `import library`: "pip install 'geocontact[dynamics]'"; "" where no extra brings it."""
    try:
        told = requires("geocontact") or []
    except PackageNotFoundError:  # run from a checkout that is not installed
        return ""
    wanted = library.partition(".")[0].lower()
    for line in told:
        name, extra = re.match(r"[\w-]*", line), re.search(r"""extra == ['"](\w+)['"]""", line)
        if name and extra and name[0].lower() == wanted and extra[1] not in FOR_WORK:
            return f"pip install 'geocontact[{extra[1]}]'"
    return ""
