"""Descriptions in TOML as classes: what each key may hold, and one way to say what is wrong with it.

    class Trial(Document):
        name: FileName
        motion: File
        mass: Annotated[float, WithUnit("kg")]
        seated: bool = False

    class Study(Document):
        trials: Annotated[tuple[Trial, ...], Listed("T{number}")]

    study = read_document(path, Study)

A key without a default must be there, and one that is not declared must not; a class with `extra="allow"` and the type
of `__pydantic_extra__` takes further ones. Files are looked for beside the description. What is wrong is said of the
first key that is: InputError with its place as it is written in TOML. `docs/reference/descriptions.md` is made of these
classes: the meaning of a key stands under its name in the docstring.
"""

from __future__ import annotations

import math
import re
import warnings
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from os.path import isfile, lexists
from pathlib import Path
from typing import Annotated, Any, TypeGuard, TypeVar, get_args, get_origin

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    GetCoreSchemaHandler,
    PlainValidator,
    TypeAdapter,
    ValidationError,
    create_model,
    model_validator,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.plausible import Plausible
from geocontact.io.document_errors import LONGEST, input_error, refusal, shown
from geocontact.io.text.column_names import near_names
from geocontact.io.text.file_preflight import regular_file
from geocontact.io.text.toml_text import toml_of
from geocontact.io.text.units import si_unit

LARGEST = 1_000_000
"""Bytes of a description, unless its reader says otherwise."""
BESIDE = ("source", "note")
"""Keys that a value with its unit may have besides."""
_FILE_NAME = re.compile(r"[\w-]{1,40}")


class Document(BaseModel):
    """A table, or a whole file, with the keys that are declared and no other."""

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True)

    @classmethod
    def by_key(cls) -> dict[str, FieldInfo]:
        """Every key as it is written, with what is declared of it."""
        return {field.alias or name: field for name, field in cls.model_fields.items()}

    @model_validator(mode="before")
    @classmethod
    def _require_keys(cls, content: object) -> object:
        keys = cls.by_key()
        every = ", ".join(keys)
        if not isinstance(content, dict):
            raise refusal("is not a table", f"write {every}")
        odd = next((key for key in content if key not in keys), None)
        if odd is not None and cls.model_config["extra"] == "forbid":
            near = ", ".join(near_names([odd[:LONGEST]], list(keys)).values())
            raise refusal("is not known here", f"perhaps {near}" if near else f"write {every}", at=(odd,))
        for name, field in keys.items():
            if field.is_required():
                _require(name, field, content.get(name))
        return content


D = TypeVar("D", bound=Document)
Value = str | int | float | bool


def _is_document(kind: object) -> TypeGuard[type[Document]]:
    return isinstance(kind, type) and issubclass(kind, Document)


def _require(name: str, field: FieldInfo, value: object) -> None:
    """That a key is there, and of tables by name or in a row at least one."""
    table = next((each for each in get_args(field.annotation) if _is_document(each)), None)
    if table is not None:
        kind, heading = (list, f"[[{name}]]") if get_origin(field.annotation) is tuple else (dict, f"[{name}.NAME]")
        if not value or not isinstance(value, kind):
            raise refusal(f"no {heading}", f"write one for each, with {', '.join(table.by_key())}", at=("",))
    if value is None and _is_document(field.annotation):
        raise refusal(f"no [{name}]", f"add it, with {', '.join(field.annotation.by_key())}", at=("",))
    if value is None:
        example = next((each.example for each in field.metadata if isinstance(each, WithUnit)), "")
        example = next(iter(field.examples or ()), example)
        raise refusal(f"no {name}", f"add it: {name} = {example}" if example else "add it", at=("",))


