"""Constraint forces of an exoskeleton whose axis is not the joint's: `gc.misalignment.identify(...)` and four more."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from geocontact.analyses.misalignment.compare.job import compare
    from geocontact.analyses.misalignment.design.job import design
    from geocontact.analyses.misalignment.identify.job import identify
    from geocontact.analyses.misalignment.population.job import population
    from geocontact.analyses.misalignment.simulate.job import simulate

__all__ = ["compare", "design", "identify", "population", "simulate"]


def __getattr__(name: str) -> Any:
    """Import the analysis that is asked for."""
    if name in __all__:
        return getattr(import_module(f"geocontact.analyses.misalignment.{name}.job"), name)
    raise AttributeError(f"module 'geocontact.misalignment' has no attribute {name!r}")
