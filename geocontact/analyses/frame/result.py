"""What every analysis returns: tables, figure, page, and in words what was found."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from base64 import b64encode
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import wraps
from html import escape
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory
from textwrap import shorten
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from geocontact.analyses.frame.collector import collecting, current
from geocontact.analyses.frame.embedded import LARGEST_EMBEDDED, Embedded
from geocontact.analyses.frame.folder import is_inside, written_whole
from geocontact.analyses.frame.record import Record
from geocontact.analyses.frame.table_forms import TableForms
from geocontact.analyses.frame.warning_kinds import merged
from geocontact.analyses.frame.words import counted
from geocontact.data.errors import InputError

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from geocontact.analyses.frame.pages import Thinned
    from geocontact.identify.goodness_of_fit import Outcome
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page

REPORT = "report.html"
"""Page of a folder of results."""
MEASURED = re.compile(r"\d\s?(%|°|[kMmcµn]?(m|N|Pa|s|J|W|Hz|rad)\b|kg\b|deg\b|BW\b)")
"""A number with a unit: 2505.0 mm^2, 86 %, 201.8 N/m."""
WIDEST = 200
"""Characters of the line that stands for a result in a list or at the prompt."""

Part = Literal["tables", "figures", "pages"]
PARTS: frozenset[Part] = frozenset(("tables", "figures", "pages"))
"""What the frame writes."""
OF_THE_FRAME = frozenset(
    (
        "claims",
        "elsewhere",
        "fits",
        "folders",
        "parts",
        "put",
        "refers_to",
        "reservations",
        "spread_bands",
        "units",
        "write_files",
        "write_page",
    )
)
"""Attributes of a result that are there for the frame and for analyses, not for who has the result."""


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Result(ABC):
    """Base of the results of all analyses.

    A notebook shows it as its sentences and its figure. Numbers in its fields are in SI; tables have the unit in each
    column's name. An analysis says what its tables, figures and pages are, by the names of their files, sub-folders
    included ("walk/forces"); this class writes them.

    Parameters
    ----------
    record
        Inputs with their hashes, options, reservations, time taken: what `run.json` holds.

    Examples
    --------
    >>> import geocontact as gc
    >>> result = gc.fit_shape("meshes/sphere_r20.stl", shape="sphere", unit="mm")
    >>> isinstance(result, gc.Result), list(result.tables())
    (True, ['fit'])
    >>> sorted(file.name for file in result.write("out").iterdir())
    ['fit.json', 'fit.png', 'fit.svg', 'report.html', 'run.json']
    """

    elsewhere: ClassVar[frozenset[str]] = frozenset()
    """Tables that `write` leaves to another file of the analysis."""
    claims: ClassVar[frozenset[str]] = frozenset()
    """Columns that hold only if the model does; with ends of intervals and verdicts they are withheld else."""
    spread_bands: ClassVar[bool] = False
    """Whether bands of curves are the spread of what was recorded, which holds without a model."""

    record: Record = field(default_factory=current, repr=False)

    def __init_subclass__(cls, **options: Any) -> None:
        """Tables and curves of every analysis are without intervals where its result contradicts its data.

        Pages are made with its record open, so that their words know it as well.
        """
        super().__init_subclass__(**options)
        own = vars(cls)
        for name, withhold in (("tables", _without_claims), ("curves", _without_bands)):
            if name in own:
                setattr(cls, name, _if_it_fits(own[name], withhold))
        for name in {"pages"} & set(own):
            setattr(cls, name, _recorded(own[name]))

    @property
    def sentences(self) -> tuple[str, ...]:
        """What was found, in words; what contradicts the data comes first."""
        judged = self.record.judged
        return (*((judged,) if judged else ()), *self.record.sentences)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Reservations, each one line."""
        return tuple(self.record.warnings)

    @property
    def fit_outcome(self) -> Outcome | None:
        """Whether the result agrees with its data: fits, doubtful, contradicts; None where nothing was compared."""
        return None if self.record.fit is None else self.record.fit.outcome

    @property
    def fits(self) -> bool:
        """False where the result contradicts its data: no interval and no claim is shown then."""
        return self.fit_outcome != "contradicts"

    @property
    def accepted(self) -> bool:
        """False where a comparison that was asked for is beyond its tolerance."""
        return True

    @property
    def exit_code(self) -> int:
        """What the command ends with: 2 where it contradicts its data, and its inputs each other."""
        if not self.fits and self.record.causes:
            return 2
        return 0 if self.accepted and self.fits else 1

    @property
    def folders(self) -> tuple[str, ...]:
        """Sub-folders that `write` fills, each with a `run.json` of its own, as "" the folder itself."""
        return ("",)

    @property
    def parts(self) -> frozenset[Part]:
        """What `write` leaves in the folder: all `PARTS`, but for those not wanted, or written as further files."""
        return PARTS

    @abstractmethod
    def tables(self) -> dict[str, pd.DataFrame]:
        """Tables by the name of their file, the main one first."""

    def table(self, name: str = "") -> pd.DataFrame:
        """One table, the main one unless named; KeyError names those that there are."""
        tables = self.tables()
        if name and name not in tables:
            raise KeyError(f"no table {name!r}; there are {', '.join(tables)}")
        return tables[name or next(iter(tables))]

    def curves(self) -> Mapping[str, CurveSheet]:
        """Sets of curves by the name of their figure's file, the main one first; the page shows them as well."""
        return {}

    def figures(self) -> dict[str, Figure]:
        """Static figures by the name of their file, the main one first: those of `curves`, unless there are others."""
        from geocontact.view.curves.drawn import drawn  # late, like all that draws

        return {name: drawn(sheet) for name, sheet in self.curves().items()}

    def figure(self) -> Figure | None:
        """The main figure; None where there is nothing to draw."""
        return next(iter(self.figures().values()), None)

    def pages(self, drawings: Mapping[str, bytes]) -> Mapping[str, Page | Thinned]:
        """Pages by the name of their file; without any, figure and tables are shown on one.

        Reservations, input files and options are added to each.

        Parameters
        ----------
        drawings
            Every figure (SVG) by its name in `figures`; one that is not asked for need not be drawn.
        """
        return {}

    @property
    def title(self) -> str:
        """Heading of a page of figure and tables."""
        return f"geocontact {self.record.command}"

    def reservations(self, folder: str) -> tuple[str, ...]:
        """Reservations on the pages of a sub-folder; all of them, unless some belong to one of several parts."""
        return self.warnings

    def units(self, table: str) -> Mapping[str, str]:
        """Units that a table is written in by kind of quantity, as `io.text.results` names them."""
        from geocontact.io.text.results import RESULTS

        return RESULTS

    def refers_to(self, table: str) -> Mapping[str, object] | None:
        """What a table refers to, such as point and frame, for `run.json`."""
        return None

    def write_files(self, folder: Path) -> None:
        """Write tables, figures and pages into a folder that is there; further files are written by who overrides it.

        Pages come last: they show reservations that writing brought up.
        """
        from geocontact.analyses.frame.pages import (
            Drawings,
            save_both,  # late, like all that draws: --help needs no numpy
            write_finished,
        )
        from geocontact.io.text.results import write_table

        parts = {each for each in self.parts if each not in self.record.without}
        for name, table in self.tables().items() if "tables" in parts else ():
            if name in self.elsewhere:
                continue
            _make_room(folder, name)
            if len(table.columns):  # without any there is nothing that a file could hold
                write_table(table, folder, name, self.units(name))
            if about := self.refers_to(name):
                self.record.tables[f"{name}.csv"] = about
        saved = {}
        for name, figure in self.figures().items() if "figures" in parts else ():
            _make_room(folder, name)
            saved[name] = save_both(figure, folder, name)
        drawings = Drawings(self.figures) if "figures" in self.record.without else saved
        for name, page in self._pages(drawings).items() if "pages" in parts else ():
            _make_room(folder, name)
            home = name.rpartition("/")[0]
            write_finished(page, folder / name, self.record, home, self.reservations(home))

    def write_page(self, file: Path, largest: int | None = None) -> None:
        """Write the page of the whole, one file that needs no network; of several parts, their figure and tables.

        It shows fewer frames until it has at most `largest` bytes, those of a mail by default.
        """
        from geocontact.analyses.frame.pages import LARGEST_FILE, Drawings, write_finished

        pages, most = self._pages(Drawings(self.figures)), LARGEST_FILE if largest is None else largest
        if REPORT in pages:
            write_finished(pages[REPORT], file, self.record, "", self.reservations(""), most)
        else:
            drawn = self._plain_page(Drawings(self.figures))
            write_finished(drawn, file, self.record, "", self.warnings, most)

    def _pages(self, drawings: Mapping[str, bytes]) -> Mapping[str, Page | Thinned]:
        return self.pages(drawings) or {REPORT: self._plain_page(drawings)}

    def _plain_page(self, drawings: Mapping[str, bytes]) -> Page:
        from geocontact.analyses.frame.pages import plain_page

        main = next((drawings[name] for name in drawings), None)
        return plain_page(self.title, self.record, main, self.tables())

    def put(self, draft: Path, forms: TableForms | None = None) -> list[str]:
        """Write everything into `draft`, `run.json` included; names of the files.

        Tables are also written in `forms`, by default in those that the run was asked for.
        """
        self.write_files(draft)
        (forms or self.record.forms).write(self.tables(), draft, self.record.command)
        self.record.write(draft, *(draft / name for name in self.folders))
        return sorted(file.relative_to(draft).as_posix() for file in draft.rglob("*") if file.is_file())

    def write(
        self,
        folder: str | PathLike[str],
        *,
        parquet: bool = False,
        netcdf: bool = False,
        excel_safe: bool = False,
        figures: bool = True,
        overwrite: bool = True,
    ) -> Path:
        """Write what the command writes into a folder, whole or not at all; the folder is made where it is missing.

        Results that an earlier run left there and this one does not write again are removed, all else stays.

        Parameters
        ----------
        folder
            Where to.
        parquet
            Also write the tables as .parquet.
        netcdf
            Also write the tables over time as .nc; refused where there are none.
        excel_safe
            Write ' before texts in .csv that a spreadsheet program would run as a formula.
        figures
            Write no .png and .svg when false; a page draws only what it shows.
        overwrite
            Refuse a folder that holds results already when false.
        """
        out = self.record.out = Path(folder)
        self.record.without = frozenset() if figures else frozenset(("figures",))
        with collecting(self.record), written_whole(out, overwrite) as draft:
            self.put(draft, TableForms(parquet, netcdf, excel_safe))
        return out

    def page(self, file: str | PathLike[str]) -> Path:
        """Write the page alone: one HTML file with figures and numbers that can be mailed."""
        path = Path(file)
        with collecting(self.record):
            self.write_page(path)
        return path

    def embedded(self, height: int = 640) -> Embedded:
        """The page as a notebook shows it, live: bodies in 3-D that turn and play. At most 2 MB, with fewer frames."""
        with TemporaryDirectory() as folder, collecting(self.record):
            file = Path(folder) / REPORT
            self.write_page(file, LARGEST_EMBEDDED)
            return Embedded(file.read_text(encoding="utf-8"), height)

    def __dir__(self) -> list[str]:
        """Names without those that only the frame uses: what Tab offers."""
        return sorted(set(super().__dir__()) - OF_THE_FRAME)

    def __str__(self) -> str:
        """Sentences and warnings, as the command prints them."""
        return "\n".join(self._lines())

    def _lines(self) -> list[str]:
        """Sentences, and one line for each kind of warning."""
        return [*self.sentences, *(f"warning: {line}" for line in merged(self.warnings))]

    def __repr__(self) -> str:
        """The first sentence with a number and its unit, and how many reservations there are, in one line.

        Without such a sentence the first one. The line has `WIDEST` characters at most.
        """
        name, count = type(self).__name__, len(self.warnings)
        end = f"; {counted(count, 'warning')}>" if count else ">"
        first = next(filter(MEASURED.search, self.sentences), (self.sentences or ("",))[0])
        words = " ".join(first.split())
        return f"<{name}: {shorten(words, WIDEST - len(name) - len(end) - 3, placeholder=' …')}{end}"

    def _repr_html_(self) -> str:
        """Sentences, reservations and figure, as a notebook shows them."""
        lines = self._lines()
        text = "".join(f"<p>{escape(line)}</p>" for line in lines)
        figure = self.figure()
        if figure is None:
            return text
        from geocontact.view.curves.sheet import png_of

        drawn, words = b64encode(png_of(figure)).decode("ascii"), escape("Figure: " + "".join(self.sentences[:1]))
        return f'{text}<img src="data:image/png;base64,{drawn}" alt="{words}"/>'


