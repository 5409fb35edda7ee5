"""Names of `geocontact.analyses.sit_to_stand`; those of analyses are written by `python -m website.stubs`."""

from geocontact.analyses.sit_to_stand.calibrate.result import calibrate
from geocontact.analyses.sit_to_stand.compare.result import compare
from geocontact.analyses.sit_to_stand.coordinates.result import coordinates
from geocontact.analyses.sit_to_stand.design.result import design
from geocontact.analyses.sit_to_stand.device.result import device
from geocontact.analyses.sit_to_stand.movements.result import movements
from geocontact.analyses.sit_to_stand.predict.result import predict

__all__ = ["calibrate", "compare", "coordinates", "design", "device", "movements", "predict"]
