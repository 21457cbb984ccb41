"""Given slosh coefficients belong to one tank: that of the file they stand in, with its fill and its density.

A changed tank has other modes. Coefficients that outlive their tank would give a wrong number that looks right.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Final, TypeVar

from pydantic import ValidationError

from slosh_cli.errors import Problem, ScenarioError
from slosh_cli.scenario.amounts import AMOUNTS, tare_of
from slosh_cli.scenario.base import Path
from slosh_cli.scenario.document import Document
from slosh_cli.scenario.leaves import Quantity
from slosh_cli.scenario.schema_tank import TankBase
from slosh_cli.scenario.schema_wagon import Wagon
from slosh_cli.scenario.tree import spot_of
from slosh_cli.scenario.units import plain, shown

_T = TypeVar("_T", bound=TankBase)

_USERS: Final = ("modal",)
"""Models of the liquid that use slosh coefficients."""
_WITHOUT_EFFECT: Final = frozenset({"bottom_height", "liquid", "coefficients", "modes", "baffles"})
"""Keys of a tank on which its slosh modes do not depend; of `liquid` the density does tell."""
_OF_TARE: Final = (
    "wagon",
    *(f"wagon.{body}{mass}" for body in ("car_body", "bogie", "wheelset") for mass in ("", ".mass")),
)
"""Keys on which the load depends where it stands as a gross mass."""


class OutlivedCoefficientsError(ScenarioError):
    """A tank was changed, but not the slosh coefficients given for it, and the liquid's model uses them."""


def with_own_coefficients(tank: _T, document: Document, before: TankBase | None, file: str) -> _T:
    """`tank` with slosh coefficients that belong to it after the overrides of `document`.

    `before` is the tank that given coefficients were given for, None where it is the one of `document` ahead of its
    overrides. Coefficients that a changed tank has outlived are refused where the liquid's model uses them
    (OutlivedCoefficientsError); elsewhere `computed` takes their place, so that no later change brings them back.
    """
    if isinstance(tank.coefficients, str) or document.origin(("tank", "coefficients")).override:
        return tank
    before = before or _tank_of_file(document, tank)
    changed = next(_changes(before, tank, document), None)
    if changed is None:
        return tank
    if tank.liquid.model in _USERS:
        raise OutlivedCoefficientsError(file, [_problem(changed, before, tank, document)])
    return tank.model_copy(update={"coefficients": "computed"})


def shapes_modes(key: str, tank: TankBase) -> bool:
    """Whether the slosh modes of a tank depend on the value at a dotted key path."""
    if tank.gross_mass is not None and key in _OF_TARE:
        return True
    first, *rest = key.split(".")
    if first != "tank" or not rest:
        return first == "tank"
    return rest in (["liquid", "density"], ["liquid"]) or rest[0] not in _WITHOUT_EFFECT


def _tank_of_file(document: Document, tank: TankBase) -> TankBase | None:
    """The tank as the file has it before any override; None where it is no sound tank of the shape of `tank`."""
    original, wagon = (
        document.original.get(key) if isinstance(document.original, dict) else None for key in ("tank", "wagon")
    )
    if not isinstance(original, dict) or original.get("shape") != getattr(tank, "shape", None):
        return None
    try:
        found = type(tank).from_text(original)
        return found.loaded(tare_of(Wagon.from_text(wagon)) if found.gross_mass is not None else None)
    except (ValidationError, ArithmeticError, TypeError):
        return None


def _changes(before: TankBase | None, tank: TankBase, document: Document) -> Iterator[Path]:
    """Paths of what the slosh modes depend on and an override has changed."""
    if before is not None and type(before) is not type(tank):
        yield ("tank", "shape")
        return
    unused = _WITHOUT_EFFECT if before is None else _WITHOUT_EFFECT.union(AMOUNTS)  # the fill tells of them
    names = [name for name in type(tank).model_fields if name not in unused]
    for path in (*(("tank", name) for name in names), ("tank", "liquid", "density")):
        if document.origin(path).override if before is None else not _same(_value(before, path), _value(tank, path)):
            yield path


def _same(one: Any, other: Any) -> bool:
    """Whether two values are equal but for the rounding that a change of units leaves behind."""
    return math.isclose(one, other, rel_tol=1e-12) if isinstance(one, float) else bool(one == other)


def _value(tank: TankBase, path: Path) -> Any:
    value: Any = tank
    for name in path[1:]:
        value = getattr(value, str(name))
    return value


def _problem(path: Path, before: TankBase | None, tank: TankBase, document: Document) -> Problem:
    key = ".".join(map(str, path))
    likely = [given for part in ("tank", "wagon") for given in document.overrides if part in given]
    override = document.origin(path).override or next(iter(likely), key)
    rule = "must stay as it is, because the given slosh coefficients belong to the unchanged tank"
    given = _words(tank, path)
    if before is not None and type(before) is type(tank):
        given += f" instead of {_words(before, path)}"
    fix = "set `tank.coefficients=computed` as well, or give the coefficients of the changed tank"
    return Problem(None, key, rule, given, fix, override)


def _words(tank: TankBase, path: Path) -> str:
    value, part = _value(tank, path), type(tank.liquid) if len(path) > 2 else type(tank)
    leaf = spot_of(part, str(path[-1])).leaf
    if isinstance(leaf, Quantity):
        return f"`{shown(value)} {leaf.unit}`"
    return plain(value)
