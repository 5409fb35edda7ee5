"""A command of an analysis: its signature and help come from the analysis' options, what is typed becomes SI."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

from cyclopts import Group, Parameter

from geocontact.analyses.catalogue import Entry, entry_of
from geocontact.analyses.frame.calls import key
from geocontact.analyses.frame.job import Call, Job, execute
from geocontact.analyses.frame.options import Declared, Options, declared
from geocontact.analyses.frame.record import NO_FIGURES
from geocontact.analyses.frame.result import Part, Result
from geocontact.analyses.frame.table_forms import AS_ALWAYS, TableForms
from geocontact.cli import folders, opensim_setup
from geocontact.cli.show import Terminal
from geocontact.data.errors import InputError

PROGRAM = "geocontact"
RESULTS = "Results"
"""Heading of what every command can be asked about its results."""

FORMS = {
    "parquet": "Also write the tables as .parquet, with all their digits.",
    "netcdf": "Also write the tables over time as .nc (netCDF), with units.",
    "excel_safe": "Write ' before texts in .csv that a spreadsheet program would run as a formula.",
    NO_FIGURES: "Write no .png and .svg; a page draws only what it shows.",
    "no_overwrite": "Refuse a folder that holds results already.",
}
MOST_FILES = 20  # that are listed at the end, those in sub-folders among them


class Command:
    """What the command line calls for an analysis.

    Parameters
    ----------
    options
        Its options.
    job
        Gives the analysis for options that were typed; called when it runs, since it imports all that computes.
    more
        What the help says besides, at the end.
    """

    def __init__(self, options: type[Options], job: Callable[[Options], Job[Any, Any]], more: str = "") -> None:
        self.options, self.job = options, job
        self.known = declared(options)
        self.rest = next((one.name for one in self.known if one.spelled.rest), "")
        self.spell = speller(self.known)
        self.__doc__ = in_paragraphs(self.spell(f"{summary(options)}\n\n{options.writes.strip()}\n{more}"))
        self.__name__ = options.__name__
        self.__annotations__: dict[str, Any] = {}  # types stand in the signature
        self.__signature__ = _signature(options, self.rest, self.spell)

    def __call__(self, *arguments: Any, **typed: Any) -> int:
        """Run it with what was typed, and say what was found; the exit code."""
        with self.respelling():
            folder, asked = typed["out"], _typed(self.known, self.rest, arguments, typed)
            forms = TableForms(*(typed.get(name, False) for name in ("parquet", "netcdf", "excel_safe")))
            less = {NO_FIGURES: True} if typed.get(NO_FIGURES) else {}
            result, files = self.execute(
                {**asked, **forms.given(), **less}, folder, forms, overwrite=not typed.get("no_overwrite", False)
            )
            tell(result, folder, files)
            if self.options.last_line:
                print(self.spell(self.options.last_line).format(out=folder))
            return int(result.exit_code)

    def execute(
        self, typed: Mapping[str, Any], folder: Path, forms: TableForms = AS_ALWAYS, *, overwrite: bool = True
    ) -> tuple[Result, list[str]]:
        """Run it with options as typed, by their names in `run.json`; the result and the names of its files."""
        return self.execute_in_si(self.in_si(typed), typed, folder, forms, overwrite=overwrite)

    def read(self, *arguments: Any, **typed: Any) -> Options:
        """Options of what was typed, as a call reads them; nothing is run."""
        with self.respelling():
            options = self.options(**self.in_si(_typed(self.known, self.rest, arguments, typed)))
            options.refuse_missing_files()
            return options

    def in_si(self, typed: Mapping[str, Any]) -> dict[str, Any]:
        """Options as typed in SI, by their names in Python."""
        return {one.name: one.read(typed[key(one)]) for one in self.known if key(one) in typed}

    def execute_in_si(
        self,
        given: Mapping[str, Any],
        told: Mapping[str, Any],
        folder: Path,
        forms: TableForms = AS_ALWAYS,
        *,
        overwrite: bool = True,
    ) -> tuple[Result, list[str]]:
        """Run it with options in SI, by their names in Python; `told` is what `run.json` says of them."""
        options = self.options(**given)
        options.refuse_missing_files()
        call = Call(told, Terminal(), self.spell, forms, overwrite, parts_left_out(told))
        return execute(self.job(options), options, folder, call)

    @contextmanager
    def respelling(self) -> Iterator[None]:
        """Mistakes in the words of the command line."""
        try:
            yield
        except InputError as error:
            raise respelled(error, self.spell) from error


def __getattr__(name: str) -> Command:
    """The command of an analysis by how it is called: "geocontact elbow fit"."""
    program, _, command = name.partition(" ")
    if program != PROGRAM or not command:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return command_of(entry_of(command))


def place_of(entry: Entry) -> str:
    """Where `__getattr__` has its command, for a program that imports commands when they are asked for."""
    return f"{__name__}:{PROGRAM} {entry.command}"


def command_of(entry: Entry) -> Command:
    """The command of an analysis of the catalogue."""

    def job(options: Options) -> Job[Any, Any]:
        return entry.load_job(many=bool(entry.many) and options.given("many"))

    more = [each.HELP for each in (opensim_setup, folders) if entry.command in each.COMMANDS]
    return Command(entry.load_options(), job, "\n\n".join(more))


def parts_left_out(options: Mapping[str, Any]) -> frozenset[Part]:
    """Parts that options, as `run.json` has them, say are not written."""
    return frozenset(("figures",)) if options.get(NO_FIGURES) else frozenset()


def _shortened(files: list[str]) -> list[str]:
    """Names of files as they are, but sub-folders as a whole where there are many files in them."""
    if len(files) <= MOST_FILES:
        return files
    return sorted({name if "/" not in name else f"{name.partition('/')[0]}/…" for name in files})


def summary(options: type[Options]) -> str:
    """What an analysis does: the first paragraph of the docstring of its options."""
    return inspect.cleandoc(options.__doc__ or "").partition("\n\n")[0]


def in_paragraphs(text: str) -> str:
    """Text whose lines are as long as the terminal makes them; blank lines stay."""
    return "\n\n".join(" ".join(paragraph.split()) for paragraph in text.strip().split("\n\n"))


def speller(known: tuple[Declared, ...]) -> Callable[[str], str]:
    """What turns `` `radius` `` into --radius-mm, for the options of one command."""
    names = {one.name: one.name.upper() if argument(one) else f"--{option(one)}" for one in known}
    names |= {name: f"--{name.replace('_', '-')}" for name in ("out", *FORMS)}

    def spelled(text: str) -> str:
        return re.sub(r"`(\w+)`", lambda found: names.get(found[1], found[0]), text)

    return spelled


def spelling(command: str) -> folders.Spelling:
    """Options of a command that take no value, and its speller, which knows `trial` of folders as well."""
    known = declared(entry_of(command).load_options())
    flags = [option(one) for one in known if one.kind is bool]
    names = [*flags, *(f"no-{flag}" for flag in flags), *(name.replace("_", "-") for name in FORMS)]
    spell = speller(known)
    return frozenset(f"--{name}" for name in names), lambda text: spell(text).replace("`trial`", folders.TRIAL)


def argument(one: Declared) -> bool:
    """Whether it is typed without its name."""
    return one.positional and not one.spelled.keyword


def respelled(error: InputError, spell: Callable[[str], str]) -> InputError:
    """The same mistake in the words of the command line."""
    return InputError(error.file, *map(spell, (error.place, error.what, error.remedy)))


def tell(result: Result, folder: Path, files: list[str]) -> None:
    """Say what was found and where it lies."""
    for sentence in result.sentences:
        print(sentence)
    if files:
        print(f"results in {folder}: {', '.join(_shortened(files))}")


def negative(one: Declared) -> str:
    """How a switch that is on by default is turned off."""
    return f"--no-{option(one)}"


def option(one: Declared) -> str:
    """The option's name on the command line, without the dashes."""
    return one.spelled.name or one.name.replace("_", "-")


