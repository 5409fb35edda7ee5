"""A simulator of somebody's own made callable: a Python file, an FMU, or a program that is called per trial."""

from __future__ import annotations

import importlib.util
import inspect
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import Any

from geocontact.analyses.gap.init.adapter import fmu_adapter, function_adapter
from geocontact.analyses.gap.init.fmu import FmuVariable, read_fmu
from geocontact.analyses.gap.init.options import InitOptions
from geocontact.analyses.gap.init.starts import shipped_model
from geocontact.chain.system import System
from geocontact.data.errors import InputError
from geocontact.data.gap_case import COMMAND, GapCase
from geocontact.data.parameter import Parameter
from geocontact.io.cases.gap_case import PLACES, program
from geocontact.systems.base import Base
from geocontact.systems.catalogue import SYSTEMS
from geocontact.systems.simulator import simulated_system, simulator_base
from geocontact.systems.validate import said

LOADS = ("N", "N m", "Pa")
"""Units of what a simulator of contact predicts, where nobody says which columns it does."""
Units = Mapping[str, str]
"""SI unit of each column of the trials, by name, in their order."""


@dataclass(frozen=True)
class FoundSimulator:
    """What was found in place of a simulator.

    Parameters
    ----------
    words
        What it is, for sentences.
    system
        As case.toml names it.
    base
        Callable like every base model.
    declared
        Parameters that it brings itself.
    questions
        What it leaves open.
    settings
        Further keys of case.toml with their values in TOML.
    adapter
        Name and text of the module that has to lie beside it; empty where it needs none.
    units
        SI units of its numbers, of those that are known.
    """

    words: str
    system: str
    base: Base
    declared: tuple[Parameter, ...] = ()
    questions: tuple[str, ...] = ()
    settings: tuple[tuple[str, str | tuple[str, ...]], ...] = ()
    adapter: tuple[str, str] = ("", "")
    units: Mapping[str, str] = field(default_factory=dict)


def found_simulator(o: InitOptions, units: Units, case: GapCase) -> FoundSimulator:
    """The simulator that is named; InputError where there is none, or where it is not clear what it takes and gives."""
    if any(place in o.simulator for place in PLACES):
        return _program(o, units)
    if shipped := next((base for base in SYSTEMS if base.name == o.simulator), None):
        return _shipped(shipped, o, units, case)
    path, _, name = o.simulator.partition(".py:")
    file = Path(f"{path}.py" if name else o.simulator)
    if not file.is_file():
        models = ", ".join(base.name for base in SYSTEMS)
        remedy = f'give a .py or .fmu file, {models}, or a command such as "prog {{params}} {{trial}} {{out}}"'
        raise InputError("", "`simulator`", f"there is no file {str(file)!r}", remedy)
    if file.suffix.lower() == ".fmu":
        return _fmu(file, units)
    if file.suffix != ".py":
        what = f"{file.name} is neither a .py nor an .fmu file"
        raise InputError("", "`simulator`", what, f'give the command that runs it: "prog {" ".join(PLACES)}"')
    return _python(file, name, o, units)


def _shipped(base: Base, o: InitOptions, units: Units, case: GapCase) -> FoundSimulator:
    """A base model of the package, whose channels, numbers and tables have names of its own."""
    for option, given in (("outputs", o.outputs), ("inputs", o.inputs), ("acts_on", o.acts_on)):
        if given is not None:
            channels = f"{', '.join(base.inputs)} → {', '.join(base.outputs)}"
            what = f"has no effect: the channels of the model {base.name} are {channels}"
            raise InputError("", f"`{option}`", what, "leave it out")
    system, needed = shipped_model(base, o.number, units, case)
    lacking = [name for name in (*system.inputs, *system.outputs) if name not in units]
    for name, unit in units.items():
        if not lacking and name in system.units and unit != system.unit(name):
            what = f"needs {name} in {system.unit(name)}, the trials give {unit}"
            raise InputError(o.simulator, "", what, "correct column or unit")

    def build(parameters: tuple[Parameter, ...], _constants: Mapping[str, float], _tables: object) -> System:
        return replace(system, parameters=parameters)  # their bounds are open as yet; numbers are known as constants

    own = Base(base.name, system.inputs, system.outputs, build)
    return FoundSimulator(f"the model {base.name}", base.name, own, units=needed)


