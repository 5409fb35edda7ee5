"""OpenSim's own set-up files run as they are: the same numbers as typed options, and as OpenSim's own tool."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.cli.opensim_setup import with_setup
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.dynamics.scaling import scaled
from geocontact.io.mocap.markers import read_markers
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.opensim.tool_setup import read_tool_setup
from geocontact.io.text.tables import read_table
from tests import legs, opensim_oracle
from tests.cli.calls import call, done
from tests.dynamics.test_coupled_coordinates import coupled_leg
from tests.dynamics.test_passive_loads import planar_leg
from tests.elsewhere import Elsewhere

ID = """<OpenSimDocument Version="40000"><InverseDynamicsTool name="leg"><model_file>leg.osim</model_file>
<time_range> 0.1 0.5 </time_range><forces_to_exclude>{exclude}</forces_to_exclude>
<external_loads_file>loads.xml</external_loads_file><coordinates_file>walk.mot</coordinates_file>
<lowpass_cutoff_frequency_for_coordinates>-1</lowpass_cutoff_frequency_for_coordinates>
<output_gen_force_file>theirs.sto</output_gen_force_file></InverseDynamicsTool></OpenSimDocument>"""
IK = """<OpenSimDocument Version="40000"><InverseKinematicsTool name="leg"><model_file>leg.osim</model_file>
<marker_file>walk.trc</marker_file><output_motion_file>theirs.mot</output_motion_file>
<time_range>-Inf Inf</time_range><coordinate_file>Unassigned</coordinate_file>
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


@pytest.mark.parametrize("span", ["0.1037 0.5037", "0.103 0.497", "-1 0.4999999", "0.0999999 99"])
def test_a_range_takes_the_frames_that_opensim_takes(tmp_path: Path, opensim: Elsewhere, span: str) -> None:
    """Whose two tools take other ones: markers the nearest frames, coordinates the last ones that are not later."""
    swinging(tmp_path)
    (tmp_path / "id.xml").write_text(ID.format(exclude="stops").replace(" 0.1 0.5 ", span))
    (tmp_path / "ik.xml").write_text(IK.replace("-Inf Inf", span))
    opensim(opensim_oracle.run_inverse_dynamics, tmp_path / "id.xml", tmp_path / "theirs")
    opensim(opensim_oracle.run_inverse_kinematics, tmp_path / "ik.xml")
    theirs = read_table(tmp_path / "theirs" / "theirs.sto").time, read_table(tmp_path / "theirs.mot").time
    for command, wanted in zip(("id", "ik"), theirs, strict=True):
        told = with_setup([command, "--setup", str(tmp_path / f"{command}.xml")])
        (time,) = [token for token in told if token.startswith("--time=")]
        assert [float(end) for end in time.partition("=")[2].split(":")] == pytest.approx(wanted[[0, -1]], abs=1e-9)


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
    """Factors by hand come after measurements, axis by axis; sizes from a trial of their own, masses by volume."""
    _, model, time, values = legs.planted(tmp_path)
    larger = scaled(model, {"femur_r": 1.1 * np.ones(3)})
    legs.trc_file(tmp_path, legs.markers_of(larger, time[:3], 0.0 * values[:3] + 0.05))
    tasks = "".join(task(m.name, 1.0) for m in model.markers)
    (tmp_path / "measured.trc").write_bytes((tmp_path / "walk.trc").read_bytes())
    legs.trc_file(tmp_path, legs.markers_of(model, time[:3], 0.0 * values[:3] + 0.05))
    own = SCALE.replace("walk.trc</marker_file><preserve", "measured.trc</marker_file><preserve")
    (tmp_path / "scale.xml").write_text(own.format(tasks))
    result = done(call("scale", "--setup", tmp_path / "scale.xml", "--out", tmp_path / "s", folder=tmp_path / "s"))
    assert result.record()["results"]["factors"] == {
        "femur_r": pytest.approx(1.1, abs=1e-6),
        "tibia_r x": 0.9,
        "tibia_r y": 0.95,
        "tibia_r z": 0.9,
    }
    made = {b.name: b.mass for b in read_multibody(tmp_path / "s" / "scaled.osim").bodies}
    grown = {"pelvis": 1.0, "femur_r": 1.1**3, "tibia_r": 0.9 * 0.95 * 0.9, "foot_r": 1.0}
    wanted = {b.name: b.mass * grown[b.name] for b in model.bodies}
    assert made == pytest.approx({name: 30.0 * m / sum(wanted.values()) for name, m in wanted.items()})


