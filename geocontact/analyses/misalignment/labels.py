"""How the figures of a misaligned joint label their axes."""

from __future__ import annotations

from geocontact.view.curves.quantity import Quantity

ANGLE = "exoskeleton angle β [°]"
CONSTRAINT = Quantity("constraint force", "N")
