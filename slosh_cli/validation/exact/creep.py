"""Polach's creep force and the Hertz ellipse, written once more and plainly.

O. Polach, Wear 258 (2005) 992-1000; the ellipse by elliptic integrals evaluated by quadrature (Johnson, Contact
Mechanics, 1985, section 4.2).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import atan, cos, exp, pi, sin, sqrt


@dataclass(frozen=True)
class PolachParameters:
    """Polach's parameters as his Table prints them; B in s/m."""

    kA: float  # noqa: N815 - the symbols of the law
    kS: float  # noqa: N815
    mu0: float
    A: float
    B: float


def friction(p: PolachParameters, slip: float) -> float:
    """Falling friction at a slip velocity in m/s."""
    return p.mu0 * ((1 - p.A) * exp(-p.B * abs(slip)) + p.A)


def adhesion(p: PolachParameters, gradient: float, creepage: float, speed: float) -> float:
    """Tangential over normal force; `eps = gradient creepage / mu`, slip = creepage speed."""
    mu = friction(p, creepage * speed)
    eps = gradient * creepage / mu
    return 2 * mu / pi * (p.kA * eps / (1 + (p.kA * eps) ** 2) + atan(p.kS * eps))


def ellipse(
    wheel_radius: float, crown_radius: float, youngs: float, poisson: float, force: float
) -> tuple[float, float, float]:
    """Semi-axes a >= b and approach, m, under `force` (N), for crossed cylinders of one material."""
    from scipy.integrate import quad
    from scipy.optimize import brentq

    small, large = sorted((0.5 / wheel_radius, 0.5 / crown_radius))

    def integrals(ratio: float) -> tuple[float, float]:
        m = 1 - 1 / ratio**2
        first = quad(lambda t: 1 / sqrt(1 - m * sin(t) ** 2), 0, pi / 2, epsrel=1e-13)[0]
        second = quad(lambda t: sqrt(cos(t) ** 2 + (1 - m) * sin(t) ** 2), 0, pi / 2, epsrel=1e-13)[0]
        return float(first), float(second)

    def surplus(ratio: float) -> float:
        first, second = integrals(ratio)
        return (ratio**2 * second - first) / (first - second) - large / small

    ratio = float(brentq(surplus, 1 + 1e-5, 1e3, xtol=1e-14)) if large > small * (1 + 1e-6) else 1.0
    first, second = integrals(ratio)
    modulus = youngs / (2 * (1 - poisson**2))
    a = (3 * ratio**2 * second * force / (2 * pi * modulus * (small + large))) ** (1 / 3)
    return a, a / ratio, 3 * force * first / (2 * pi * modulus * a)


def half_space(semi_axes: tuple[float, float], force: float, modulus: float) -> tuple[float, float, float]:
    """Approach (m) and the two curvatures (1/m) that the pressure `p0 sqrt(1 - x^2/a^2 - y^2/b^2)` makes.

    Johnson (3.64): displacements of the half space `(L - M x^2 - N y^2)/(pi E*)`, potentials integrated over psi from
    0 to infinity; `psi = (t b/(1 - t))^2` makes the integrals proper.
    """
    from scipy.integrate import quad

    a, b = semi_axes
    p0 = 3 * force / (2 * pi * a * b)

    def integral(along: int, across: int) -> float:
        def integrand(t: float) -> float:
            root = t * b / (1 - t)
            stretch = 2 * b / (1 - t) ** 2
            other = 1 / sqrt((a**2 + root**2) * (b**2 + root**2))
            return stretch * other / ((a**2 + root**2) ** along * (b**2 + root**2) ** across)

        return float(0.5 * p0 * a * b / modulus * quad(integrand, 0.0, 1.0 - 1e-9, epsrel=1e-10)[0])

    return integral(0, 0), integral(1, 0), integral(0, 1)