def test_the_set_ups_written_give_opensim_the_same_angles_and_moments(tmp_path: Path, opensim: Elsewhere) -> None:
    """From markers in other axes and by other names, with weights and a coordinate held; angles as far as it solves."""
    swinging(tmp_path)
    model, seen = read_multibody(tmp_path / "leg.osim"), read_markers(tmp_path / "walk.trc")
    turned = MarkerTrajectories(seen.time, seen.positions[..., [0, 2, 1]] * [1.0, -1.0, 1.0], seen.names)
    write_trc(tmp_path / "z_up.trc", turned.renamed({"foot_r0": "HEEL"}))
    asked = ("--axes", "x,z,-y", "--markers-map", "HEEL=foot_r0", "--weight", "foot_r1=3", "--hold", "ankle=4")
    leg = ("--model", tmp_path / "leg.osim")
    done(call("ik", tmp_path / "z_up.trc", *leg, *asked, "--time", "0.1:0.4", "--out", tmp_path / "ik"))
    opensim(opensim_oracle.run_inverse_kinematics, tmp_path / "ik" / "setup_ik.xml")
    ours, theirs = (read_table(tmp_path / "ik" / name) for name in ("ik.mot", "opensim_ik.mot"))
    assert ours.time[0] == pytest.approx(0.1) and "ankle" in ours.channels
    for c in model.coordinates:
        np.testing.assert_allclose(ours.column(c.name), theirs.column(c.name), atol=0.03, err_msg=c.name)
    (of_opensim,) = (
        file for file in (tmp_path / "ik").glob("*_ik_marker_errors.sto") if not file.stem.startswith("z_up")
    )
    ours, theirs = (read_table(each) for each in (tmp_path / "ik" / "z_up_ik_marker_errors.sto", of_opensim))
    assert ours.channels == theirs.channels == ("total_squared_error", "marker_error_RMS", "marker_error_max")
    for name in ours.channels:  # both solve to a part of what markers are off
        np.testing.assert_allclose(ours.column(name), theirs.column(name), rtol=0.02, atol=1e-9, err_msg=name)
    options = ("--loads", tmp_path / "loads.xml", "--cutoff", "12", "--time", "0.1:0.5", "--exclude", "stops")
    walk = tmp_path / "walk.mot"
    done(call("id", walk, "--model", tmp_path / "leg.osim", *options, "--threshold", "30", "--out", tmp_path / "id"))
    opensim(opensim_oracle.run_inverse_dynamics, tmp_path / "id" / "setup_id.xml", tmp_path / "id")
    ours, theirs = (read_table(tmp_path / "id" / name) for name in ("id.sto", "opensim_id.sto"))
    for name in theirs.channels:
        wanted = theirs.column(name)
        assert np.abs(ours.column(name) - wanted).max() < 1e-3 * np.abs(wanted).max(), name


def test_a_coordinate_follows_a_recording_as_in_opensim(tmp_path: Path, opensim: Elsewhere) -> None:
    """`from_file`: a knee that is 3 deg off what markers say, and counts as much as they do."""
    swinging(tmp_path)
    model = read_multibody(tmp_path / "leg.osim")
    time, values = legs.motion(model)
    values[:, [c.name for c in model.coordinates].index("knee")] += np.radians(3.0)
    (tmp_path / "off").mkdir()
    legs.mot_file(tmp_path / "off", model, time, values)
    near = '<IKCoordinateTask name="knee"><value_type>from_file</value_type><weight>0.05</weight></IKCoordinateTask>'
    tasks = "".join(task(m.name, 1.0) for m in model.markers)
    (tmp_path / "tasks.xml").write_text(TASKS.format(tasks + near))
    setup = tmp_path / "ik.xml"
    setup.write_text(IK.replace("Unassigned", "off/walk.mot"))
    done(call("ik", "--setup", setup, "--out", tmp_path / "ours"))
    opensim(opensim_oracle.run_inverse_kinematics, tmp_path / "ours" / "setup_ik.xml")
    ours, theirs = (read_table(tmp_path / "ours" / name) for name in ("ik.mot", "opensim_ik.mot"))
    truth = read_table(tmp_path / "walk.mot").column("knee")
    assert 0.2 < np.abs(ours.column("knee") - truth).max() < 2.9
    for c in model.coordinates:
        np.testing.assert_allclose(ours.column(c.name), theirs.column(c.name), atol=0.03, err_msg=c.name)


