"""The address of a trial's results: a digest of all that they depend on.

It is made of the analysis, its options in SI, the content of the files that these name, the sources of the package
that the analysis can import and the versions of its libraries. A file among the results of an earlier step counts by
its content, not by the address of those. Files that an analysis finds by itself, such as those that a settings file
names, stand in `run.json` and are compared when results are used again.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import chdir
from glob import glob, has_magic
from pathlib import Path
from typing import Any, get_args, get_origin

from geocontact.analyses.frame.calls import key
from geocontact.analyses.frame.folder import digest
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.options import Declared, Options, declared
from geocontact.data.errors import InputError
from geocontact.study.code_version import code_version

LENGTH = 32
"""Hexadecimal digits of an address: 128 bits."""
ONE_THREAD = "workers"
"""Option of analyses that use several cores: in a study each trial has one, unless the study says otherwise."""


class Digests:
    """SHA-256 of files, each read once as long as its size and time stay."""

    def __init__(self) -> None:
        self._known: dict[tuple[str, int, int], str] = {}

    def of(self, file: Path) -> str:
        """The digest of one file."""
        state = file.stat()
        place = (str(file.absolute()), state.st_size, state.st_mtime_ns)
        if place not in self._known:
            self._known[place] = digest(file)
        return self._known[place]


def options_of(options: type[Options], typed: Mapping[str, Any]) -> Options:
    """Options from what a study says, by their names in run.json or in Python; paths from the present folder."""
    known = {**{one.name: one for one in declared(options)}, **{key(one): one for one in declared(options)}}
    given = {}
    for name, value in typed.items():
        one = known.get(name)
        if one is None or not one.settable:
            names = ", ".join(key(each) for each in known.values() if each.settable)
            raise InputError("", f"`{name}`", "is not an option of this analysis", f"there are {names}")
        given[one.name] = one.read(as_typed(one, value))
    if ONE_THREAD in known and ONE_THREAD not in given:
        given[ONE_THREAD] = 1
    missing = next((one for one in known.values() if one.required and one.name not in given), None)
    if missing is not None:
        raise InputError("", f"`{missing.name}`", "is missing", "add it to [options]")
    return options(**given)


def as_typed(one: Declared, value: Any) -> Any:
    """What would be typed: lists with commas, where text is read; InputError for a value of another kind."""
    kind: Any = one.kind if one.typed is None else one.typed.kind
    if get_origin(kind) is tuple:
        return tuple(_item(one, get_args(kind)[0], each) for each in (value if isinstance(value, list) else [value]))
    if kind is str and isinstance(value, list):  # the options refuse more than one where nothing reads the text
        return value if one.typed is None else ",".join(_item(one, str, each) for each in value)
    return _item(one, kind, value)


def _item(one: Declared, kind: Any, value: Any) -> Any:
    """A value that is no list; numbers stand for texts, and texts for numbers where a pattern found them."""
    number = isinstance(value, (int, float)) and not isinstance(value, bool)
    if kind is str and number:
        return str(value)
    if kind in (int, float) and isinstance(value, str):
        try:
            return kind(value)
        except ValueError:
            pass
    right = {Path: isinstance(value, str), str: isinstance(value, str), bool: isinstance(value, bool)}
    right |= {float: number, int: number and float(value).is_integer()}
    if not right.get(kind, True):
        remedy = {Path: "a path in quotes", str: "a text in quotes", bool: "true or false", float: "a number"}
        raise InputError("", f"`{one.name}`", f"cannot be {value!r:.60}", f"write {remedy.get(kind, 'a whole number')}")
    return int(value) if kind is int else value


def address_of(
    job: Job[Any, Any],
    options: Options,
    home: Path,
    digests: Digests,
    taken: Sequence[str] = (),
    without: Collection[str] = (),
) -> str:
    """Address of results; paths of the options start from `home`, and count by name and content.

    Parameters
    ----------
    taken
        Folders of earlier results that options name, as they stand in these: their place in the list counts.
    without
        What is not written.
    """

    def named(text: str) -> str:
        for k, place in enumerate(taken):
            text = text.replace(place, f"{{{k}}}")
        return text

    with chdir(home):
        files = {named(path.as_posix()): digests.of(path) for path in _files(options)}
    depends = {
        "command": job.command,
        "options": {name: _plain(value, named) for name, value in options.in_si().items()},
        "files": files,
        **code_version(job.run.__module__),
        **({"without": sorted(without)} if without else {}),
    }
    return hashlib.sha256(json.dumps(depends, sort_keys=True).encode()).hexdigest()[:LENGTH]


def contents_of(options: Options, home: Path, digests: Digests) -> tuple[str, tuple[str, ...]]:
    """A digest of what options ask, whatever their files are called, and the names of these files."""
    with chdir(home):
        files = {path.as_posix(): digests.of(path) for path in _files(options)}

    def content(text: str) -> str:
        for name in sorted(files, key=len, reverse=True):
            text = text.replace(name, files[name])
        return text

    plain = {name: _plain(value, content) for name, value in options.in_si().items()}
    return hashlib.sha256(json.dumps(plain, sort_keys=True).encode()).hexdigest(), tuple(sorted(files))


def _plain(value: object, named: Callable[[str], str]) -> object:
    if isinstance(value, (list, tuple)):
        return [_plain(each, named) for each in value]
    if isinstance(value, Mapping):
        return {str(name): _plain(each, named) for name, each in value.items()}
    if isinstance(value, (int, float, bool)) or value is None:
        return value
    return named(value.as_posix() if isinstance(value, Path) else str(value))


def _files(options: Options) -> Iterator[Path]:
    """Files that options name, those in folders and those that patterns find among them."""
    for one in declared(type(options)):
        for text in _texts(getattr(options, one.name)):
            for name in (text, text.partition(":")[0]):
                yield from _below(name)


def _texts(value: object) -> Iterator[str]:
    if isinstance(value, (str, Path)):
        yield str(value)
    elif isinstance(value, tuple):
        for each in value:
            yield from _texts(each)


def _below(name: str) -> Iterator[Path]:
    try:
        path = Path(name)
        if path.is_file():
            yield path
        elif path.is_dir() and name:
            yield from sorted(each for each in path.rglob("*") if each.is_file())
        elif has_magic(name):
            yield from (Path(each) for each in sorted(glob(name)) if Path(each).is_file())
    except (OSError, ValueError):  # a text that no file can be named
        return
