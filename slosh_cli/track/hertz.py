"""Hertz contact of a wheel on a crowned rail (Johnson, Contact Mechanics, 1985, section 4.2)."""

from __future__ import annotations

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


def _curvature_ratio(axis_ratio: float) -> float:
    """Ratio B/A of the relative curvatures whose contact ellipse has a/b = `axis_ratio` (Johnson 4.28)."""
    from scipy.special import ellipe, ellipk

    parameter = 1 - axis_ratio**-2
    complete_k, complete_e = ellipk(parameter), ellipe(parameter)
    return float((axis_ratio**2 * complete_e - complete_k) / (complete_k - complete_e))


def hertz_contact(
    wheel_radius: float, crown_radius: float, youngs_modulus: float, poisson_ratio: float
) -> HertzContact:
    """Contact of a wheel with straight profile (radius m) on a rail crown (radius m); both of one material (Pa).

    With A <= B the relative curvatures 1/(2 R), 1/(2 r), a >= b the semi-axes, p0 = 3N/(2 pi a b), e the
    eccentricity, K(e) and E(e) the complete elliptic integrals (Johnson 4.26 to 4.28):
    `B/A = ((a/b)^2 E - K)/(K - E)`, `A + B = p0 E/(b E*)`, approach `= 3 N K/(2 pi a E*)`.
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipk

    small, large = sorted((0.5 / wheel_radius, 0.5 / crown_radius))
    if large / small > 1 + 1e-9:
        ratio = float(brentq(lambda r: _curvature_ratio(r) - large / small, 1 + 1e-7, 1e4, xtol=1e-13))
    else:
        ratio = 1.0
    parameter = 1 - ratio**-2
    complete_k, complete_e = float(ellipk(parameter)), float(ellipe(parameter))
    modulus = youngs_modulus / (2 * (1 - poisson_ratio**2))
    semi_major_cubed = ratio**2 * 3 * complete_e / (2 * np.pi * modulus * (small + large))
    semi_major = semi_major_cubed ** (1 / 3)  # m per N^(1/3)
    approach = 3 * complete_k / (2 * np.pi * modulus * semi_major)  # m per N^(2/3)
    return HertzContact(float(approach**-1.5), float(semi_major**2 / ratio), ratio)