def test_a_recording_to_follow_is_needed_and_has_an_effect(tmp_path: Path) -> None:
    swinging(tmp_path)
    leg = ("--model", tmp_path / "leg.osim", "--tasks", tmp_path / "tasks.xml", "--out", tmp_path / "o")
    idle = call("ik", tmp_path / "walk.trc", *leg, "--follow", tmp_path / "walk.mot")
    assert idle.code == 2 and "--follow: has no effect: no task is of the kind from_file" in idle.err
    near = '<IKCoordinateTask name="knee"><value_type>from_file</value_type><weight>1</weight></IKCoordinateTask>'
    text = (tmp_path / "tasks.xml").read_text()
    (tmp_path / "tasks.xml").write_text(text.replace("</objects>", f"{near}</objects>"))
    alone = call("ik", tmp_path / "walk.trc", *leg)
    assert alone.code == 2 and "knee follows a recording; name its file with --follow" in alone.err
    done(call("ik", tmp_path / "walk.trc", *leg, "--follow", tmp_path / "walk.mot"))


@pytest.mark.parametrize(("force", "point"), [("foot_r", "foot_r"), ("tibia_r", "ground"), ("ground", "femur_r")])
def test_forces_and_points_in_bodies_are_those_of_opensim(
    tmp_path: Path, opensim: Elsewhere, force: str, point: str
) -> None:
    """With the torque named as the beginning of its columns, without the underscore."""
    swinging(tmp_path)
    time, _ = legs.motion(read_multibody(tmp_path / "leg.osim"))
    legs.plate_files(tmp_path, time, (20.0, 200.0, 5.0), (0.1, 0.0, 0.05), (3.0, 6.0, -4.0))
    expressed = "<{0}_expressed_in_body>{1}</{0}_expressed_in_body>"
    frames = expressed.format("force", force) + expressed.format("point", point)
    text = (tmp_path / "loads.xml").read_text().replace("</applied_to_body>", f"</applied_to_body>{frames}")
    (tmp_path / "loads.xml").write_text(text.replace("plate_torque_<", "plate_torque<"))
    done(call("id", "--setup", tmp_path / "id.xml", "--out", tmp_path / "ours"))
    opensim(opensim_oracle.run_inverse_dynamics, tmp_path / "id.xml", tmp_path / "theirs")
    ours, theirs = read_table(tmp_path / "ours" / "id.sto"), read_table(tmp_path / "theirs" / "theirs.sto")
    for name in theirs.channels:
        wanted = theirs.column(name)
        assert np.abs(ours.column(name) - wanted).max() < 1e-3 * np.abs(wanted).max(), name


def test_axes_beside_loads_in_bodies_are_refused(tmp_path: Path) -> None:
    swinging(tmp_path)
    both = "".join(f"<{each}_expressed_in_body>tibia_r</{each}_expressed_in_body>" for each in ("force", "point"))
    text = (tmp_path / "loads.xml").read_text().replace("</applied_to_body>", f"</applied_to_body>{both}")
    (tmp_path / "loads.xml").write_text(text)
    told = call("id", "--setup", tmp_path / "id.xml", "--axes", "x,z,-y", "--out", tmp_path / "o")
    assert told.code == 2 and "--axes: has no effect: all loads are expressed in bodies" in told.err


def test_a_force_that_opensim_cannot_leave_out_is_told(tmp_path: Path) -> None:
    swinging(tmp_path)
    leg = ("--model", tmp_path / "leg.osim", "--loads", tmp_path / "loads.xml", "--out", tmp_path / "id")
    told = done(call("id", tmp_path / "walk.mot", *leg, "--exclude", "knee_stop"))
    assert any("groups of forces only: with setup_id.xml it lets knee_stop act" in line for line in told.warnings)
    assert not any("groups of forces" in w for w in done(call("id", tmp_path / "walk.mot", *leg)).warnings)


