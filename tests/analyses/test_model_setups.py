"""Set-ups of public full-body models: against the public files by their labels, and one model from end to end."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.motion.model_setup import KnownSetup, known_setup, setup_measures, setup_tasks
from geocontact.analyses.motion.naming import Coverage, NamedLabel, Naming
from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.body_places import PLACES
from geocontact.data.multibody.marker_labels import normalised
from geocontact.data.multibody.marker_sets import MARKER_SETS
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Body, Marker, Multibody
from geocontact.data.multibody.model_setups import MODEL_SETUPS
from geocontact.io.mocap.trc import write_trc
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import read_table
from tests import opensim_oracle
from tests.analyses.test_marker_sets import joint_text
from tests.elsewhere import Elsewhere

TRIPLES = "{s}.Thigh.Upper {s}.Thigh.Front {s}.Thigh.Rear {s}.Shank.Upper {s}.Shank.Front {s}.Shank.Rear"
FOOT = "{s}.Midfoot.Sup {s}.Midfoot.Lat {s}.Toe.Lat {s}.Toe.Med"
KNEES = "{s}.Knee.Lat {s}.Knee.Med {s}.Ankle.Lat {s}.Ankle.Med"
ARMS = "{s}.Elbow {s}.Wrist.Med {s}.Wrist.Lat"
CLUSTERS = "{s}TH1 {s}TH2 {s}TH3 {s}TB1 {s}TB2 {s}TB3"
STUDY_KNEES = "{s}_knee_study {s}_mknee_study {s}_ankle_study {s}_mankle_study"
STUDY_CLUSTERS = " ".join(f"{{s}}_{name}{k}_study" for name in ("thigh", "sh") for k in (1, 2, 3))
TASKS = {  # weight by label, as in the IKTaskSets of the public files that MODEL_SETUPS names; {s} is r and l
    ("gait2392", "moving"): {
        10.0: "{s}.ASIS V.Sacral {s}.Heel {s}.Toe.Tip",
        1.0: f"Sternum {TRIPLES} {FOOT}",
        0.5: "{s}.Acromium",
        0.1: "Top.Head",
        0.0: KNEES,
    },
    ("gait2392", "standing"): {
        1000.0: f"{{s}}.ASIS V.Sacral {KNEES} {{s}}.Heel {{s}}.Toe.Tip",
        1.0: f"Sternum {{s}}.Acromium Top.Head {TRIPLES} {FOOT}",
    },
    ("hamner", "moving"): {
        50.0: "{s}.ASIS V.Sacral {s}.Heel {s}.Toe.Tip",
        20.0: ARMS,
        10.0: f"{{s}}.Acromium {TRIPLES} {FOOT}",
        1.0: "Sternum",
        0.0: KNEES,
    },
    ("hamner", "standing"): {
        100.0: "{s}.ASIS V.Sacral",
        50.0: f"{{s}}.Acromium {ARMS} {KNEES}",
        10.0: "Sternum {s}.Heel {s}.Toe.Tip",
        0.0: TRIPLES,
    },
    ("rajagopal", "moving"): {
        100.0: "{s}ASI {s}PSI",
        50.0: f"{CLUSTERS} {{s}}CAL {{s}}TOE {{s}}MT5",
        25.0: "{s}ACR C7 CLAV {s}UA2 {s}UA3 {s}LEL {s}MEL {s}FAradius {s}FAulna",
        0.0: "{s}LFC {s}MFC {s}KJC {s}LMAL {s}MMAL {s}AJC {s}HJC",
    },
    ("rajagopal", "standing"): {
        250.0: "C7 CLAV",
        100.0: "{s}ACR {s}ASI {s}HJC",
        50.0: "{s}LEL {s}MEL {s}FAradius {s}FAulna {s}PSI {s}LFC {s}MFC {s}LMAL {s}MMAL",
        25.0: "{s}CAL {s}TOE {s}MT5",
        0.0: CLUSTERS,
    },
    ("laiuhlrich", "moving"): {
        60.0: "{s}_calc_study",
        30.0: f"{STUDY_KNEES} {{s}}_toe_study {{s}}_5meta_study",
        25.0: "{s}.ASIS_study {s}.PSIS_study {s}HJC_study",
        5.0: "C7_study {s}_shoulder_study {s}_lelbow_study {s}_melbow_study {s}_lwrist_study {s}_mwrist_study",
        4.0: STUDY_CLUSTERS,
    },
    ("laiuhlrich", "standing"): {
        20.0: "C7_study",
        10.0: f"{{s}}.ASIS_study {{s}}.PSIS_study {{s}}HJC_study {STUDY_KNEES} {{s}}_toe_study {{s}}_5meta_study "
        "{s}_calc_study",
        5.0: "{s}_shoulder_study {s}_lwrist_study {s}_mwrist_study",
        1.0: "{s}_lelbow_study",
        0.0: STUDY_CLUSTERS,
    },
}
PAIRS = {  # MeasurementSets of the same files: bodies, axes, pairs of labels; a row with {s} in its bodies is two
    "gait2392": (
        ("torso", "V.Sacral Top.Head"),
        ("pelvis", "R.ASIS L.ASIS"),
        ("femur_r femur_l", "{s}.ASIS {s}.Knee.Lat"),
        ("tibia_r tibia_l talus_r talus_l", "{s}.Knee.Lat {s}.Ankle.Lat"),
        ("calcn_r calcn_l toes_r toes_l", "{s}.Heel {s}.Toe.Tip"),
    ),
    "hamner": (
        ("torso", "V.Sacral {s}.Acromium"),
        ("pelvis", "R.ASIS L.ASIS"),
        ("femur_r femur_l", "{s}.ASIS {s}.Knee.Lat"),
        ("tibia_r tibia_l talus_r talus_l", "{s}.Knee.Lat {s}.Ankle.Lat"),
        ("calcn_r calcn_l toes_r toes_l", "{s}.Heel {s}.Toe.Tip"),
        ("humerus_r humerus_l", "{s}.Acromium {s}.Elbow"),
        ("ulna_r ulna_l radius_r radius_l", "{s}.Elbow {s}.Wrist.Lat", "{s}.Elbow {s}.Wrist.Med"),
    ),
    "rajagopal": (
        ("torso", "{s}ASI CLAV", "{s}PSI C7", "{s}ASI {s}ACR"),
        ("pelvis:x", "{s}ASI {s}PSI"),
        ("pelvis:y", "{s}PSI {s}HJC", "{s}ASI {s}HJC"),
        ("pelvis:z", "RPSI LPSI", "RASI LASI"),
        ("femur_r femur_l", "{s}HJC {s}LFC", "{s}HJC {s}MFC"),
        ("tibia_r tibia_l", "{s}LFC {s}LMAL", "{s}MFC {s}MMAL"),
        ("talus_r talus_l calcn_r calcn_l toes_r toes_l", "{s}CAL {s}MT5", "{s}CAL {s}TOE"),
        ("humerus_r humerus_l", "{s}SJC {s}MEL", "{s}SJC {s}LEL"),
        ("ulna_r ulna_l radius_r radius_l hand_r hand_l", "{s}LEL {s}FAradius", "{s}MEL {s}FAulna"),
    ),
    "laiuhlrich": (
        (
            "talus_r talus_l calcn_r calcn_l toes_r toes_l",
            "{s}_calc_study {s}_toe_study",
            "{s}_calc_study {s}_5meta_study",
        ),
        ("tibia_r", "R_knee_study R_ankle_study", "R_mknee_study R_mankle_study"),
        ("tibia_l", "L_knee_study L_ankle_study", "L_mknee_study L_mankle_study"),
        ("femur_r patella_r", "RHJC_study R_knee_study"),
        ("femur_l patella_l", "LHJC_study L_knee_study"),
        ("pelvis:xy", "{s}.ASIS_study {s}.PSIS_study"),
        ("pelvis:z", "RHJC_study LHJC_study"),
        ("torso:xy", "{s}_shoulder_study {s}.PSIS_study", "C7_study {s}.PSIS_study"),
        ("torso:z", "R_shoulder_study L_shoulder_study"),
        ("humerus_r humerus_l", "{s}_shoulder_study {s}_lelbow_study", "{s}_shoulder_study {s}_melbow_study"),
        (
            "ulna_r ulna_l radius_r radius_l hand_r hand_l",
            "{s}_lwrist_study {s}_lelbow_study",
            "{s}_mwrist_study {s}_melbow_study",
        ),
    ),
}


def _sides(text: str) -> list[str]:
    return [text.replace("{s}", s) for s in "RL"] if "{s}" in text else [text]


def _weights(tasks: dict[float, str]) -> dict[str, float]:
    return {label: w for w, labels in tasks.items() for each in labels.split() for label in _sides(each)}


def _empty(name: str, bodies: tuple[str, ...], markers: tuple[Marker, ...] = ()) -> Multibody:
    """A model of which bodies and markers alone are looked at."""
    masses = tuple(Body(each, 1.0, np.zeros(3), np.eye(3)) for each in bodies)
    return replace(read_multibody("meshes/leg.osim"), name=name, bodies=masses, markers=markers)


def _naming(key: str, labels: list[str]) -> Naming:
    """A recording with these labels of the set that the models of a set-up carry."""
    setup = MODEL_SETUPS[key]
    places = MARKER_SETS[setup.marker_sets[0]].places()
    known = []
    for label in labels:
        place, side = places[normalised(label)]
        segment = PLACES[place].segment
        body = "torso" if segment == "head" else segment if segment in {"pelvis", "torso"} else f"{segment}_{side}"
        known.append(NamedLabel(label, (place, side), body, label))
    markers = tuple(Marker(n.label, n.body, np.zeros(3)) for n in known)
    model = _empty("any", setup.all_bodies, markers)
    return Naming(Coverage(setup.marker_sets[0], {}, 1), model, tuple(known))


@pytest.mark.parametrize(("key", "when"), TASKS)
def test_weights_are_those_of_the_public_files(key: str, when: str) -> None:
    """Typed once more by label, where the product has them by place."""
    wanted = _weights(TASKS[key, when])
    known = KnownSetup(key, MODEL_SETUPS[key], "")
    with warnings.catch_warnings():
        warnings.simplefilter("error", InputWarning)
        tasks = setup_tasks(known, _naming(key, list(wanted)), standing=when == "standing")
    assert dict(tasks.markers) == wanted


@pytest.mark.parametrize("key", PAIRS)
def test_measurements_are_those_of_the_public_files(key: str) -> None:
    wanted = {
        frozenset(bodies.split()): {frozenset(each.split()) for pair in pairs for each in _sides(pair)}
        for bodies, *pairs in PAIRS[key]
    }
    labels = sorted(set().union(*(pair for pairs in wanted.values() for pair in pairs)))
    texts = setup_measures(KnownSetup(key, MODEL_SETUPS[key], ""), _naming(key, labels))
    found = {}
    for text in texts:
        bodies, _, pairs = text.partition("=")
        there = frozenset(bodies.split(","))
        found[there] = {frozenset(pair.split("/")) for pair in pairs.split(",")}
        assert len(found[there]) == len(pairs.split(",")), "no pair counts twice"
    assert found == wanted


def test_every_place_and_body_of_a_set_up_is_known() -> None:
    for key, setup in MODEL_SETUPS.items():
        assert set(setup.standing) | set(setup.moving) <= set(PLACES), key
        axes: list[tuple[str, str]] = []
        for text in setup.measurements:
            bodies, _, pairs = text.partition("=")
            for body in bodies.split(","):
                name, _, along = body.partition(":")
                axes += [(name, axis) for axis in along or "xyz"]
            for end in pairs.replace("/", ",").split(","):
                place = end[:-2] if end.endswith(("_r", "_l")) else end
                assert place in PLACES, f"{key}: {end}"
        assert len(axes) == len(set(axes)), f"{key}: an axis is measured twice"
        assert {name for name, _ in axes} - {"patella_r", "patella_l"} <= set(setup.all_bodies), key


NAMES = {
    "3DGaitModel2392": "gait2392",
    "gait2354_simbody": "gait2392",
    "FullBodyModel_Hamner2010_v2_0": "hamner",
    "Rajagopal2016": "rajagopal",
    "FullBodyModel_MuscleActuatedLowerLimb_TorqueActuatedUpperBody": "rajagopal",
    "RajagopalLaiUhlrich2023": "laiuhlrich",
    "LaiArnoldModified2017_poly_withArms_weldHand": "laiuhlrich",
}


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
@pytest.mark.parametrize("name", NAMES)
def test_a_model_is_known_by_its_name(name: str) -> None:
    bodies = MODEL_SETUPS[NAMES[name]].all_bodies
    found = known_setup(_empty(name, bodies), "auto")
    assert found.name == NAMES[name]
    assert found.by == f"by the model's name {name}"


def test_a_model_is_known_by_its_bodies_and_markers_and_asked_about() -> None:
    """Rajagopal's and LaiUhlrich's have the same bodies: their markers decide, and without them the user."""
    with pytest.warns(InputWarning, match=r"gait2392 .*by its bodies, 12 of 12: is subject01 one of gait2392 and"):
        assert known_setup(_empty("subject01", MODEL_SETUPS["gait2392"].all_bodies), "auto").name == "gait2392"
    full = MODEL_SETUPS["rajagopal"].all_bodies
    with pytest.raises(InputError, match=r"subject02 has the bodies of rajagopal and of laiuhlrich.*`model_setup` raj"):
        known_setup(_empty("subject02", full), "auto")
    for key, labels in (
        ("rajagopal", "RASI LASI RPSI LPSI RLFC RLMAL RACR CLAV"),
        ("laiuhlrich", "r.ASIS_study C7_study"),
    ):
        markers = tuple(Marker(label, "pelvis", np.zeros(3)) for label in labels.split())
        with pytest.warns(InputWarning, match="by its bodies, 22 of 22, and its markers of"):
            assert known_setup(_empty("subject02", full, markers), "auto").name == key
    with pytest.warns(InputWarning, match="hamner .*by its bodies, 20 of 20"):
        assert known_setup(_empty("subject02", MODEL_SETUPS["hamner"].all_bodies), "auto").name == "hamner"


def test_a_model_that_no_set_up_fits_is_refused() -> None:
    with pytest.raises(InputError, match=r"no set-up is known for any \(bodies: gait2392 2 of 12\)"):
        known_setup(_empty("any", ("pelvis", "femur_r")), "auto")
    with pytest.raises(InputError, match=r"'gait2393' is no set-up.*auto, gait2392, hamner"):
        known_setup(_empty("any", ("pelvis",)), "gait2393")
    with pytest.raises(InputError, match="any has no body of hamner"):
        known_setup(_empty("any", ("trunk",)), "hamner")
    with pytest.warns(InputWarning, match="as asked for: .* It has no torso"):
        known_setup(_empty("any", MODEL_SETUPS["gait2392"].all_bodies[:1]), "gait2392")


def test_what_is_not_recorded_is_measured_by_other_pairs_or_keeps_its_size() -> None:
    labels = ["RASI", "LASI", "RLFC", "RLMAL", "RCAL", "RMT5", "RLEL", "RACR", "LACR"]
    naming = _naming("rajagopal", labels)
    known = KnownSetup("rajagopal", MODEL_SETUPS["rajagopal"], "")
    with pytest.warns(InputWarning) as caught:
        texts = setup_measures(known, naming)
    said = " ".join(str(each.message) for each in caught)
    assert "in their stead: pelvis:x=RASI/LASI; pelvis:y=RASI/LASI; femur_r=RASI/RLFC; humerus_r=RACR/RLEL" in said
    assert "nothing measures femur_l, humerus_l, ulna_r,ulna_l,radius_r,radius_l,hand_r,hand_l: sizes are kept" in said
    assert "tibia_r,tibia_l=RLFC/RLMAL" in texts and "torso=RASI/RACR,LASI/LACR" in texts


def test_markers_that_a_source_leaves_out_count_where_nothing_else_fixes_the_segment() -> None:
    """Epicondyles are taken off for Rajagopal's walk, in favour of clusters; Helen Hayes has none."""
    known = KnownSetup("rajagopal", MODEL_SETUPS["rajagopal"], "")
    of_clusters = setup_tasks(known, _naming("rajagopal", ["RTH1", "RTH2", "RTH3", "RLFC"]), standing=False)
    assert dict(of_clusters.markers) == {"RTH1": 50.0, "RTH2": 50.0, "RTH3": 50.0, "RLFC": 0.0}
    with pytest.warns(InputWarning, match="the source has no weight for RLFC: that of the others on the segment"):
        alone = setup_tasks(known, _naming("rajagopal", ["RTH1", "RTH2", "RLFC"]), standing=False)
    assert alone.markers["RLFC"] == 50.0


