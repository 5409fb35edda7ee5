"""A shoulder exoskeleton driven by human motion: `gc.shoulder.simulate(...)` and more."""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from geocontact.analyses.shoulder.compare.job import compare
    from geocontact.analyses.shoulder.simulate.job import simulate
    from geocontact.analyses.shoulder.study.job import study

__all__ = ["compare", "simulate", "study"]


class _Analyses(ModuleType):
    """The package, whose attributes are the analyses and not the sub-packages that have their names."""

    def __getattribute__(self, name: str) -> Any:
        if name in __all__:  # importing a sub-package sets an attribute, which would hide its analysis
            return getattr(import_module(f"{__name__}.{name}.job"), name)
        return super().__getattribute__(name)


sys.modules[__name__].__class__ = _Analyses