@pytest.mark.parametrize("masses", [(), ("--mass-by-volume",)])
def test_a_set_up_of_scaling_gives_opensim_the_same_model(
    tmp_path: Path, opensim: Elsewhere, masses: tuple[str, ...]
) -> None:
    _, model, time, values = legs.planted(tmp_path)
    larger = scaled(model, {"femur_r": 1.1 * np.ones(3)})
    legs.trc_file(tmp_path, legs.markers_of(larger, time[:3], 0.0 * values[:3] + 0.05))
    sizes = ("--scale", "femur_r=femur_r0/femur_r2,femur_r1/femur_r3", "--scale", "tibia_r:y=0.95", "--mass", "30")
    out = tmp_path / "s"
    done(call("scale", tmp_path / "walk.trc", "--model", tmp_path / "leg.osim", *sizes, *masses, "--out", out))
    opensim(opensim_oracle.run_scaling, out / "setup_scale.xml")
    ours, theirs = (read_multibody(out / name) for name in ("scaled.osim", "opensim_scaled.osim"))
    for own, other in zip(ours.bodies, theirs.bodies, strict=True):
        assert own.mass == pytest.approx(other.mass, rel=1e-9)
        np.testing.assert_allclose(own.centre, other.centre, atol=1e-9)
        if own.name != "tibia_r":  # unequal factors: OpenSim takes a cylinder, here it is exact
            np.testing.assert_allclose(own.inertia, other.inertia, rtol=1e-9, atol=1e-12)
    for own, other in zip(ours.markers, theirs.markers, strict=True):
        np.testing.assert_allclose(
            own.location, other.location, atol=1e-3, err_msg=own.name
        )  # as far as it solves its static pose


def test_what_is_written_is_read_back(tmp_path: Path) -> None:
    """Without OpenSim: the same call again from the set-up alone."""
    swinging(tmp_path)
    model = ("--model", tmp_path / "leg.osim")
    done(call("ik", tmp_path / "walk.trc", *model, "--tasks", tmp_path / "tasks.xml", "--out", tmp_path / "one"))
    done(call("ik", "--setup", tmp_path / "one" / "setup_ik.xml", "--out", tmp_path / "two"))
    assert (tmp_path / "one" / "ik.mot").read_bytes() == (tmp_path / "two" / "ik.mot").read_bytes()
    loads = ("--loads", tmp_path / "loads.xml", "--time", "0.1:0.5")
    done(call("id", tmp_path / "walk.mot", *model, *loads, "--out", tmp_path / "id"))
    done(call("id", "--setup", tmp_path / "id" / "setup_id.xml", "--out", tmp_path / "again"))
    one, two = (read_table(tmp_path / name / "id.sto") for name in ("id", "again"))
    np.testing.assert_allclose(two.values, one.values, rtol=1e-6, atol=1e-6)
    sizes = ("--scale", "femur_r=1.1", "--scale", "tibia_r:y=0.95", "--mass", "30", "--time", "0:0.02")
    done(call("scale", tmp_path / "walk.trc", *model, *sizes, "--out", tmp_path / "scale"))
    done(call("scale", "--setup", tmp_path / "scale" / "setup_scale.xml", "--out", tmp_path / "rescaled"))
    one, two = (read_multibody(tmp_path / name / "scaled.osim") for name in ("scale", "rescaled"))
    for own, other in zip(one.bodies, two.bodies, strict=True):
        np.testing.assert_allclose(own.inertia, other.inertia, rtol=1e-9)
    for setup in tmp_path.glob("*/setup_*.xml"):  # no name of a folder of the user's machine
        assert "../leg.osim" in (text := setup.read_text(encoding="utf-8")) and str(tmp_path) not in text, setup


