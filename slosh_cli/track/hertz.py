"""Hertz contact of a wheel on a crowned rail (Johnson, Contact Mechanics, 1985, section 4.2)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class HertzContact:
    """Point contact of two equal elastic bodies: force = stiffness * approach^(3/2)."""

    stiffness: float
    """C_H, N/m^1.5."""
    ellipse_area_factor: float
    """a*b / N^(2/3), m^2/N^(2/3): product of the semi-axes over force to the two thirds."""
    axis_ratio: float
    """Larger over smaller semi-axis of the contact ellipse, at least 1."""

    def semi_axes(self, force: float) -> tuple[float, float]:
        """Larger and smaller semi-axis (m) of the contact ellipse under `force` (N)."""
        product = self.ellipse_area_factor * force ** (2 / 3)
        return float(np.sqrt(product * self.axis_ratio)), float(np.sqrt(product / self.axis_ratio))


def _elliptic_integrals(axis_ratio: float) -> tuple[float, float, float]:
    """Complete elliptic integrals K, E and K - E of the eccentricity of an ellipse with a/b = `axis_ratio`.

    By the arithmetic-geometric mean (Abramowitz and Stegun 17.6), to the last digits and in microseconds, where
    loading scipy's takes a quarter of a second. K - E comes as a sum: next to a circle a difference would be rounding.
    """
    mean, geometric = 1.0, 1 / axis_ratio
    weight, share = 0.5, 0.5 * (1 - geometric**2)
    while abs(mean - geometric) > 1e-15 * mean:
        half_gap = 0.5 * (mean - geometric)
        mean, geometric = 0.5 * (mean + geometric), math.sqrt(mean * geometric)
        weight *= 2
        share += weight * half_gap**2
    first = math.pi / (2 * mean)
    return first, first * (1 - share), first * share


def _curvature_ratio(axis_ratio: float) -> float:
    """Ratio B/A of the relative curvatures whose contact ellipse has a/b = `axis_ratio` > 1 (Johnson 4.28)."""
    first, second, difference = _elliptic_integrals(axis_ratio)
    return (axis_ratio**2 * second - first) / difference


def _axis_ratio(curvature_ratio: float) -> float:
    """Axis ratio of the contact ellipse under relative curvatures of the ratio B/A > 1.

    By secants, until rounding lets the gap shrink no further: ln B/A over ln a/b is nearly a straight line through the
    circle's (0, 0), of slope 3/2 there.
    """
    target = math.log(curvature_ratio)
    ratio, gap, following = 0.0, -target, target / 1.5
    while abs(closer := math.log(_curvature_ratio(math.exp(following))) - target) < abs(gap):
        step = closer * (following - ratio) / (closer - gap)
        ratio, gap, following = following, closer, following - step
    return math.exp(ratio)


def hertz_contact(
    wheel_radius: float, crown_radius: float, youngs_modulus: float, poisson_ratio: float
) -> HertzContact:
    """Contact of a wheel with straight profile (radius m) on a rail crown (radius m); both of one material (Pa).

    With A <= B the relative curvatures 1/(2 R), 1/(2 r), a >= b the semi-axes, p0 = 3N/(2 pi a b), e the
    eccentricity, K(e) and E(e) the complete elliptic integrals (Johnson 4.26 to 4.28):
    `B/A = ((a/b)^2 E - K)/(K - E)`, `A + B = p0 E/(b E*)`, approach `= 3 N K/(2 pi a E*)`.
    """
    small, large = sorted((0.5 / wheel_radius, 0.5 / crown_radius))
    ratio = _axis_ratio(large / small) if large / small > 1 + 1e-9 else 1.0
    complete_k, complete_e, _ = _elliptic_integrals(ratio)
    modulus = youngs_modulus / (2 * (1 - poisson_ratio**2))
    semi_major_cubed = ratio**2 * 3 * complete_e / (2 * np.pi * modulus * (small + large))
    semi_major = semi_major_cubed ** (1 / 3)  # m per N^(1/3)
    approach = 3 * complete_k / (2 * np.pi * modulus * semi_major)  # m per N^(2/3)
    return HertzContact(float(approach**-1.5), float(semi_major**2 / ratio), ratio)
