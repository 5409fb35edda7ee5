"""Areas of a real implant beside published ones: DM's knee under the load of Fuji films."""

from __future__ import annotations

import warnings
from pathlib import Path

import pytest

import geocontact as gc

DM = "gc6_dm_knee/stl"


@pytest.mark.slow
def test_dm_at_rest_is_in_the_range_of_films(data_dir: Path) -> None:
    """2000 N at 0 and 30 deg: films of seven implants have 80 to 154 mm^2; a modulus of 463 MPa is assumed."""
    bodies = [data_dir / DM / f"{name} decimated.stl" for name in ("Femoral Component", "Tibial Insert")]
    layer = {"modulus": gc.MPa(463), "poisson": 0.46, "region": "ny>0.25", "piece": gc.mm(1)}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.knee.settle(
            *bodies,
            unit="m",
            side="right",
            sweep=("flexion", 0.0, gc.deg(30), gc.deg(30)),
            load=2000.0,
            compare="literature",
            **layer,
        )
    film = found.table("literature").set_index("published").loc["film 1995, seven implants"]
    assert film["comparable"] == "yes" and 80.0 < film["ours [mm^2]"] < 200.0
    assert film["ours [mm^2]"] == pytest.approx(1e6 * found.area.mean())