def test_a_range_of_a_static_trial_takes_the_frames_that_opensim_takes(tmp_path: Path, opensim: Elsewhere) -> None:
    """Those that enclose it, of a leg that grows by 1 % and moves by 1 cm in each frame; for sizes and for the pose."""
    _, model, time, values = legs.planted(tmp_path)
    grown = [scaled(model, {"femur_r": (1.0 + 0.01 * k) * np.ones(3)}) for k in range(9)]
    places = np.array([each.marker_places(0.0 * values[:1])[0] + 0.01 * k for k, each in enumerate(grown)])
    legs.trc_file(tmp_path, MarkerTrajectories(time[:9], places, tuple(m.name for m in model.markers)))
    tasks = "".join(task(m.name, 1.0) for m in model.markers)
    narrow = SCALE.replace("<preserve", "<time_range>0.013 0.032</time_range><preserve").replace(
        "0 0.02<", "0.018 0.041<"
    )
    end = "</MarkerPlacer>"
    text = narrow.replace(end, f"<output_model_file>theirs.osim</output_model_file>{end}").format(tasks)
    (tmp_path / "scale.xml").write_text(text)
    told = with_setup(["scale", "--setup", str(tmp_path / "scale.xml")])
    assert {"--time=0.01:0.05", "--sizes-time=0.01:0.04"} < set(told)
    done(call("scale", "--setup", tmp_path / "scale.xml", "--out", tmp_path / "s"))
    opensim(opensim_oracle.run_scaling, tmp_path / "scale.xml")
    ours, theirs = (read_multibody(tmp_path / name) for name in ("s/scaled.osim", "theirs.osim"))
    assert [b.mass for b in ours.bodies] == pytest.approx([b.mass for b in theirs.bodies], rel=1e-6)
    for own, other in zip(ours.markers, theirs.markers, strict=True):
        np.testing.assert_allclose(own.location, other.location, atol=1e-3, err_msg=own.name)


def test_muscles_that_a_set_up_lets_act_are_told(tmp_path: Path) -> None:
    """A set-up that leaves nothing out: in OpenSim muscles act at rest, here they never do."""
    swinging(tmp_path)
    text = (tmp_path / "leg.osim").read_text()
    muscle = '<ForceSet><objects><Thelen2003Muscle name="vasti"/>'
    (tmp_path / "leg.osim").write_text(text.replace("<ForceSet><objects>", muscle, 1))
    assert "vasti" in (tmp_path / "leg.osim").read_text()
    for excluded, told in {"": 1, "stops": 1, "Muscles stops": 0, "ALL": 0}.items():
        (tmp_path / "id.xml").write_text(ID.format(exclude=excluded))
        unheeded = read_tool_setup(tmp_path / "id.xml", "InverseDynamicsTool").unheeded
        assert sum(what.startswith("passive force of 1 muscles") for what in unheeded) == told, excluded


def test_without_placing_markers_the_default_pose_stays(tmp_path: Path) -> None:
    """As OpenSim has it, whose set-up then needs no task of a marker, as Pose2Sim's for BlazePose has none."""
    _, model, time, values = legs.planted(tmp_path)
    legs.trc_file(tmp_path, legs.markers_of(model, time[:3], 0.0 * values[:3] + 0.05))
    own = SCALE.replace("<MarkerPlacer><apply>true", "<MarkerPlacer><apply>false")
    near = '<IKCoordinateTask name="knee"><value_type>default_value</value_type><weight>0</weight></IKCoordinateTask>'
    (tmp_path / "scale.xml").write_text(own.format(near))
    done(call("scale", "--setup", tmp_path / "scale.xml", "--out", tmp_path / "s"))
    made = read_multibody(tmp_path / "s" / "scaled.osim")
    assert [c.default for c in made.coordinates] == [c.default for c in model.coordinates]


def test_bodies_that_the_model_lacks_are_passed_over_as_in_opensim(tmp_path: Path) -> None:
    """One set-up for models of several kinds, as Pose2Sim has it; told, not refused."""
    legs.model_file(tmp_path)
    whole = _scale_options(tmp_path, SCALE)
    begin = "<BodyScaleSet><objects>"
    more = SCALE.replace(begin, f'{begin}<BodyScale name="fibula_r"><axes>X</axes></BodyScale>')
    (tmp_path / "scale.xml").write_text(more.format(task("femur_r0", 1.0)))
    found = read_tool_setup(tmp_path / "scale.xml", "ScaleTool")
    assert found.options == whole and found.unheeded == ("size of fibula_r, which the model does not have,",)


def _scale_options(folder: Path, text: str) -> tuple[tuple[str, str], ...]:
    (folder / "scale.xml").write_text(text.format(task("femur_r0", 1.0)))
    return read_tool_setup(folder / "scale.xml", "ScaleTool").options


