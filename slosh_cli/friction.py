"""Friction laws of brakes (theory section 12): plain functions, which kernels compile and Python calls as they are.

A law takes the speed (km/h) at which the surfaces rub and the force (kN) on one block or friction face, and gives the
coefficient of friction and its derivative by the speed (h/km). A new law is one more such function here, the class of
its keys in `scenario/schema_brake.py` and its line in `wagon/brake.py`.
"""

from __future__ import annotations


def cast_iron(speed: float, force: float) -> tuple[float, float]:
    """Cast-iron blocks, after Karwatzki: `0.6 (1.62 F + 100)/(8.1 F + 100) (v + 100)/(5 v + 100)`."""
    pressed, below = 0.6 * (1.62 * force + 100.0) / (8.1 * force + 100.0), 5.0 * speed + 100.0
    return pressed * (speed + 100.0) / below, -400.0 * pressed / (below * below)


def composite(speed: float, force: float) -> tuple[float, float]:
    """Composite blocks (K), after Karwatzki: `0.44 (0.1 F + 20)/(0.4 F + 20) (v + 150)/(2 v + 150)`."""
    pressed, below = 0.44 * (0.1 * force + 20.0) / (0.4 * force + 20.0), 2.0 * speed + 150.0
    return pressed * (speed + 150.0) / below, -150.0 * pressed / (below * below)
