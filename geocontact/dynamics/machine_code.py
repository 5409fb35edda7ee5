"""CasADi functions of scalars as machine code, by the LLVM that numba brings: no compiler is needed.

CasADi interprets one operation after another; here each is one instruction of LLVM's language, in the same order and
with the same rounding, so that results are equal but for signs of zero (fmin, fmax, copysign). Functions of some
hundred thousand operations are cut into pieces, because a compiler's time grows faster than the length of what it sees
at once; values that a later piece needs are stored where CasADi's own interpreter stores them. Code is made without
optimisation: for operations without branches it gains a fifth and costs ten times as much.

A step of a prosthetic stance (117,896 operations) is translated in 1.3 CPU s and read again in 0.02; a call takes 0.05
ms, CasADi's own 0.6.
"""

from __future__ import annotations

import ctypes
import hashlib
import struct
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

from geocontact.dynamics.code_cache import keep, kept

if TYPE_CHECKING:
    from casadi import Function

PIECE = 500
"""Operations that are compiled at once."""
VERSION = "2"
"""Version of this translation: code that an earlier one kept is not found."""

ARITHMETIC = {"ADD": "fadd", "SUB": "fsub", "MUL": "fmul", "DIV": "fdiv"}
COMPARED = {"LT": "olt", "LE": "ole", "EQ": "oeq", "NE": "une"}
"""CasADi's comparisons give 0 or 1; a NaN is unequal to everything, as in C."""
SHORT = {
    "TWICE": "fadd double {0}, {0}",
    "SQ": "fmul double {0}, {0}",
    "NEG": "fneg double {0}",
    "INV": "fdiv double 1.0, {0}",
    "ASSIGN": "fadd double {0}, -0.0",
}
"""Operations of one number in one instruction."""
CALLED = {
    **{name: name.lower() for name in ("SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "ATAN2", "SINH", "COSH", "TANH")},
    **{name: name.lower() for name in ("ASINH", "ACOSH", "ATANH", "EXP", "LOG", "POW", "FLOOR", "CEIL", "LOG1P")},
    **{name: name.lower() for name in ("EXPM1", "FMOD", "COPYSIGN", "ERF", "HYPOT", "FMIN", "FMAX")},
    "CONSTPOW": "pow",
}
"""Functions of C's library that CasADi's interpreter calls too."""
DECIDED = ("NOT", "AND", "OR", "SIGN", "IF_ELSE_ZERO")
OWN = {"SQRT": "llvm.sqrt.f64", "FABS": "llvm.fabs.f64"}
"""What is an instruction of the processor."""


@dataclass(frozen=True)
class MachineCode:
    """A function that has been compiled: void (const double **arguments, double **results, double *work).

    Parameters
    ----------
    address
        Where it begins; valid as long as this object is.
    work
        Numbers that it works on.
    engine
        Owner of the memory.
    """

    address: int
    work: int
    engine: Any = field(repr=False)

    @property
    def run(self) -> Any:
        """What ctypes calls, with the addresses of two lists of addresses and of the work."""
        return ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p, ctypes.c_void_p)(self.address)


MOST = 64
"""Functions that a process keeps in memory: those asked for last."""
_IN_MEMORY: dict[str, MachineCode] = {}


def machine_code(function: Function) -> MachineCode | None:
    """The function's machine code, kept in memory and in the cache, and found again by all that it is made of.

    None where an operation has no translation, or where this machine may not compile. ValueError for a sparse output.
    Where nothing can be kept between runs it is made in each.
    """
    refuse_sparse(function)
    if not function.is_a("SXFunction"):
        return None
    text, work = function.serialize(), function.sz_w()

    def read(code: bytes) -> MachineCode | None:
        return _placed(code, work)

    return _found(text, read, lambda machine: _translated_code(function, machine))


@dataclass(frozen=True)
class Recipe:
    """A function that is made only where its machine code is not kept; all its outputs are dense.

    Parameters
    ----------
    made_of
        What determines it, but for the versions of CasADi and LLVM: the text of whatever makes it among this.
    inputs, outputs
        How many numbers each has.
    make
        Makes it.
    """

    made_of: str
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    make: Callable[[], Function]

    def machine_code(self) -> MachineCode | None:
        """The function's machine code, kept and found again by what the function is made of; else as `machine_code`."""

        def made(machine: Any) -> bytes | None:
            function = self.make()
            code = _translated_code(function, machine)
            return None if code is None else struct.pack("<q", function.sz_w()) + code

        return _found(f"recipe {self.made_of}", _with_its_work, made)


def _with_its_work(content: bytes) -> MachineCode | None:
    """What `Recipe` keeps: how many numbers the code works on, and the code."""
    (work,) = struct.unpack("<q", content[:8])
    return _placed(content[8:], work)


def _found(
    text: str, read: Callable[[bytes], MachineCode | None], made: Callable[[Any], bytes | None]
) -> MachineCode | None:
    """Machine code by what it is made of: in memory, in the cache, or made for the machine and kept."""
    target = _target()
    if target is None:
        return None
    machine, key = target
    name = hashlib.sha256("\0".join((VERSION, str(PIECE), key, text)).encode()).hexdigest()
    found = _IN_MEMORY.get(name) or _read_or_made(f"{name}.o", read, lambda: made(machine))
    if found is not None:
        _IN_MEMORY.pop(name, None)
        _IN_MEMORY[name] = found
        for earliest in list(_IN_MEMORY)[:-MOST]:
            _IN_MEMORY.pop(earliest, None)
    return found


def refuse_sparse(function: Function) -> None:
    """ValueError for an output with zeros that are not stored: its numbers would be taken for others."""
    for k in range(function.n_out()):
        if not function.sparsity_out(k).is_dense():
            raise ValueError(f"output {function.name_out(k)} of {function.name()} is sparse: densify it")


def _read_or_made(
    file: str, read: Callable[[bytes], MachineCode | None], made: Callable[[], bytes | None]
) -> MachineCode | None:
    code = kept(file)
    if code is not None and (found := read(code)) is not None:
        return found
    code = made()
    found = None if code is None else read(code)
    if code is not None and found is not None:
        keep(file, code)
    return found


def _translated_code(function: Function, machine: Any) -> bytes | None:
    source = translated(function)
    return None if source is None else _emitted(source, machine)


@cache
def _target() -> tuple[Any, str] | None:
    """The machine to compile for, and its name; none of its extensions: fused operations would round otherwise."""
    import llvmlite
    from casadi import CasadiMeta
    from llvmlite import binding

    try:
        binding.initialize_native_target()
        binding.initialize_native_asmprinter()
        machine = binding.Target.from_default_triple().create_target_machine(opt=0, jit=True)
    except RuntimeError:
        return None
    return machine, f"{machine.triple} llvmlite {llvmlite.__version__} casadi {CasadiMeta.version()}"


def _emitted(source: str, machine: Any) -> bytes | None:
    """Machine code; None where LLVM refuses."""
    from llvmlite import binding

    try:
        return bytes(machine.emit_object(binding.parse_assembly(source)))
    except RuntimeError:
        return None


def _placed(code: bytes, work: int) -> MachineCode | None:
    """Machine code in memory, ready to run; None where LLVM cannot read it or memory may not be run."""
    from llvmlite import binding

    try:
        machine = binding.Target.from_default_triple().create_target_machine(opt=0, jit=True)
        engine = binding.create_mcjit_compiler(binding.parse_assembly(""), machine)  # owns the machine it is given
        engine.add_object_file(binding.ObjectFileRef.from_data(code))
        engine.finalize_object()
        address = engine.get_function_address("whole")
    except RuntimeError:
        return None
    return MachineCode(address, work, engine) if address else None


class _Operation(NamedTuple):
    """One of CasADi's.

    Parameters
    ----------
    kind
        Its name without "OP_".
    places
        As CasADi numbers them: places in the work of what it takes; of an input its argument and number there; of an
        output its result and number there.
    into
        Place in the work of what it gives.
    given
        Which operations made what it takes.
    constant
        Of a constant.
    """

    kind: str
    places: tuple[int, ...]
    into: int
    given: tuple[int, ...]
    constant: float


def translated(function: Function) -> str | None:
    """The function in LLVM's language; None where an operation has no translation."""
    operations = _operations(function)
    known = {*ARITHMETIC, *COMPARED, *CALLED, *OWN, *SHORT, "INPUT", "OUTPUT", "CONST", *DECIDED}
    if any(each.kind not in known for each in operations):
        return None
    last = [-1] * len(operations)
    for k, each in enumerate(operations):
        for made in each.given:
            last[made] = k
    lines = [f"declare double @{name}(double)" for name in OWN.values()]
    for kind, name in CALLED.items():
        count = next((len(each.given) for each in operations if each.kind == kind), 0)
        if count and not (kind == "CONSTPOW" and any(each.kind == "POW" for each in operations)):
            lines.append(f"declare double @{name}({', '.join(['double'] * count)})")
    starts = range(0, len(operations), PIECE)
    for number, start in enumerate(starts):
        lines.append(f"define internal void @p{number}(double** %a, double** %r, double* %w) noinline {{")
        lines += _Part(operations, last, start, min(start + PIECE, len(operations))).lines()
        lines += ["ret void", "}"]
    lines.append("define void @whole(double** %a, double** %r, double* %w) {")
    lines += [f"call void @p{number}(double** %a, double** %r, double* %w)" for number in range(len(starts))]
    return "\n".join([*lines, "ret void", "}", ""])


def _operations(function: Function) -> list[_Operation]:
    names, found = _names(), list[_Operation]()
    made: dict[int, int] = {}
    for k in range(function.n_instructions()):
        kind = names.get(function.instruction_id(k), "")
        taken, given = tuple(function.instruction_input(k)), tuple(function.instruction_output(k))
        constant = function.instruction_constant(k) if kind == "CONST" else 0.0
        if kind == "OUTPUT":
            found.append(_Operation(kind, given, -1, (made[taken[0]],), constant))
            continue
        from_where = () if kind in ("INPUT", "CONST") else tuple(made[place] for place in taken)
        found.append(_Operation(kind, taken, given[0] if len(given) == 1 else -1, from_where, constant))
        if len(given) == 1:
            made[given[0]] = k
    return found


@cache
def _names() -> dict[int, str]:
    import casadi

    return {getattr(casadi, name): name[3:] for name in dir(casadi) if name.startswith("OP_")}


class _Part:
    """Instructions of the operations from `first` to before `end`."""

    def __init__(self, operations: list[_Operation], last: list[int], first: int, end: int) -> None:
        self.operations, self.last, self.first, self.end = operations, last, first, end
        self.known: set[str] = set()
        self.found: list[str] = []

    def lines(self) -> list[str]:
        """All of them."""
        for k in range(self.first, self.end):
            one = self.operations[k]
            if one.kind == "OUTPUT":
                value = self._value(one.given[0])
                place = self._at(self._column("r", one.places[0]), one.places[1], f"%o{k}")
                self.found.append(f"store double {value}, double* {place}")
                continue
            self.found += list(self._made(k, one))  # which itself adds what is loaded first
            if self.last[k] >= self.end:
                self.found.append(f"store double %v{k}, double* {self._at('%w', one.into, f'%s{k}')}")
        return self.found

    def _made(self, k: int, one: _Operation) -> Iterator[str]:
        """What gives %v of an operation."""
        if one.kind == "INPUT":
            place = self._at(self._column("a", one.places[0]), one.places[1], f"%i{k}")
            yield f"%v{k} = load double, double* {place}"
            return
        if one.kind == "CONST":
            (bits,) = struct.unpack("<Q", struct.pack("<d", one.constant))
            yield f"%v{k} = fadd double 0x{bits:016X}, -0.0"
            return
        given = [self._value(made) for made in one.given]
        if one.kind in ARITHMETIC:
            yield f"%v{k} = {ARITHMETIC[one.kind]} double {given[0]}, {given[1]}"
        elif one.kind in SHORT:
            yield f"%v{k} = {SHORT[one.kind].format(given[0])}"
        elif one.kind in CALLED or one.kind in OWN:
            name = CALLED.get(one.kind) or OWN[one.kind]
            yield f"%v{k} = call double @{name}({', '.join(f'double {each}' for each in given)})"
        else:
            yield from _decided(k, one.kind, given)

    def _value(self, made: int) -> str:
        """Name of an operation's result, loaded where an earlier piece made it."""
        name = f"%v{made}"
        if made < self.first and name not in self.known:
            self.known.add(name)
            place = self._at("%w", self.operations[made].into, f"%l{made}")
            self.found.append(f"{name} = load double, double* {place}")
        return name

    def _column(self, of: str, number: int) -> str:
        """Name of the address of an argument or a result."""
        name = f"%{of}{number}x"
        if name not in self.known:
            self.known.add(name)
            self.found.append(f"%{of}{number}y = getelementptr double*, double** %{of}, i64 {number}")
            self.found.append(f"{name} = load double*, double** %{of}{number}y")
        return name

    def _at(self, base: str, number: int, name: str) -> str:
        self.found.append(f"{name} = getelementptr double, double* {base}, i64 {number}")
        return name


def _decided(k: int, kind: str, given: list[str]) -> Iterator[str]:
    """Comparisons and logic: every number but zero is true, NaN too."""
    if kind in COMPARED:
        yield f"%b{k} = fcmp {COMPARED[kind]} double {given[0]}, {given[1]}"
    elif kind == "NOT":
        yield f"%b{k} = fcmp oeq double {given[0]}, 0.0"
    elif kind in ("AND", "OR"):
        for side, each in zip("cd", given, strict=True):
            yield f"%{side}{k} = fcmp une double {each}, 0.0"
        yield f"%b{k} = {kind.lower()} i1 %c{k}, %d{k}"
    elif kind == "IF_ELSE_ZERO":
        yield f"%b{k} = fcmp une double {given[0]}, 0.0"
        yield f"%v{k} = select i1 %b{k}, double {given[1]}, double 0.0"
        return
    elif kind == "SIGN":
        yield f"%c{k} = fcmp olt double {given[0]}, 0.0"
        yield f"%d{k} = fcmp ogt double {given[0]}, 0.0"
        yield f"%e{k} = select i1 %d{k}, double 1.0, double {given[0]}"
        yield f"%v{k} = select i1 %c{k}, double -1.0, double %e{k}"
        return
    yield f"%v{k} = uitofp i1 %b{k} to double"
