"""What the opensim package says, asked in a process of its own: its libraries and CasADi's do not load into one.

Functions here run there; each takes and gives plain values. Coordinates are in rad and m.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np


def _model(file: Path) -> tuple[Any, Any]:
    import opensim

    opensim.Logger.setLevelString("Off")
    model = opensim.Model(str(file))
    return model, model.initSystem()


def _body(model: Any, name: str) -> Any:
    """Ground or body, also one that is in no set; a view that lives as long as the model does."""
    if name == "ground":
        return model.getGround()
    if model.getBodySet().contains(name):
        return model.getBodySet().get(name)
    return model.getComponent(f"/{name}")


def _set(model: Any, state: Any, names: Sequence[str], values: np.ndarray) -> None:
    for name, value in zip(names, values, strict=True):
        model.updCoordinateSet().get(name).setValue(state, float(value), False)


def poses(file: Path, names: Sequence[str], samples: np.ndarray, pairs: Sequence[tuple[str, str]]) -> np.ndarray:
    """Poses of the first body in the second for each sample and pair, (s, p, 4, 4)."""
    model, state = _model(file)
    frames = [[_body(model, b) for b in pair] for pair in pairs]
    found = np.tile(np.eye(4), (len(samples), len(pairs), 1, 1))
    for k, values in enumerate(samples):
        _set(model, state, names, values)
        model.realizePosition(state)
        for i, (child, parent) in enumerate(frames):
            theirs = child.findTransformBetween(state, parent)
            found[k, i, :3, 3] = [theirs.p().get(n) for n in range(3)]
            found[k, i, :3, :3] = [[theirs.R().asMat33().get(m, n) for n in range(3)] for m in range(3)]
    return found


def motion_types(file: Path, names: Sequence[str]) -> list[str]:
    """What kind of motion each coordinate is."""
    model, _ = _model(file)
    kinds = ("", "rotational", "translational", "coupled")
    return [kinds[model.getCoordinateSet().get(name).getMotionType()] for name in names]


def converted(file: Path, out: Path) -> None:
    """The model written again, as this version writes models."""
    import opensim

    opensim.Logger.setLevelString("Off")
    model = opensim.Model(str(file))
    model.finalizeFromProperties()
    model.printToXML(str(out))


def cell(file: Path, row: int, column: int) -> tuple[float, float]:
    """Time and value in a row of a .mot or .sto file, columns counted after time."""
    import opensim

    opensim.Logger.setLevelString("Off")
    table = opensim.Storage(str(file))  # what it gives lives as long as it does
    state = table.getStateVector(row)
    return state.getTime(), state.getData().get(column)


def external_loads(file: Path) -> list[tuple[str, str, str]]:
    """Name, body and force identifier of each load of an external-loads file, whose data file is read as well."""
    import opensim

    opensim.Logger.setLevelString("Off")
    loads = opensim.ExternalLoads(str(file), True)
    opensim.Storage(str(file.parent / loads.getDataFileName()))
    found = []
    for k in range(loads.getSize()):
        one = loads.get(k)
        found.append((one.getName(), one.getAppliedToBodyName(), one.getForceIdentifier()))
    return found


def external_wrenches(model_file: Path, file: Path, time: float) -> dict[str, tuple[str, str, np.ndarray]]:
    """Body, frame, and force, point and torque (3, 3) of each load at a time, with the loads added to a model."""
    import opensim

    model, _ = _model(model_file)
    loads = opensim.ExternalLoads(str(file), True)
    model.addModelComponent(loads)
    model.initSystem()
    found = {}
    for k in range(loads.getSize()):
        one = loads.get(k)
        vectors = (one.getForceAtTime(time), one.getPointAtTime(time), one.getTorqueAtTime(time))
        numbers = np.array([[vector.get(i) for i in range(3)] for vector in vectors])
        found[one.getName()] = one.getAppliedToBodyName(), one.getForceExpressedInBodyName(), numbers
    return found


def markers(file: Path, row: int) -> tuple[list[str], np.ndarray]:
    """Names of a .trc file and where the markers are in a row, in the file's unit."""
    import opensim

    opensim.Logger.setLevelString("Off")
    table = opensim.TimeSeriesTableVec3(str(file))
    cells = table.getRowAtIndex(row)
    places = [[cells[k].get(n) for n in range(3)] for k in range(table.getNumColumns())]
    return list(table.getColumnLabels()), np.array(places)


