"""What an analysis may be asked for: one declaration for Python, the command line and the documentation.

The options of an analysis are a frozen dataclass below `Options`: inputs first, then keyword-only options, values
in SI. What else there is to know of an option stands in its annotation: its unit (`Typed`), how the command line spells
it (`Spelled`), with which other options it has an effect (`Requires`, `Excludes`, `Needs`), and what it can be
(`data.plausible`: what is impossible is refused, what is unusual is a reservation of the result). A message names an
option in backticks, which is how Python spells it; the command line turns that into its own spelling.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING, Field, dataclass, fields
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, ClassVar, Literal, Union, get_args, get_origin, get_type_hints

from geocontact.analyses.frame import typed_text
from geocontact.analyses.frame.docstrings import Documented, documented
from geocontact.analyses.frame.marks import Excludes, ForFiles, Missing, Needs, Requires, Spelled, Typed
from geocontact.data.errors import InputError
from geocontact.data.plausible import ByName, ByPlace, Plausible, Range, numbers_in

IN_PLACE_OF_FILES = "give a path, a DataFrame, an array of rows or a mesh of trimesh, pyvista or open3d"


@dataclass(frozen=True)
class Declared:
    """One option as it was declared.

    Parameters
    ----------
    kind
        Its type without None and without annotations.
    optional
        Whether it may be None.
    range
        What its values can be.
    endings
        Endings of the files that it is for; empty where it is for any.
    missing
        What is said where it is a path that leads nowhere.
    words
        What the docstring of the options says of it.
    section
        Heading of the docstring that it stands under, "" where there is none.
    settable
        Whether it may be given; else it is what the class says.
    """

    name: str
    kind: Any
    optional: bool
    positional: bool
    default: Any
    typed: Typed | None
    spelled: Spelled
    rules: tuple[Requires | Excludes | Needs, ...]
    endings: tuple[str, ...]
    range: Range | None
    missing: Missing
    words: str
    section: str = ""
    settable: bool = True

    @property
    def required(self) -> bool:
        """Whether there is no default."""
        return self.default is MISSING

    @property
    def choices(self) -> tuple[Any, ...]:
        """Values that are allowed; empty where any is."""
        return get_args(self.kind) if get_origin(self.kind) is Literal else ()

    @property
    def several(self) -> bool:
        """Whether the value is a tuple of any length."""
        return get_origin(self.kind) is tuple and get_args(self.kind)[-1] is Ellipsis

    def read(self, typed: Any) -> Any:
        """What was typed on the command line or stands in a study, in SI."""
        if self.typed is None or typed is None:
            return typed
        whole = isinstance(typed, int) and not isinstance(typed, bool) and self.typed.kind is float
        return typed_text.read(self.typed, self.name, float(typed) if whole else typed)

    def coerced(self, value: Any) -> Any:
        """The value as the analysis takes it: in SI, paths for text and text for paths, a tuple for a single value."""
        value = self._from_text(_plain(value))
        if value is None:
            if self.required and not self.optional:
                raise InputError("", f"`{self.name}`", "is None", "give a value")
            return None
        if self.several:
            one = get_args(self.kind)[0]
            items = (value,) if self._alone(value) else value
            return tuple(self._path(item) if one is Path else _as(one, item) for item in items)
        return self._single(value)

    def _single(self, value: Any) -> Any:
        """One value as the analysis takes it."""
        if self.kind is str and isinstance(value, (tuple, list)):
            remedy = f'write "{",".join(map(str, value))}"'
            raise InputError("", f"`{self.name}`", f"is {len(value)} values where one text is asked for", remedy)
        if self.kind is float:
            return self._number(value)
        if self.kind in (Path, str):
            return self._path(value) if self.kind is Path else _as(str, value)
        if isinstance(value, str) and Path in get_args(self.kind):
            return Path(value)
        if get_origin(self.kind) is tuple and set(get_args(self.kind)) == {float}:
            self._require_numbers(value)
        if self.choices and value not in self.choices:
            raise InputError("", f"`{self.name}`", f"{value!r} is not a choice", f"one of {', '.join(self.choices)}")
        return value

    def _path(self, value: Any) -> Path:
        """A path; InputError for what is none."""
        try:
            return Path(value)
        except TypeError:
            raise InputError("", f"`{self.name}`", f"is a {type(value).__name__}", IN_PLACE_OF_FILES) from None

    def _from_text(self, value: Any) -> Any:
        """What a text of Python stands for; anything else as it is."""
        if self.typed is not None:
            return typed_text.from_python(self.typed, self.name, self.kind, self.spelled.each, value)
        if isinstance(self.range, Plausible) and self.kind is float and isinstance(value, str):
            return typed_text.with_unit(self.name, self.range.unit.si, value)
        return value

    def _number(self, value: Any) -> float:
        """The number; InputError for what is none."""
        try:
            return float(value)
        except (TypeError, ValueError):
            shown = repr(value) if isinstance(value, str) else f"a {type(value).__name__}"
            remedy = f"give a number, as in {self.typed.python}" if self.typed else "give a number"
            raise InputError("", f"`{self.name}`", f"{shown} is not a number", remedy) from None

    def _require_numbers(self, value: Any) -> None:
        """InputError unless there are as many numbers as are asked for."""
        count = len(get_args(self.kind))
        try:
            right = not isinstance(value, str) and len([float(each) for each in value]) == count
        except (TypeError, ValueError):
            right = False
        if not right:
            remedy = f"give {count} numbers" + (f": {self.typed.python}" if self.typed and self.typed.python else "")
            raise InputError("", f"`{self.name}`", f"{value!r} is not {count} numbers", remedy)

    def _alone(self, value: Any) -> bool:
        """Whether a value is one of several; a pair is one where pairs are asked for."""
        if not isinstance(value, (tuple, list)):
            return True
        pairs = get_origin(get_args(self.kind)[0]) is tuple
        return pairs and len(value) > 0 and not isinstance(value[0], (tuple, list))


@dataclass(frozen=True)
class Options:
    """Base of the options of every analysis: values are coerced, and options without effect are refused.

    The first paragraph of the docstring of a class is what its analysis does, for the help of both doors.

    Attributes
    ----------
    over_time
        Whether results have tables over time, which can be written as netCDF.
    writes
        What the help of the command says below that: which files it writes, and what else is to be known.
    folder_help
        What it says of the folder for the results.
    last_line
        The command prints it at the end, with the folder in place of {out}; nothing where it is empty.
    first_frame
        Module whose `first_frame` gives the bodies at the first frame for a picture of `threshold`; "" without one.
    """

    over_time: ClassVar[bool] = False
    writes: ClassVar[str] = ""
    folder_help: ClassVar[str] = "Folder for the results."
    last_line: ClassVar[str] = ""
    first_frame: ClassVar[str] = ""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        cls.__repr__ = Options.__repr__  # type: ignore[method-assign]  # else each dataclass makes its own

    def __repr__(self) -> str:
        """What differs from the defaults, in one line."""
        values = ((one, getattr(self, one.name)) for one in declared(type(self)))
        said = [f"{one.name}={_shown(value)}" for one, value in values if repr(value) != repr(one.default)]
        return f"{type(self).__name__}({', '.join(said)})"

    def __post_init__(self) -> None:
        for one in declared(type(self)):
            object.__setattr__(self, one.name, one.coerced(getattr(self, one.name)))
        self.refuse_without_effect()
        self.refuse_implausible()
        self.refuse_impossible()

    def refuse_implausible(self) -> None:
        """InputError for the first value that its quantity cannot have."""
        for place, known, value in self._ranged():
            known.require(value, place)

    def programs(self) -> tuple[str, ...]:
        """Programs and modules of others, in words, that the input files name and this analysis would start."""
        return ()

    def doubts(self) -> tuple[str, ...]:
        """What is unusual about the values, each one line."""
        found = [(place, known.doubt(value)) for place, known, value in self._ranged()]
        return tuple(dict.fromkeys(f"{place}: {doubt}" for place, doubt in found if doubt))

    def _ranged(self) -> Iterator[tuple[str, Plausible, float]]:
        """Every number that has a range, and where it was given: "`known` k"."""
        for one in declared(type(self)):
            for name, known, value in numbers_in(one.range, getattr(self, one.name)):
                yield f"`{one.name}` {name}".rstrip(), known, value

    def refuse_missing_files(self) -> None:
        """InputError for the first path that leads nowhere: said before anything heavy is imported or read."""
        for path, missing in self.paths():
            if missing.what and leads_nowhere(path):
                raise InputError(path, "", missing.what, missing.remedy)

    def paths(self) -> Iterator[tuple[Path, Missing]]:
        """Every path that the options name, and what is said where it leads nowhere."""
        for one in declared(type(self)):
            value = getattr(self, one.name)
            for each in value if isinstance(value, tuple) else (value,):
                if isinstance(each, Path):
                    yield each, one.missing

    def refuse_impossible(self) -> None:
        """InputError for values that cannot be; for an analysis to fill."""

    def refuse_without_effect(self) -> None:
        """InputError for the first option that has no effect here, or lacks another one that it needs."""
        for one in declared(type(self)):
            if self.given(one.name):
                for rule in one.rules:
                    _refuse(one.name, rule, any(map(self.given, _others(rule))))
                if one.endings and not any(path.suffix.lower() in one.endings for path, _ in self.paths()):
                    what = f"has no effect without a {one.endings[0]} file"
                    raise InputError("", f"`{one.name}`", what, "leave it out")

    def given(self, name: str) -> bool:
        """Whether an option was given: it is neither None, nor False, nor empty."""
        value = getattr(self, name)
        return value is not None and value is not False and value != ()

    def in_si(self) -> dict[str, object]:
        """Values of what was given or is in force, by name, with the SI unit where there is one."""
        units = {one.name: one.typed.si for one in declared(type(self)) if one.typed is not None}
        return {
            f"{name} [{units[name]}]" if units.get(name, "-") != "-" else name: getattr(self, name)
            for name in (one.name for one in declared(type(self)))
            if getattr(self, name) is not None
        }


def _shown(value: Any) -> str:
    """A value as somebody writes it: a path as its text."""
    if isinstance(value, tuple):
        return f"({', '.join(map(_shown, value))}{',' if len(value) == 1 else ''})"
    return repr(fspath(value) if isinstance(value, PathLike) else value)


def leads_nowhere(path: Path) -> bool:
    """Whether there is neither a file nor a folder; names that no file can have are left to who opens them."""
    try:
        path.stat()
    except FileNotFoundError:
        return True
    except (OSError, ValueError):
        pass
    return False


def _others(rule: Requires | Excludes | Needs) -> tuple[str, ...]:
    """Options that a rule speaks of."""
    alternative = rule.alternative if isinstance(rule, Requires) else ""
    return (rule.other, alternative) if alternative else (rule.other,)


def _refuse(name: str, rule: Requires | Excludes | Needs, other: bool) -> None:
    match rule:
        case Requires() if not other:
            named = " or ".join(f"`{each}`" for each in _others(rule))
            raise InputError("", f"`{name}`", f"has no effect without {named}", rule.remedy or f"give {named}")
        case Excludes() if other:
            what = rule.why or f"has no effect with `{rule.other}`"
            raise InputError("", f"`{name}`", what, rule.remedy)
        case Needs() if not other:
            raise InputError("", f"`{rule.other}`", f"is missing with `{name}`", rule.remedy or "give it too")


def _plain(value: Any) -> Any:
    """An array or a series of one dimension as a tuple, one of none as its number, anything else as it is."""
    if getattr(value, "ndim", None) == 1 and hasattr(value, "tolist"):
        return tuple(value.tolist())
    return value.item() if getattr(value, "ndim", None) == 0 and hasattr(value, "item") else value


def _as(kind: Any, value: Any) -> Any:
    """Numbers and paths become what they are declared as, and a path is text where text is asked for."""
    if kind in (Path, float):
        return kind(value)
    return fspath(value) if kind is str and isinstance(value, PathLike) else value


def declared(options: type[Options]) -> tuple[Declared, ...]:
    """The options of a class in the order of their declaration, those of its base first, positional ones before all."""
    anything: Any = options
    return _all(anything)


@cache
def _all(options: Any) -> tuple[Declared, ...]:
    hints = get_type_hints(options, include_extras=True)
    told: dict[str, Documented] = {}
    for base in reversed(options.__mro__):
        for name, one in documented(base.__doc__ or "").items():
            told[name] = Documented(one.section or told.get(name, one).section, one.lines)
    ordered = sorted(fields(options), key=lambda each: bool(each.kw_only))
    return tuple(_declared(each, hints[each.name], told.get(each.name, Documented(""))) for each in ordered)


def _declared(each: Field[Any], hint: Any, told: Documented) -> Declared:
    kind, marks, optional = _taken_apart(hint)
    default = each.default if each.default_factory is MISSING else each.default_factory()
    return Declared(
        each.name,
        kind,
        optional,
        not each.kw_only,
        default,
        next((mark for mark in marks if isinstance(mark, Typed)), None),
        next((mark for mark in marks if isinstance(mark, Spelled)), Spelled()),
        tuple(mark for mark in marks if isinstance(mark, (Requires, Excludes, Needs))),
        next((mark.endings for mark in marks if isinstance(mark, ForFiles)), ()),
        next((mark for mark in marks if isinstance(mark, (Plausible, ByPlace, ByName))), None),
        next((mark for mark in marks if isinstance(mark, Missing)), Missing()),
        told.words,
        told.section,
        each.init,
    )


def _taken_apart(hint: Any) -> tuple[Any, list[Any], bool]:
    """Type without None, marks of all layers (the outer ones first), whether None is allowed."""
    marks: list[Any] = []
    optional = False
    while True:
        if get_origin(hint) is Annotated:
            hint, *own = get_args(hint)
            marks += own
        elif get_origin(hint) in (Union, UnionType) and NoneType in get_args(hint):
            hint = Union[tuple(each for each in get_args(hint) if each is not NoneType)]  # noqa: UP007
            optional = True
        else:
            return hint, marks, optional
