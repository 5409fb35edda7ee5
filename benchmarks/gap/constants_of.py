"""Numbers that modules of the package are built on, and a process in which some of them are others."""

from __future__ import annotations

import ast
import importlib
import inspect
import multiprocessing
import pkgutil
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar, cast

import geocontact

T = TypeVar("T")
Value = Any
"""A number, or a table: numbers in tuples, of tuples perhaps."""


@dataclass(frozen=True)
class Constant:
    """A number or a table with a name at the top of a module; `label` has the module without the package."""

    module: str
    name: str
    value: Value

    @property
    def label(self) -> str:
        """As the table of the theory has it."""
        return f"{self.module.removeprefix('geocontact.')}.{self.name}"

    def times(self, factor: float) -> Value:
        """So many times as large, every number of a table; a count stays a count, of one at the least, and 0 is 0."""
        return _times(self.value, factor)


def _times(value: Value, factor: float) -> Value:
    if isinstance(value, tuple):
        return tuple(_times(each, factor) for each in value)
    if isinstance(value, int):
        return (1 if value > 0 else -1) * max(1, round(abs(value) * factor)) if value else 0
    return value * factor


def constants(rooms: Sequence[str]) -> list[Constant]:
    """Numbers of these rooms, in the order of modules and lines; neither words nor tables of several values.

    Of modules that a diagnosis imports: others are of other analyses.
    """
    return [Constant(*each) for each, _ in _named(rooms) if _is_number(each[2])]


def tables(rooms: Sequence[str]) -> list[Constant]:
    """Tables of numbers of these rooms, in the same order, if numbers are written where they stand.

    What is worked out of other constants is no choice of its own.
    """

    def whole(value: Value) -> bool:
        return all(map(whole, value)) if isinstance(value, tuple) and value else _is_number(value)

    def written(node: ast.expr) -> bool:
        numbers = [each.value for each in ast.walk(node) if isinstance(each, ast.Constant)]
        return _is_literal(node) or any(_is_number(each) and not _plain(each) for each in numbers)

    found = [Constant(*each) for each, node in _named(rooms) if isinstance(each[2], tuple) and written(node)]
    return [each for each in found if whole(each.value)]


def numbers_in(value: Value) -> list[float | int]:
    """Numbers of a constant, one after the other."""
    return [number for each in value for number in numbers_in(each)] if isinstance(value, tuple) else [value]


def _named(rooms: Sequence[str]) -> Iterator[tuple[tuple[str, str, Any], ast.expr]]:
    """Module, name and value of whatever has a name in capitals, and what stands behind it."""
    for module in _modules(rooms):
        for node in ast.parse(inspect.getsource(module)).body:
            for name, right in _names(node):
                yield (module.__name__, name, getattr(module, name)), right


def _is_number(value: Value) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_literal(node: ast.expr) -> bool:
    try:
        ast.literal_eval(node)
    except ValueError:
        return False
    return True


def bare(rooms: Sequence[str]) -> list[tuple[str, float | int]]:
    """Numbers without a name in functions of these rooms, with their module: no counts to two, halves, powers of ten.

    Nor what stands in words, or numbers the places of a sequence.
    """
    found = []
    for module in _modules(rooms):
        for node in ast.walk(ast.parse(inspect.getsource(module))):
            if isinstance(node, (ast.FunctionDef, ast.Lambda)):
                found += [(module.__name__, each) for each in _numbers(node) if not _plain(each)]
    return found


def put(changed: Mapping[Constant, Value]) -> None:
    """Put other numbers in place of these constants, in all modules that have been loaded, for this process.

    Functions read them when they are called; where one is the default of an argument, that is changed too. What was
    compiled or worked out before stays as it was.
    """
    for constant, value in changed.items():
        home = sys.modules[constant.module]
        setattr(home, constant.name, value)
        _put_defaults(home, constant.name)
        for module in [m for name, m in sys.modules.items() if name.startswith("geocontact.")]:
            for here in _imported(module, constant):
                setattr(module, here, value)
                _put_defaults(module, here)


def with_others(changed: Mapping[Constant, Value], work: Callable[[], T]) -> T | None:
    """What is worked out in a process of its own, whose constants end with it; None where that ended before.

    The process is forked, so that it has what the caller has: Linux and macOS only.
    """
    context = multiprocessing.get_context("fork")
    receive, send = context.Pipe(duplex=False)
    process = context.Process(target=_sent, args=(changed, work, send))
    process.start()
    send.close()
    try:
        return cast("T", receive.recv())
    except EOFError:
        return None
    finally:
        process.join()


