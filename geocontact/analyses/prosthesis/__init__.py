"""A below-knee prosthesis on the ground: `gc.prosthesis.calibrate(...)` and more."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.prosthesis.calibrate.job import calibrate

__all__ = ["calibrate"]

sys.modules[__name__].__class__ = PackageOfJobs
