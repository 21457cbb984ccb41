"""A whole scenario written out of presets, every value with its standing and source."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Path
from slosh_cli.scenario.presets import Preset, Standing, find_preset
from slosh_cli.scenario.schema import parse_scenario
from slosh_cli.scenario.units import plain

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
_ORDER: Final = ("wagon", "tank", "track", "contact", "braking", "limits")


def composed(name: str, chosen: Mapping[str, str]) -> str:
    """The text of a scenario of presets and values.

    `chosen` has presets by their kinds (`wagon`, `track`, `product`, `brake`), `temperature` (a number of degC with or
    without `C`), `gross` and `speed` (texts with units). Raises ValueRefused where a name or the temperature is wrong,
    ScenarioError where the scenario is not sound: a gross mass that does not fit into the tank, say.
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
    leaves[("tank", "gross_mass")] = Standing(chosen["gross"], _CHOSEN, "mass of the wagon with its load")
    leaves[("braking", "initial_speed")] = Standing(chosen["speed"], _CHOSEN, "speed at the start of the run")
    found = _written(name, presets, celsius, leaves)
    parse_scenario(found, name)
    return found


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
