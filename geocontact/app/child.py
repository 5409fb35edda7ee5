"""A run in a process of its own: the command line with its words, which says more often how far it is."""

from __future__ import annotations

import sys

from geocontact.cli import show
from geocontact.cli.main import main

PAUSE = 0.5
"""s between two lines on how far the work is; somebody watches."""


def run() -> None:
    """The command whose words follow, to its exit code."""
    show.PAUSE = PAUSE
    main(sys.argv[1:])


if __name__ == "__main__":
    run()