BODIES = {  # parent and place of the origin in it, right side, as in gait2392 [m]
    "pelvis": ("ground", (0.0, 0.0, 0.0)),
    "torso": ("pelvis", (-0.1, 0.08, 0.0)),
    "femur": ("pelvis", (-0.07, -0.066, 0.0835)),
    "tibia": ("femur", (0.0, -0.4, 0.0)),
    "talus": ("tibia", (0.0, -0.43, 0.0)),
    "calcn": ("talus", (-0.05, -0.04, 0.008)),
    "toes": ("calcn", (0.18, 0.0, 0.0)),
}
OWN = {  # labels of gait2354 and gait2392: body and place on the right side [m]; synthetic
    "Top.Head": ("torso", (0.0, 0.6, 0.0)),
    "Sternum": ("torso", (0.1, 0.31, 0.0)),
    "{s}.Acromium": ("torso", (-0.01, 0.41, 0.16)),
    "V.Sacral": ("pelvis", (-0.16, 0.04, 0.0)),
    "{s}.ASIS": ("pelvis", (0.02, 0.03, 0.12)),
    "{s}.Thigh.Front": ("femur", (0.1, -0.25, 0.01)),
    "{s}.Knee.Lat": ("femur", (0.0, -0.41, 0.05)),
    "{s}.Shank.Upper": ("tibia", (-0.01, -0.07, 0.07)),
    "{s}.Ankle.Lat": ("tibia", (0.0, -0.42, 0.05)),
    "{s}.Heel": ("calcn", (-0.02, 0.02, 0.0)),
    "{s}.Toe.Lat": ("toes", (0.02, 0.0, 0.06)),
    "{s}.Toe.Tip": ("toes", (0.08, 0.005, 0.0)),
}


