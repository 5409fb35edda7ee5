"""Standing up from a chair: `gc.sit_to_stand.calibrate(...)`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from geocontact.analyses.package_of_jobs import PackageOfJobs

if TYPE_CHECKING:
    from geocontact.analyses.sit_to_stand.calibrate.result import calibrate
    from geocontact.analyses.sit_to_stand.compare.result import compare
    from geocontact.analyses.sit_to_stand.design.result import design
    from geocontact.analyses.sit_to_stand.device.result import device
    from geocontact.analyses.sit_to_stand.predict.result import predict

__all__ = ["calibrate", "compare", "design", "device", "predict"]

sys.modules[__name__].__class__ = PackageOfJobs
