"""A whole scenario written out of presets, every value with its standing and source."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Path
from slosh_cli.scenario.leaves import Quantity, Range
from slosh_cli.scenario.presets import Preset, Standing, find_preset
from slosh_cli.scenario.schema import parse_scenario
from slosh_cli.scenario.units import parse_quantity, percentage, plain, shown

_CHOSEN: Final = "chosen"
_ASSUMED: Final = "assumed"
_OTHERS: Final[tuple[tuple[str, str], ...]] = (
    ("tank.liquid.model", "shallow-water"),
    ("contact.youngs_modulus", "210 GPa"),
    ("contact.poisson_ratio", "0.3"),
    ("contact.rail_crown_radius", "0.3 m"),
    ("contact.kalker_c11", "4.12"),
    ("contact.adhesion", "dry"),
    ("braking.onset", "0.5 s"),
)
"""What no preset says."""
_SHARES: Final = (0.8, 1.25)
"""Sizes of a tank over that of its preset: beyond, the wagon under it is another one."""
_VOLUME: Final = Quantity("volume", Range(0.0, 1e5, above=True), "52.8 m^3")
_ORDER: Final = ("wagon", "tank", "track", "contact", "braking", "limits")


def composed(name: str, chosen: Mapping[str, str]) -> str:
    """The text of a scenario of presets and values.

    `chosen` has presets by their kinds (`wagon`, `track`, `product`, `brake`), `temperature` (a number of degC with or
    without `C`), `speed` and one of `gross` and `load` (texts with units; of `load` also per cent of the tank's
    volume). With a `capacity` the tank's length is that of this volume. Raises ValueRefused where a name, the
    temperature, the load or the capacity is wrong, ScenarioError where the scenario is not sound: a gross mass that
    does not fit into the tank, say.
    """
    presets = [find_preset(chosen[kind], kind) for kind in ("wagon", "track", "product", "brake")]
    leaves: dict[Path, Standing] = {}
    for preset in presets:
        leaves |= {
            path: Standing(leaf.value, leaf.standing, f"{preset.name}; {leaf.source}")
            for path, leaf in preset.leaves.items()
        }
    celsius, product = _celsius(chosen["temperature"]), presets[2]
    density = ("tank", "liquid", "density")
    text = f"{round(product.density(celsius), 1)} kg/m^3"
    leaves[density] = Standing(text, leaves[density].standing, f"at {celsius:g} C, {leaves[density].source}")
    leaves |= {tuple(key.split(".")): Standing(value, _ASSUMED, "usual") for key, value in _OTHERS}
    leaves |= _sized(wagon=presets[0].name, leaves=leaves, capacity=chosen.get("capacity"))
    leaves |= _loaded(leaves, chosen)
    leaves[("braking", "initial_speed")] = Standing(chosen["speed"], _CHOSEN, "speed at the start of the run")
    found = _written(name, presets, celsius, leaves)
    parse_scenario(found, name)
    return found


def _sized(wagon: str, leaves: Mapping[Path, Standing], capacity: str | None) -> dict[Path, Standing]:
    """The length of a tank with flat ends of a `capacity`; nothing without one."""
    if capacity is None:
        return {}
    own, wanted = _capacity(leaves), _VOLUME.parse(capacity)
    if not _SHARES[0] <= wanted / own <= _SHARES[1]:
        rule = f"must be from {_SHARES[0]:g} to {_SHARES[1]:g} times the {own:.1f} m^3 of {wagon}"
        raise ValueRefused(rule, plain(capacity), "choose a wagon of `slosh presets` that is nearer to it")
    length = ("tank", "length")
    text = f"{round(_metres(leaves, length) * wanted / own, 3):g} m"
    return {length: Standing(text, _CHOSEN, f"flat ends, so that the tank holds {shown(wanted)} m^3")}


def _loaded(leaves: Mapping[Path, Standing], chosen: Mapping[str, str]) -> dict[Path, Standing]:
    """What is in the tank, by the key that the scenario has for it."""
    if "load" not in chosen:
        told = Standing(chosen["gross"], _CHOSEN, "mass of the wagon with its load")
        return {("tank", "gross_mass"): told}
    load = chosen["load"].strip()
    share, whole = percentage(load), _capacity(leaves)
    if share is not None:
        text = f"{round(share * whole, 3):g} m^3"
        return {("tank", "volume"): Standing(text, _CHOSEN, f"{load} of the {shown(round(whole, 3))} m^3 of the tank")}
    for dimension in ("volume", "mass"):
        try:
            parse_quantity(load, dimension)
        except ValueRefused:
            continue
        return {("tank", dimension): Standing(load, _CHOSEN, f"{dimension} of the liquid")}
    rule = "must be a share of the tank's volume, a volume or a mass of the liquid"
    raise ValueRefused(rule, plain(load), "write such as `60 %`, `52.8 m^3` or `44 t`")


def _capacity(leaves: Mapping[Path, Standing]) -> float:
    """Volume of a preset's tank, a lying cylinder, m^3."""
    return 0.25 * math.pi * _metres(leaves, ("tank", "diameter")) ** 2 * _metres(leaves, ("tank", "length"))


def _metres(leaves: Mapping[Path, Standing], path: Path) -> float:
    return parse_quantity(leaves[path].value, "length", None, "3 m")


def _celsius(text: str) -> float:
    """A temperature in degC."""
    try:
        return float(text.strip().removesuffix("degC").removesuffix("C").removesuffix("°").strip())
    except ValueError:
        raise ValueRefused("must be a temperature in degrees Celsius", plain(text), "write such as `15 C`") from None


def _written(name: str, presets: Sequence[Preset], celsius: float, leaves: Mapping[Path, Standing]) -> str:
    wagon, track, product, brake = presets
    lines = [
        f"# {wagon.title}; {product.title} at {celsius:g} C.",
        "# Every value says its standing (published, measured, assumed, chosen), the preset it is of and its source.",
        "format: 1",
        f"name: {name}",
        f"description: Wagon {wagon.name}, product {product.name}, track {track.name}, brake {brake.name}",
    ]
    tree: dict[str, Any] = {}
    for path, leaf in leaves.items():
        inner = tree
        for step in path[:-1]:
            inner = inner.setdefault(str(step), {})
        inner[str(path[-1])] = leaf
    for part in _ORDER:
        if part in tree:
            lines += ["", f"{part}:", *_lines(tree[part], 1)]
    return "\n".join(lines) + "\n"


def _lines(tree: Mapping[str, Any], depth: int) -> list[str]:
    """A mapping as lines, every value with its comment."""
    found: list[str] = []
    for key, value in tree.items():
        start = f"{'  ' * depth}{key}:"
        if isinstance(value, Standing):
            found.append(f"{f'{start} {value.value}':48}# {value.standing}: {value.source}")
        else:
            found += [start, *_lines(value, depth + 1)]
    return found
