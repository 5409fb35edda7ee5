"""Marker sets known by name: which set labels belong to, and what the model makes of them."""

from __future__ import annotations

import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.motion.naming import SOFT, coverages, named_markers, recognised
from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.body_places import PLACES
from geocontact.data.multibody.marker_labels import normalised
from geocontact.data.multibody.marker_sets import MARKER_SETS
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Marker, Multibody
from geocontact.io.mocap.trc import read_trc, write_trc
from geocontact.io.opensim.osim_multibody import read_multibody

PUBLIC = {  # labels of public files and lists, those that MarkerSet.source names
    "plug-in-gait-lower": "LASI RASI LPSI RPSI RTHI RKNE RTIB RANK RHEE RTOE LTHI LKNE LTIB LANK LHEE LTOE",
    "plug-in-gait": "LFHD RFHD LBHD RBHD C7 T10 CLAV STRN RBAK LSHO LELB LWRA LWRB LFIN RSHO RELB RWRA RWRB RFIN LASI "
    "RASI LPSI RPSI LTHI LKNE LTIB LANK LHEE LTOE RTHI RKNE RTIB RANK RHEE RTOE",
    "cgm2.3": "LASI RASI LPSI RPSI RTHI RTHAP RTHAD RKNE RTIB RTIAP RTIAD RANK RHEE RTOE LTHI LTHAP LTHAD LKNE LTIB "
    "LTIAP LTIAD LANK LHEE LTOE RKNM LKNM RMED LMED",
    "helen-hayes": "RSHO ROFF RELB RWRI LSHO LELB LWRI RASI LASI VSAC RTHI RKNE RSHA RANK RHEE RTOE LTHI LKNE LSHA "
    "LANK LHEE LTOE",
    "cleveland": "R.ASIS L.ASIS V.Sacral R.Thigh.Upper R.Thigh.Front R.Thigh.Rear R.Knee.Lat R.Knee.Med R.Shank.Upper "
    "R.Ankle.Lat R.Heel R.Toe.Tip Top.Head",
    "grand-challenge": "RAsis LAsis RPsis LPsis RThighSuperior RThighLateral RPatella RShankInferior RHeel RToe "
    "RToeMedial RMidfootSuperior Sacral",
    "opencap": "r.ASIS_study L.ASIS_study r.PSIS_study L.PSIS_study r_knee_study r_mknee_study r_ankle_study "
    "r_mankle_study r_toe_study r_5meta_study r_calc_study C7_study r_thigh1_study RHJC_study",
    "opencap-keypoints": "Neck RShoulder RElbow RWrist LShoulder LElbow LWrist midHip RHip RKnee RAnkle LHip LKnee "
    "LAnkle LBigToe LSmallToe LHeel RBigToe RSmallToe RHeel",
    "ior": "RASIS LASIS RPSIS LPSIS RGT LGT RLE LLE RME LME RHF RTT RLM LLM RMM RCA RFM RSM RVM",
    "cgm2.4": "LASI RASI LPSI RPSI RTHI RKNE RTIAP RTIAD RTIB RANK RHEE RSMH RTOE RFMH RVMH LTHI LKNE LTHAP LTHAD LTIB "
    "LANK LTIAP LTIAD LHEE LSMH LTOE LFMH LVMH RKNM LKNM RMED LMED",
    "ior-qualisys": "L_IAS R_IAS L_IPS R_IPS R_FTC R_FLE R_FME R_FAL R_TAM R_FCC R_FM1 R_FM2 R_FM5",
    "ior-bmclab": "R.ASIS L.ASIS R.PSIS L.PSIS L.Iliac.Crest R.Iliac.Crest R.GTR R.Knee R.HF R.TT R.Ankle R.Heel R.MT1 "
    "R.MT5 L.GTR L.Knee L.HF L.TT L.Ankle L.Heel L.MT1 L.MT5 R.Knee.Medial R.Ankle.Medial R.MT2 L.Knee.Medial "
    "L.Ankle.Medial L.MT2",
    "helen-hayes-cortex": "R.Shoulder L.Shoulder R.Bicep R.Elbow R.ForeArm R.Radius R.Ulna R.Thumb R.Pinky L.Bicep "
    "L.Elbow L.Forearm L.Radius L.Ulna L.Thumb L.Pinky R.ASIS L.ASIS R.PSIS L.PSIS V.Sacral R.Thigh R.Knee R.Shank "
    "R.Ankle R.Heel R.Toe R.Foot L.Thigh L.Knee L.Shank L.Ankle L.Toe L.Heel L.Foot",
    "rris40": "RTEMP RHEAD LHEAD LTEMP RACR RHLE RHME RRSP RUSP RCAP RHMC2 RFLE RFME RTAM RFAL RFCC RFMT1 RFMT5 STER "
    "XPRO C7 T10 RASIS LASIS LPSIS RPSIS LACR LHLE LHME LRSP LUSP LCAP LHMC2 LFLE LFME LTAM LFAL LFCC LFMT1 LFMT5",
    "cast-clusters": "RFT1 RFT2 RFT3 LFT1 RSK1 RSK2 RSK3 RSK4 RTH1 RTH2 RTH3 RTH4 PV1 PV2 PV3 pv4",
}


