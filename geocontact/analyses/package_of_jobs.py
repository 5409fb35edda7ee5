"""A package whose attributes are its analyses and not the sub-packages that have their names."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import Any


class PackageOfJobs(ModuleType):
    """Class of such a package: every name in its `__all__` is in the module `job` or `result` of its sub-package."""

    def __getattribute__(self, name: str) -> Any:
        known = super().__getattribute__
        if name in known("__dict__").get("__all__", ()):  # importing a sub-package sets an attribute of its name
            home = f"{known('__name__')}.{name}"
            return getattr(import_module(f"{home}.job" if find_spec(f"{home}.job") else f"{home}.result"), name)
        return known(name)
