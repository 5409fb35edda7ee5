"""Constraint forces of an exoskeleton whose axis is not the joint's: `gc.misalignment.identify(...)` and four more."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.misalignment.compare.result import compare
    from geocontact.analyses.misalignment.design.result import design
    from geocontact.analyses.misalignment.identify.result import identify
    from geocontact.analyses.misalignment.population.result import population
    from geocontact.analyses.misalignment.simulate.result import simulate

__all__ = ["compare", "design", "identify", "population", "simulate"]

sys.modules[__name__].__class__ = PackageOfJobs