@pytest.mark.parametrize("name", PUBLIC)
def test_public_labels_are_of_their_set(name: str) -> None:
    labels = PUBLIC[name].split()
    assert (found := recognised(labels, "file")).name == name
    assert set(found.found) == set(labels), "all labels"
    shouted = [f"JW:{label.upper()}" for label in labels]
    assert recognised(shouted, "file").name == name, "neither case nor subject counts"


def test_every_label_names_one_place_that_is_known() -> None:
    for name, known in MARKER_SETS.items():
        written = [label.replace("{s}", side) for label in known.labels for side in ("rl" if "{s}" in label else "m")]
        assert len({normalised(label) for label in written}) == len(written), f"{name}: two labels are one"
        assert set(known.labels.values()) <= set(PLACES), name
        placed = [place for place in known.labels.values() if PLACES[place].at is not None]
        assert len(set(placed)) == len(placed), f"{name}: two labels are one place"


RAJAGOPAL = {  # markers of Rajagopal2016.osim, opensim-models: body and place [m]
    "RACR": ("torso", (-0.003, 0.425, 0.13)),
    "C7": ("torso", (-0.085, 0.435, 0.0017)),
    "CLAV": ("torso", (0.04, 0.38, 0.017)),
    "RLEL": ("humerus", (0.015, -0.28, 0.04)),
    "RMEL": ("humerus", (0.00225, -0.286, -0.046)),
    "RASI": ("pelvis", (0.0095, 0.0181, 0.1285)),
    "RPSI": ("pelvis", (-0.155, 0.035, 0.045)),
    "RLFC": ("femur", (0.0, -0.404, 0.05)),
    "RMFC": ("femur", (0.0, -0.404, -0.05)),
    "RLMAL": ("tibia", (-0.005, -0.3888, 0.053)),
    "RMMAL": ("tibia", (0.006, -0.3888, -0.038)),
    "RCAL": ("calcn", (-0.025, 0.02, -0.005)),
    "RTOE": ("calcn", (0.205, 0.0297, -0.03)),
    "RMT5": ("calcn", (0.145, 0.0249, 0.059)),
}


@pytest.mark.parametrize("label", RAJAGOPAL)
def test_labels_of_rajagopals_model_name_the_place_nearest_to_its_marker(label: str) -> None:
    """RTOE is on the side of the foot there, 70 mm from the tip of the toes."""
    segment, at = RAJAGOPAL[label]
    off = {
        key: np.linalg.norm(np.subtract(at, place.at))
        for key, place in PLACES.items()
        if place.segment == segment and place.at is not None
    }
    named = MARKER_SETS["rajagopal"].places()[normalised(label)][0]
    assert min(off, key=lambda key: off[key]) == named
    assert off[named] < 0.04


BIOMEC = {  # first row of BMClab's public BiomecII2018_gait_n.txt: right leg in IOR's labels, x forward, y up [mm]
    "RHF": (102.46, 409.20, -228.73),
    "RTT": (157.71, 427.24, -271.53),
    "RLM": (226.21, 77.22, -247.40),
    "RMM": (253.55, 109.31, -322.97),
    "RCA": (194.83, 40.30, -297.36),
    "RFM": (390.65, 104.91, -272.78),
    "RVM": (353.49, 79.48, -215.40),
}


