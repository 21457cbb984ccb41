"""A load of one of two kinds, which its own number tells: for trains that mix them (theory section 16).

Vehicles make a list only where their liquids are of one class. Where all of them are, no train needs this.
"""

from __future__ import annotations

from slosh_cli.compiled import inner_kernel
from slosh_cli.tank.cells import CellLiquid
from slosh_cli.tank.liquid import Slosh
from slosh_cli.tank.modal import ModalLiquid


class MixedLiquid(Slosh):
    """The `cells` of a tank where `flows` is 1, else its `modes`; the other part belongs to another tank, or to none,
    and is left alone. A liquid by `liquid`'s contract."""

    modes: ModalLiquid
    cells: CellLiquid
    flows: int

    @inner_kernel
    def expect(self, ride, step):
        """Of the part that there is."""
        return self.cells.expect(ride, step) if self.flows == 1 else self.modes.expect(ride, step)

    @inner_kernel
    def predict(self, more, weight, weight_more, implicit):
        """Of the part that there is."""
        if self.flows == 1:
            self.cells.predict(more, weight, weight_more, implicit)
        else:
            self.modes.predict(more, weight, weight_more, implicit)

    @inner_kernel
    def inertia(self, implicit):
        """Of the part that there is."""
        return self.cells.inertia(implicit) if self.flows == 1 else self.modes.inertia(implicit)

    @inner_kernel
    def push(self, base, implicit, pitch, pull):
        """Of the part that there is."""
        if self.flows == 1:
            return self.cells.push(base, implicit, pitch, pull)
        return self.modes.push(base, implicit, pitch, pull)

    @inner_kernel
    def follow(self, stage, base, implicit, pitch, acceleration, pitch_acceleration):
        """Of the part that there is."""
        if self.flows == 1:
            self.cells.follow(stage, base, implicit, pitch, acceleration, pitch_acceleration)
        else:
            self.modes.follow(stage, base, implicit, pitch, acceleration, pitch_acceleration)

    @inner_kernel
    def error(self, step, implicit, speed, pitch, pitch_rate):
        """Of the part that there is."""
        if self.flows == 1:
            return self.cells.error(step, implicit, speed, pitch, pitch_rate)
        return self.modes.error(step, implicit, speed, pitch, pitch_rate)

    @inner_kernel
    def carry(self, ride, step, allowed):
        """Of the part that there is."""
        return self.cells.carry(ride, step, allowed) if self.flows == 1 else self.modes.carry(ride, step, allowed)

    @inner_kernel
    def energy(self, ride, stage):
        """Of the part that there is."""
        return self.cells.energy(ride, stage) if self.flows == 1 else self.modes.energy(ride, stage)

    @inner_kernel
    def momentum(self, ride, stage):
        """Of the part that there is."""
        return self.cells.momentum(ride, stage) if self.flows == 1 else self.modes.momentum(ride, stage)

    @inner_kernel
    def highest(self):
        """Of the part that there is."""
        return self.cells.highest() if self.flows == 1 else self.modes.highest()

    @inner_kernel
    def record(self, row, first, part, cubic, parabola):
        """Of the part that there is."""
        if self.flows == 1:
            self.cells.record(row, first, part, cubic, parabola)
        else:
            self.modes.record(row, first, part, cubic, parabola)

    @inner_kernel
    def taken(self):
        """Of the part that there is."""
        return self.cells.taken() if self.flows == 1 else self.modes.taken()

    @inner_kernel
    def accept(self, step):
        """Of the part that there is."""
        if self.flows == 1:
            self.cells.accept(step)
        else:
            self.modes.accept(step)


def own_liquid(liquid: Slosh) -> Slosh:
    """The part that a load of two kinds has; any other load is its own."""
    if not isinstance(liquid, MixedLiquid):
        return liquid
    return liquid.cells if liquid.flows == 1 else liquid.modes


def of_one_class(liquids: list[Slosh], still: ModalLiquid) -> list[Slosh]:
    """The loads of a train as blocks of one class; `still` stands for a frozen load beside liquids."""
    if len({type(liquid) for liquid in liquids}) == 1:
        return liquids
    cells = next((liquid for liquid in liquids if isinstance(liquid, CellLiquid)), None)
    if cells is None:
        return [liquid if isinstance(liquid, ModalLiquid) else still for liquid in liquids]
    return [
        MixedLiquid(
            modes=liquid if isinstance(liquid, ModalLiquid) else still,
            cells=liquid if isinstance(liquid, CellLiquid) else cells,
            flows=int(isinstance(liquid, CellLiquid)),
            recorded=liquid.recorded,
        )
        for liquid in liquids
    ]