def _program(o: InitOptions, units: Units) -> FoundSimulator:
    inputs, outputs, questions = _channels(o, units)
    try:
        own = program(o.simulator, inputs, outputs, {name: units[name] for name in (*inputs, *outputs)})
    except ValueError as error:
        raise InputError("", "`simulator`", str(error), "the program gets the paths of three files") from error

    def build(parameters: tuple[Parameter, ...], constants: Mapping[str, float], _tables: object) -> System:
        return simulated_system(COMMAND, own, None, parameters, constants)

    settings = (("simulate", o.simulator), ("inputs", inputs), ("outputs", outputs))
    return FoundSimulator(
        f"the program {own.command[0]}", COMMAND, Base(COMMAND, inputs, outputs, build), (), questions, settings
    )


def _fmu(file: Path, units: Units) -> FoundSimulator:
    variables = read_fmu(file)
    sides = {side: tuple(one for one in variables if one.causality == side) for side in ("input", "output")}
    for side, some in sides.items():
        if not some:
            raise InputError(file, "", f"has no {side}", "an FMU needs inputs and outputs of type Real or Float64")
    used = {one.name: _unit_of(one, file, units) for some in sides.values() for one in some if one.name in units}
    inputs, outputs = (tuple(one.name for one in some if one.name in units) for some in sides.values())
    for side, names in (("input", inputs), ("output", outputs)):
        if not names:
            there = ", ".join(one.name for one in sides[side])
            raise InputError(file, "", f"no {side} is a column of the trials", f"it has {there}; rename the columns")
    declared = tuple(one.parameter for one in variables if one.causality == "parameter")
    text = fmu_adapter(file, {n: used[n] for n in inputs}, {n: used[n] for n in outputs}, [p.name for p in declared])
    module = f"{_identifier(file.stem)}_adapter"
    namespace: dict[str, Any] = {"__file__": str(file.with_name(f"{module}.py")), "__name__": module}
    try:
        exec(compile(text, f"{module}.py", "exec"), namespace)  # noqa: S102 our own text, as it will be written
    except ImportError as error:
        raise InputError(file, "", f"cannot be run: {error}", "pip install fmpy") from error
    open_inputs = [one.name for one in sides["input"] if one.name not in units]
    questions = [f"inputs that no column drives stay at their start: {', '.join(open_inputs)}"] if open_inputs else []
    if held := [p.name for p in declared if p.fixed]:
        questions.append(
            f"which of {', '.join(held)} are to be fitted? Without min and max in the FMU each is fixed; replace "
            "fixed = true by lower and upper"
        )
    return FoundSimulator(
        f"the FMU {file.name}",
        f"{module}:SIMULATOR",
        namespace["SIMULATOR"],
        declared,
        tuple(questions),
        adapter=(f"{module}.py", text),
    )


def _unit_of(one: FmuVariable, file: Path, units: Units) -> str:
    """Unit of a column that drives or checks a variable; InputError where the variable has another one."""
    unit = units[one.name]
    if one.unit and one.unit != unit:
        what = f"{one.name} is in {one.unit}, trials are given to simulators in SI, in {unit}"
        raise InputError(file, "", what, "convert it inside the FMU, or wrap the FMU in a Python run")
    return unit


def _python(file: Path, name: str, o: InitOptions, units: Units) -> FoundSimulator:
    module = _imported(file)
    found = _object_of(module, name, file)
    parameters = getattr(module, "PARAMETERS", ())
    if not isinstance(parameters, tuple) or not all(isinstance(one, Parameter) for one in parameters):
        raise InputError(file, "PARAMETERS", "is no tuple of gc.Parameter", 'write (gc.Parameter("k", "N/m", 300.0),)')
    if isinstance(found[1], Base):
        base = found[1]
        return FoundSimulator(f"{found[0]} of {file.name}", f"{file.stem}:{found[0]}", base, parameters)
    inputs, outputs, questions = _channels(o, units)
    acts_on = _acts_on(found[1], inputs, o, file)
    sides = ({name: units[name] for name in inputs}, {name: units[name] for name in outputs})
    base = simulator_base(_identifier(file.stem), *sides, found[1], acts_on=acts_on)
    own = f"{file.stem}_adapter"
    rows = ", ".join(f"inputs[{k}] = {each} in {units[each]}" for k, each in enumerate(inputs))
    gives = ", ".join(f"{each} in {units[each]}" for each in outputs)
    questions = (*questions, f"does {found[0]} take time in s, {rows}, and give {gives}? All are SI units here")
    return FoundSimulator(
        f"{found[0]} of {file.name}",
        f"{own}:SIMULATOR",
        base,
        parameters,
        questions,
        adapter=(f"{own}.py", function_adapter(file.stem, found[0], *sides, acts_on)),
    )


