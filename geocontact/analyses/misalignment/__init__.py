"""Constraint forces of an exoskeleton whose axis is not the joint's: `gc.misalignment.identify(...)` and four more."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.misalignment.compare.job import compare
    from geocontact.analyses.misalignment.design.job import design
    from geocontact.analyses.misalignment.identify.job import identify
    from geocontact.analyses.misalignment.population.job import population
    from geocontact.analyses.misalignment.simulate.job import simulate

__all__ = ["compare", "design", "identify", "population", "simulate"]

sys.modules[__name__].__class__ = PackageOfJobs