def _typed(known: tuple[Declared, ...], rest: str, arguments: tuple[Any, ...], typed: dict[str, Any]) -> dict[str, Any]:
    """What was typed, by name, in the order of the declaration; defaults included."""
    found: dict[str, Any] = {}
    left = list(arguments)
    for one in known:
        if argument(one):
            several = tuple(left.pop(0) for _ in range(len(left))) if one.several else ()
            found[key(one)] = several if one.several else left.pop(0) if left else default(one)
        elif one.name in typed:
            found[key(one)] = typed[one.name]
        else:
            found[key(one)] = default(one)
    if rest:
        found[rest] = (*(found[rest] or ()), *left) or None
    return {**found, "out": typed["out"]}


def default(one: Declared) -> Any:
    """The default as it is typed."""
    return one.default if one.spelled.default is None else one.spelled.default


def _signature(options: type[Options], rest: str, spell: Callable[[str], str]) -> inspect.Signature:
    known = declared(options)
    parameters: list[inspect.Parameter] = []
    for one in known:
        if argument(one):
            parameters += _positional(one, spell)
    if rest:
        words = f"Further ones, as a shell pattern after `{rest}` gives them."
        parameters.append(_parameter(f"more_{rest}s", inspect.Parameter.VAR_POSITIONAL, str, {"help": spell(words)}))
    keywords = [one for one in known if not argument(one)]
    sections = list(dict.fromkeys(one.section for one in known))
    spelled = {one.name: _keyword(one, sections.index(one.section), spell) for one in keywords}
    required = [spelled[one.name] for one in keywords if one.required]
    folder = _parameter("out", inspect.Parameter.KEYWORD_ONLY, Path, {"help": options.folder_help})
    others = [spelled[one.name] for one in keywords if not one.required]
    group = Group(RESULTS, sort_key=sections.index(RESULTS) if RESULTS in sections else len(sections))
    forms = [_flag(name, words, group) for name, words in FORMS.items() if name != "netcdf" or options.over_time]
    return inspect.Signature([*parameters, *required, folder, *others, *forms])


