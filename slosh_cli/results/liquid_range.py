"""Verdicts on a liquid: what its tank allows its model, and what its motion does."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from slosh_cli.results.validity import Check
from slosh_cli.scenario import Tank
from slosh_cli.scenario.schema_tank import MOST_CELLS
from slosh_cli.scenario.units import STANDARD_GRAVITY, digits
from slosh_cli.section import section_of
from slosh_cli.tank.comparison import ROUNDING, given_fractions, impossible_fractions
from slosh_cli.tank.still import frequency_excess

FREQUENCY_LIMIT = 0.05
"""Shallow water is used where its first frequency is this close to potential flow's."""
_SHIFT_LIMIT = 0.01
"""Centres of mass that move by more than this part of the tank's length leave linear theory: B. Baeuerlein and K.
Avila, J. Fluid Mech. 925 (2021) A22."""
_CELL_LIMIT = 0.02
"""Cells are too few where a wave needs more than this part of the stop for one of them, if all mass were liquid."""
_MISSED = 0.7
"""The distance was off by at most this times that part: 0.3 in 25 random stops of 1 to 150 m with 20 and 40 cells,
0.66 in one whose liquid strikes the roof at once."""
_SLOT_LIMIT = 0.1
"""A slot that may hold more than this part of the room above the liquid changes the surface elsewhere."""


@dataclass(frozen=True)
class Motion:
    """How far a liquid moved, m: largest change of its level at an end wall, up or down, largest head of pressure under
    the roof, and largest `shift` of its centre of mass where that was watched, none negative; whether the slot above
    the roof alone carried that head (`tank.roof`); of a wagon that stopped the `seconds` from the onset to rest, and
    the liquid's part of all that is braked."""

    surface: float
    head: float = 0.0
    slot_alone: bool = True
    shift: float | None = None
    seconds: float | None = None
    part: float = 1.0


def room_and_depth(tank: Tank) -> tuple[float, float]:
    """Room above the still surface and depth of the liquid below it, m."""
    height = section_of(tank).height
    return height * (1.0 - tank.fill), height * tank.fill


def tank_checks(tank: Tank, advice: str) -> tuple[Check, ...]:
    """What can be said of the liquid's model before anything moves; `advice` is the sentence that recommends one."""
    if tank.liquid.model == "modal":
        return coefficient_checks(tank)
    if tank.liquid.model == "shallow-water":
        return (_frequency_check(tank, advice),)
    return ()


def coefficient_checks(tank: Tank) -> tuple[Check, ...]:
    """Given coefficients against the bound of a tank with flat ends; nothing where they are computed."""
    shares = [fraction / bound for fraction, bound in given_fractions(tank)]
    if not shares:
        return ()
    meaning = "; ".join(impossible_fractions(tank))
    name = "slosh mass of the given coefficients over its bound"
    return (Check(name, "input", max(shares), 1.0 + ROUNDING, meaning),)


def motion_checks(tank: Tank, motion: Motion, advice: str) -> tuple[Check, ...]:
    """What the liquid's motion says of its model; `advice` is the sentence that recommends one."""
    return tuple(_motion_checks(tank, motion, advice))


def expected_checks(tank: Tank, deceleration: float, advice: str) -> tuple[Check, ...]:
    """The same before a stop of this `deceleration` (m/s^2): a level at rest in it, a L/2g, is passed by as much."""
    (room, depth), moved = room_and_depth(tank), deceleration * tank.length / STANDARD_GRAVITY
    if tank.liquid.model == "modal":
        meaning = (
            f"The surface is expected to move by {moved:.2f} m at the end walls, but there is {room:.2f} m of room "
            f"above it and {depth:.2f} m of liquid below: outside the linear theory of the modal liquid. {advice}"
        )
        name = "expected surface rise over the room above and below"
        return (Check(name, "model", moved / min(room, depth), 1.0, meaning),)
    if tank.liquid.model == "shallow-water":
        meaning = (
            f"The liquid is expected to strike the roof (rise {moved:.2f} m, room {room:.2f} m): peaks of force, "
            "moment and wheel load will depend on tank.liquid.slot_speed; means and the braking distance hardly will."
        )
        return (Check("expected surface rise over the room above", "accuracy", moved / room, 1.0, meaning),)
    return ()


