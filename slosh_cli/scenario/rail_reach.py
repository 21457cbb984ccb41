"""How much of the rail has to be computed, and how finely: lengths that follow from the track itself.

The stretch of rail that moves with the wagon ends in supports. Such an end at distance d from a wheel acts like a
mirrored load at 2 d: the deflection under the wheel is wrong by the share of the wheel's own wave that comes back. The
steady wave obeys `EI p^4 + lam V p^3 - (k_sm - m V^2) p^2 - alpha V p + k = 0` (theory section 6). The root that
fades most slowly decides on either side of the wheel; the wave goes out on one and comes back on the other.
"""

from __future__ import annotations

import cmath
import math
from functools import lru_cache
from typing import Final

from slosh_cli.scenario.schema_run import Foundation, Rail, Track

REFUSED: Final = 1e-2
"""A stretch of rail whose ends change the deflection by more than this part is refused."""
TOLD: Final = 1e-3
"""A change by more than this part is warned of, from the ends as from the elements."""
_DEFAULT: Final = 1e-6
"""What the default length leaves of it, no more than the energy ledger misses."""
LEAST_MARGIN: Final = 5.0
"""Least length of rail ahead of the first and behind the last wheel, m, whatever the track."""
_FINE: Final = 0.4
"""Default length of an element by the length in which a load's deflection fades, (4 EI/k)^(1/4); the error is 1e-4."""
_ELEMENT_ERROR: Final = 1.0 / 250.0
"""Error of the deflection under a load, by the fourth power of the same ratio (cubic elements; 1/230 to 1/280)."""
LONGEST: Final = 1000.0
"""Longest stretch of rail, m."""
_SWEEPS: Final = 200


def computed_lengths(track: Track, wheelbase: float, pivot_spacing: float, speed: float) -> tuple[float, float]:
    """Length (m) of the stretch of rail and of its elements for a stop from `speed` (m/s), defaults put in.

    The default length is a whole number of metres, so that neighbouring speeds share a rail.
    """
    rail, foundation, domain = track.rail, track.foundation, track.domain
    length, element = domain.length, domain.element_length
    if length is None:
        margin = margin_for(rail, foundation, speed, _DEFAULT)
        length = math.ceil(min(pivot_spacing + wheelbase + 2.0 * margin, LONGEST))
    if element is None:
        element = min(_FINE * fading_length(rail, foundation), 0.5 * wheelbase)
    return float(length), element


@lru_cache(maxsize=1024)
def fading(rail: Rail, foundation: Foundation, speed: float) -> tuple[float, float]:
    """How fast a wheel's wave fades at `speed` (m/s), out and back together, 1/m, and by how much it may exceed that.

    The second number is the wave's amplitude over the deflection under the wheel.
    """
    stiffness = rail.youngs_modulus * rail.second_moment
    tension = foundation.shear_stiffness - rail.mass_per_length * speed**2
    roots = _roots(
        foundation.shear_damping * speed / stiffness,
        -tension / stiffness,
        -foundation.damping * speed / stiffness,
        foundation.stiffness / stiffness,
    )
    ahead = min((-p.real for p in roots if p.real < 0.0), default=0.0)
    behind = min((p.real for p in roots if p.real >= 0.0), default=0.0)
    waving = min((abs(p.imag) for p in roots), default=0.0)
    amplitude = math.hypot(1.0, 0.5 * (ahead + behind) / waving) if waving > 1e-3 * (ahead + behind) else 4.0
    return ahead + behind, min(amplitude, 4.0)


def error_of_ends(rail: Rail, foundation: Foundation, speed: float, margin: float) -> float:
    """Largest error of the deflection under an outer wheel, as a part of it, `margin` (m) from the end of the rail.

    At standstill or at `speed` (m/s), whichever is worse.
    """
    found = (fading(rail, foundation, at) for at in (0.0, speed))
    return max(min(amplitude * math.exp(-rate * margin), 1.0) for rate, amplitude in found)


def margin_for(rail: Rail, foundation: Foundation, speed: float, error: float) -> float:
    """Least length of rail beyond the outer wheels, m, that keeps the same error below `error`."""
    found = (fading(rail, foundation, at) for at in (0.0, speed))
    needed = max(math.log(amplitude / error) / rate if rate > 0.0 else math.inf for rate, amplitude in found)
    return max(needed, LEAST_MARGIN)


def error_of_elements(rail: Rail, foundation: Foundation, element: float) -> float:
    """Error of the deflection under a wheel, as a part of it, by elements of length `element` (m)."""
    return _ELEMENT_ERROR * (element / fading_length(rail, foundation)) ** 4


def fading_length(rail: Rail, foundation: Foundation) -> float:
    """Length in which the deflection under a standing load fades on the foundation's springs, (4 EI/k)^(1/4), m."""
    return math.sqrt(math.sqrt(4.0 * rail.youngs_modulus * rail.second_moment / foundation.stiffness))


def critical_speed(rail: Rail, foundation: Foundation) -> float:
    """Lowest speed (m/s) at which a moving load meets a free wave of the undamped track (theory section 6)."""
    bending = rail.youngs_modulus * rail.second_moment
    return math.sqrt(
        (foundation.shear_stiffness + 2.0 * math.sqrt(foundation.stiffness * bending)) / rail.mass_per_length
    )


def _roots(b: float, c: float, d: float, e: float) -> list[complex]:
    """Roots of p^4 + b p^3 + c p^2 + d p + e by the method of Durand and Kerner, scaled by their mean size."""
    size = e**0.25
    b, c, d = b / size, c / size**2, d / size**3
    roots = [cmath.exp(1j * (0.4 + 0.5 * math.pi * k)) for k in range(4)]
    for _ in range(_SWEEPS):
        moved = 0.0
        for i, p in enumerate(roots):
            apart = math.prod((p - q for j, q in enumerate(roots) if j != i), start=complex(1.0))
            change = ((((p + b) * p + c) * p + d) * p + 1.0) / (apart or 1e-30)
            roots[i] = p - change
            moved = max(moved, abs(change))
        if moved < 1e-13:
            break
    return [size * p for p in roots]
