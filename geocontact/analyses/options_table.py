"""How a result was made, as its page tells it."""

from __future__ import annotations

from pathlib import Path

from geocontact.analyses import quantities
from geocontact.analyses.run_record import Record
from geocontact.view.page.content import Table


def options_table(record: Record) -> Table:
    """Options without the folders of files: a page is passed on, and where its files lay is nobody's business."""
    told = {key: value for key, value in record.options.items() if key != "out"}
    given = [(key, _shown(value)) for key, value in told.items() if value not in (None, False, [], ())]
    rows = [("command", f"geocontact {record.command}"), *given, *record.versions().items()]
    return Table("How it was made", ("option", "value"), rows, folded=True)


def _shown(value: object) -> str:
    if isinstance(value, (list, tuple)):
        return ", ".join(_shown(item) for item in value)
    text = str(value)
    return Path(text).name if isinstance(value, Path) or quantities.named_file(text) is not None else text