def _mirrored(at: tuple[float, ...], side: str) -> np.ndarray:
    return np.array(at) * [1.0, 1.0, -1.0 if side == "l" else 1.0]


def _named(body: str, side: str) -> str:
    return body if body in {"ground", "pelvis", "torso"} else f"{body}_{side}"


def _at(body: str, side: str) -> np.ndarray:
    """Origin of a body in the default pose, by hand."""
    if body == "ground":
        return np.zeros(3)
    parent, at = BODIES[body]
    return _at(parent, side) + _mirrored(at, side)


@pytest.fixture
def walker(tmp_path: Path) -> Path:
    """The bodies of gait2392, with the markers of its set, and its coordinates of the foot."""

    def both(names: dict[str, object]) -> list[tuple[str, str]]:
        return [(n, s) for n in names for s in ("rl" if "{s}" in n or n in list(BODIES)[2:] else "r")]

    bodies = "".join(
        f'<Body name="{_named(n, s)}"><mass>5</mass><mass_center>0 -0.1 0</mass_center>'
        f"<inertia>1 1 1 0 0 0</inertia></Body>"
        for n, s in both(dict(BODIES))
    )
    joints = "".join(
        joint_text(
            f"to_{_named(n, s)}",
            "FreeJoint" if n == "pelvis" else "BallJoint" if n in {"femur", "torso"} else "PinJoint",
            _named(BODIES[n][0], s),
            _named(n, s),
            _mirrored(BODIES[n][1], s),
            6 if n == "pelvis" else 3 if n in {"femur", "torso"} else 1,
        )
        .replace(f"to_calcn_{s}_0", f"subtalar_angle_{s}")
        .replace(f"to_toes_{s}_0", f"mtp_angle_{s}")
        for n, s in both(dict(BODIES))
    )
    markers = "".join(
        f'<Marker name="{n.replace("{s}", s.upper())}"><socket_parent_frame>/bodyset/{_named(OWN[n][0], s)}'
        f"</socket_parent_frame><location>{' '.join(map(str, _mirrored(OWN[n][1], s)))}</location></Marker>"
        for n, s in both(dict(OWN))
    )
    path = tmp_path / "walker.osim"
    path.write_text(
        '<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="subject01"><gravity>0 -9.8 0</gravity>'
        f"<BodySet><objects>{bodies}</objects></BodySet><JointSet><objects>{joints}</objects></JointSet>"
        f"<MarkerSet><objects>{markers}</objects></MarkerSet></Model></OpenSimDocument>"
    )
    return path


