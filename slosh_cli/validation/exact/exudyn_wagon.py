"""The wagon once more, built from rigid bodies, springs and joints in exudyn, a general multibody code.

J. Gerstmayr, Exudyn: a C++-based Python package for flexible multibody systems, Multibody Syst. Dyn. 60 (2024)
533-561. Nothing is linearised by hand but the longitudinal guidance of model section 2; rotations are finite. The slosh
mode is a body of mass lambda_1^2/mu that slides in the car on a spring, at the height lambda_02/lambda_1; the rest of
the liquid is part of the car. One rail, half a wagon, x forward, y up, rotations positive nose-up.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from slosh_cli.scenario import Scenario
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.tank.load import frozen_load
from slosh_cli.validation.exact.creep import Adhesion, adhesion, ellipse
from slosh_cli.validation.exact.wagon import GRAVITY

Array = NDArray[np.float64]


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


@dataclass(frozen=True)
class Bodies:
    """Half masses (kg), pitch inertia (kg m^2) and heights (m) of the car with the liquid that does not slosh, and of
    the slosh body; `slosh_height` counts from the car's centre.

    `attachment` is how far below the car's centre the secondary springs act: there the weight's overturning moment is
    the `m_l g z_c theta` of model section 3.
    """

    car: float
    car_inertia: float
    car_height: float
    slosh: float
    slosh_height: float
    attachment: float

    @staticmethod
    def of(scenario: Scenario, mode: SloshMode) -> Bodies:
        """Split the load into what slides and what does not, keeping mass, centre and pitch inertia."""
        body, load = scenario.wagon.car_body, frozen_load(scenario.tank)
        bottom = scenario.tank.bottom_height
        slosh, slosh_height = mode.slosh_mass, bottom + mode.height
        rest = load.mass - slosh
        rest_height = (load.mass * (bottom + load.centre_height) - slosh * slosh_height) / rest
        rest_inertia = load.pitch_inertia + load.mass * (bottom + load.centre_height - slosh_height) ** 2
        rest_inertia -= rest * (rest_height - slosh_height) ** 2
        mass = body.mass + rest
        height = (body.mass * body.centre_height + rest * rest_height) / mass
        inertia = body.pitch_inertia + body.mass * (body.centre_height - height) ** 2
        inertia += rest_inertia + rest * (rest_height - height) ** 2
        overturning = load.mass * load.centre_height - slosh * (slosh_height - height)
        attachment = overturning / (mass + slosh)
        return Bodies(mass / 2, inertia / 2, height, slosh / 2, slosh_height - height, attachment)


class _Contact:
    """Hertz and Polach on a rigid rail, resistance and brake, as generalised forces on one wheel (x, y, rotation)."""

    def __init__(self, scenario: Scenario) -> None:
        steel, p = scenario.contact, scenario.contact.adhesion
        self.radius = scenario.wagon.wheelset.wheel_radius
        a, b, approach = ellipse(self.radius, steel.rail_crown_radius, steel.youngs_modulus, steel.poisson_ratio, 1.0)
        self.stiffness = approach**-1.5
        shear = steel.youngs_modulus / (2 * (1 + steel.poisson_ratio))
        self.gradient = shear * np.pi * a * b * steel.kalker_c11 / 4  # times N^(-1/3)
        self.adhesion = Adhesion(p.kA, p.kS, p.mu0, p.A, p.B)
        self.resistance = scenario.wagon.running_resistance
        self.torque, self.onset = scenario.braking.torque, scenario.braking.onset

    def braking(self, time: float) -> float:
        """Torque on the wheel, N m; the stop is over before a wheel locks."""
        return self.torque if time > self.onset + 1e-9 else 0.0

    def forces(self, _: Any, time: float, __: int, q: Array, rate: Array) -> Array:
        """Forward and upward force (N) and moment (N m, nose-up) on a wheel that moves as `q`, `rate` say."""
        normal = self.stiffness * max(-q[1], 0.0) ** 1.5
        creep = 0.0
        if normal > 0.0:
            slip = rate[0] + self.radius * rate[2]  # the wheel turns clockwise: rotation is negative
            nu = abs(slip) / max(abs(rate[0]), 0.05)
            share = adhesion(self.adhesion, self.gradient * normal ** (-1 / 3), nu, abs(slip) / nu) if nu > 0 else 0.0
            creep = np.sign(slip) * share * normal
        terms = self.resistance
        rolling = (terms.constant + terms.linear * rate[0] + terms.quadratic * rate[0] ** 2) / 8
        return np.array([-creep - rolling, normal, self.braking(time) - creep * self.radius])


class _Builder:
    """Adds bodies and connectors to an exudyn system. Bodies start at the origin: coordinates are displacements."""

    def __init__(self, system: Any, scenario: Scenario) -> None:
        self.system: Any = system
        self.items: Any = import_module("exudyn.itemInterface")
        self.speed = scenario.braking.initial_speed

    def body(self, mass: float, inertia: float, y: float, spin: float = 0.0) -> tuple[int, int]:
        """Node and object of a rigid body that has settled by `y` (m) and moves at the initial speed."""
        node = self.system.AddNode(
            self.items.NodeRigidBody2D(initialCoordinates=[0, y, 0], initialVelocities=[self.speed, 0, spin])
        )
        return node, self.system.AddObject(
            self.items.ObjectRigidBody2D(physicsMass=mass, physicsInertia=inertia, nodeNumber=node)
        )

    def weigh(self, body: int) -> None:
        """Gravity at a body's centre."""
        marker = self.system.AddMarker(self.items.MarkerBodyMass(bodyNumber=body))
        self.system.AddLoad(self.items.LoadMassProportional(markerNumber=marker, loadVector=[0, -GRAVITY, 0]))

    def point(self, body: int, x: float, y: float) -> int:
        """Marker at a point of a body."""
        return int(self.system.AddMarker(self.items.MarkerBodyRigid(bodyNumber=body, localPosition=[x, y, 0])))

    def coordinates(self, body: int) -> int:
        """Marker of all coordinates of a body."""
        return int(self.system.AddMarker(self.items.MarkerObjectODE2Coordinates(objectNumber=body)))

    def spring(self, markers: list[int], stiffness: float, damping: float, offset: float = 0.0) -> None:
        """A vertical spring and damper; the second marker stands `offset` (m) above the first when it is slack."""
        self.system.AddObject(
            self.items.ObjectConnectorCartesianSpringDamper(
                markerNumbers=markers, stiffness=[0, stiffness, 0], damping=[0, damping, 0], offset=[0, offset, 0]
            )
        )

    def tie(self, one: int, its: list[float], other: int, others: list[float]) -> None:
        """`its . coordinates of one = others . coordinates of other`, at all times."""
        self.system.AddObject(
            self.items.ObjectConnectorCoordinateVector(
                markerNumbers=[one, other],
                scalingMarker0=np.array([its]),
                scalingMarker1=np.array([others]),
                offset=[0.0],
            )
        )

    def watch(self, node: int, velocity: bool = False) -> int:
        """Sensor of a node's coordinates or their rates."""
        exu = import_module("exudyn")
        kind = exu.OutputVariableType.Coordinates_t if velocity else exu.OutputVariableType.Coordinates
        return int(
            self.system.AddSensor(
                self.items.SensorNode(nodeNumber=node, storeInternal=True, writeToFile=False, outputVariableType=kind)
            )
        )


