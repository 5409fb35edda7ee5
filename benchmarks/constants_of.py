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


@dataclass(frozen=True)
class Constant:
    """A number with a name at the top of a module; `label` has the module without the package."""

    module: str
    name: str
    value: float | int

    @property
    def label(self) -> str:
        """As the table of the theory has it."""
        return f"{self.module.removeprefix('geocontact.')}.{self.name}"

    def times(self, factor: float) -> float | int:
        """So many times as large; a count stays a count, of one at the least."""
        if isinstance(self.value, int):
            return max(1, round(self.value * factor))
        return self.value * factor


def constants(rooms: Sequence[str]) -> list[Constant]:
    """All of these rooms, in the order of modules and lines; neither words nor tables of several values.

    Of modules that a diagnosis imports: others are of other analyses.
    """
    found = []
    for module in _modules(rooms):
        tree = ast.parse(inspect.getsource(module))
        for name in (name for node in tree.body for name in _names(node)):
            value = getattr(module, name)
            if isinstance(value, (int, float)) and not isinstance(value, bool):
                found.append(Constant(module.__name__, name, value))
    return found


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


def put(changed: Mapping[Constant, float | int]) -> None:
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


def with_others(changed: Mapping[Constant, float | int], work: Callable[[], T]) -> T | None:
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


def _sent(changed: Mapping[Constant, float | int], work: Callable[[], Any], send: Any) -> None:
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


def _names(node: ast.stmt) -> list[str]:
    if not isinstance(node, ast.Assign):
        return []
    targets = [part for target in node.targets for part in (target.elts if isinstance(target, ast.Tuple) else [target])]
    return [each.id for each in targets if isinstance(each, ast.Name) and each.id.isupper()]


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
    asked = [node for node in ast.walk(ast.parse(inspect.getsource(module))) if isinstance(node, ast.ImportFrom)]
    taken = [alias for node in asked if node.module == constant.module for alias in node.names]
    return [alias.asname or alias.name for alias in taken if alias.name == constant.name]
