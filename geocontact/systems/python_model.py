"""A base model of the user's own: `system = "package.module:OBJECT"`.

Naming a module runs it, so it is looked for where Python looks (installed packages, PYTHONPATH) and in the current
folder, never in the folder of the case: a case is data, and data from somebody else must not bring code along.
"""

from __future__ import annotations

import sys
from importlib import import_module, invalidate_caches
from os import getcwd
from types import ModuleType

from geocontact.chain.links import Geometry
from geocontact.chain.system import System
from geocontact.data.gap_case import LISTED_SYSTEMS, GapCase
from geocontact.systems.base import Base
from geocontact.systems.validate import refusal, said, validated

FORMER_NAMES = {
    "geocontact.systems.knee_chain": "geocontact.systems.knee_full_chain",
    "geocontact.systems.knee.full_chain": "geocontact.systems.knee_full_chain",
    "geocontact.systems.elastic_joint.model": "geocontact.systems.elastic_joint",
}
"""Modules of the package as existing cases name them, kept for one version, and where these models are now."""


def python_base(case: GapCase) -> Base:
    """The object that the case names; InputError when it cannot be imported or is no base model."""
    module, _, name = case.system.partition(":")
    module = FORMER_NAMES.get(module, module)
    found = getattr(_imported(module, case), name, None)
    if found is None:
        raise refusal(case, f"module {module} has no object {name}", f"write {name} = Base(...) there")
    return _checked(found, case)


def python_system(case: GapCase) -> System:
    """Own model of a case, tried once on every trial; InputError when it cannot be built or does not fit the case."""
    base = python_base(case)
    try:
        system = base.made(case)
    except Exception as error:  # the user's code may raise anything
        raise refusal(case, f"cannot be built: {said(error)}", "correct the case or the model") from error
    if not isinstance(system, System):
        raise refusal(case, f"build gave a {type(system).__name__}", "return a geocontact.chain.system.System")
    if not isinstance(system.geometry, Geometry):
        what = f"its geometry is a {type(system.geometry).__name__}"
        raise refusal(case, what, "it needs what geocontact.chain.links.Geometry has")
    if (system.inputs, system.outputs) != (base.inputs, base.outputs):
        channels = f"{', '.join(system.inputs)} → {', '.join(system.outputs)}"
        raise refusal(case, f"its system has the channels {channels}", "give Base the same inputs and outputs")
    return validated(system, case)


def _imported(module: str, case: GapCase) -> ModuleType:
    if module.partition(".")[0] in sys.stdlib_module_names:
        raise refusal(case, f"{module} is a part of Python, not a model", "name a module of your own")
    try:
        _look_here()
        return import_module(module)
    except ModuleNotFoundError as error:
        remedy = "start from the folder that holds it, set PYTHONPATH, or install it"
        raise refusal(case, f"module {module} cannot be imported: {said(error)}", remedy) from error
    except (Exception, SystemExit) as error:  # the user's module may do anything while it is imported
        raise refusal(case, f"module {module} cannot be imported: {said(error)}", "correct the module") from error


def _look_here() -> None:
    """The current folder is looked at last, from now on: a module may import its neighbours later."""
    here = getcwd()
    if here not in sys.path and "" not in sys.path:
        sys.path.append(here)
    invalidate_caches()


def _checked(found: object, case: GapCase) -> Base:
    """`found` as a Base, whether it is one or merely has what one has."""
    name, build = getattr(found, "name", None), getattr(found, "build", None)
    channels = [getattr(found, side, None) for side in ("inputs", "outputs")]
    named = all(isinstance(names, tuple) and names and all(isinstance(n, str) for n in names) for names in channels)
    if not (isinstance(name, str) and named and callable(build)):
        what = f"is a {type(found).__name__}, not a base model"
        raise refusal(case, what, "it needs name, inputs, outputs and build, as geocontact.systems.base.Base has")
    if name in LISTED_SYSTEMS:
        raise refusal(case, f"is named {name} like a listed system", "give it another name")
    if isinstance(found, Base):
        return found
    return Base(name, channels[0] or (), channels[1] or (), build, tuple(getattr(found, "meshes", ())))
