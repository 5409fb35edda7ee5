"""Show that a change of structure left every output of the command line as it was.

    python -m benchmarks.same_outputs record BEFORE --checkout ../old
    python -m benchmarks.same_outputs record AFTER
    python -m benchmarks.same_outputs compare BEFORE AFTER
    python -m benchmarks.same_outputs numbers BEFORE AFTER

`record` starts the commands of `runs.txt` in child processes of a checkout, on samples that lie at the same paths in
every recording. `compare` fails when a table, a JSON file or an array differs; texts, pages and figures are reported.
`numbers` leaves words and names out: where columns were renamed, or numbers were changed on purpose (`meant.toml`), it
fails for numbers alone that differ without a reason, and says by how much every file differs.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from benchmarks.same_outputs.comparing import compared
from benchmarks.same_outputs.numbers import Meant, numbers_compared
from benchmarks.same_outputs.recording import ROOT, record


def main() -> int:
    """Exit code: 0 when everything agrees."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    verbs = parser.add_subparsers(dest="verb", required=True)
    one = verbs.add_parser("record", help="run every command and keep what it writes")
    one.add_argument("folder", type=Path, help="new or existing folder of the recording")
    one.add_argument("--checkout", type=Path, default=ROOT, help="checkout whose cli.py is run (%(default)s)")
    one.add_argument("--only", nargs="+", default=[], metavar="NAME", help="these runs, and those that they read")
    one.add_argument("--jobs", type=int, default=2, help="child processes at a time (%(default)s)")
    two = verbs.add_parser("compare", help="compare two recordings")
    two.add_argument("before", type=Path)
    two.add_argument("after", type=Path)
    two.add_argument("--strip", nargs="+", default=[], metavar="KEY", help="further JSON keys that are left out")
    three = verbs.add_parser("numbers", help="compare the numbers of two recordings, apart from words and names")
    three.add_argument("before", type=Path)
    three.add_argument("after", type=Path)
    three.add_argument("--results", default="", metavar="NAME", help="also write benchmarks/results/NAME.json")
    three.add_argument("--note", default="", help="with --results: what is to be known of the recordings")
    given = parser.parse_args()
    if given.verb == "record":
        return record(given.folder, given.checkout, given.only, given.jobs)
    if given.verb == "numbers":
        return numbers_compared(given.before, given.after, Meant.of(), given.results, given.note)
    return compared(given.before, given.after, given.strip)


if __name__ == "__main__":
    sys.exit(main())