def marker_places(file: Path, motion: Path, row: int) -> dict[str, np.ndarray]:
    """Where the markers of a model are in the ground [m] in a row of a motion in degrees."""
    import opensim

    model, state = _model(file)
    table = opensim.Storage(str(motion))
    cells, labels = table.getStateVector(row).getData(), table.getColumnLabels()
    for k in range(1, labels.getSize()):
        coordinate = model.updCoordinateSet().get(labels.get(k))
        turns = coordinate.getMotionType() == opensim.Coordinate.Rotational
        value = cells.get(k - 1)
        coordinate.setValue(state, float(np.radians(value)) if turns else value, False)
    model.realizePosition(state)
    found = {}
    for k in range(model.getMarkerSet().getSize()):
        marker = model.getMarkerSet().get(k)
        place = marker.getLocationInGround(state)
        found[marker.getName()] = np.array([place.get(n) for n in range(3)])
    return found


def inverse_dynamics(
    file: Path, names: Sequence[str], q: np.ndarray, u: np.ndarray, a: np.ndarray, passive: bool = False
) -> np.ndarray:
    """Generalised forces without external loads, (s, n), beside the forces of the model's own set or with none."""
    import opensim

    model, state = _model(file)
    forces = model.updForceSet()
    for i in range(0 if passive else forces.getSize()):
        forces.get(i).setAppliesForce(state, False)
    coordinates = model.getCoordinateSet()
    place = {}
    for name in names:
        coordinates.get(name).setSpeedValue(state, 7.25)
        place[name] = next(i for i in range(len(names)) if state.getU().get(i) == 7.25)
        coordinates.get(name).setSpeedValue(state, 0.0)
    solver = opensim.InverseDynamicsSolver(model)
    found = np.zeros(q.shape)
    for k in range(len(q)):
        _set(model, state, names, q[k])
        fast = opensim.Vector(len(names), 0.0)
        for i, name in enumerate(names):
            coordinates.get(name).setSpeedValue(state, float(u[k, i]))
            fast.set(place[name], float(a[k, i]))
        model.realizeDynamics(state)
        forces_found = solver.solve(state, fast)
        found[k] = [forces_found.get(place[name]) for name in names]
    return found


def scaled(file: Path, out: Path, factors: dict[str, tuple[float, float, float]], mass: float) -> None:
    """The model scaled by hand and written again, masses shared as before."""
    import opensim

    model, state = _model(file)
    wanted = opensim.ScaleSet()
    for name, by in factors.items():
        one = opensim.Scale()
        one.setSegmentName(name)
        one.setScaleFactors(opensim.Vec3(*by))
        one.setApply(True)
        wanted.cloneAndAppend(one)
    model.scale(state, wanted, True, mass)
    model.printToXML(str(out))