@pytest.mark.parametrize(("one", "other"), [(a, b) for a in BIOMEC for b in BIOMEC if a < b])
def test_places_of_iors_labels_are_as_far_apart_as_on_a_public_subject(one: str, other: str) -> None:
    """Within a segment; LE and ME were recorded as well, on a segment of their own with a virtual third point."""
    places = [PLACES[MARKER_SETS["ior"].places()[normalised(label)][0]] for label in (one, other)]
    if places[0].segment != places[1].segment:
        return
    assert places[0].at is not None and places[1].at is not None
    table = np.linalg.norm(np.subtract(places[0].at, places[1].at))
    assert table == pytest.approx(1e-3 * np.linalg.norm(np.subtract(BIOMEC[one], BIOMEC[other])), abs=0.03), "m"


def test_coverage_counts_labels_of_the_set_and_of_the_file() -> None:
    first = coverages(["LASI", "LPSI", "LKNE", "LANK", "foo"])[0]
    assert first.words == "plug-in-gait-lower 4 of 16, left side only"
    with pytest.raises(InputError, match=r"no marker set is recognised \(best is isb-trunk 1 of 4\)"):
        recognised(["PX", "*1", "*2", "*3"], "file")


def test_two_sets_that_fit_alike_and_differ_are_refused() -> None:
    """A marker called Sternum is on the bone's middle in one set, on its upper end in another."""
    tied = ["R_Asis", "L_Asis", "R_Heel", "L_Heel", "Sternum"]
    with pytest.raises(InputError, match=r"5 of 49 and grand-challenge 5 of 58: .* Sternum.*`naming` cleveland"):
        recognised(tied, "file")
    labels = ["RASI", "LASI", "RPSI", "LPSI", "RTOE", "LTOE"]
    assert recognised(labels, "file").found["RTOE"] == ("metatarsal_2", "r"), "6 of 16, not 6 of 44"
    assert recognised(labels, "file", "rajagopal").found["RTOE"] == ("toe_medial", "r")
    with pytest.raises(InputError, match="is no marker set"):
        recognised(labels, "file", "vicon")


def test_a_label_of_another_set_is_added_only_where_all_sets_agree() -> None:
    labels = ["r_knee_study", "L_knee_study", "r.ASIS_study", "L.ASIS_study", "RTOE", "PX", "T8"]
    assert recognised(labels, "file").further == {}, "2 of 4 are no set, and RTOE has two meanings"
    found = recognised([*labels, "IJ"], "file")
    assert found.further == {"PX": ("xiphoid", ""), "T8": ("t8", ""), "IJ": ("incisura", "")}
    assert set(found.donors.values()) == {"isb-trunk 3 of 4"}


def test_joints_of_video_are_not_markers_on_skin() -> None:
    """R.Knee and R.Ankle beside R.ASIS are on the skin, not the centres that OpenCap's keypoints are."""
    labels = ["R.ASIS", "L.ASIS", "R.PSIS", "L.PSIS", "R.GTR", "R.Knee", "R.Ankle", "R.Heel", "R.MT1", "R.MT5"]
    found = recognised(labels, "file")
    assert found.words == "ior-bmclab 10 of 28"
    assert found.found["R.Knee"] == ("knee_lateral", "r") and found.further == {}
    legs = [f"{s}.{name}" for s in "RL" for name in ("ASIS", "Thigh", "Knee", "Shank", "Ankle", "Heel", "Toe")]
    found = recognised([*legs, "V.Sacral"], "file")
    assert found.words == "helen-hayes-cortex 15 of 40", "was opencap-keypoints 6 of 20"
    assert found.found["L.Ankle"] == ("ankle_lateral", "l")
    with pytest.raises(InputError, match=r"opencap-keypoints 4 of 20 and ior-bmclab 4 of 28: both fit, and differ"):
        recognised(["R.Knee", "L.Knee", "R.Ankle", "L.Ankle"], "file")
    centres = [label for label in PUBLIC["opencap-keypoints"].split() if "Heel" not in label]
    study = [label.format(s=side) for label in MARKER_SETS["opencap"].labels for side in "rl" if "{s}" in label]
    found = recognised([*study, *centres], "file")
    assert found.name == "opencap"
    assert not any(place.endswith("centre") for place, _ in found.further.values()), "though 18 of 20 are there"


