"""OpenSim's own set-up files run as they are: the same numbers as typed options, and as OpenSim's own tool."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.cli.opensim_setup import with_setup
from geocontact.data.errors import InputError
from geocontact.dynamics.scaling import scaled
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.tool_setup import read_tool_setup
from geocontact.io.text.tables import read_table
from tests import legs, opensim_oracle
from tests.cli.calls import call, done
from tests.dynamics.test_passive_loads import planar_leg
from tests.elsewhere import Elsewhere

ID = """<OpenSimDocument Version="40000"><InverseDynamicsTool name="leg"><model_file>leg.osim</model_file>
<time_range> 0.1 0.5 </time_range><forces_to_exclude>{exclude}</forces_to_exclude>
<external_loads_file>loads.xml</external_loads_file><coordinates_file>walk.mot</coordinates_file>
<lowpass_cutoff_frequency_for_coordinates>-1</lowpass_cutoff_frequency_for_coordinates>
<output_gen_force_file>theirs.sto</output_gen_force_file></InverseDynamicsTool></OpenSimDocument>"""
IK = """<OpenSimDocument Version="40000"><InverseKinematicsTool name="leg"><model_file>leg.osim</model_file>
<marker_file>walk.trc</marker_file><time_range>-Inf Inf</time_range><coordinate_file>Unassigned</coordinate_file>
<IKTaskSet file="tasks.xml"/></InverseKinematicsTool></OpenSimDocument>"""
TASKS = """<OpenSimDocument Version="40000"><IKTaskSet><objects>{}</objects></IKTaskSet></OpenSimDocument>"""
SCALE = """<OpenSimDocument Version="40000"><ScaleTool name="leg"><mass>30</mass>
<GenericModelMaker><model_file>leg.osim</model_file><marker_set_file>Unassigned</marker_set_file></GenericModelMaker>
<ModelScaler><scaling_order> measurements manualScale</scaling_order><MeasurementSet><objects>
<Measurement name="thigh"><apply>true</apply><MarkerPairSet><objects>
<MarkerPair><markers> femur_r0 femur_r2</markers></MarkerPair>
<MarkerPair><markers>femur_r1 femur_r3</markers></MarkerPair>
</objects></MarkerPairSet><BodyScaleSet><objects><BodyScale name="femur_r"><axes> X Y Z</axes></BodyScale>
<BodyScale name="tibia_r"><axes> Y</axes></BodyScale></objects></BodyScaleSet></Measurement>
<Measurement name="off"><apply>false</apply></Measurement></objects></MeasurementSet><ScaleSet><objects>
<Scale><scales> 0.9 0.95 0.9</scales><segment>tibia_r</segment><apply>true</apply></Scale></objects></ScaleSet>
<marker_file>walk.trc</marker_file><preserve_mass_distribution>false</preserve_mass_distribution></ModelScaler>
<MarkerPlacer><apply>true</apply><IKTaskSet><objects>{}</objects></IKTaskSet><marker_file>walk.trc</marker_file>
<time_range>0 0.02</time_range></MarkerPlacer></ScaleTool></OpenSimDocument>"""


def task(marker: str, weight: float) -> str:
    return f'<IKMarkerTask name="{marker}"><apply>true</apply><weight>{weight}</weight></IKMarkerTask>'


def swinging(folder: Path) -> None:
    """A leg with passive forces, its motion without filter, its markers and a plate."""
    model = read_multibody(planar_leg(folder))
    time, values = legs.motion(model)
    legs.mot_file(folder, model, time, values)
    legs.plate_files(folder, time, (20.0, 200.0, 5.0), (0.1, 0.0, 0.05))
    legs.trc_file(folder, legs.markers_of(model, time, values))
    for name, text in {"id.xml": ID.format(exclude="stops"), "ik.xml": IK, "tasks.xml": TASKS}.items():
        tasks = "".join(task(m.name, k % 3 + 1) for k, m in enumerate(model.markers))
        (folder / name).write_text(text.format(tasks) if name == "tasks.xml" else text)


def test_moments_are_those_of_opensims_own_tool(tmp_path: Path, opensim: Elsewhere) -> None:
    """Column by column, to a thousandth of each column's size; one group of the model's forces is left out."""
    swinging(tmp_path)
    done(call("id", "--setup", tmp_path / "id.xml", "--out", tmp_path / "ours"))
    opensim(opensim_oracle.run_inverse_dynamics, tmp_path / "id.xml", tmp_path / "theirs")
    ours, theirs = read_table(tmp_path / "ours" / "id.sto"), read_table(tmp_path / "theirs" / "theirs.sto")
    assert set(ours.channels) == set(theirs.channels)
    np.testing.assert_allclose(ours.time, theirs.time, atol=1e-9)
    for name in theirs.channels:
        wanted = theirs.column(name)
        assert np.abs(ours.column(name) - wanted).max() < 1e-3 * np.abs(wanted).max(), name


def test_a_set_up_is_what_its_options_are(tmp_path: Path) -> None:
    """Paths are relative to its folder; what is typed counts instead of what it says."""
    swinging(tmp_path)
    here = [f"--{name}={tmp_path / file}" for name, file in (("model", "leg.osim"), ("loads", "loads.xml"))]
    tokens = with_setup(["id", "--setup", str(tmp_path / "id.xml"), "--out", "o", "--cutoff=9"])
    motion = str(tmp_path / "walk.mot")
    assert tokens == ["id", motion, *here, "--time=0.1:0.5", "--exclude=stops", "--out", "o", "--cutoff=9"]
    tokens = with_setup(["ik", f"--setup={tmp_path / 'ik.xml'}"])
    assert tokens == ["ik", str(tmp_path / "walk.trc"), here[0], f"--tasks={tmp_path / 'tasks.xml'}"]
    assert with_setup(["area", "--setup", "x"]) == ["area", "--setup", "x"]


def test_a_model_is_scaled_as_its_set_up_says(tmp_path: Path) -> None:
    """Factors by hand come after measurements, axis by axis; what is not heeded is told."""
    _, model, time, values = legs.planted(tmp_path)
    larger = scaled(model, {"femur_r": 1.1 * np.ones(3)})
    legs.trc_file(tmp_path, legs.markers_of(larger, time[:3], 0.0 * values[:3] + 0.05))
    tasks = "".join(task(m.name, 1.0) for m in model.markers)
    (tmp_path / "scale.xml").write_text(SCALE.format(tasks))
    result = done(call("scale", "--setup", tmp_path / "scale.xml", "--out", tmp_path / "s", folder=tmp_path / "s"))
    assert "masses by volume is not heeded" in result.err
    assert result.record()["results"]["factors"] == {
        "femur_r": pytest.approx(1.1, abs=1e-6),
        "tibia_r x": 0.9,
        "tibia_r y": 0.95,
        "tibia_r z": 0.9,
    }
    assert sum(b.mass for b in read_multibody(tmp_path / "s" / "scaled.osim").bodies) == pytest.approx(30.0)


REFUSED = {
    "another tool": (IK, "holds no <InverseDynamicsTool>"),
    "no motion": (ID.replace("walk.mot", "Unassigned"), "<coordinates_file>: names no file"),
    "half a range": (ID.replace(" 0.1 0.5 ", "0.1"), "'0.1' where a first and a last time are expected"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused(tmp_path: Path, case: str) -> None:
    text, message = REFUSED[case]
    (tmp_path / "setup.xml").write_text(text)
    with pytest.raises(InputError, match=message):
        read_tool_setup(tmp_path / "setup.xml", "InverseDynamicsTool")
