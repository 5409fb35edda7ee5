"""A below-knee prosthesis with a variable-stiffness foot: `gc.prosthesis.simulate(...)` and more."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.prosthesis.calibrate.result import calibrate
    from geocontact.analyses.prosthesis.compare.result import compare
    from geocontact.analyses.prosthesis.design.result import design
    from geocontact.analyses.prosthesis.scale.result import scale
    from geocontact.analyses.prosthesis.simulate.result import simulate

__all__ = ["calibrate", "compare", "design", "scale", "simulate"]

sys.modules[__name__].__class__ = PackageOfJobs