@pytest.mark.parametrize("labels", ["A:{0} B:{0}", "{0} l_asi", "{0} L.Asi"])
def test_two_subjects_in_one_recording_are_refused(labels: str) -> None:
    """Both were put on one body: 32 of 16."""
    names = [name for label in PUBLIC["plug-in-gait-lower"].split() for name in labels.format(label).split()]
    with pytest.raises(InputError, match=r"LASI and \S+ are one place; give a recording of one subject"):
        recognised(names, "file")


def test_markers_of_a_model_that_two_sets_place_apart_are_not_used(file: Path) -> None:
    """A marker called Sternum of a model is where nobody knows, unless one set fits its markers better."""
    model = read_multibody(file)
    moved = dict(zip(("R_Asis", "L_Asis", "Sternum", "R_Heel", "R_Acromium"), model.markers, strict=True))
    known = replace(model, markers=tuple(replace(m, name=name) for name, m in moved.items()))
    seen = MarkerTrajectories(np.zeros(1), np.zeros((1, 4, 3)), ("R.ASIS", "L.ASIS", "V.Sacral", "Sternum"), "a.trc")
    with pytest.warns(InputWarning, match=r"taken for|no marker for|not used"):
        found = named_markers(known, seen, "cleveland")
    assert dict(found.table()[["label", "marker of the model"]].to_numpy())["Sternum"] == "Sternum"
    fewer = replace(known, markers=known.markers[:4])
    with pytest.warns(InputWarning, match=r"taken for|no marker for|not used"):
        found = named_markers(fewer, seen, "cleveland")
    how = dict(found.table()[["label", "marker of the model"]].to_numpy())
    assert how["R.ASIS"] == "R_Asis" and how["Sternum"].startswith("not used")


HIP, KNEE, ANKLE = np.array([-0.07, -0.066, 0.0835]), np.array([0.0, -0.42, 0.0]), np.array([0.0, -0.40, 0.0])


