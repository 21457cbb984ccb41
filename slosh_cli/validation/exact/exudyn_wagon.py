"""The wagon once more, built from rigid bodies, springs and joints in exudyn, a general multibody code.

J. Gerstmayr, Exudyn: a C++-based Python package for flexible multibody systems, Multibody Syst. Dyn. 60 (2024)
533-561. Nothing is linearised by hand but the longitudinal guidance of theory section 2; rotations are finite. A slosh
mode is a body of mass lambda_1^2/mu that slides in the car on a spring, at the height lambda_02/lambda_1; the rest of
the liquid is part of the car. One rail, half a wagon, x forward, y up, rotations positive nose-up.

The sliding body may be held to what linear slosh theory lets it do: then it heaves with the car whatever the pitch.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from slosh_cli.arrays import Array
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.validation.exact.exudyn_bodies import Bodies, WheelContact, settled
from slosh_cli.validation.exact.exudyn_builder import Builder


@dataclass(frozen=True, eq=False)
class Histories:
    """What exudyn found at each `time` (n,) s: speed (m/s), wheel loads (n, 4) N, heave (m) and pitch (rad, nose-down)
    of the car, amplitude of the slosh mode (m)."""

    time: Array
    speed: Array
    loads: Array
    heave: Array
    pitch: Array
    amplitude: Array


def _build(system: Any, scenario: Scenario, mode: SloshMode, linear: bool) -> dict[str, Any]:
    build, contact = Builder(system, scenario), WheelContact(scenario)
    wagon, bodies = scenario.wagon, Bodies.of(scenario, mode)
    axle, pivot = wagon.wheelset.wheel_radius, wagon.traction_height
    sunk_car, sunk_bogie, sunk_wheel = settled(scenario, bodies, contact)
    car_node, car = build.body(bodies.car, bodies.car_inertia, sunk_car)
    build.weigh(car)
    yoke = _yoke(build)
    # at the pivots' height the car goes with the mean of both bogies (theory section 2)
    build.tie(build.coordinates(car), [1, 0, bodies.car_height - pivot], yoke, [0.5, 0.5])
    axle_lines, wheel_nodes = [], []
    for k, place in enumerate((0.5 * wagon.pivot_spacing, -0.5 * wagon.pivot_spacing)):
        _, bogie = build.body(wagon.bogie.mass / 2, wagon.bogie.pitch_inertia / 2, sunk_bogie)
        build.weigh(bogie)
        its = build.coordinates(bogie)
        low = [1.0, 0.0, wagon.bogie.centre_height - axle]  # a point below the centre moves forward as the nose rises
        build.tie(its, [1, 0, wagon.bogie.centre_height - pivot], yoke, [1.0 - k, float(k)])
        axle_lines.append((its, low))
        unit = wagon.secondary_suspension
        assert unit != "none"  # refused before
        build.spring(
            [build.point(bogie, 0, 0), build.point(car, place, -bodies.attachment)],
            unit.stiffness,
            unit.damping,
            -bodies.attachment,
        )
        for arm in (0.5 * wagon.bogie.wheelbase, -0.5 * wagon.bogie.wheelbase):
            wheel_nodes.append(_wheel(build, scenario, contact, bogie, arm, sunk_wheel, (its, low)))
    build.tie(axle_lines[0][0], axle_lines[0][1], axle_lines[1][0], axle_lines[1][1])
    slosh_node = (_linear_slosh if linear else _slosh)(build, bodies, (car_node, car), mode, sunk_car)
    return {
        "car": build.watch(car_node),
        "slosh": build.watch(slosh_node),
        "wheels": [build.watch(node) for node in wheel_nodes],
        "speed": build.watch(wheel_nodes[0], velocity=True),
        "slosh_height": bodies.slosh_height,
    }


def _yoke(build: Builder) -> int:
    """Marker of two coordinates without mass to speak of: the places of the two pivots along the track."""
    nodes = [
        build.system.AddNode(
            build.items.NodeGenericODE2(
                numberOfODE2Coordinates=1,
                referenceCoordinates=[0],
                initialCoordinates=[0],
                initialCoordinates_t=[build.speed],
            )
        )
        for _ in range(2)
    ]
    return build.coordinates(
        build.system.AddObject(build.items.ObjectGenericODE2(nodeNumbers=nodes, massMatrix=1e-6 * np.eye(2)))
    )


def _wheel(
    build: Builder,
    scenario: Scenario,
    contact: WheelContact,
    bogie: int,
    arm: float,
    sunk: float,
    axle_line: tuple[int, list[float]],
) -> int:
    """A wheel under its bogie, `arm` (m) ahead of the pivot; returns its node."""
    wheelset, unit = scenario.wagon.wheelset, scenario.wagon.primary_suspension
    node = build.system.AddNode(
        build.items.NodeRigidBody2D(
            initialCoordinates=[0, sunk, 0], initialVelocities=[build.speed, 0, -build.speed / contact.radius]
        )
    )
    wheel = build.system.AddObject(
        build.items.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=np.diag([wheelset.mass, wheelset.mass, wheelset.spin_inertia]) / 2,
            forceUserFunction=lambda *state: contact.forces(*state) - [0, STANDARD_GRAVITY * wheelset.mass / 2, 0],
        )
    )
    build.tie(build.coordinates(wheel), [1, 0, 0], *axle_line)
    below = build.system.AddMarker(build.items.MarkerNodePosition(nodeNumber=node))
    build.spring([below, build.point(bogie, arm, 0)], unit.stiffness, unit.damping)
    turning = build.system.AddMarker(build.items.MarkerBodyRigid(bodyNumber=bogie, localPosition=[0, 0, 0]))
    build.system.AddLoad(
        build.items.LoadTorqueVector(
            markerNumber=turning,
            loadVectorUserFunction=lambda _, time, __: [0, 0, -contact.braking(time)],
        )
    )
    return int(node)


def _slosh(build: Builder, bodies: Bodies, its_car: tuple[int, int], mode: SloshMode, sunk: float) -> int:
    """The slosh body on its spring along the car's axis; returns its node. `its_car`: node and object of the car."""
    _, car = its_car
    node, body = build.body(bodies.slosh, 1e-3, sunk + bodies.slosh_height)
    build.weigh(body)
    rail, rider = build.point(car, 0, bodies.slosh_height), build.point(body, 0, 0)
    build.system.AddObject(
        build.items.ObjectJointPrismatic2D(
            markerNumbers=[rider, rail], axisMarker0=[1, 0, 0], normalMarker1=[0, 1, 0], constrainRotation=True
        )
    )
    stiffness = bodies.slosh * mode.frequency**2
    build.system.AddObject(
        build.items.ObjectConnectorCartesianSpringDamper(markerNumbers=[rail, rider], stiffness=[stiffness, 0, 0])
    )
    return node


