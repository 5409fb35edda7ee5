"""A knee implant under load: `gc.knee.settle(...)`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.knee.settle.result import settle

__all__ = ["settle"]

sys.modules[__name__].__class__ = PackageOfJobs