def _if_it_fits(method: Callable[[Any], Any], withhold: Callable[[Any, Any], Any]) -> Callable[[Any], Any]:
    """The method of a result, what it makes withheld where the result contradicts its data."""

    @wraps(method)
    def shown(self: Result) -> Any:
        made = method(self)
        return made if self.fits else withhold(self, made)

    return shown


def _recorded(method: Callable[[Any, Any], Any]) -> Callable[[Any, Any], Any]:
    @wraps(method)
    def shown(self: Result, drawings: Mapping[str, bytes]) -> Any:
        with collecting(self.record):
            return method(self, drawings)

    return shown


def _without_claims(result: Result, tables: Mapping[str, pd.DataFrame]) -> dict[str, pd.DataFrame]:
    from geocontact.analyses.frame.withheld import withheld_tables  # late: --help needs no numpy

    return withheld_tables(tables, result.claims)


def _without_bands(result: Result, sheets: Mapping[str, CurveSheet]) -> Mapping[str, CurveSheet]:
    from geocontact.analyses.frame.withheld import withheld_sheets

    return sheets if result.spread_bands else withheld_sheets(sheets)


def _make_room(folder: Path, name: str) -> None:
    """A sub-folder that the name of a file begins with; InputError where it leads out of the folder of results."""
    if not is_inside(folder, name):
        raise InputError(folder, "", f"{name[:80]!r} is not a name of results", "rename what it is made of")
    (folder / name).parent.mkdir(parents=True, exist_ok=True)
