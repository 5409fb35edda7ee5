"""Limits of the colours of what a fit leaves over: the same on the page and in the figure."""

from __future__ import annotations

from geocontact.geometry.fit.found import OUTLYING, ShapeFit

FINEST = 1e-6  # m; what the colours resolve at least
BEYOND = 1.5  # times the distance from which on a point is an outlier


def outlying(fit: ShapeFit) -> float:
    """Distance beyond which a point is called an outlier: three times the noise [m]."""
    return max(OUTLYING * fit.quality.noise, FINEST)


def colour_end(fit: ShapeFit) -> float:
    """Distance from the shape, to either side, at which the colours end [m]."""
    return BEYOND * outlying(fit)
