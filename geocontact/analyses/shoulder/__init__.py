"""A shoulder exoskeleton driven by human motion: `gc.shoulder.simulate(...)` and more."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.shoulder.compare.job import compare
    from geocontact.analyses.shoulder.optimise.job import optimise
    from geocontact.analyses.shoulder.simulate.job import simulate
    from geocontact.analyses.shoulder.study.job import study

__all__ = ["compare", "optimise", "simulate", "study"]

sys.modules[__name__].__class__ = PackageOfJobs
