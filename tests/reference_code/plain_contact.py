"""Wheel on rail: Hertz normal force and Polach creep force, for arrays of wheels."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

SPEED_FLOOR = 0.05  # m/s, below it the creepage is referred to this speed


@dataclass(frozen=True)
class Contact:
    """Constants of one contact; ``N = hertz delta^1.5``, ``a b = ellipse N^(2/3)``."""

    hertz: float
    ellipse: float
    axis_ratio: float  # b / a
    creep_stiffness: float  # G pi c11 / 4
    mu0: float
    A: float
    B: float
    k_adhesion: float
    k_slip: float


def hertz_constants(curvature_1: float, curvature_2: float, modulus: float) -> tuple[float, float, float]:
    """Return ``C_H`` (N/m^1.5), ``a b / N^(2/3)`` and ``b / a``, for two principal relative curvatures (1/m).

    Johnson, Contact Mechanics, section 4.2: with p0 = 3 N / (2 pi a b) and e^2 = 1 - (b/a)^2 the gap's two
    quadratic coefficients are ``p0 b / (E* e^2 a^2) (K - E)`` and ``p0 b / (E* e^2 a^2) (E a^2/b^2 - K)``,
    the approach is ``p0 b K / E*``. ``modulus`` is E*, ``1/E* = 2 (1 - nu^2) / E`` for equal materials.
    """
    small, large = sorted((0.5 * curvature_1, 0.5 * curvature_2))

    def integrals(ratio):
        parameter = 1.0 - ratio**2  # scipy's m = e^2
        return parameter, ellipk(parameter), ellipe(parameter)

    def mismatch(ratio):
        _, K, E = integrals(ratio)
        return small * (E / ratio**2 - K) - large * (K - E)

    ratio = brentq(mismatch, 1e-3, 1.0 - 1e-6, xtol=1e-15, rtol=1e-14)
    parameter, K, E = integrals(ratio)
    # N = 1: small = 3 / (2 pi E*) (K - E) / (e^2 a^3); delta = 3 K / (2 pi E* a)
    a = (1.5 / np.pi / modulus * (K - E) / (parameter * small)) ** (1.0 / 3.0)
    approach = 1.5 * K / (np.pi * modulus * a)
    return approach**-1.5, ratio * a**2, ratio


def contact_of(scenario) -> Contact:
    """Contact constants of a scenario (wheel tread straight across the rail, rail straight along it)."""
    contact, adhesion = scenario.contact, scenario.contact.adhesion
    E, nu = contact.youngs_modulus, contact.poisson_ratio
    wheel, crown = 1.0 / scenario.wagon.wheelset.wheel_radius, 1.0 / contact.rail_crown_radius
    hertz, ellipse, ratio = hertz_constants(wheel, crown, E / (2.0 * (1.0 - nu**2)))
    hertz = contact.stiffness or hertz
    stiffness = E / (2.0 * (1.0 + nu)) * np.pi * contact.kalker_c11 / 4.0
    return Contact(hertz, ellipse, ratio, stiffness, adhesion.mu0, adhesion.A, adhesion.B, adhesion.kA, adhesion.kS)


def normal_force(contact: Contact, penetration: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Normal force and its derivative; nothing where the surfaces are apart."""
    closed = np.maximum(penetration, 0.0)
    root = np.sqrt(closed)
    return contact.hertz * closed * root, 1.5 * contact.hertz * root


def creep_force(contact: Contact, N, slip, speed):
    """Rearward force on the wagon, Polach (Wear 258, 2005); elementwise in N (N), slip and speed (m/s)."""
    load = np.maximum(N, 1e-6)  # newtons; keeps the ratio finite where the wheel is off the rail
    creepage = np.abs(slip) / np.maximum(np.abs(speed), SPEED_FLOOR)
    mu = contact.mu0 * ((1.0 - contact.A) * np.exp(-contact.B * np.abs(slip)) + contact.A)
    eps = contact.creep_stiffness * contact.ellipse * np.cbrt(load) ** 2 * creepage / (mu * load)
    adhesion = contact.k_adhesion * eps
    saturation = adhesion / (1.0 + adhesion**2) + np.arctan(contact.k_slip * eps)
    return np.sign(slip) * 2.0 / np.pi * mu * np.maximum(N, 0.0) * saturation


def creep_force_and_slopes(contact: Contact, N, slip, speed):
    """Creep force (4,) and its slopes in N, slip and speed, by differences (for Newton's method only)."""
    reference = max(abs(speed), SPEED_FLOOR)
    step_N, step_slip, step_speed = 1e-3, 1e-8 * reference, 1e-6 * reference
    loads = np.array([N, N + step_N, N, N])
    slips = np.array([slip, slip, slip + step_slip, slip])
    speeds = np.array([[speed], [speed], [speed], [speed + step_speed]])
    force = creep_force(contact, loads, slips, speeds)
    by_N, by_slip, by_speed = (force[1:] - force[0]) / np.array([[step_N], [step_slip], [step_speed]])
    return force[0], by_N, by_slip, by_speed