def inverse_kinematics(
    file: Path,
    markers: Path,
    weights: dict[str, float],
    held: dict[str, tuple[float, float | None]],
    times: Sequence[float],
    names: Sequence[str],
    accuracy: float = 1e-5,
    constraints: float = float("inf"),
) -> tuple[float, np.ndarray]:
    """CPU seconds of its solver for these frames, the first among them, and the coordinates it finds, (t, n).

    `accuracy` is the tool's own unless told; `constraints` is the weight of the model's constraints.
    """
    import time

    import opensim

    model, state = _model(file)
    wanted = opensim.SetMarkerWeights()
    for name, weight in weights.items():
        if weight > 0.0:
            wanted.cloneAndAppend(opensim.MarkerWeight(name, weight))
    seen = opensim.MarkersReference(str(markers), wanted)
    coordinates = opensim.SimTKArrayCoordinateReference()
    for name, (weight, value) in held.items():
        if value is None:
            value = model.getCoordinateSet().get(name).getDefaultValue()
        one = opensim.CoordinateReference(name, opensim.Constant(value))
        one.setWeight(weight)
        coordinates.push_back(one)
    solver = opensim.InverseKinematicsSolver(model, seen, coordinates, constraints)
    solver.setAccuracy(accuracy)
    found = np.zeros((len(times), len(names)))
    began = time.process_time()
    for k, at in enumerate(times):
        state.setTime(float(at))
        solver.track(state) if k else solver.assemble(state)
        found[k] = [model.getCoordinateSet().get(name).getValue(state) for name in names]
    return time.process_time() - began, found


def smooth_sphere(
    modulus: float,
    radius: float,
    dissipation: float,
    friction: Sequence[float],
    depth: np.ndarray,
    velocity: np.ndarray,
) -> np.ndarray:
    """Force of a `SmoothSphereHalfSpaceForce` along x and upwards [N], (s, 2), on a sphere that slides and sinks.

    Friction is transition velocity, static, dynamic and viscous coefficient; velocities are along x and upwards.
    """
    import opensim

    opensim.Logger.setLevelString("Off")
    model = opensim.Model()
    body = opensim.Body("ball", 1.0, opensim.Vec3(0), opensim.Inertia(1.0, 1.0, 1.0))
    joint = opensim.PlanarJoint("joint", model.getGround(), body)
    model.addBody(body)
    model.addJoint(joint)
    ground, zero = model.getGround(), opensim.Vec3(0)
    half = opensim.ContactHalfSpace(zero, opensim.Vec3(0, 0, -np.pi / 2), ground, "ground")
    sphere = opensim.ContactSphere(radius, zero, body, "sphere")
    model.addContactGeometry(half)
    model.addContactGeometry(sphere)
    force = opensim.SmoothSphereHalfSpaceForce("contact", sphere, half)
    force.set_stiffness(modulus)
    force.set_dissipation(dissipation)
    force.set_transition_velocity(friction[0])
    force.set_static_friction(friction[1])
    force.set_dynamic_friction(friction[2])
    force.set_viscous_friction(friction[3])
    model.addForce(force)
    state = model.initSystem()
    names = [joint.get_coordinates(k).getName() for k in (1, 2)]
    found = np.zeros((len(depth), 2))
    for k, (deep, speeds) in enumerate(zip(depth, velocity, strict=True)):
        _set(model, state, names, np.array([0.0, radius - deep]))
        for name, speed in zip(names, speeds, strict=True):
            model.updCoordinateSet().get(name).setSpeedValue(state, float(speed))
        model.realizeDynamics(state)
        values, labels = force.getRecordValues(state), force.getRecordLabels()
        named = [labels.get(i).lower() for i in range(labels.getSize())]
        at = next(i for i, name in enumerate(named) if "sphere" in name and "force" in name)
        found[k] = [values.get(at), values.get(at + 1)]
    return found


def moco_trajectory(file: str, states: Sequence[str], controls: Sequence[str]) -> tuple[list[str], np.ndarray]:
    """Names of the states, and time with the named states and controls in columns, as `MocoTrajectory` reads a file."""
    import opensim

    opensim.Logger.setLevelString("Off")
    read = opensim.MocoTrajectory(file)
    columns = [read.getTimeMat(), *(read.getStateMat(name) for name in states)]
    columns += [read.getControlMat(name) for name in controls]
    return list(read.getStateNames()), np.column_stack(columns)


def run_inverse_dynamics(setup: Path, out: Path) -> None:
    """OpenSim's own tool on a set-up file, from its folder; results into another."""
    from contextlib import chdir

    import opensim

    opensim.Logger.setLevelString("Off")
    with chdir(setup.parent):
        tool = opensim.InverseDynamicsTool(setup.name)
        tool.setResultsDir(str(out))
        tool.run()


