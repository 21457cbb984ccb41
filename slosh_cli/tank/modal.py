"""Linear slosh modes as they act on a moving tank: oscillators driven by the tank's own acceleration."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from slosh_cli.arrays import Matrix, Vector
from slosh_cli.compiled import inner_kernel, kernel
from slosh_cli.method import (
    BASE,
    END,
    ERROR_END,
    ERROR_MIDDLE,
    ERROR_START,
    MIDDLE,
    START,
    hermites,
    parabolas,
    predict,
    step_extremes,
)
from slosh_cli.tank.coefficients import SloshMode
from slosh_cli.tank.liquid import Slosh
from slosh_cli.vectors import copy


class ModalLiquid(Slosh):
    """Slosh modes of half a tank (or a whole one); every vector (modes,), SI units. A liquid by `liquid`'s contract.

    `lambda_1` kg and `lambda_02` kg m couple a mode to the bottom centre's displacement and the tank's pitch,
    `mu` kg is its inertia, `damping` N s/m, `stiffness` N/m, `pitch_weight` = g lambda_1 in N, and `side` +1 where a
    positive amplitude raises the surface at the front wall, -1 where it raises it at the rear. `amplitude` m, `rate`
    and `second`, its time derivatives, are (4, modes): at a step's stages and at a stage's base.
    """

    lambda_1: Vector
    lambda_02: Vector
    mu: Vector
    damping: Vector
    stiffness: Vector
    pitch_weight: Vector
    side: Vector
    amplitude: Matrix
    rate: Matrix
    second: Matrix

    @inner_kernel
    def predict(self, more, weight, weight_more, implicit):
        """The base's amplitudes and rates."""
        amplitude, rate, second = self.amplitude, self.rate, self.second
        predict(
            amplitude[START], rate[START], second[START], rate[more], second[more],
            weight, weight_more, implicit, amplitude[BASE], rate[BASE],
        )  # fmt: skip

    @inner_kernel
    def inertia(self, implicit):
        """What the modes, led by the tank's acceleration, take off the frozen load's."""
        uu = up = pp = 0.0
        for n in range(self.mu.size):
            inertia = self.mu[n] + implicit * self.damping[n] + implicit * implicit * self.stiffness[n]
            arm = self.lambda_02[n] - implicit * implicit * self.pitch_weight[n]
            uu -= self.lambda_1[n] * self.lambda_1[n] / inertia
            up -= self.lambda_1[n] * arm / inertia
            pp -= arm * arm / inertia
        return uu, up, pp

    @inner_kernel
    def push(self, base, implicit, pitch, pull):
        """Force and moment of the modes on a tank without acceleration."""
        force = moment = 0.0
        amplitude, rate = self.amplitude[base], self.rate[base]
        for n in range(self.mu.size):
            inertia = self.mu[n] + implicit * self.damping[n] + implicit * implicit * self.stiffness[n]
            arm = self.lambda_02[n] - implicit * implicit * self.pitch_weight[n]
            rest = self.damping[n] * rate[n] + self.stiffness[n] * amplitude[n] - self.pitch_weight[n] * pitch
            rest -= self.lambda_1[n] * pull
            force += self.lambda_1[n] * rest / inertia
            moment += arm * rest / inertia + self.pitch_weight[n] * amplitude[n]
        return force, moment

    @kernel
    def follow(self, stage, base, implicit, pitch, acceleration, pitch_acceleration):
        """Modal accelerations (m/s^2) at a stage, then rates and amplitudes."""
        amplitude, rate, second = self.amplitude[base], self.rate[base], self.second[stage]
        for n in range(self.mu.size):
            inertia = self.mu[n] + implicit * self.damping[n] + implicit * implicit * self.stiffness[n]
            arm = self.lambda_02[n] - implicit * implicit * self.pitch_weight[n]
            rest = self.damping[n] * rate[n] + self.stiffness[n] * amplitude[n] - self.pitch_weight[n] * pitch
            drive = self.lambda_1[n] * acceleration + arm * pitch_acceleration
            second[n] = -(drive + rest) / inertia
        moved, moved_rate = self.amplitude[stage], self.rate[stage]
        for n in range(self.mu.size):
            moved[n] = amplitude[n] + implicit * implicit * second[n]
            moved_rate[n] = rate[n] + implicit * second[n]

    @inner_kernel
    def error(self, step, implicit, speed, pitch, pitch_rate):
        """The modes' errors, filtered as the wagon's are."""
        size = force = moment = 0.0
        rates, seconds = self.rate, self.second
        for n in range(self.mu.size):
            place = step * (ERROR_START * rates[START, n] + ERROR_MIDDLE * rates[MIDDLE, n] + ERROR_END * rates[END, n])
            rate = step * (
                ERROR_START * seconds[START, n] + ERROR_MIDDLE * seconds[MIDDLE, n] + ERROR_END * seconds[END, n]
            )
            inertia = self.mu[n] + implicit * self.damping[n] + implicit * implicit * self.stiffness[n]
            arm = self.lambda_02[n] - implicit * implicit * self.pitch_weight[n]
            own = (
                self.mu[n] * rate
                + self.lambda_1[n] * speed
                + self.lambda_02[n] * pitch_rate
                - implicit * (self.stiffness[n] * place - self.pitch_weight[n] * pitch)
            )
            force += self.lambda_1[n] * (rate - own / inertia)
            moment += self.lambda_02[n] * rate + implicit * self.pitch_weight[n] * place - arm * own / inertia
            size = max(size, abs(rate))
        return size, force, moment

    @inner_kernel
    def energy(self, ride, stage):
        """The modes' energies, their coupling to the tank included."""
        kinetic = potential = loss = 0.0
        speed, pitch, pitch_rate = ride.speed[stage], ride.pitch[stage], ride.pitch_rate[stage]
        amplitude, rate = self.amplitude[stage], self.rate[stage]
        for n in range(self.mu.size):
            coupled = self.lambda_1[n] * speed + self.lambda_02[n] * pitch_rate
            kinetic += rate[n] * (coupled + 0.5 * self.mu[n] * rate[n])
            potential += amplitude[n] * (0.5 * self.stiffness[n] * amplitude[n] - self.pitch_weight[n] * pitch)
            loss += self.damping[n] * rate[n] * rate[n]
        return kinetic, potential, loss

    @inner_kernel
    def momentum(self, ride, stage):
        """That of the modes."""
        momentum = 0.0
        for n in range(self.mu.size):
            momentum += self.lambda_1[n] * self.rate[stage, n]
        return momentum

    @inner_kernel
    def rise(self, stage):
        """Rise of the surface (m) at the front end wall; at the rear wall it is the opposite (odd modes)."""
        front = 0.0
        for n in range(self.mu.size):
            front += self.side[n] * self.amplitude[stage, n]
        return front

    @inner_kernel
    def highest(self):
        """By the parabola through the stages."""
        low, high = step_extremes(self.rise(START), self.rise(MIDDLE), self.rise(END))
        return max(-low, high)

    @kernel
    def force(self, stage):
        """Slosh force (N) and moment (N m) on the tank beside the frozen load's."""
        force = moment = 0.0
        amplitude, second = self.amplitude[stage], self.second[stage]
        for n in range(self.mu.size):
            force -= self.lambda_1[n] * second[n]
            moment += self.pitch_weight[n] * amplitude[n] - self.lambda_02[n] * second[n]
        return force, moment

    @inner_kernel
    def record(self, row, first, part, cubic, parabola):
        """Amplitudes, then accelerations."""
        amplitude, rate, second = self.amplitude, self.rate, self.second
        hermites(amplitude[START], rate[START], amplitude[END], rate[END], cubic, row, first)
        parabolas(second[START], second[MIDDLE], second[END], parabola, row, first + self.mu.size)

    @inner_kernel
    def accept(self, step):
        """The end becomes the start."""
        copy(self.amplitude[END], self.amplitude[START])
        copy(self.rate[END], self.rate[START])
        copy(self.second[END], self.second[START])


def modal_liquid(modes: Sequence[SloshMode], gravity: float, share: float) -> ModalLiquid:
    """Oscillators at rest for the `share` (0.5: one rail's half, 1: the whole tank) of `modes`; gravity in m/s^2."""

    def column(name: str) -> Vector:
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
        **{name: np.zeros((4, len(modes))) for name in ("amplitude", "rate", "second")},
        recorded=2 * len(modes),
    )
