"""A run in a process of its own: the command line with its words, which says more often how far it is."""

from __future__ import annotations

import json
import os
import sys

from geocontact.cli import show
from geocontact.cli.main import main

PAUSE = 0.5
"""s between two lines on how far the work is; somebody watches."""
MODULES = "GEOCONTACT_MODULES"
"""Variable with folders of a simulator of the user's own, in JSON. PYTHONPATH would put them before all others."""


def run() -> None:
    """The command whose words follow, to its exit code; folders of `MODULES` are looked at last."""
    sys.path += [each for each in json.loads(os.environ.pop(MODULES, "[]")) if each not in sys.path]
    show.PAUSE = PAUSE
    main(sys.argv[1:])


if __name__ == "__main__":
    run()