def accelerations(file: Path, names: Sequence[str], q: np.ndarray, u: np.ndarray) -> np.ndarray:
    """Of the coordinates of a model that moves by its own forces, no actuator at work, (s, n)."""
    model, state = _model(file)
    found = np.zeros(q.shape)
    for k, (values, rates) in enumerate(zip(q, u, strict=True)):
        _set(model, state, names, values)
        for name, rate in zip(names, rates, strict=True):
            model.updCoordinateSet().get(name).setSpeedValue(state, float(rate))
        model.realizeAcceleration(state)
        found[k] = [model.getCoordinateSet().get(name).getAccelerationValue(state) for name in names]
    return found


def solved(model_file: Path, solution: Path) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations as a `MocoTrajectory` has them, and as its model has them by its states and controls, (s, n)."""
    import opensim

    model, state = _model(model_file)
    read = opensim.MocoTrajectory(str(solution))
    names = [name.split("/")[2] for name in read.getStateNames() if name.endswith("/value")]
    values, rates, told = (
        np.column_stack([of(f"/jointset/{name}/{name}/{kind}") for name in names])
        for kind, of in (("value", read.getStateMat), ("speed", read.getStateMat), ("accel", read.getDerivativeMat))
    )
    controls = {name.split("/")[-1]: read.getControlMat(name) for name in read.getControlNames()}
    found = np.zeros(told.shape)
    for k in range(len(found)):
        _set(model, state, names, values[k])
        for name, rate in zip(names, rates[k], strict=True):
            model.updCoordinateSet().get(name).setSpeedValue(state, float(rate))
        for name, torque in controls.items():
            actuator = opensim.CoordinateActuator.safeDownCast(model.getForceSet().get(name))
            actuator.overrideActuation(state, True)
            actuator.setOverrideActuation(state, float(torque[k]))
        model.realizeAcceleration(state)
        found[k] = [model.getCoordinateSet().get(name).getAccelerationValue(state) for name in names]
    return told, found


def run_inverse_kinematics(setup: Path) -> None:
    """OpenSim's own tool on a set-up file, from its folder, where results go too."""
    from contextlib import chdir

    import opensim

    opensim.Logger.setLevelString("Off")
    with chdir(setup.parent):
        tool = opensim.InverseKinematicsTool(setup.name)
        tool.setResultsDir(".")
        tool.run()


def run_scaling(setup: Path) -> None:
    """OpenSim's own tool from its set-up file."""
    import opensim

    opensim.Logger.setLevelString("Off")
    opensim.ScaleTool(str(setup)).run()