@dataclass(frozen=True)
class WithUnit:
    """A number with its unit, `{ value = 32, unit = "mm" }`, as a float in SI.

    Parameters
    ----------
    known
        The SI unit, or the values that it can have.
    bare
        Whether it may also be a number, in SI.
    """

    known: str | Plausible
    bare: bool = False

    @property
    def si(self) -> str:
        """The SI unit."""
        return self.known if isinstance(self.known, str) else self.known.unit.si

    @property
    def example(self) -> str:
        """How it may be written."""
        if isinstance(self.known, Plausible):
            return f'{{ value = …, unit = "{self.known.unit.name}" }}'
        return '{ value = 300, unit = "mm" }' if self.si == "m" else f'{{ value = 1, unit = "{self.si}" }}'

    def read(self, stated: object) -> float:
        """The value in SI; a refusal of what is no such quantity."""
        if self.bare and not isinstance(stated, dict):
            stated = {"value": stated, "unit": self.si}
        if not isinstance(stated, dict) or not {"value", "unit"} <= set(stated) <= {"value", "unit", *BESIDE}:
            raise refusal("is not a value with its unit", example=self.example)
        value, unit = stated["value"], str(stated["unit"])
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise refusal(f"{shown(value)} is not a finite number", example=self.example)
        number = float(value)
        si, factor = (self.si, 1.0) if unit == self.si else si_unit(unit) or ("", 1.0)
        if si not in (self.si, "-" if self.si == "1" else self.si):
            raise refusal(f"{shown(unit)} is not a unit of it", f"its SI unit is {self.si}")
        wrong = None if isinstance(self.known, str) else self.known.refusal(number * factor, number)
        if wrong is not None:
            raise refusal(*wrong)
        return number * factor

    def doubted(self, value: float, stated: object, info: Any) -> None:
        """An InputWarning for a value [SI] that is unusual; `info` is pydantic's ValidationInfo."""
        number = stated.get("value") if isinstance(stated, dict) else None
        written = float(number) if isinstance(number, int | float) else None
        doubt = None if isinstance(self.known, str) else self.known.doubt(value, written)
        if doubt is not None:
            warnings.warn(InputWarning(f"{info.context} {info.field_name}: {doubt}"), stacklevel=2)

    def validated(self, stated: object, info: Any) -> Any:
        """What `read` makes of it, with a warning where that is unusual."""
        value = self.read(stated)
        self.doubted(value, stated, info)
        return value

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        """A float that is read so."""
        return core_schema.with_info_plain_validator_function(self.validated)


@dataclass(frozen=True)
class Holds:
    """What a key holds, as the table of keys says it, where that does not follow from its type."""

    words: str


@dataclass(frozen=True)
class Some:
    """A table in which every key may be missing, as a dict of those that are there; `kinds` by name, as annotated."""

    kinds: Mapping[str, Any]

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        """A dict that is read so."""
        fields: dict[str, Any] = {name: (kind, None) for name, kind in self.kinds.items()}
        table = handler.generate_schema(create_model("Some", __base__=Document, **fields))
        return core_schema.no_info_after_validator_function(_stated, table)


@dataclass(frozen=True)
class Listed:
    """Tables in a row, `[[trials]]`, each with its own `name`.

    Parameters
    ----------
    usual
        Name of one that has none, with `{number}` from 1 and `{key}` of its own keys.
    again
        The first name that stands twice, None where there is none.
    """

    usual: str
    again: Callable[[Iterable[str]], str | None]

    def __get_pydantic_core_schema__(self, source: object, handler: GetCoreSchemaHandler) -> CoreSchema:
        """A tuple with a name for each."""
        named = core_schema.no_info_before_validator_function(self._named, handler(source))
        return core_schema.no_info_after_validator_function(self._require_apart, named)

    def _named(self, rows: Sequence[Any]) -> tuple[Any, ...]:
        return tuple(
            {"name": self.usual.format_map(defaultdict(str, row, number=k)), **row} if isinstance(row, dict) else row
            for k, row in enumerate(rows, 1)
        )

    def _require_apart(self, rows: tuple[Any, ...]) -> tuple[Any, ...]:
        twice = self.again(each.name for each in rows)
        if twice is not None:
            raise refusal(f"two have the name {shown(twice)}", "give each its own name")
        return rows


def read_document(path: Path, kind: type[D], largest: int = LARGEST) -> D:
    """A file of at most `largest` bytes; InputError for what is missing, not known or cannot be."""
    read: D = checked(path, kind, toml_of(path, largest))
    return read


