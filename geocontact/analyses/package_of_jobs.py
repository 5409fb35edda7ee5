"""A package whose attributes are its analyses and not the sub-packages that have their names."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType
from typing import Any

from geocontact.analyses.job import Job


class PackageOfJobs(ModuleType):
    """Class of such a package: every name in its `__all__` is a job of its sub-package's module `result` or `job`."""

    def __getattribute__(self, name: str) -> Any:
        known = super().__getattribute__
        if name in known("__dict__").get("__all__", ()):  # importing a sub-package sets an attribute of its name
            home = f"{known('__name__')}.{name}"
            made = getattr(import_module(f"{home}.result"), name, None)
            return made if isinstance(made, Job) else getattr(import_module(f"{home}.job"), name)
        return known(name)