def _imported(file: Path) -> ModuleType:
    """The module in a file; neighbours of the file may be imported by it."""
    specification = importlib.util.spec_from_file_location(file.stem, file)
    if specification is None or specification.loader is None or not file.stem.isidentifier():
        raise InputError(file, "", "is no name of a Python module", "rename it to letters, digits and _")
    module = importlib.util.module_from_spec(specification)
    folder = str(file.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)
    try:
        specification.loader.exec_module(module)
    except (Exception, SystemExit) as error:  # the user's module may do anything while it is imported
        raise InputError(file, "", f"cannot be imported: {said(error)}", "correct the module") from error
    return module


def _object_of(module: ModuleType, name: str, file: Path) -> tuple[str, Any]:
    """Name and object: the one that is named, else the only base model, else `run`."""
    if name:
        if not callable(getattr(module, name, None)) and not isinstance(getattr(module, name, None), Base):
            raise InputError(file, "", f"has no function or base model {name!r}", "name one that it has")
        return name, getattr(module, name)
    bases = [key for key, value in vars(module).items() if isinstance(value, Base)]
    if len(bases) > 1:
        remedy = f"name one: {file.name}:{bases[0]}"
        raise InputError(file, "", f"has {len(bases)} base models, {', '.join(bases)}", remedy)
    if bases:
        return bases[0], getattr(module, bases[0])
    if callable(getattr(module, "run", None)):
        return "run", module.run
    remedy = "write run(time, inputs, numbers), which returns a row per time, or name another function: mine.py:NAME"
    raise InputError(file, "", "has neither a base model nor a function run", remedy)


def _channels(o: InitOptions, units: Units) -> tuple[tuple[str, ...], tuple[str, ...], tuple[str, ...]]:
    """Columns that drive the simulator, those that it predicts, and what is open about them."""
    outputs = _listed(o.outputs, "outputs", units) or tuple(name for name, unit in units.items() if unit in LOADS)
    inputs = _listed(o.inputs, "inputs", units) or tuple(name for name in units if name not in outputs)
    columns = ", ".join(f"{name} [{unit}]" for name, unit in units.items())
    if both := [name for name in inputs if name in outputs]:
        raise InputError("", "`inputs`", f"{both[0]} is among the outputs too", "a column is one or the other")
    for option, names in (("outputs", outputs), ("inputs", inputs)):
        if not names:
            raise InputError("", f"`{option}`", "not clear from the units of the columns", f"name some of {columns}")
    if o.outputs is not None:
        return inputs, outputs, ()
    every = ", ".join(outputs)
    return inputs, outputs, (f"are {every} the outputs? They are in {', '.join(LOADS)}; else give `outputs`",)


def _listed(text: str | None, option: str, units: Units) -> tuple[str, ...]:
    if text is None:
        return ()
    names = tuple(name.strip() for name in text.split(",") if name.strip())
    if wrong := [name for name in names if name not in units]:
        raise InputError("", f"`{option}`", f"no column {wrong[0]!r}", f"the trials have {', '.join(units)}")
    return names


def _acts_on(function: Callable[..., object], inputs: Sequence[str], o: InitOptions, file: Path) -> str:
    """Input that the law of a function acts on, "" for a function without a law."""
    taken = [
        p
        for p in inspect.signature(function).parameters.values()
        if p.default is p.empty and p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)
    ]
    if len(taken) not in (3, 4):
        what = f"takes {len(taken)} arguments"
        raise InputError(file, "", what, "it is called with time, inputs, numbers, and the law where it takes four")
    if len(taken) == 3:
        if o.acts_on is not None:
            raise InputError("", "`acts_on`", "the function takes no law", "leave it out, or write run(…, law)")
        return ""
    name = o.acts_on or (inputs[0] if len(inputs) == 1 else "")
    if name not in inputs:
        raise InputError("", "`acts_on`", f"is {name!r}" if name else "is missing", f"name one of {', '.join(inputs)}")
    return name


def _identifier(text: str) -> str:
    made = "".join(letter if letter.isalnum() else "_" for letter in text)
    return made if made.isidentifier() else f"model_{made}"