def joint_text(name: str, kind: str, parent: str, child: str, at: np.ndarray, coordinates: int) -> str:
    """A joint of OpenSim 4 with its frames and coordinates."""
    named = "".join(f'<Coordinate name="{name}_{k}"/>' for k in range(coordinates))
    frames = "".join(
        f'<PhysicalOffsetFrame name="{body}_o"><socket_parent>{"/ground" if body == "ground" else "/bodyset/" + body}'
        f"</socket_parent><translation>{' '.join(map(str, place))}</translation>"
        f"<orientation>0 0 0</orientation></PhysicalOffsetFrame>"
        for body, place in ((parent, at), (child, np.zeros(3)))
    )
    return (
        f'<{kind} name="{name}"><socket_parent_frame>{parent}_o</socket_parent_frame>'
        f"<socket_child_frame>{child}_o</socket_child_frame><coordinates>{named}</coordinates>"
        f"<frames>{frames}</frames></{kind}>"
    )


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A right leg of other lengths than gait2392's, with some of gait2354's markers."""
    bodies = "".join(
        f'<Body name="{name}"><mass>5</mass><mass_center>0 0 0</mass_center><inertia>1 1 1 0 0 0</inertia></Body>'
        for name in ("pelvis", "femur_r", "tibia_r", "talus_r")
    )
    joints = (
        joint_text("root", "FreeJoint", "ground", "pelvis", np.zeros(3), 6)
        + joint_text("hip_r", "BallJoint", "pelvis", "femur_r", HIP, 3)
        + joint_text("knee_r", "PinJoint", "femur_r", "tibia_r", KNEE, 1)
        + joint_text("ankle_r", "PinJoint", "tibia_r", "talus_r", ANKLE, 1)
    )
    own = {
        "R.ASIS": ("pelvis", (0.02, 0.03, 0.12)),
        "L.ASIS": ("pelvis", (0.02, 0.03, -0.12)),
        "V.Sacral": ("pelvis", (-0.17, 0.04, 0.0)),
        "R.Knee.Lat": ("femur_r", (0.0, -0.43, 0.05)),
        "RTHI": ("pelvis", (0.0, 0.0, 0.0)),
    }
    markers = "".join(
        f'<Marker name="{name}"><socket_parent_frame>/bodyset/{body}</socket_parent_frame>'
        f"<location>{' '.join(map(str, at))}</location></Marker>"
        for name, (body, at) in own.items()
    )
    path = tmp_path / "leg.osim"
    path.write_text(
        '<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="leg"><gravity>0 -9.8 0</gravity>'
        f"<BodySet><objects>{bodies}</objects></BodySet><JointSet><objects>{joints}</objects></JointSet>"
        f"<MarkerSet><objects>{markers}</objects></MarkerSet></Model></OpenSimDocument>"
    )
    return path


LABELS = ("RASI", "LASI", "VSAC", "RTHI", "RKNE", "RSHA", "RANK", "LKNE", "ROFF", "FOO")


def _place(label: str) -> tuple[str, np.ndarray]:
    """Where a label is on the model, by hand: own markers, else the table in proportion to the segment."""
    thigh, shank = 0.42 / 0.396, 0.40 / 0.430
    return {
        "RASI": ("pelvis", np.array([0.02, 0.03, 0.12])),
        "LASI": ("pelvis", np.array([0.02, 0.03, -0.12])),
        "VSAC": ("pelvis", np.array([-0.17, 0.04, 0.0])),
        "RKNE": ("femur_r", np.array([0.0, -0.43, 0.05])),
        "RTHI": ("femur_r", thigh * np.array([0.005, -0.22, 0.1])),
        "RSHA": ("tibia_r", shank * np.array([0.0, -0.2, 0.075])),
        "RANK": ("tibia_r", shank * np.array([-0.005, -0.425, 0.05])),
    }[label]


ORIGINS = {"pelvis": np.zeros(3), "femur_r": HIP, "tibia_r": HIP + KNEE}


@pytest.fixture
def standing(tmp_path: Path) -> Path:
    """The leg as the model stands by default, 1.1 times as large; labels of Helen Hayes, and one of no set."""
    places = np.full((3, len(LABELS), 3), 0.5)
    for k, label in enumerate(LABELS[:7]):
        body, at = _place(label)
        places[:, k] = 1.1 * (ORIGINS[body] + at)
    path = tmp_path / "static.trc"
    write_trc(path, MarkerTrajectories(np.array([0.0, 0.01, 0.02]), places, LABELS))
    return path


def _named(file: Path) -> tuple[Multibody, dict[str, Marker], dict[str, str], dict[str, float]]:
    seen = MarkerTrajectories(np.zeros(1), np.zeros((1, len(LABELS), 3)), LABELS, "static.trc")
    with pytest.warns(InputWarning, match=r"taken for helen-hayes 9 of 22|no marker for|not used"):
        found = named_markers(read_multibody(file), seen, "auto")
    table = found.table().set_index("label")
    return found.model, {m.name: m for m in found.model.markers}, dict(table["marker of the model"]), found.weights


def test_labels_take_the_models_markers_and_the_table_in_proportion_to_the_segments(file: Path) -> None:
    _, markers, how, weights = _named(file)
    assert set(markers) == set(LABELS[:7])
    for label, marker in markers.items():
        body, at = _place(label)
        assert marker.body == body, label
        np.testing.assert_allclose(marker.location, at, atol=1e-12, err_msg=label)
    assert how["RASI"] == "R.ASIS"
    assert how["RTHI"] == "placed by the table", "the model's own of that name is on the pelvis: another place"
    assert how["LKNE"] == "not used: no body femur_l"
    assert how["FOO"] == "not used: in no set"
    assert weights["RTHI"] == SOFT
    assert weights["RKNE"] == 1.0


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_scale_measures_the_sets_pairs_and_ik_needs_no_name(file: Path, standing: Path, tmp_path: Path) -> None:
    result = gc.scale(standing, model=file, naming="auto")
    assert result.scale_factors == pytest.approx({"pelvis": 1.1, "femur_r": 1.1, "tibia_r": 1.1}, abs=1e-9)
    assert result.rms < 1e-6
    folder = result.write(tmp_path / "s")
    assert (folder / "naming.csv").exists()
    assert set(re.findall(r'Marker name="(\w+)"', (folder / "scaled.osim").read_text())) == set(LABELS[:7])
    angles = gc.inverse_kinematics(standing, model=folder / "scaled.osim")
    assert angles.rms < 1e-6
    assert set(angles.distances) == set(LABELS[:7])
    direct = gc.inverse_kinematics(standing, model=file, naming="helen-hayes")
    assert direct.rms > 0.01, "not scaled: 10 % larger"
    assert "naming" in direct.tables()
    with pytest.raises(InputError, match="naming"):
        gc.inverse_kinematics(standing, model=file, naming="auto", markers_map="RASI=R.ASIS")


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_a_scaled_model_keeps_its_wands_and_a_marker_set_is_named_once(
    file: Path, standing: Path, tmp_path: Path
) -> None:
    """A static pose has moved the wands: they count as others do. OpenSim's set-up names one set of markers."""
    own = tmp_path / "markers.xml"
    text = file.read_text()
    markers = text[text.index("<MarkerSet>") : text.index("</MarkerSet>") + len("</MarkerSet>")]
    own.write_text(f'<?xml version="1.0"?><OpenSimDocument Version="40000">{markers}</OpenSimDocument>')
    folder = gc.scale(standing, model=file, naming="auto", marker_set=own).write(tmp_path / "s")
    setup = (folder / "setup_scale.xml").read_text()
    assert "<model_file>model.osim" in setup
    assert "markers.xml" not in setup
    assert set(re.findall(r'Marker name="(\w+)"', (folder / "model.osim").read_text())) == set(LABELS[:7])
    seen = MarkerTrajectories(np.zeros(1), np.zeros((1, 7, 3)), LABELS[:7], "static.trc")
    assert set(named_markers(read_multibody(folder / "scaled.osim"), seen, "auto").weights.values()) == {1.0}


