"""What a device on the body presses down with is no plate that is the wrong way round."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.tables import read_table
from tests import legs
from tests.cli.calls import Call, call, done

WEIGHT = sum(legs.BODIES.values()) * legs.GRAVITY
PLUMB = (0.0, -1.0, 0.1 * 13.0 / 23.0)
"""Point of the ground below the mass centre of the straight leg with its pelvis."""

FORCE = """<ExternalForce name="{name}"><applied_to_body>{body}</applied_to_body>
<force_expressed_in_body>{frame}</force_expressed_in_body><point_expressed_in_body>ground</point_expressed_in_body>
<force_identifier>{name}_force_v</force_identifier><point_identifier>{name}_force_p</point_identifier></ExternalForce>"""


def worn(folder: Path, device: float, carried: float, frame: str = "ground") -> Call:
    """A leg that stands still: a device presses its pelvis down by so many newtons, a plate carries what is told."""
    _, model, time, values = legs.planted(folder, amplitude=0.0)
    names = [f"{name}_force_{kind}{axis}" for name in ("plate", "device") for kind in "vp" for axis in "xyz"]
    row = np.array([0.0, carried, 0.0, *PLUMB, 0.0, -device, 0.0, PLUMB[0], 0.9, PLUMB[2]])
    write_storage(folder / "grf.mot", time, names, np.tile(row, (len(time), 1)), title="Loads", degrees=False)
    both = FORCE.format(name="plate", body="foot_r", frame="ground") + FORCE.format(
        name="device", body="pelvis", frame=frame
    )
    (folder / "loads.xml").write_text(
        f"""<?xml version="1.0"?><OpenSimDocument Version="40000"><ExternalLoads name="loads"><objects>{both}</objects>
<datafile>grf.mot</datafile></ExternalLoads></OpenSimDocument>""",
        encoding="utf-8",
    )
    motion = legs.mot_file(folder, model, time, values)
    options = ("--model", legs.model_file(folder), "--loads", folder / "loads.xml", "--out", folder / "out")
    return call("id", motion, *options, folder=folder / "out")


@pytest.mark.parametrize("device", [15.0, 21.0, 60.0])
def test_a_device_that_is_worn_presses_down(device: float, tmp_path: Path) -> None:
    """A plate below both carries both: nothing is left over. From 20 N on the direction is said."""
    result = done(worn(tmp_path, device, WEIGHT + device))
    np.testing.assert_allclose(read_table(result.folder / "id.sto").column("ty_force"), 0.0, atol=1e-6)
    said = [line for line in result.warnings if "presses down" in line]
    if device < 20.0:
        assert not said
    else:
        (line,) = said
        assert f"device_force: its force along y, which is up, is -{device:g} N under load" in line
        assert f"{device / WEIGHT:.0%} of the model's weight" in line


def test_beyond_two_fifths_of_the_weight_it_is_a_plate_the_wrong_way_round(tmp_path: Path) -> None:
    result = worn(tmp_path, 0.45 * WEIGHT, 1.45 * WEIGHT)
    assert (result.code, len(result.complaints)) == (2, 1)
    assert "device_force: its force along y, which is up, is -101.5 N under load" in result.err
    assert "turn the sign of forces and torques" in result.err


def test_a_force_in_the_axes_of_a_body_has_no_up(tmp_path: Path) -> None:
    """y of the file is that of the pelvis, which is upright here, and need not be: no direction is wrong or said."""
    result = done(worn(tmp_path, 0.9 * WEIGHT, 1.9 * WEIGHT, "pelvis"))
    np.testing.assert_allclose(read_table(result.folder / "id.sto").column("ty_force"), 0.0, atol=1e-6)
    assert not any("presses down" in line for line in result.warnings)
