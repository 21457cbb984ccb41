"""What the time integrator asks of a liquid: the contract of its kinds, which a frozen load keeps by doing nothing.

A kind of liquid is a block of its constants, its own state and work space. It is a `Slosh` with kernels of its own; the
load's frozen part is the wagon's. Every force is that of what the program models of the tank: half of it, on one rail.
The kinds are `modal.ModalLiquid` and `cells.CellLiquid`.
"""

from __future__ import annotations

from slosh_cli.arrays import Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel


class Ride(Block):
    """The motion that a vehicle gives its tank, at the stages of a step (`method.START`, ...); each (3,).

    Along the track they are those of the tank's bottom centre: `speed` m/s, `acceleration` m/s^2 without the `pull`
    (m/s^2) that gravity gives to every mass on a gradient. `pitch` rad is nose-down.
    """

    speed: Vector
    acceleration: Vector
    pull: Vector
    pitch: Vector
    pitch_rate: Vector
    pitch_acceleration: Vector


class Slosh(Block):
    """The motion of a load beside its frozen part: none.

    `recorded` is how many numbers `record` writes.
    """

    recorded: int

    @inner_kernel
    def expect(self, ride, step):
        """Get ready for a step (s) from the start of `ride`: whether that worked, and by how much force (N) and moment
        (N m) on the tank at the start change."""
        return True, 0.0, 0.0

    @inner_kernel
    def predict(self, more, weight, weight_more, implicit):
        """Set the `method.BASE` to what the start and the stage `more`, weighted (s), make of it without the stage's
        own accelerations; `implicit` (s) is the stage's implicit step."""

    @inner_kernel
    def inertia(self, implicit):
        """Inertia with which the liquid follows at a stage: of u'' with itself (kg), with pitch'' (kg m), of pitch''
        with itself (kg m^2). The force on the tank is `push - inertia @ (u'', pitch'')`."""
        return 0.0, 0.0, 0.0

    @inner_kernel
    def push(self, base, implicit, pitch, pull):
        """Force (N) and moment (N m) on the tank at a stage but for what follows its acceleration; `base` is the place
        of the stage without its own accelerations, `pitch` (rad) the tank's there, `pull` (m/s^2) as for `Ride`."""
        return 0.0, 0.0

    @inner_kernel
    def follow(self, stage, base, implicit, pitch, acceleration, pitch_acceleration):
        """Move the liquid to a stage whose accelerations are known, that along the track without gravity's pull; `base`
        and `pitch` as for `push`."""

    @inner_kernel
    def error(self, step, implicit, speed, pitch, pitch_rate):
        """Largest error of the liquid's own speeds in a step (m/s), and what its errors put on the tank's right-hand
        side (N s, N m s), where the tank errs by `speed` (m/s), `pitch` (rad) and `pitch_rate` (rad/s)."""
        return 0.0, 0.0, 0.0

    @inner_kernel
    def carry(self, ride, step, allowed):
        """Carry through a step whose stages are solved what moves beside them: the speed (m/s) that the wagon lacks by
        it, where `allowed` is what it may lack; negative where it could not be carried through."""
        return 0.0

    @inner_kernel
    def energy(self, ride, stage):
        """Kinetic and potential energy (J) beside those of the frozen load, and the power (W) that damping takes."""
        return 0.0, 0.0, 0.0

    @inner_kernel
    def momentum(self, ride, stage):
        """Momentum (N s) along the track beside that of the frozen load, as far as the wagon carries that."""
        return 0.0

    @inner_kernel
    def highest(self):
        """Largest rise (m) of the surface at an end wall within the step."""
        return 0.0

    @inner_kernel
    def record(self, row, first, part, cubic, parabola):
        """Put the liquid's numbers at the fraction `part` of the step into `row` from `first` on; the weights are those
        of `method.hermites` and `method.parabolas` there."""

    @inner_kernel
    def taken(self):
        """Energy (J) that the liquid lost in the step beside the power of its stages."""
        return 0.0

    @inner_kernel
    def accept(self, step):
        """Let the end of the step be the next start."""
