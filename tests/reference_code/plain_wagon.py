"""Half of the wagon as a linear mechanical system, built from the kinematics of each body.

Nothing is expanded by hand: every body contributes ``J^T diag(m, m, I) J`` with its own velocity rows, every
suspension unit ``k d d^T`` with the row ``d`` of its elongation, so the matrices follow from one Lagrangian.
"""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import quad

GRAVITY = 9.81

# Degrees of freedom: s; car, front and rear bogie (w, theta each); the wheels' w, then their phi; beta.
S, W_CAR, THETA_CAR = 0, 1, 2
W_BOGIE, THETA_BOGIE = (3, 5), (4, 6)
W_WHEEL, PHI = (7, 8, 9, 10), (11, 12, 13, 14)
FIRST_MODE = 15
BOGIE_OF_WHEEL = (0, 0, 1, 1)


@dataclass(frozen=True)
class FrozenLoad:
    """Still liquid, whole tank: mass (kg), centroid above bottom (m), pitch inertia about it (kg m^2)."""

    mass: float
    centroid: float
    pitch_inertia: float


@dataclass(frozen=True)
class Wagon:
    """Matrices of the half wagon, ``mass u' + damping u + stiffness q = forces``; SI units."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    weight: np.ndarray  # generalised gravity force, (n,)
    wheel_radius: float
    axle_positions: np.ndarray  # ahead of the wagon's centre, wheel 1 first, (4,)

    @property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return len(self.weight)


def frozen_load(tank) -> FrozenLoad:
    """Mass properties of the still liquid in a horizontal circular cylinder, by quadrature over its depth."""
    if tank.shape != "horizontal-cylinder":
        raise ValueError(f"tank shape must be horizontal-cylinder, but is {tank.shape!r}")
    radius, depth = tank.radius, tank.fill * 2.0 * tank.radius

    def moment(power):
        def strip(z):
            return 2.0 * np.sqrt(max(z * (2.0 * radius - z), 0.0)) * z**power

        return quad(strip, 0.0, depth, epsabs=1e-13)[0]

    area = moment(0)
    centroid = moment(1) / area
    mass = tank.liquid.density * area * tank.length
    pitch_inertia = mass * (tank.length**2 / 12.0 + moment(2) / area - centroid**2)
    return FrozenLoad(mass, centroid, pitch_inertia)


def _unit(size: int, index: int) -> np.ndarray:
    row = np.zeros(size)
    row[index] = 1.0
    return row


def _bogie_row(scenario, size: int, bogie: int, height: float) -> np.ndarray:
    """Longitudinal velocity of a bogie's point at ``height``: s' + theta_b' (z - z_a)."""
    axle = scenario.wagon.wheelset.wheel_radius
    return _unit(size, S) + (height - axle) * _unit(size, THETA_BOGIE[bogie])


def _car_row(scenario, size: int, height: float) -> np.ndarray:
    """Longitudinal velocity of a car's point: the mean of the two pivots, plus theta_c' (z - z_t)."""
    pivot = scenario.wagon.traction_height
    pivots = [_bogie_row(scenario, size, bogie, pivot) for bogie in (0, 1)]
    return 0.5 * (pivots[0] + pivots[1]) + (height - pivot) * _unit(size, THETA_CAR)


def _rigid_body(mass: float, inertia: float, along, up, turn) -> np.ndarray:
    """Mass matrix of one body from its longitudinal, vertical and angular velocity rows."""
    jacobian = np.vstack([along, up, turn])
    return jacobian.T @ np.diag([mass, mass, inertia]) @ jacobian


