"""Standing up from a chair: `gc.sit_to_stand.calibrate(...)`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.sit_to_stand.calibrate.job import calibrate
    from geocontact.analyses.sit_to_stand.compare.job import compare
    from geocontact.analyses.sit_to_stand.design.job import design
    from geocontact.analyses.sit_to_stand.device.job import device
    from geocontact.analyses.sit_to_stand.predict.job import predict

__all__ = ["calibrate", "compare", "design", "device", "predict"]

sys.modules[__name__].__class__ = PackageOfJobs