def _settled(scenario: Scenario, bodies: Bodies, contact: _Contact) -> tuple[float, float, float]:
    """Heave (m) of car, bogies and wheels under the weight, from the unloaded geometry."""
    wagon = scenario.wagon
    on_secondary = GRAVITY * (bodies.car + bodies.slosh) / 2
    on_primary = (on_secondary + GRAVITY * wagon.bogie.mass / 2) / 2
    load = on_primary + GRAVITY * wagon.wheelset.mass / 2
    wheel = -((load / contact.stiffness) ** (2 / 3))
    bogie = wheel - on_primary / wagon.primary_suspension.stiffness
    return bogie - on_secondary / wagon.secondary_suspension.stiffness, bogie, wheel


def _build(system: Any, scenario: Scenario, mode: SloshMode) -> dict[str, Any]:
    build, contact = _Builder(system, scenario), _Contact(scenario)
    wagon, bodies = scenario.wagon, Bodies.of(scenario, mode)
    axle, pivot = wagon.wheelset.wheel_radius, wagon.traction_height
    sunk_car, sunk_bogie, sunk_wheel = _settled(scenario, bodies, contact)
    car_node, car = build.body(bodies.car, bodies.car_inertia, sunk_car)
    build.weigh(car)
    yoke = _yoke(build)
    # at the pivots' height the car goes with the mean of both bogies (model section 2)
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
        build.spring(
            [build.point(bogie, 0, 0), build.point(car, place, -bodies.attachment)],
            unit.stiffness,
            unit.damping,
            -bodies.attachment,
        )
        for arm in (0.5 * wagon.bogie.wheelbase, -0.5 * wagon.bogie.wheelbase):
            wheel_nodes.append(_wheel(build, scenario, contact, bogie, arm, sunk_wheel, (its, low)))
    build.tie(axle_lines[0][0], axle_lines[0][1], axle_lines[1][0], axle_lines[1][1])
    slosh_node = _slosh(build, bodies, car, mode, sunk_car)
    return {
        "car": build.watch(car_node),
        "slosh": build.watch(slosh_node),
        "wheels": [build.watch(node) for node in wheel_nodes],
        "speed": build.watch(wheel_nodes[0], velocity=True),
        "slosh_height": bodies.slosh_height,
    }


def _yoke(build: _Builder) -> int:
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
    build: _Builder,
    scenario: Scenario,
    contact: _Contact,
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
            forceUserFunction=lambda *state: contact.forces(*state) - [0, GRAVITY * wheelset.mass / 2, 0],
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


def _slosh(build: _Builder, bodies: Bodies, car: int, mode: SloshMode, sunk: float) -> int:
    """The slosh body on its spring along the car's axis; returns its node."""
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


def exudyn_stop(scenario: Scenario, mode: SloshMode, duration: float, step: float) -> Histories:
    """The first `duration` s of the scenario's stop on a rigid rail, by the trapezoidal rule in steps of `step` s."""
    exu = import_module("exudyn")
    exu.config.printToConsole = False  # stdout belongs to the answer
    system = exu.SystemContainer().AddSystem()
    sensors = _build(system, scenario, mode)
    system.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(duration / step)
    settings.timeIntegration.endTime = duration
    settings.timeIntegration.newton.relativeTolerance = 1e-9
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = step
    settings.timeIntegration.verboseMode = 0
    system.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)
    return _read(system, sensors, _Contact(scenario), mode)


def _read(system: Any, sensors: dict[str, Any], contact: _Contact, mode: SloshMode) -> Histories:
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
