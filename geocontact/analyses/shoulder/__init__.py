"""A shoulder exoskeleton driven by human motion: `gc.shoulder.simulate(...)` and more."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.shoulder.compare.result import compare
    from geocontact.analyses.shoulder.optimise.result import optimise
    from geocontact.analyses.shoulder.simulate.result import simulate
    from geocontact.analyses.shoulder.study.result import study

__all__ = ["compare", "optimise", "simulate", "study"]

sys.modules[__name__].__class__ = PackageOfJobs