def _walked(standing: Path, longer: float, bent: float) -> Path:
    """The right shank longer by so many metres, and in every other frame the knee further from the pelvis."""
    seen = read_trc(standing)
    places = np.array(seen.positions)
    places[:, seen.names.index("RANK"), 1] -= longer
    for name in ("RKNE", "RTHI", "RSHA", "RANK"):
        places[::2, seen.names.index(name), 1] -= bent
    file = standing.with_name("moved.trc")
    write_trc(file, replace(seen, positions=places))
    return file


def _doubts(file: Path, trial: Path, *scale: str) -> list[str]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        found = gc.scale(trial, model=file, scale=scale, **({} if scale else {"naming": "auto"}))
    return [line for line in found.warnings if "mm longer" in line or "mm apart" in line]


def test_a_pair_that_changes_its_length_is_said(file: Path, standing: Path) -> None:
    """Hip or knee lie between: the factor belongs to the pose."""
    assert not _doubts(file, _walked(standing, 0.0, 0.015))
    (line,) = _doubts(file, _walked(standing, 0.0, 0.03))
    match = re.search(r"femur_r: RASI and RKNE are (\d+) to (\d+) mm apart, which changes with hip_r_\d:", line)
    apart = 1.1 * (HIP + np.array([-0.02, -0.46, -0.07]))
    by_hand = [1e3 * np.linalg.norm(apart - (0.0, lower, 0.0)) for lower in (0.0, 0.03)]
    np.testing.assert_allclose([float(each) for each in match.groups()] if match else line, by_hand, atol=3.0)
    with pytest.warns(InputWarning):
        still = gc.scale(standing, model=file, naming="auto")
    said = next(line for line in still.sentences if "across a joint" in line)
    assert re.search(r"femur_r by RASI/RKNE \(hip_r_\d, \d+ mm\)", said), said
    assert "pelvis by" not in said, "one body"


