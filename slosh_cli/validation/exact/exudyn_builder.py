"""Bodies, springs, ties and sensors of an exudyn system in the few forms that the wagon needs."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from slosh_cli.scenario import Scenario
from slosh_cli.scenario.units import STANDARD_GRAVITY


class Builder:
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
        return node, self.system.AddObject(self.items.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node))

    def weigh(self, body: int) -> None:
        """Gravity at a body's centre."""
        marker = self.system.AddMarker(self.items.MarkerBodyMass(bodyNumber=body))
        self.system.AddLoad(self.items.LoadMassProportional(markerNumber=marker, loadVector=[0, -STANDARD_GRAVITY, 0]))

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