def static_optimisation(
    file: Path, coordinates: Path, loads: Path, span: tuple[float, float], folder: Path, free: Sequence[str]
) -> tuple[list[str], np.ndarray, list[str], np.ndarray]:
    """Activations of OpenSim's own tool, and its reaction on tibia_r across the knee in that body; names, time first.

    Reserves of 1 N m act along all coordinates, of 1000 along those of `free`, which no muscle drives.
    """
    import opensim

    model, _ = _model(file)
    for k in range(model.getMuscles().getSize()):
        muscle = opensim.Thelen2003Muscle.safeDownCast(model.updMuscles().get(k))
        muscle.setMinimumActivation(0.01)
        muscle.setMinControl(0.01)
    for k in range(model.getCoordinateSet().getSize()):
        name = model.getCoordinateSet().get(k).getName()
        reserve = opensim.CoordinateActuator(name)
        reserve.setName(f"reserve_{name}")
        reserve.setOptimalForce(1000.0 if name in free else 1.0)
        reserve.setMinControl(-1e4)
        reserve.setMaxControl(1e4)
        model.addForce(reserve)
    model.finalizeConnections()
    model.printToXML(str(folder / "reserved.osim"))
    tool = opensim.AnalyzeTool()
    tool.setName("so")
    tool.setModelFilename(str(folder / "reserved.osim"))
    tool.setCoordinatesFileName(str(coordinates))
    tool.setExternalLoadsFileName(str(loads))
    tool.setLowpassCutoffFrequency(6.0)
    tool.setInitialTime(span[0])
    tool.setFinalTime(span[1])
    tool.setResultsDir(str(folder))
    found = opensim.StaticOptimization()
    found.setUseMusclePhysiology(False)
    found.setActivationExponent(2.0)
    found.setConvergenceCriterion(1e-7)
    found.setMaxIterations(1000)
    found.setStartTime(span[0])
    found.setEndTime(span[1])
    tool.updAnalysisSet().cloneAndAppend(found)
    tool.printToXML(str(folder / "setup.xml"))
    opensim.AnalyzeTool(str(folder / "setup.xml")).run()
    activations = folder / "so_StaticOptimization_activation.sto"
    reaction = opensim.JointReaction()
    reaction.setName("JointReaction")
    for setting, name in (
        (reaction.setJointNames, "knee_r"),
        (reaction.setOnBody, "child"),
        (reaction.setInFrame, "child"),
    ):
        names = opensim.ArrayStr()
        names.append(name)
        setting(names)
    reaction.setForcesFileName(str(folder / "so_StaticOptimization_force.sto"))
    tool.updAnalysisSet().setSize(0)
    tool.updAnalysisSet().cloneAndAppend(reaction)
    tool.printToXML(str(folder / "reaction.xml"))
    opensim.AnalyzeTool(str(folder / "reaction.xml")).run()
    return *_table(activations), *_table(folder / "so_JointReaction_ReactionLoads.sto")


def _table(file: Path) -> tuple[list[str], np.ndarray]:
    """Names of its columns, time first, and all values."""
    import opensim

    table = opensim.TimeSeriesTable(str(file))
    names = list(table.getColumnLabels())
    rows = [table.getRowAtIndex(t) for t in range(table.getNumRows())]
    values = np.array([[row[k] for k in range(len(names))] for row in rows])
    return ["time", *names], np.column_stack([np.array(table.getIndependentColumn()), values])


def orientation_kinematics(
    model_file: Path, calibration: Path, recording: Path, base: str, axis: str, turn: Sequence[float], out: Path
) -> tuple[list[str], np.ndarray]:
    """Names and values [deg, m] of OpenSense: IMUPlacer on a calibration, then its kinematics of a recording."""
    import opensim

    opensim.Logger.setLevelString("Off")
    placer = opensim.IMUPlacer()
    placer.set_model_file(str(model_file))
    placer.set_orientation_file_for_calibration(str(calibration))
    placer.set_sensor_to_opensim_rotations(opensim.Vec3(*turn))
    placer.set_base_imu_label(base)
    placer.set_base_heading_axis(axis)
    placed = out / "placed.osim"
    placer.set_output_model_file(str(placed))
    placer.run(False)
    tool = opensim.IMUInverseKinematicsTool()
    tool.set_model_file(str(placed))
    tool.set_orientations_file(str(recording))
    tool.set_sensor_to_opensim_rotations(opensim.Vec3(*turn))
    tool.set_results_directory(str(out))
    tool.run(False)
    table = opensim.TimeSeriesTable(str(out / f"ik_{recording.stem}.mot"))
    names = [str(name).rpartition("/")[2] for name in table.getColumnLabels()]
    return names, table.getMatrix().to_numpy()


def meshes(file: Path) -> dict[str, tuple[str, str, list[float]]]:
    """Body, file and scale factors of each mesh of a model, by its name."""
    import opensim

    model, _ = _model(file)
    found = {}
    for component in model.getComponentsList():
        if component.getConcreteClassName() == "Mesh":
            mesh = opensim.Mesh.safeDownCast(component)
            scale = mesh.get_scale_factors()
            body = mesh.getFrame().findBaseFrame().getName()
            found[mesh.getName()] = (body, mesh.getGeometryFilename(), [scale.get(k) for k in range(3)])
    return found