def test_sides_of_unequal_length_are_said(two_legs: Path, tmp_path: Path) -> None:
    """20 mm, more than 3 standard deviations of legs; numbers that are typed are no measurement."""
    labels = ("R.ASIS", "L.ASIS", "R.Knee.Lat", "L.Knee.Lat")
    for longer, said in ((0.0, 0), (0.015, 0), (0.03, 1)):
        places = np.array([[0.02, 0.03, 0.12], [0.02, 0.03, -0.12], [0, -0.486, 0.13], [0, -0.486 - longer, -0.13]])
        trial = tmp_path / "static.trc"
        write_trc(trial, MarkerTrajectories(np.array([0.0, 0.01]), np.tile(places, (2, 1, 1)), labels))
        pairs = "femur_r=R.ASIS/R.Knee.Lat", "femur_l=L.ASIS/L.Knee.Lat"
        found = _doubts(two_legs, trial, *pairs)
        assert len(found) == said, found
        both = "femur_r,femur_l=R.ASIS/R.Knee.Lat,L.ASIS/L.Knee.Lat"
        assert not _doubts(two_legs, trial, both)
    (line,) = found
    assert re.search(r"femur: the left one is scaled 30 mm longer than the right one; markers are", line), line
    assert not _doubts(two_legs, trial, "femur_r=1.0", "femur_l=1.1")
    places[3, 1] = places[2, 1]  # legs of one length, and a model whose markers are not
    write_trc(trial, MarkerTrajectories(np.array([0.0, 0.01]), np.tile(places, (2, 1, 1)), labels))
    two_legs.write_text(two_legs.read_text().replace("0.07 -0.42 -0.0465", "0.07 -0.38 -0.0465"))
    (line,) = _doubts(two_legs, trial, *pairs)
    assert re.search(r"markers are (\d+) and \1 mm apart, right and left, those of the model \d+ and \d+ mm", line), (
        line
    )


@pytest.fixture
def two_legs(tmp_path: Path) -> Path:
    """Pelvis and two femora, a marker on each side of each."""
    bodies = "".join(
        f'<Body name="{name}"><mass>5</mass><mass_center>0 0 0</mass_center><inertia>1 1 1 0 0 0</inertia></Body>'
        for name in ("pelvis", "femur_r", "femur_l")
    )
    joints = joint_text("root", "FreeJoint", "ground", "pelvis", np.zeros(3), 6) + "".join(
        joint_text(f"hip_{s}", "BallJoint", "pelvis", f"femur_{s}", HIP * (1, 1, z), 3)
        for s, z in (("r", 1), ("l", -1))
    )
    markers = "".join(
        f'<Marker name="{s.upper()}.{name}"><socket_parent_frame>/bodyset/{body.format(s)}</socket_parent_frame>'
        f"<location>{x} {y} {z if s == 'r' else -z}</location></Marker>"
        for s in "rl"
        for name, body, (x, y, z) in (
            ("ASIS", "pelvis", (0.02, 0.03, 0.12)),
            ("Knee.Lat", "femur_{}", (0.07, -0.42, 0.0465)),
        )
    )
    path = tmp_path / "legs.osim"
    path.write_text(
        '<?xml version="1.0"?><OpenSimDocument Version="40000"><Model name="legs"><gravity>0 -9.8 0</gravity>'
        f"<BodySet><objects>{bodies}</objects></BodySet><JointSet><objects>{joints}</objects></JointSet>"
        f"<MarkerSet><objects>{markers}</objects></MarkerSet></Model></OpenSimDocument>"
    )
    return path


@pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
def test_an_iliac_crest_is_used_on_a_model_without_its_label(file: Path) -> None:
    """Within 25 mm of where the internal oblique begins on gait2354's subject01, intobl_r-P1, and outside of it."""
    labels = ("R.ASIS", "L.ASIS", "R.Iliac.Crest", "L.Iliac.Crest", "R.GTR", "R.Knee", "R.HF", "R.TT", "R.Ankle")
    seen = MarkerTrajectories(np.zeros(1), np.zeros((1, len(labels), 3)), labels, "synthetic")
    found = named_markers(read_multibody(file), seen, "ior-bmclab")
    at = {m.name: m.location for m in found.model.markers if m.body == "pelvis"}
    muscle = np.array([-0.0409831, 0.0717204, 0.118544])
    size = at["R.Iliac.Crest"][1] / 0.075
    assert np.linalg.norm(at["R.Iliac.Crest"] / size - muscle) < 0.025
    assert at["R.Iliac.Crest"][2] / size > muscle[2]
    np.testing.assert_allclose(at["L.Iliac.Crest"], at["R.Iliac.Crest"] * [1.0, 1.0, -1.0])
    assert set(found.weights.values()) == {1.0}, "a bony place"
