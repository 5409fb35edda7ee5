"""Names of `geocontact`; those of analyses are written by `python -m website.stubs`."""

from geocontact import chain
from geocontact.analyses import knee, misalignment, prosthesis, shoulder, sit_to_stand
from geocontact.analyses.area.pairs.rest import settle_pairs
from geocontact.analyses.area.pairs.result import area_pairs
from geocontact.analyses.area.result import area, pressure
from geocontact.analyses.cop.result import centre_of_pressure
from geocontact.analyses.frame.bodies import read_surface
from geocontact.analyses.frame.result import Result
from geocontact.analyses.gap.diagnose.result import diagnose
from geocontact.analyses.gap.discriminability.result import discriminability
from geocontact.analyses.gap.gather.result import gather
from geocontact.analyses.gap.init.result import init_gap_case
from geocontact.analyses.gap.inject.result import inject
from geocontact.analyses.loadcells.result import load_cells
from geocontact.analyses.mat.result import mat
from geocontact.analyses.modulus.result import modulus
from geocontact.analyses.motion.functional_joint.result import functional_joint
from geocontact.analyses.motion.inverse_dynamics.result import inverse_dynamics
from geocontact.analyses.motion.inverse_kinematics.result import inverse_kinematics
from geocontact.analyses.motion.scale.result import scale
from geocontact.analyses.motion.virtual_markers.result import virtual_markers
from geocontact.analyses.shape.result import fit_shape
from geocontact.analyses.thickness.result import thickness
from geocontact.data.errors import InputError, InputWarning
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.data.parameter import Parameter
from geocontact.data.units import GPa, MPa, cm, deg, inch, kN, kPa, lbf, m, mm, mmHg, ms, percent
from geocontact.effects.catalogue import candidates
from geocontact.geometry.contact_area.area import Refinement
from geocontact.geometry.contact_area.evolution import ContactPair, Settings, area_evolution
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.plane import Plane
from geocontact.geometry.regions import faces_where
from geocontact.geometry.separation import separation, settle
from geocontact.geometry.shapes import HalfSpace, Proximity, Sphere, Tube
from geocontact.geometry.surface import Surface
from geocontact.geometry.sweep import Axis, sweep
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.motion.motion import read_motion
from geocontact.study.result import cohort
from geocontact.systems.base import Base, require_numbers
from geocontact.systems.catalogue import system_of
from geocontact.systems.simulator import simulator_base

__version__: str

__all__ = [
    "AreaEvolution",
    "Axis",
    "Base",
    "ContactPair",
    "DistanceMaps",
    "GPa",
    "HalfSpace",
    "InputError",
    "InputWarning",
    "MPa",
    "Motion",
    "Parameter",
    "Plane",
    "Proximity",
    "Refinement",
    "Result",
    "Settings",
    "Sphere",
    "Surface",
    "Tube",
    "area",
    "area_evolution",
    "area_pairs",
    "candidates",
    "centre_of_pressure",
    "chain",
    "cm",
    "cohort",
    "deg",
    "diagnose",
    "discriminability",
    "faces_where",
    "fit_shape",
    "functional_joint",
    "gather",
    "inch",
    "init_gap_case",
    "inject",
    "inverse_dynamics",
    "inverse_kinematics",
    "kN",
    "kPa",
    "knee",
    "lbf",
    "load_cells",
    "m",
    "mat",
    "misalignment",
    "mm",
    "mmHg",
    "modulus",
    "ms",
    "percent",
    "pressure",
    "prosthesis",
    "read_gap_case",
    "read_mesh",
    "read_motion",
    "read_surface",
    "require_numbers",
    "scale",
    "separation",
    "settle",
    "settle_pairs",
    "shoulder",
    "simulator_base",
    "sit_to_stand",
    "sweep",
    "system_of",
    "thickness",
    "virtual_markers",
]
