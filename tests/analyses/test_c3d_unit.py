"""`c3d_unit` states the unit of a .c3d file that says none, wherever such a file is read."""

from __future__ import annotations

import ast
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from geocontact import analyses
from geocontact.analyses.frame.options import declared
from geocontact.analyses.motion.markers import markers_given, unit_of_c3d
from geocontact.data.errors import InputError
from tests.io.plate_files import channels, plate_file, stance

READ_C3D = {
    "cop": "CopOptions",
    "gap.gather": "GatherOptions",
    "motion.functional_joint": "JointOptions",
    "motion.inverse_dynamics": "IdOptions",
    "motion.inverse_kinematics": "IkOptions",
    "motion.scale": "ScaleOptions",
    "prosthesis.calibrate": "ProsthesisCalibrateOptions",
    "prosthesis.compare": "ProsthesisCompareOptions",
    "prosthesis.design": "ProsthesisDesignOptions",
    "prosthesis.scale": "ProsthesisScaleOptions",
    "prosthesis.simulate": "ProsthesisSimulateOptions",
    "prosthesis.walk": "ProsthesisWalkOptions",
    "shoulder.optimise": "ShoulderOptimiseOptions",
    "shoulder.simulate": "ShoulderSimulateOptions",
    "shoulder.study": "StudyOptions",
    "sit_to_stand.calibrate": "StandingCalibrateOptions",
    "sit_to_stand.compare": "StandingCompareOptions",
    "sit_to_stand.design": "StandingDesignOptions",
    "sit_to_stand.predict": "StandingPredictOptions",
}


@pytest.mark.parametrize("room", READ_C3D)
def test_every_job_that_reads_such_files_takes_it(room: str) -> None:
    options = getattr(import_module(f"geocontact.analyses.{room}.options"), READ_C3D[room])
    (one,) = [each for each in declared(options) if each.name == "c3d_unit"]
    assert one.optional and one.default is None and not one.positional
    assert one.choices == ("m", "cm", "mm", "in", "um") and "POINT:UNITS" in one.words


def test_it_has_no_effect_without_such_a_file() -> None:
    options = import_module("geocontact.analyses.motion.inverse_kinematics.options").IkOptions
    assert options(Path("a.c3d"), model=Path("m.osim"), c3d_unit="m").c3d_unit == "m"
    with pytest.raises(InputError, match=r"`c3d_unit`: has no effect without a \.c3d file; leave it out"):
        options(Path("a.trc"), model=Path("m.osim"), c3d_unit="m")
    with pytest.raises(InputError, match="'feet' is not a choice"):
        options(Path("a.c3d"), model=Path("m.osim"), c3d_unit="feet")
    assert unit_of_c3d("m", Path("a.trc"), None) is None
    assert unit_of_c3d("m", Path("a.trc"), Path("b.C3D")) == "m"


def test_markers_as_they_are_asked_for(tmp_path: Path) -> None:
    """The heel at 0.3, 0.2, 0.1 m, written in metres without a word."""
    file = plate_file(tmp_path / "a.c3d", channels(stance()), ("", "N", "Nm"), 1.0, 1.0)
    with pytest.raises(InputError, match="POINT:UNITS: is empty"):
        markers_given(file, None, None, None)
    seen = markers_given(file, "x,z,-y", (0.1, 0.2), "m")
    np.testing.assert_allclose(seen.positions[0, 0], [0.3, 0.1, -0.2], atol=1e-6)


@pytest.mark.parametrize("reader", ["read_markers", "read_force_plates"])
def test_every_analysis_passes_it_on(reader: str) -> None:
    """Every call has a second argument. OpenSim's set-up files name .trc files only, of which times are read.

    What a file holds is said before a unit is given: a .c3d that states none is refused there too.
    """
    others = ("opensim_setup.py", "file_content.py")
    calls = [
        (file.name, call)
        for file in Path(analyses.__file__).parent.rglob("*.py")
        for call in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(call, ast.Call) and getattr(call.func, "id", "") == reader and file.name not in others
    ]
    assert calls
    assert [name for name, call in calls if len(call.args) < 2] == []
