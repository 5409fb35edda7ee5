"""Forward dynamics of an OpenSim arm: a drive's torque in, the elbow's angle out.

inputs: torque [N m], outputs: angle [rad] from hanging down, at rest before. Numbers: mass m [kg] at length [m],
stiffness k [N m/rad] and damping b [N m s/rad] of the joint.
"""

import numpy as np
import opensim

import geocontact as gc

opensim.Logger.setLevelString("Off")


def arm(numbers, time, torque):
    """The model with its drive; the functions that it owns live as long as it does."""
    model = opensim.Model()
    model.setGravity(opensim.Vec3(0.0, -9.81, 0.0))
    place, inertia = opensim.Vec3(0.0, -numbers["length"], 0.0), opensim.Inertia(1e-6, 1e-6, 1e-6)
    forearm = opensim.Body("forearm", numbers["m"], place, inertia)
    elbow = opensim.PinJoint("elbow", model.getGround(), forearm)
    elbow.updCoordinate().setName("angle")
    model.addBody(forearm)
    model.addJoint(elbow)
    spring = opensim.SpringGeneralizedForce("angle")
    spring.setStiffness(numbers["k"])
    spring.setViscosity(numbers["b"])
    spring.setRestLength(0.0)
    model.addForce(spring)
    drive = opensim.CoordinateActuator("angle")
    drive.setName("drive")
    drive.setOptimalForce(1.0)
    model.addForce(drive)
    course = opensim.PiecewiseLinearFunction()
    for moment, value in zip(time, torque, strict=True):
        course.addPoint(float(moment), float(value))
    controller = opensim.PrescribedController()
    controller.addActuator(drive)
    controller.prescribeControlForActuator("drive", course)
    model.addController(controller)
    model.finalizeConnections()
    return model


def run(time, inputs, numbers):
    """Angle at each time."""
    model = arm(numbers, time, inputs[0])
    state = model.initSystem()
    state.setTime(float(time[0]))
    manager = opensim.Manager(model)
    manager.setIntegratorAccuracy(1e-7)
    manager.initialize(state)
    coordinate = model.getCoordinateSet().get("angle")
    angle = np.empty(len(time))
    angle[0] = coordinate.getValue(state)
    for i in range(1, len(time)):
        angle[i] = coordinate.getValue(manager.integrate(float(time[i])))
    return angle


PARAMETERS = (
    gc.Parameter("m", "kg", 1.5, 0.5, 4.0),
    gc.Parameter("k", "N m/rad", 2.0, 0.0, 20.0),
    gc.Parameter("b", "N m s/rad", 0.3, 0.01, 3.0),
    gc.Parameter("length", "m", 0.3, fixed=True),
)
ELBOW = gc.simulator_base("opensim_elbow", {"torque": "N m"}, {"angle": "rad"}, run, dynamic=True)