STRETCH = np.array([1.04, 1.08, 0.97])


def _places(labels: list[str]) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Markers of the model in its default pose, and of a subject of other proportions."""
    own = {}
    for name, (body, at) in OWN.items():
        for s in "rl" if "{s}" in name else "r":
            own[name.replace("{s}", s.upper())] = _at(body, s) + _mirrored(at, s)
    return {k: own[k] for k in labels}, {k: STRETCH * own[k] for k in labels}


@pytest.fixture
def standing(tmp_path: Path) -> Path:
    labels = [name.replace("{s}", s.upper()) for name in OWN for s in ("rl" if "{s}" in name else "r")]
    _, seen = _places(labels)
    path = tmp_path / "static.trc"
    write_trc(path, MarkerTrajectories(np.array([0.0, 0.01]), np.stack([list(seen.values())] * 2), tuple(labels)))
    return path


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_a_subject_is_scaled_by_the_set_ups_pairs(walker: Path, standing: Path, tmp_path: Path) -> None:
    """Factors by hand from the pairs of gait2392_Scale_MeasurementSet.xml, and its weights in both commands."""
    made = gc.scale(standing, model=walker, model_setup="auto", mass=70.0)
    for bodies, *pairs in PAIRS["gait2392"]:
        ends = [each.split() for pair in pairs for each in _sides(pair)]
        own, seen = _places([label for pair in ends for label in pair])
        by_hand = np.mean([np.linalg.norm(seen[a] - seen[b]) / np.linalg.norm(own[a] - own[b]) for a, b in ends])
        for body in bodies.split():
            assert made.scale_factors[body] == pytest.approx(by_hand, rel=1e-9), body
    assert "set-up gait2392: 5 of 5 measurements, 8 of 8 pairs were recorded" in made.sentences
    weights = _weights(TASKS["gait2392", "standing"])
    assert made.standing.tasks.markers == {label: weights[label] for label in made.standing.markers.names}
    foot = {f"{name}_angle_{side}": (1000.0, None) for name in ("subtalar", "mtp") for side in "rl"}
    assert made.standing.tasks.coordinates == foot, "as in gait2392_Scale_Tasks.xml"
    scaled = made.write(tmp_path / "s") / "scaled.osim"
    angles = gc.inverse_kinematics(standing, model=scaled, model_setup="auto")
    assert angles.seen.tasks.markers["R.ASIS"] == 10.0 and angles.seen.tasks.markers["Top.Head"] == 0.1
    assert angles.seen.tasks.coordinates == foot, "as in gait2392_IK_Tasks.xml"
    chosen = gc.inverse_kinematics(standing, model=scaled, model_setup="auto", weight=("R.ASIS=3",))
    assert chosen.seen.tasks.markers["R.ASIS"] == 3.0, "typed weights count"
    typed = gc.scale(standing, model=walker, model_setup="auto", scale=("pelvis=1.1",))
    assert typed.scale_factors == {"pelvis": 1.1}, "typed sizes count"
    for option in ({"markers_map": "A=B"}, {"tasks": walker}):
        with pytest.raises(InputError, match="model_setup"):
            gc.scale(standing, model=walker, model_setup="auto", **option)


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_opensim_measures_and_places_the_same(walker: Path, standing: Path, tmp_path: Path, opensim: Elsewhere) -> None:
    """Its ScaleTool gets the pairs, not the factors; its inverse kinematics the weights."""
    folder = gc.scale(standing, model=walker, model_setup="gait2392", mass=70.0).write(tmp_path / "s")
    text = (folder / "setup_scale.xml").read_text()
    assert "<markers>V.Sacral Top.Head</markers>" in text and "<ScaleSet>" not in text
    opensim(opensim_oracle.run_scaling, folder / "setup_scale.xml")
    ours, theirs = (read_multibody(folder / name) for name in ("scaled.osim", "opensim_scaled.osim"))
    for one, other in zip(ours.bodies, theirs.bodies, strict=True):
        assert one.mass == pytest.approx(other.mass, rel=1e-9)
        np.testing.assert_allclose(one.centre, other.centre, atol=1e-9, err_msg=one.name)
    for one, other in zip(ours.joints, theirs.joints, strict=True):
        np.testing.assert_allclose(
            one.parent_offset.translation, other.parent_offset.translation, atol=1e-9, err_msg=one.name
        )
    out = gc.inverse_kinematics(standing, model=folder / "scaled.osim", model_setup="gait2392").write(tmp_path / "a")
    opensim(opensim_oracle.run_inverse_kinematics, out / "setup_ik.xml")
    angles = [read_table(out / name) for name in ("ik.mot", "opensim_ik.mot")]
    for name in angles[0].channels:
        np.testing.assert_allclose(angles[0].column(name), angles[1].column(name), atol=0.05, err_msg=name)
