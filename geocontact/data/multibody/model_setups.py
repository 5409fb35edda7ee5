"""Set-ups of scaling and inverse kinematics of public full-body models, stated by places of the body.

A measurement is written as `scale` takes it, with places in the stead of markers: femur_r=hip_centre_r/knee_lateral_r.
Weights are those of the sources, by place; 0 is a marker that the source leaves out, of the moving trial because it is
taken off, of the static one because it is moved to where it was seen. Two deviations: coordinates that Hamner keeps
near the static pose of its own example (hips, ankles and arms) are left out, as they are another person's; and so is
the neutral pose near which OpenCap keeps everybody (0 at hips, knees, ankles and trunk with weight 0.1, a marker having
1 to 60), so that angles come from the markers alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

Weights = Mapping[str, float]


@dataclass(frozen=True)
class ModelSetup:
    """How markers measure a public model, and what they count.

    Parameters
    ----------
    words
        The models.
    source
        Public files of the numbers.
    names
        Parts of the name of a model, in lower case.
    bodies
        Bodies without their side; both sides are meant where the body has sides.
    marker_sets
        Sets of `data.multibody.marker_sets` that the models carry.
    measurements
        Bodies, axes and pairs of places.
    standing, moving
        Weights of markers by place in the static pose and in motion [1/m^2, up to a common factor].
    coordinates
        Weights with which coordinates are kept near their defaults, as in the sources.
    """

    words: str
    source: str
    names: tuple[str, ...]
    bodies: tuple[str, ...]
    marker_sets: tuple[str, ...]
    measurements: tuple[str, ...]
    standing: Weights
    moving: Weights
    coordinates: Weights = field(default_factory=dict)

    @property
    def all_bodies(self) -> tuple[str, ...]:
        """Names of the bodies, right and left."""
        middle = ("pelvis", "torso")
        sided = [f"{name}_{side}" for name in self.bodies if name not in middle for side in "rl"]
        return tuple([name for name in self.bodies if name in middle] + sided)


def _weighed(*groups: tuple[float, str]) -> Weights:
    return {place: weight for weight, places in groups for place in places.split()}


def _both(bodies: str, *pairs: str, axes: str = "") -> str:
    """One measurement of bodies on both sides by pairs on both sides, which count alike; {s} stands for the side."""
    sides = [f"{name}_{side}{axes}" for name in bodies.split() for side in "rl"]
    return f"{','.join(sides)}={','.join(pair.replace('{s}', side) for pair in pairs for side in 'rl')}"


_LEGS = ("pelvis", "femur", "tibia", "talus", "calcn", "toes", "torso")
_ARMS = ("humerus", "ulna", "radius", "hand")
_PELVIS = "pelvis=asis_r/asis_l"
_THIGH = ("asis_{s}/knee_lateral_{s}",)
_SHANK = ("knee_lateral_{s}/ankle_lateral_{s}",)
_KNEE_AND_ANKLE = "knee_lateral knee_medial ankle_lateral ankle_medial"
_CENTRES = "knee_centre ankle_centre"
_TRIPLES = " ".join(f"{body}_{where}" for body in ("thigh", "shank") for where in ("upper", "front", "rear"))
_SIDES_OF_FOOT = "midfoot_top midfoot_lateral toe_lateral toe_medial"

MODEL_SETUPS: Mapping[str, ModelSetup] = {
    "gait2392": ModelSetup(
        "gait2392 and gait2354",
        "opensim-models: gait2392_Scale_MeasurementSet.xml, gait2392_Scale_Tasks.xml, gait2392_IK_Tasks.xml",
        ("gait2392", "gait2354", "gaitmodel2392", "gaitmodel2354"),
        _LEGS,
        ("cleveland",),
        (
            "torso=sacrum/head",
            _PELVIS,
            _both("femur patella", *_THIGH),
            _both("tibia talus", *_SHANK),
            _both("calcn toes", "heel_{s}/toe_tip_{s}"),
        ),
        _weighed(
            (1000.0, f"asis sacrum heel toe_tip {_KNEE_AND_ANKLE}"),
            (1.0, f"sternum acromion head {_TRIPLES} {_SIDES_OF_FOOT}"),
        ),
        _weighed(
            (10.0, "asis sacrum heel toe_tip"),
            (1.0, f"sternum {_TRIPLES} {_SIDES_OF_FOOT}"),
            (0.5, "acromion"),
            (0.1, "head"),
            (0.0, _KNEE_AND_ANKLE),
        ),
        {f"{name}_angle_{side}": 1000.0 for name in ("subtalar", "mtp") for side in "rl"},
    ),
    "hamner": ModelSetup(
        "Hamner 2010, full body for running",
        "opensim-models, Pipelines/Hamner: Setup_Scale.xml, Tasks_IK.xml",
        ("hamner",),
        (*_LEGS, *_ARMS),
        ("cleveland",),
        (
            "torso=sacrum/acromion_l,sacrum/acromion_r",
            _PELVIS,
            _both("femur", *_THIGH),
            _both("tibia talus", *_SHANK),
            _both("calcn toes", "heel_{s}/toe_tip_{s}"),
            _both("humerus", "acromion_{s}/elbow_lateral_{s}"),
            _both("ulna radius", "elbow_lateral_{s}/wrist_radial_{s}", "elbow_lateral_{s}/wrist_ulnar_{s}"),
        ),
        _weighed(
            (100.0, "asis sacrum"),
            (50.0, f"acromion elbow_lateral wrist_radial wrist_ulnar {_KNEE_AND_ANKLE}"),
            (10.0, "sternum heel toe_tip"),
            (0.0, f"{_TRIPLES} {_SIDES_OF_FOOT}"),
        ),
        _weighed(
            (50.0, "asis sacrum heel toe_tip"),
            (20.0, "elbow_lateral wrist_radial wrist_ulnar"),
            (10.0, f"acromion arm {_TRIPLES} {_SIDES_OF_FOOT}"),
            (1.0, "sternum"),
            (0.0, _KNEE_AND_ANKLE),
        ),
    ),
    "rajagopal": ModelSetup(
        "Rajagopal 2016, full body",
        "opensim-models, Pipelines/Rajagopal: Setup_Scale.xml, Setup_IK.xml",
        ("rajagopal", "muscleactuatedlowerlimb"),
        (*_LEGS, *_ARMS, "patella"),
        ("rajagopal",),
        (
            "torso=asis_r/incisura,asis_l/incisura,psis_l/c7,psis_r/c7,asis_r/acromion_r,asis_l/acromion_l",
            "pelvis:x=asis_r/psis_r,asis_l/psis_l",
            "pelvis:y=psis_l/hip_centre_l,psis_r/hip_centre_r,asis_r/hip_centre_r,asis_l/hip_centre_l",
            "pelvis:z=psis_r/psis_l,asis_r/asis_l",
            _both("femur", "hip_centre_{s}/knee_lateral_{s}", "hip_centre_{s}/knee_medial_{s}"),
            _both("tibia", "knee_lateral_{s}/ankle_lateral_{s}", "knee_medial_{s}/ankle_medial_{s}"),
            _both("talus calcn toes", "heel_{s}/metatarsal_5_{s}", "heel_{s}/toe_medial_{s}"),
            _both("humerus", "shoulder_centre_{s}/elbow_medial_{s}", "shoulder_centre_{s}/elbow_lateral_{s}"),
            _both("ulna radius hand", "elbow_lateral_{s}/wrist_radial_{s}", "elbow_medial_{s}/wrist_ulnar_{s}"),
        ),
        _weighed(
            (250.0, "c7 incisura"),
            (100.0, "acromion asis hip_centre"),
            (50.0, f"psis elbow_lateral elbow_medial wrist_radial wrist_ulnar {_KNEE_AND_ANKLE}"),
            (25.0, "heel toe_medial metatarsal_5"),
            (0.0, f"thigh_cluster shank_cluster arm shoulder_centre {_CENTRES}"),
        ),
        _weighed(
            (100.0, "asis psis"),
            (50.0, "thigh_cluster shank_cluster heel toe_medial metatarsal_5"),
            (25.0, "acromion c7 incisura arm elbow_lateral elbow_medial wrist_radial wrist_ulnar"),
            (0.0, f"hip_centre shoulder_centre {_KNEE_AND_ANKLE} {_CENTRES}"),
        ),
    ),
    "laiuhlrich": ModelSetup(
        "LaiUhlrich 2022 and LaiArnold 2017, full body, as OpenCap uses them",
        "opencap-core: Setup_scaling_LaiUhlrich2022.xml, Setup_IK.xml",
        ("laiuhlrich", "laiarnold"),
        (*_LEGS, *_ARMS, "patella"),
        ("opencap",),
        (
            _both(
                "talus calcn toes",
                "heel_{s}/metatarsal_2_{s}",
                "heel_{s}/metatarsal_5_{s}",
            ),
            *(
                text.replace("{s}", side)
                for side in "rl"
                for text in (
                    "tibia_{s}=knee_lateral_{s}/ankle_lateral_{s},knee_medial_{s}/ankle_medial_{s}",
                    "femur_{s},patella_{s}=hip_centre_{s}/knee_lateral_{s}",
                )
            ),
            "pelvis:xy=asis_r/psis_r,asis_l/psis_l",
            "pelvis:z=hip_centre_r/hip_centre_l",
            "torso:xy=acromion_r/psis_r,acromion_l/psis_l,c7/psis_r,c7/psis_l",
            "torso:z=acromion_r/acromion_l",
            _both("humerus", "acromion_{s}/elbow_lateral_{s}", "acromion_{s}/elbow_medial_{s}"),
            _both("ulna radius hand", "wrist_radial_{s}/elbow_lateral_{s}", "wrist_ulnar_{s}/elbow_medial_{s}"),
        ),
        _weighed(
            (20.0, "c7"),
            (10.0, f"asis psis hip_centre metatarsal_2 metatarsal_5 heel {_KNEE_AND_ANKLE}"),
            (5.0, "acromion wrist_radial wrist_ulnar"),
            (1.0, "elbow_lateral"),
            (0.0, "elbow_medial thigh_cluster shank_cluster"),
        ),
        _weighed(
            (60.0, "heel"),
            (30.0, f"metatarsal_2 metatarsal_5 {_KNEE_AND_ANKLE}"),
            (25.0, "asis psis hip_centre"),
            (5.0, "c7 acromion elbow_lateral elbow_medial wrist_radial wrist_ulnar"),
            (4.0, "thigh_cluster shank_cluster"),
        ),
    ),
}
"""By the name that `model_setup` takes."""