def test_sizes_are_asked_for_as_opensim_takes_them(tmp_path: Path) -> None:
    """Each seen by trial on OpenSim 4.6: sets in files of their own, no order, a scaler that is switched off."""
    whole = _scale_options(tmp_path, SCALE)
    sizes = SCALE[SCALE.index("<MeasurementSet>") : SCALE.index("<ScaleSet>")]
    (tmp_path / "sizes.xml").write_text(f"<OpenSimDocument>{sizes}</OpenSimDocument>")
    assert _scale_options(tmp_path, SCALE.replace(sizes, '<MeasurementSet file="sizes.xml"/>')) == whole
    off = SCALE.replace("<ModelScaler>", "<ModelScaler><apply>false</apply>")
    unordered = SCALE.replace("<scaling_order> measurements manualScale</scaling_order>", "")
    assert not {"scale", "mass"} & dict(_scale_options(tmp_path, off)).keys() and "scale" in dict(whole)
    assert dict(_scale_options(tmp_path, unordered)).keys() == dict(whole).keys() - {"scale", "sizes"}
    with pytest.raises(InputError, match=r"sizes\.xml: holds no <ScaleSet>"):
        _scale_options(tmp_path, SCALE.replace("<ScaleSet>", '<ScaleSet file="sizes.xml">'))


def test_numbers_of_a_set_up_are_not_rounded(tmp_path: Path) -> None:
    told = dict(
        _scale_options(tmp_path, SCALE.replace("<mass>30<", "<mass>62.1234567<").replace("0.02<", "101.2345678<"))
    )
    assert float(told["mass"]) == 62.1234567 and float(told["time"].split(":")[1]) == 101.2345678


def test_sizes_have_a_trial_and_times_of_their_own(tmp_path: Path) -> None:
    """OpenSim measures in one part of a trial and places markers in another; all of it where no range is given."""
    narrow = SCALE.replace("<preserve", "<time_range>0 0.01</time_range><preserve")
    walk = str(tmp_path / "walk.trc")
    assert {("sizes", walk), ("sizes-time", "0.0:0.01")} < set(_scale_options(tmp_path, narrow))
    assert ("sizes", walk) in _scale_options(tmp_path, SCALE) and "sizes-time" not in dict(
        _scale_options(tmp_path, SCALE)
    )
    alike = SCALE.replace("<preserve", "<time_range>0 0.02</time_range><preserve")
    assert not {"sizes", "sizes-time"} & dict(_scale_options(tmp_path, alike)).keys()


def test_masses_follow_volumes_unless_a_set_up_keeps_their_shares(tmp_path: Path) -> None:
    """OpenSim's default is not to keep them."""
    assert "mass-by-volume" in dict(_scale_options(tmp_path, SCALE))
    shares = "<preserve_mass_distribution>{}</preserve_mass_distribution>".format
    assert "mass-by-volume" in dict(_scale_options(tmp_path, SCALE.replace(shares("false"), "")))
    assert "mass-by-volume" not in dict(_scale_options(tmp_path, SCALE.replace(shares("false"), shares("true"))))


def test_a_trial_for_sizes_without_measurements_is_refused(tmp_path: Path) -> None:
    _, model, time, values = legs.planted(tmp_path)
    legs.trc_file(tmp_path, legs.markers_of(model, time[:3], values[:3]))
    leg = ("--model", tmp_path / "leg.osim", "--scale", "femur_r=1.1", "--out", tmp_path / "o")
    told = call("scale", tmp_path / "walk.trc", *leg, "--sizes", tmp_path / "walk.trc")
    assert told.code == 2 and "--sizes: has no effect: no body is measured" in told.err


def test_a_weight_of_constraints_is_told_where_there_are_some(tmp_path: Path) -> None:
    swinging(tmp_path)
    soft = IK.replace("<time_range>", "<constraint_weight>20</constraint_weight><time_range>")
    (tmp_path / "ik.xml").write_text(soft)
    assert read_tool_setup(tmp_path / "ik.xml", "InverseKinematicsTool").unheeded == ()
    coupled_leg(tmp_path)
    (told,) = read_tool_setup(tmp_path / "ik.xml", "InverseKinematicsTool").unheeded
    assert told.startswith("constraint_weight 20")
    (tmp_path / "ik.xml").write_text(soft.replace(">20<", ">Infinity<"))
    assert read_tool_setup(tmp_path / "ik.xml", "InverseKinematicsTool").unheeded == ()


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