def checked(path: Path, kind: Any, content: object) -> Any:
    """What `kind`, as a field is annotated, makes of the content of a file; InputError as `read_document`."""
    try:
        return TypeAdapter(kind).validate_python(content, context=path)
    except ValidationError as error:
        raise input_error(path, error.errors(include_url=False)[0]) from error


def _stated(table: Document) -> dict[str, Any]:
    """In the order of the declared keys; `model_fields_set` has one of its own in every process."""
    return {name: getattr(table, name) for name in type(table).model_fields if name in table.model_fields_set}


def _word(value: object) -> object:
    """Numbers stand for themselves in names: plate = 1."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
    return str(value) if number else value


def _file_name(name: str) -> str:
    if not _FILE_NAME.fullmatch(name):
        raise refusal(f"{shown(name)} cannot be that of a file", "write letters, digits, - and _")
    return name


def _beside(named: object, info: Any) -> Path:
    """`info` is pydantic's ValidationInfo, whose context is the path of the description."""
    if not isinstance(named, str) or not named.strip():
        raise refusal(f"{shown(named)} is not a path", "write it in quotes, from the folder of this file")
    return Path(info.context).parent / named


def _file(named: object, info: Any) -> Path:
    file = _beside(named, info)
    if not lexists(file):
        raise refusal(f"there is no file {named!s:.200}", "give its path from the study's folder")
    if not isfile(file):  # what is in a file is for its reader
        try:
            regular_file(file)
        except InputError as error:
            raise refusal(f"{named!s:.200}: {error.what}", error.remedy) from error
    return file


def _files(named: object, info: Any) -> tuple[Path, ...]:
    return tuple(_file(each, info) for each in (named if isinstance(named, list) else [named]))


def _names(value: object) -> tuple[str, ...]:
    if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
        raise refusal("is not a list of names", example='["…", "…"]')
    return tuple(value)


def _value(value: object) -> Value:
    if not isinstance(value, Value) or (isinstance(value, float) and not math.isfinite(value)):
        raise refusal(f"{shown(value)} is not a value", "write a text in quotes, a number, true or false")
    return value


def _values(given: object) -> tuple[Value, ...]:
    if not isinstance(given, list) or not given or not all(isinstance(each, Value) for each in given):
        raise refusal("is not a list of values", example='["one", "other"]')
    if len(set(map(str, given))) < len(given):
        raise refusal("has a value twice", "give each once")
    return tuple(given)


def _text(text: str) -> str:
    if not text.strip():
        raise refusal("is empty", "write a text in quotes")
    return text


def _rows(given: object) -> tuple[Any, ...]:
    if not isinstance(given, list) or not all(isinstance(each, dict) and each for each in given):
        raise refusal("is not a list of tables", "write it in double brackets, [[…]], with names and values below")
    return tuple(given)


def doubled(names: Iterable[str]) -> str | None:
    """The first name that stands twice; None where there is none."""
    return next((name for name, count in Counter(names).items() if count > 1), None)


Text = Annotated[str, AfterValidator(_text)]
"""A text that is not empty."""
Word = Annotated[Text, BeforeValidator(_word), Holds("text or number")]
"""A text, or a number as it is written."""
FileName = Annotated[Word, AfterValidator(_file_name), Holds("letters, digits, - and _")]
"""A text that can be part of a file's name."""
Names = Annotated[tuple[str, ...], PlainValidator(_names), Holds("list of names")]
"""A list of texts."""
File = Annotated[Path, PlainValidator(_file), Holds("file")]
"""A file that is there, from the folder of the description."""
Files = Annotated[tuple[Path, ...], PlainValidator(_files), Holds("file, or list of files")]
"""One of them, or a list."""
Beside = Annotated[Path, PlainValidator(_beside), Holds("path")]
"""A path from the folder of the description, which is looked for when it is read."""
AnyValue = Annotated[Value, PlainValidator(_value), Holds("text, number, true or false")]
"""A text, a number, true or false."""
Values = Annotated[tuple[Value, ...], PlainValidator(_values), Holds("list of values")]
"""A list of them, none twice."""
Rows = BeforeValidator(_rows)
"""Tables in a row, `[[leave_out]]`, none of them empty; there may be none."""