def _sent(changed: Mapping[Constant, Value], work: Callable[[], Any], send: Any) -> None:
    put(changed)
    send.send(work())


def _put_defaults(module: ModuleType, name: str) -> None:
    """Defaults of arguments that say this name, worked out anew from what stands behind it now."""

    def anew(default: ast.expr | None, old: Any) -> Any:
        said = {each.id for each in ast.walk(default) if isinstance(each, ast.Name)} if default else set()
        return eval(ast.unparse(default), vars(module)) if default and name in said else old

    for node in (each for each in ast.parse(inspect.getsource(module)).body if isinstance(each, ast.FunctionDef)):
        function = inspect.unwrap(getattr(module, node.name))
        if function.__defaults__:
            function.__defaults__ = tuple(map(anew, node.args.defaults, function.__defaults__))
        for argument, default in zip(node.args.kwonlyargs, node.args.kw_defaults, strict=True):
            if default is not None:
                function.__kwdefaults__[argument.arg] = anew(default, function.__kwdefaults__[argument.arg])


def _modules(rooms: Sequence[str]) -> Iterator[ModuleType]:
    for found in pkgutil.walk_packages(geocontact.__path__, "geocontact."):
        inside = any(f"{found.name}.".startswith(f"geocontact.{room}.") for room in rooms)
        if not found.ispkg and inside and found.name in in_use():
            yield importlib.import_module(found.name)


@cache
def in_use(by: str = "geocontact.gap.diagnose") -> frozenset[str]:
    """Modules of the package that one imports, itself or through others, at the top or when it is called."""
    seen, waiting = {by}, [by]
    while waiting:
        found = find_spec(waiting.pop())
        if found is None or found.origin is None:
            continue
        for node in ast.walk(ast.parse(Path(found.origin).read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("geocontact"):
                named = [str(node.module), *(f"{node.module}.{alias.name}" for alias in node.names)]
                new = [name for name in named if name not in seen and _is_module(name)]
                seen.update(new)
                waiting += new
    return frozenset(seen)


def _is_module(name: str) -> bool:
    try:
        return find_spec(name) is not None
    except ModuleNotFoundError:  # what it is named in is no package
        return False


def _names(node: ast.stmt) -> list[tuple[str, ast.expr]]:
    """Names in capitals that a line gives, each with its part of what stands behind."""
    if not isinstance(node, ast.Assign):
        return []
    found: list[tuple[ast.expr, ast.expr]] = []
    for target in node.targets:
        if isinstance(target, ast.Tuple):
            right = node.value.elts if isinstance(node.value, ast.Tuple) else [node.value] * len(target.elts)
            found += zip(target.elts, right, strict=True)
        else:
            found.append((target, node.value))
    return [(each.id, right) for each, right in found if isinstance(each, ast.Name) and each.id.isupper()]


def _numbers(node: ast.FunctionDef | ast.Lambda) -> Iterator[float | int]:
    """Of a function, those of functions in it aside."""
    body = node.body if isinstance(node.body, list) else [node.body]
    waiting: list[ast.AST] = [*body, *node.args.defaults, *(each for each in node.args.kw_defaults if each is not None)]
    while waiting:
        one = waiting.pop()
        if isinstance(one, ast.Constant) and type(one.value) in (int, float):
            yield one.value
        if isinstance(one, ast.Subscript):
            places = one.slice.elts if isinstance(one.slice, ast.Tuple) else [one.slice]
            waiting += [one.value, *(each for each in places if not isinstance(each, ast.Constant))]
        elif not isinstance(one, (ast.FunctionDef, ast.Lambda)):
            waiting += ast.iter_child_nodes(one)


def _plain(number: float | int) -> bool:
    """Whether it is no choice by itself: a count to two, a half, a power of ten."""
    return number in (0, 0.5, 1, 2) or f"{number:e}".startswith("1.000000e")


def _imported(module: ModuleType, constant: Constant) -> list[str]:
    """What a module calls a constant that it has from another one."""
    if getattr(module, "__file__", None) is None or not vars(module).keys() & {constant.name}:
        return []
    return [own for where, name, own in _imports(module) if (where, name) == (constant.module, constant.name)]


@cache
def _imports(module: ModuleType) -> list[tuple[str | None, str, str]]:
    """From which module, what, and under which name a module imports: read once, as parsing all for each is slow."""
    asked = [node for node in ast.walk(ast.parse(inspect.getsource(module))) if isinstance(node, ast.ImportFrom)]
    return [(node.module, alias.name, alias.asname or alias.name) for node in asked for alias in node.names]