def _flag(name: str, words: str, group: Group) -> inspect.Parameter:
    told = {"help": words, "group": group, "negative": "", "show_default": False}
    return _parameter(name, inspect.Parameter.KEYWORD_ONLY, bool, told).replace(default=False)


def _positional(one: Declared, spell: Callable[[str], str]) -> list[inspect.Parameter]:
    """One argument, or as many as there are; the first one is asked for where there is no default."""
    told = {"help": spell(one.words)}
    if not one.several:
        kind = one.kind | None if one.optional else one.kind
        single = _parameter(one.name, inspect.Parameter.POSITIONAL_ONLY, kind, told)
        return [single if one.required else single.replace(default=default(one))]
    many = _parameter(one.name, inspect.Parameter.VAR_POSITIONAL, Path, told)
    if not one.required:
        return [many]
    first = _parameter(one.name.removesuffix("s"), inspect.Parameter.POSITIONAL_ONLY, Path, told)
    more = Parameter(help="Further ones.")
    return [first, many.replace(name=f"more_{one.name}", annotation=Annotated[Path, more])]


def _keyword(one: Declared, place: int, spell: Callable[[str], str]) -> inspect.Parameter:
    """An option; `place` is where the section that it belongs to stands among the sections."""
    hint = f" ({one.typed.hint})" if one.typed is not None and one.typed.hint else ""
    told: dict[str, Any] = {"name": f"--{option(one)}", "help": spell(one.words) + hint}
    if one.section:
        told["group"] = Group(one.section, sort_key=place)
    if one.kind is bool and one.default is False:
        told |= {"negative": "", "show_default": False}
    if one.spelled.dashed:
        told["allow_leading_hyphen"] = True
    if one.several or one.spelled.each:
        told |= {"negative": "", "consume_multiple": False}
    kind = one.kind if one.typed is None else one.typed.kind
    annotation = kind | None if one.optional else kind
    parameter = _parameter(one.name, inspect.Parameter.KEYWORD_ONLY, annotation, told)
    return parameter if one.required else parameter.replace(default=default(one))


def _parameter(name: str, kind: Any, annotation: Any, told: dict[str, Any]) -> inspect.Parameter:
    return inspect.Parameter(name, kind, annotation=Annotated[annotation, Parameter(**told)])