def _frequency_check(tank: Tank, advice: str) -> Check:
    excess = frequency_excess(tank, STANDARD_GRAVITY)
    return Check(
        "excess of the first slosh frequency",
        "model",
        excess,
        FREQUENCY_LIMIT,
        f"Shallow water overstates the first slosh frequency of this tank by {excess:.1%}: the liquid is too deep for "
        f"the tank's length. {advice}",
    )


def _motion_checks(tank: Tank, motion: Motion, advice: str) -> Iterator[Check]:
    room, depth = room_and_depth(tank)
    if tank.liquid.model == "modal":
        yield Check(
            "surface rise over the room above and below",
            "model",
            motion.surface / min(room, depth),
            1.0,
            f"The surface moves by {motion.surface:.2f} m at the end walls, but there is {room:.2f} m of room above it "
            f"and {depth:.2f} m of liquid below: outside the linear theory of the modal liquid, which then overstates "
            f"the shift of weight. {advice}",
        )
        if motion.shift is not None:
            yield _shift_check(tank, motion.shift, advice)
    if tank.liquid.model == "shallow-water":
        yield Check(
            "head of pressure under the roof",
            "accuracy",
            motion.head,
            0.0,
            f"The liquid struck the roof (head up to {motion.head:.1f} m): peaks of force, moment and wheel load "
            "depend on tank.liquid.slot_speed there; means and the braking distance hardly do.",
        )
        if motion.slot_alone:
            yield _slot_check(tank, motion.head)
        if motion.seconds:  # none of a run without a stop, zero of one that stood at the onset
            yield _cells_check(tank, motion.seconds, motion.part)


def _cells_check(tank: Tank, seconds: float, part: float) -> Check:
    """How late the liquid pushes: what a small wave needs for one cell, over what the wagon needs to stop, weighted
    with the liquid's `part` of the mass."""
    section, depth = section_of(tank), section_of(tank).height * tank.fill
    speed = math.sqrt(STANDARD_GRAVITY * section.area(depth) / section.surface_width(depth))
    cells = tank.liquid.cells
    crossed = cells * speed * seconds / tank.length
    enough = math.ceil(1.05 * part * cells / crossed / _CELL_LIMIT)  # the stop may then be a little shorter
    fix = f"Write `tank.liquid.cells: {enough}`."
    if enough > MOST_CELLS:
        fix = f"It would take {enough} cells, more than the {MOST_CELLS} that there can be."
    return Check(
        "time of a wave through a cell over that of the stop, for the liquid's part of the mass",
        "accuracy",
        part / crossed,
        _CELL_LIMIT,
        f"Waves cross only {crossed:.0f} cells while the wagon stops: the liquid pushes late, and the braking distance "
        f"may be off by up to {digits(100.0 * _MISSED * part / crossed, 1)} %. {fix}",
    )


def _shift_check(tank: Tank, shift: float, advice: str) -> Check:
    """How far the centre of mass moves: beyond a hundredth of the length measured tanks leave linear theory."""
    return Check(
        "shift of the liquid's centre over the length of the tank",
        "model",
        shift / tank.length,
        _SHIFT_LIMIT,
        f"The liquid's centre of mass moves by {shift:.3g} m, {shift / tank.length:.1%} of the tank's length: beyond "
        f"{_SHIFT_LIMIT:.0%} swayed tanks were measured to leave linear theory, above all near resonance. {advice}",
    )


def _slot_check(tank: Tank, head: float) -> Check:
    """Most that the slot may hold, of the room above the still liquid: a head that falls evenly along the whole tank.

    The slot of pressure waves at c has the width `g A/c^2`, A being the whole section.
    """
    section = section_of(tank)
    whole = section.area(section.height)
    free = whole - section.area(section.height * tank.fill)
    share = 0.5 * STANDARD_GRAVITY * head / tank.liquid.slot_speed**2 * whole / free
    return Check(
        "liquid in the slot over the room above the liquid",
        "model",
        share,
        _SLOT_LIMIT,
        f"Under its head the slot above the roof may hold up to {share:.0%} of the room above the liquid: the surface "
        "elsewhere sinks for it, so that the shift of weight and the wheel unloading come out too large. Raise "
        "tank.liquid.slot_speed, or treat the load of so full a tank as rigid (tank.liquid.model: rigid).",
    )