def _linear_slosh(build: Builder, bodies: Bodies, its_car: tuple[int, int], mode: SloshMode, sunk: float) -> int:
    """The slosh body with the quadratic energies of theory section 3 and no others; returns its node.

    With its shift `xi = x - x_car + h rotation` along the car the spring and gravity store
    `1/2 k xi^2 + m g (xi rotation - 1/2 h rotation^2)`; it heaves with the car, `xi rotation` left out.
    """
    car_node, car = its_car
    node, body = build.body(bodies.slosh, 1e-3, sunk + bodies.slosh_height)
    build.weigh(body)
    its = build.coordinates(body)
    build.system.AddObject(
        build.items.ObjectConnectorCoordinateVector(
            markerNumbers=[its, build.coordinates(car)],
            scalingMarker0=np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
            scalingMarker1=np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]),
            offset=[bodies.slosh_height, 0.0],
        )
    )
    shift, turn = np.zeros(6), np.zeros(6)  # of x, y, rotation of the car and of the body
    shift[[0, 2, 3]] = -1.0, bodies.slosh_height, 1.0
    turn[2] = 1.0
    weight = STANDARD_GRAVITY * bodies.slosh
    stiffness = bodies.slosh * mode.frequency**2 * np.outer(shift, shift)
    stiffness += weight * (np.outer(shift, turn) + np.outer(turn, shift) - bodies.slosh_height * np.outer(turn, turn))
    build.system.AddObject(
        build.items.ObjectGenericODE2(
            nodeNumbers=[car_node, node], massMatrix=np.zeros((6, 6)), stiffnessMatrix=stiffness
        )
    )
    return node


def exudyn_stop(
    scenario: Scenario, mode: SloshMode, duration: float, step: float, *, linear: bool = False
) -> Histories:
    """The first `duration` s of the scenario's stop on a rigid rail, by the trapezoidal rule in steps of `step` s.

    `linear` holds the slosh body to linear theory; without it the body rises and sinks with the car's pitch.
    """
    exu = import_module("exudyn")
    exu.config.printToConsole = False  # stdout belongs to the answer
    system = exu.SystemContainer().AddSystem()
    sensors = _build(system, scenario, mode, linear)
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(duration / step)
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.newton.relativeTolerance = 1e-9
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    settings.timeIntegration.verboseMode = 0
    system.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    return _read(system, sensors, WheelContact(scenario), mode)


def _read(system: Any, sensors: dict[str, Any], contact: WheelContact, mode: SloshMode) -> Histories:
    """Sensors to histories; a sensor's first column is the time."""

    def stored(sensor: int) -> Array:
        return np.asarray(system.GetSensorStoredData(sensor))

    car, slosh = stored(sensors["car"]), stored(sensors["slosh"])
    heights = np.column_stack([stored(sensor)[:, 2] for sensor in sensors["wheels"]])
    return Histories(
        time=car[:, 0],
        speed=stored(sensors["speed"])[:, 1],
        loads=contact.stiffness * np.maximum(-heights, 0.0) ** 1.5,
        heave=car[:, 2],
        pitch=-car[:, 3],
        amplitude=(slosh[:, 1] - car[:, 1] + car[:, 3] * sensors["slosh_height"]) * mode.lambda_1 / mode.mu,
    )
