"""Linear slosh modes as they act on a moving tank: oscillators driven by the tank's own acceleration.

A liquid shows the time integrator three faces only. `liquid_reaction` states its force on the tank as an affine
function of the tank's accelerations at a stage; `liquid_follow` moves it there once those are known; the `energy`
and `power` functions keep the ledger. A liquid with field equations of its own can take the same place.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from slosh_cli.compiled import kernel
from slosh_cli.tank.coefficients import SloshMode

Array = NDArray[np.float64]


class ModalLiquid(NamedTuple):
    """Slosh modes of half a tank (or a whole one); every array (modes,), SI units; no modes is a frozen load.

    `lambda_1` kg and `lambda_02` kg m couple a mode to the bottom centre's displacement and the tank's pitch,
    `mu` kg is its inertia, `damping` N s/m, `stiffness` N/m, `pitch_weight` = g lambda_1 in N, and `side` +1 where a
    positive amplitude raises the surface at the front wall, -1 where it raises it at the rear.
    """

    lambda_1: Array
    lambda_02: Array
    mu: Array
    damping: Array
    stiffness: Array
    pitch_weight: Array
    side: Array


def modal_liquid(modes: Sequence[SloshMode], gravity: float, share: float) -> ModalLiquid:
    """Oscillators for the `share` (0.5: one rail's half, 1: the whole tank) of `modes`; gravity in m/s^2."""

    def column(name: str) -> Array:
        return np.array([getattr(mode, name) for mode in modes], dtype=np.float64)

    lambda_1, mu, frequency = share * column("lambda_1"), share * column("mu"), column("frequency")
    return ModalLiquid(
        lambda_1=lambda_1,
        lambda_02=share * column("lambda_02"),
        mu=mu,
        damping=2 * column("damping_ratio") * frequency * mu,
        stiffness=mu * frequency**2,
        pitch_weight=gravity * lambda_1,
        side=np.sign(lambda_1),
    )


@kernel
def liquid_reaction(liquid, amplitude, rate, step, pitch):
    """Slosh force on the tank at an implicit stage, as `force - inertia @ (u'', pitch'')`.

    `amplitude`, `rate` (modes,) are the stage's values without its own accelerations, `step` (s) the stage's
    implicit step: amplitude_stage = amplitude + step^2 beta'', and likewise for the pitch (rad). Returns the
    symmetric inertia (u u, u pitch, pitch pitch) and the force and moment (N, N m).
    """
    uu = up = pp = force = moment = 0.0
    for n in range(liquid.mu.size):
        inertia = liquid.mu[n] + step * liquid.damping[n] + step * step * liquid.stiffness[n]
        arm = liquid.lambda_02[n] - step * step * liquid.pitch_weight[n]
        rest = liquid.damping[n] * rate[n] + liquid.stiffness[n] * amplitude[n] - liquid.pitch_weight[n] * pitch
        uu -= liquid.lambda_1[n] * liquid.lambda_1[n] / inertia
        up -= liquid.lambda_1[n] * arm / inertia
        pp -= arm * arm / inertia
        force += liquid.lambda_1[n] * rest / inertia
        moment += arm * rest / inertia + liquid.pitch_weight[n] * amplitude[n]
    return uu, up, pp, force, moment


@kernel
def liquid_follow(liquid, amplitude, rate, step, pitch, tank_acceleration, pitch_acceleration, acceleration):
    """Modal accelerations (m/s^2) at a stage, into `acceleration` (modes,), for the tank's accelerations there."""
    for n in range(liquid.mu.size):
        inertia = liquid.mu[n] + step * liquid.damping[n] + step * step * liquid.stiffness[n]
        arm = liquid.lambda_02[n] - step * step * liquid.pitch_weight[n]
        rest = liquid.damping[n] * rate[n] + liquid.stiffness[n] * amplitude[n] - liquid.pitch_weight[n] * pitch
        drive = liquid.lambda_1[n] * tank_acceleration + arm * pitch_acceleration
        acceleration[n] = -(drive + rest) / inertia


@kernel
def liquid_force(liquid, amplitude, acceleration):
    """Slosh force (N) and moment (N m) on the tank at given modal amplitudes (m) and accelerations (m/s^2)."""
    force = moment = 0.0
    for n in range(liquid.mu.size):
        force -= liquid.lambda_1[n] * acceleration[n]
        moment += liquid.pitch_weight[n] * amplitude[n] - liquid.lambda_02[n] * acceleration[n]
    return force, moment


@kernel
def liquid_energy(liquid, amplitude, rate, tank_speed, pitch, pitch_rate):
    """Kinetic and potential energy (J) of the modes, their coupling to the tank included."""
    kinetic = potential = 0.0
    for n in range(liquid.mu.size):
        coupled = liquid.lambda_1[n] * tank_speed + liquid.lambda_02[n] * pitch_rate
        kinetic += rate[n] * (coupled + 0.5 * liquid.mu[n] * rate[n])
        potential += amplitude[n] * (0.5 * liquid.stiffness[n] * amplitude[n] - liquid.pitch_weight[n] * pitch)
    return kinetic, potential


@kernel
def liquid_loss(liquid, rate):
    """Power (W) that damping takes out of the modes."""
    loss = 0.0
    for n in range(liquid.mu.size):
        loss += liquid.damping[n] * rate[n] * rate[n]
    return loss


@kernel
def surface_rise(liquid, amplitude):
    """Rise of the free surface (m) at the front end wall; at the rear wall it is the opposite (odd modes)."""
    front = 0.0
    for n in range(liquid.mu.size):
        front += liquid.side[n] * amplitude[n]
    return front


def undamped_mass_fraction(liquid: ModalLiquid) -> float:
    """Sum of lambda_1^2/mu (kg): the part of the load that the modes carry."""
    return math.fsum(liquid.lambda_1**2 / liquid.mu)