def _bodies(scenario, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Mass matrix and weight of car body, bogies, wheelsets and the frozen load: half of the wagon."""
    wagon, load = scenario.wagon, frozen_load(scenario.tank)
    mass, weight = np.zeros((size, size)), np.zeros(size)

    def add(whole_mass, whole_inertia, along, vertical, angle):
        nonlocal mass
        mass = mass + _rigid_body(whole_mass / 2, whole_inertia / 2, along, _unit(size, vertical), _unit(size, angle))
        weight[vertical] -= whole_mass / 2 * GRAVITY

    body = wagon.car_body
    add(body.mass, body.pitch_inertia, _car_row(scenario, size, body.centre_height), W_CAR, THETA_CAR)
    load_row = _car_row(scenario, size, scenario.tank.bottom_height + load.centroid)
    add(load.mass, load.pitch_inertia, load_row, W_CAR, THETA_CAR)
    frame = wagon.bogie
    for bogie in (0, 1):
        along = _bogie_row(scenario, size, bogie, frame.centre_height)
        add(frame.mass, frame.pitch_inertia, along, W_BOGIE[bogie], THETA_BOGIE[bogie])
    for wheel in range(4):
        along = _unit(size, S)
        add(wagon.wheelset.mass, wagon.wheelset.spin_inertia, along, W_WHEEL[wheel], PHI[wheel])
    return mass, weight


def _suspensions(scenario, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness and damping of two secondary and four primary units; each acts on a vertical elongation."""
    wagon = scenario.wagon
    stiffness, damping = np.zeros((size, size)), np.zeros((size, size))

    def add(unit, elongation):
        stiffness[...] += unit.stiffness * np.outer(elongation, elongation)
        damping[...] += unit.damping * np.outer(elongation, elongation)

    for bogie, ahead in enumerate((0.5 * wagon.pivot_spacing, -0.5 * wagon.pivot_spacing)):
        on_car = _unit(size, W_CAR) - ahead * _unit(size, THETA_CAR)
        add(wagon.secondary_suspension, on_car - _unit(size, W_BOGIE[bogie]))
    for wheel, bogie in enumerate(BOGIE_OF_WHEEL):
        ahead = (0.5 if wheel in (0, 2) else -0.5) * wagon.bogie.wheelbase
        on_bogie = _unit(size, W_BOGIE[bogie]) - ahead * _unit(size, THETA_BOGIE[bogie])
        add(wagon.primary_suspension, on_bogie - _unit(size, W_WHEEL[wheel]))
    return stiffness, damping


def _slosh(scenario, size: int, modes) -> tuple[np.ndarray, np.ndarray]:
    """Mass and stiffness added by the slosh modes of half the tank (undamped)."""
    mass, stiffness = np.zeros((size, size)), np.zeros((size, size))
    along_bottom = _car_row(scenario, size, scenario.tank.bottom_height)
    pitch = _unit(size, THETA_CAR)
    for number, mode in enumerate(modes):
        beta = _unit(size, FIRST_MODE + number)
        coupling = np.outer(0.5 * mode.lambda_1 * along_bottom + 0.5 * mode.lambda_02 * pitch, beta)
        mass += coupling + coupling.T + 0.5 * mode.mu * np.outer(beta, beta)
        tilt = -GRAVITY * 0.5 * mode.lambda_1 * np.outer(pitch, beta)
        stiffness += tilt + tilt.T + 0.5 * mode.mu * mode.frequency**2 * np.outer(beta, beta)
    return mass, stiffness


def half_wagon(scenario) -> Wagon:
    """Assemble the half wagon; liquid model ``rigid`` or ``modal``.

    Raises ValueError for another liquid model, another tank or damped modes, and LinAlgError when the mass matrix
    is not positive definite.
    """
    tank = scenario.tank
    if tank.liquid.model not in ("rigid", "modal"):
        raise ValueError(f"liquid model must be rigid or modal, but is {tank.liquid.model!r}")
    modes = tank.coefficients if tank.liquid.model == "modal" else ()
    damping_ratios = [tank.liquid.damping_ratio, *(mode.damping_ratio for mode in modes)]
    if modes and any(damping_ratios):
        raise ValueError(f"slosh modes must be undamped, but their damping ratios are {damping_ratios}")
    size = FIRST_MODE + len(modes)
    mass, weight = _bodies(scenario, size)
    stiffness, damping = _suspensions(scenario, size)
    slosh_mass, slosh_stiffness = _slosh(scenario, size, modes)
    load = frozen_load(tank)
    stiffness[THETA_CAR, THETA_CAR] -= 0.5 * load.mass * GRAVITY * load.centroid
    np.linalg.cholesky(mass + slosh_mass)
    pivot, axle = 0.5 * scenario.wagon.pivot_spacing, 0.5 * scenario.wagon.bogie.wheelbase
    return Wagon(
        mass + slosh_mass,
        damping,
        stiffness + slosh_stiffness,
        weight,
        scenario.wagon.wheelset.wheel_radius,
        np.array([pivot + axle, pivot - axle, axle - pivot, -axle - pivot]),
    )
