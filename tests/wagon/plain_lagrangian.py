"""Energies of half a wagon, spelt out body by body from theory sections 1 to 3, for plain numbers.

The wagon's matrices are checked against second differences of these energies. Coordinates, in the order of theory
section 2: s, car heave and pitch, heave and pitch of bogie 1 and of bogie 2, four wheel heaves, four wheel
rotations, slosh amplitudes.
"""

from dataclasses import dataclass, field

import numpy as np

G = 9.81
WHEEL_OF_BOGIE = ((0, 1), (2, 3))


@dataclass(frozen=True)
class PlainLoad:
    """Whole tank: mass, centre above the bottom, own pitch inertia, modes (omega, lambda_1, lambda_02, mu, zeta)."""

    mass: float
    centre: float
    inertia: float
    modes: tuple[tuple[float, float, float, float, float], ...] = ()


def half_full_cylinder(scenario):
    """Frozen load of a half-full horizontal cylinder in closed form: half discs, centroid 4R/(3 pi) down."""
    tank = scenario.tank
    assert tank.fill == 0.5
    R, L, rho = tank.radius, tank.length, tank.liquid.density
    mass, drop = rho * L * np.pi * R**2 / 2, 4 * R / (3 * np.pi)
    vertical = np.pi * R**4 / 8 - np.pi * R**2 / 2 * drop**2  # second moment about the centroid's level
    inertia = rho * L * vertical + mass * L**2 / 12
    modes = ()
    if tank.liquid.model == "modal":
        modes = tuple((c.frequency, c.lambda_1, c.lambda_02, c.mu, c.damping_ratio) for c in tank.coefficients)
    return PlainLoad(mass, R - drop, inertia, modes)


@dataclass(frozen=True)
class Shape:
    """Names for the entries of a coordinate (or velocity) vector."""

    vector: np.ndarray = field(repr=False)

    def __post_init__(self):
        s, w_c, theta_c, w_1, theta_1, w_2, theta_2, *rest = (float(value) for value in self.vector)
        for name, value in (("s", s), ("w_c", w_c), ("theta_c", theta_c)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "w_b", (w_1, w_2))
        object.__setattr__(self, "theta_b", (theta_1, theta_2))
        object.__setattr__(self, "w_w", rest[:4])
        object.__setattr__(self, "phi", rest[4:8])
        object.__setattr__(self, "beta", rest[8:])


def car_at(wagon, u, z):
    """Longitudinal displacement of the car at height z."""
    z_t, z_a = wagon.traction_height, wagon.wheelset.wheel_radius
    return u.s + (z_t - z_a) * (u.theta_b[0] + u.theta_b[1]) / 2 + u.theta_c * (z - z_t)


def kinetic_energy(scenario, load, velocity):
    """Joule of one rail's half at `velocity`."""
    wagon, u = scenario.wagon, Shape(velocity)
    car, bogie, wheelset = wagon.car_body, wagon.bogie, wagon.wheelset
    forward = car_at(wagon, u, car.centre_height)
    whole = 0.5 * car.mass * (forward**2 + u.w_c**2) + 0.5 * car.pitch_inertia * u.theta_c**2
    for w, theta in zip(u.w_b, u.theta_b, strict=True):
        forward = u.s + theta * (bogie.centre_height - wheelset.wheel_radius)
        whole += 0.5 * bogie.mass * (forward**2 + w**2) + 0.5 * bogie.pitch_inertia * theta**2
    for w, spin in zip(u.w_w, u.phi, strict=True):
        whole += 0.5 * wheelset.mass * (u.s**2 + w**2) + 0.5 * wheelset.spin_inertia * spin**2
    bottom = car_at(wagon, u, scenario.tank.bottom_height)
    whole += 0.5 * load.mass * ((bottom + load.centre * u.theta_c) ** 2 + u.w_c**2)
    whole += 0.5 * load.inertia * u.theta_c**2
    for (_, lambda_1, lambda_02, mu, _), rate in zip(load.modes, u.beta, strict=True):
        whole += lambda_1 * bottom * rate + lambda_02 * u.theta_c * rate + 0.5 * mu * rate**2
    return whole / 2


def elongations(scenario, displacement):
    """Pairs (suspension unit, relative vertical motion of its ends): four primary, two secondary."""
    wagon, u = scenario.wagon, Shape(displacement)
    half_pivots, half_base = wagon.pivot_spacing / 2, wagon.bogie.wheelbase / 2
    found = []
    for bogie, pivot in ((0, half_pivots), (1, -half_pivots)):
        found.append((wagon.secondary_suspension, (u.w_c - u.theta_c * pivot) - u.w_b[bogie]))
        for wheel, ahead in zip(WHEEL_OF_BOGIE[bogie], (half_base, -half_base), strict=True):
            found.append((wagon.primary_suspension, (u.w_b[bogie] - u.theta_b[bogie] * ahead) - u.w_w[wheel]))
    return found


def potential_energy(scenario, load, displacement):
    """Joule of one rail's half but for weights that do not move sideways: springs (per unit) and the load's tilt."""
    u = Shape(displacement)
    springs = sum(0.5 * unit.stiffness * length**2 for unit, length in elongations(scenario, displacement))
    whole = -0.5 * load.mass * G * load.centre * u.theta_c**2
    for (omega, lambda_1, _, mu, _), beta in zip(load.modes, u.beta, strict=True):
        whole += 0.5 * mu * omega**2 * beta**2 - G * lambda_1 * u.theta_c * beta
    return springs + whole / 2


def damping_loss(scenario, load, velocity):
    """Watt lost in one rail's half: suspension dampers (per unit) and modal damping."""
    u = Shape(velocity)
    lost = sum(unit.damping * speed**2 for unit, speed in elongations(scenario, velocity))
    for (omega, _, _, mu, zeta), rate in zip(load.modes, u.beta, strict=True):
        lost += 0.5 * 2 * zeta * omega * mu * rate**2
    return lost


def weights(scenario, load):
    """Generalised forces (N) of one rail's half of the weight."""
    wagon = scenario.wagon
    force = np.zeros(15 + len(load.modes))
    force[1] = wagon.car_body.mass + load.mass
    force[[3, 5]] = wagon.bogie.mass
    force[7:11] = wagon.wheelset.mass
    return -G * force / 2


def quadratic_form(energy, size):
    """The symmetric matrix A with energy(x) = x A x / 2, from its values alone."""
    unit = np.eye(size)
    alone = np.array([energy(row) for row in unit])
    matrix = np.array([[energy(a + b) for b in unit] for a in unit])
    return matrix - alone[:, None] - alone[None, :]


@dataclass(frozen=True)
class PlainMatrices:
    """Mass, damping, stiffness and weights of one rail's half, slosh included."""

    mass: np.ndarray
    damping: np.ndarray
    stiffness: np.ndarray
    weight: np.ndarray


def plain_matrices(scenario, load):
    size = 15 + len(load.modes)
    return PlainMatrices(
        quadratic_form(lambda v: kinetic_energy(scenario, load, v), size),
        quadratic_form(lambda v: damping_loss(scenario, load, v) / 2, size),
        quadratic_form(lambda q: potential_energy(scenario, load, q), size),
        weights(scenario, load),
    )
