"""The pages of commands and of presets."""

from __future__ import annotations

import re
from typing import Any

import typer
from reference_keys import cell

from slosh_cli.cli.app import tree
from slosh_cli.scenario.presets import DEFAULT, Preset, every_preset

COMMANDS = """# Every command

Made by `make pages` from the code itself.

`--help` after a command says the same. `[...]` marks what may be left out.
"""
PRESETS = """# Every preset

Made by `make pages` from the code itself.

A part of a scenario takes a preset by `use: NAME`; keys beside it hold against it. `slosh presets NAME` prints one. The
standing says how sure a value is: *published* in the source named, *measured*, or *assumed*.
"""


def commands_page() -> str:
    """``commands.md``."""
    app: Any = typer.main.get_command(tree())
    told = paragraphs(app.epilog).split("\n\n")[0]
    return f"{COMMANDS}\n{told}\n" + "".join(
        command_text(f"slosh {name}", one, "##") for name, one in app.commands.items()
    )


def command_text(called: str, command: Any, level: str) -> str:
    """One command, or the commands below it."""
    said = f"\n{level} {called}\n\n{{usage}}{paragraphs(command.help)}"
    if hasattr(command, "commands"):
        inner = (command_text(f"{called} {name}", one, f"{level}#") for name, one in command.commands.items())
        return said.format(usage="") + "".join(inner)
    given = [one for one in command.params if one.param_type_name == "argument"]
    options = [one for one in command.params if one.param_type_name == "option"]
    words = [called, *map(argument, given), *(["[OPTIONS]"] if options else [])]
    rows = [f"| `{cell(argument(one))}` | {cell(one.help or '')} |\n" for one in given]
    for one in options:
        preset = f" Default: `{one.default}`." if one.show_default and not one.is_flag and one.default else ""
        rows.append(f"| {names(one)} | {'**Required.** ' if one.required else ''}{cell(one.help or '')}{preset} |\n")
    table = f"\n| argument or option | meaning |\n|---|---|\n{''.join(rows)}" if rows else ""
    page = re.sub(r"docs/([\w-]+\.md).*", r"[docs/\1](\1).", paragraphs(command.epilog))
    return said.format(usage=f"```text\n{' '.join(words)}\n```\n\n") + f"{table}\n{page}"


def argument(one: Any) -> str:
    """An argument as it is typed."""
    name = (one.metavar or one.name.upper()).replace("...", "").strip("[] ")
    many = "..." if one.nargs == -1 else ""
    return f"{name}{many}" if one.required else f"[{name}]{many}"


def names(one: Any) -> str:
    """The names of an option with what follows them."""
    value = "" if one.is_flag else f" {one.metavar or one.type.name.upper()}"
    return ", ".join(f"`{name}{value}`" for name in sorted(one.opts, key=len))


def paragraphs(text: str | None) -> str:
    """A help text, one line a paragraph."""
    return "\n\n".join(" ".join(part.split()) for part in (text or "").split("\n\n") if part.strip()) + "\n"


def presets_page() -> str:
    """``presets.md``."""
    texts = [PRESETS]
    kinds: dict[str, list[Preset]] = {}
    for preset in every_preset().values():
        kinds.setdefault(preset.kind, []).append(preset)
    for kind, presets in kinds.items():
        texts.append(f"\n## {'Default' if kind == DEFAULT else kind.capitalize() + 's'}\n")
        texts += map(preset_section, presets)
    return "".join(texts)


def preset_section(preset: Preset) -> str:
    """One preset: title, values, densities."""
    number = "" if preset.un is None else f" UN number {preset.un}."
    rows = [
        f"| `{'.'.join(map(str, path))}` | `{leaf.value}` | {leaf.standing} | {cell(leaf.source)} |\n"
        for path, leaf in preset.leaves.items()
    ]
    points = ", ".join(f"{density:g} kg/m^3 at {celsius:g} C" for celsius, density in preset.density_at)
    dense = f"\nDensity: {points}; linear between these points.\n" if points else ""
    return (
        f"\n### {preset.name}\n\n{preset.title}.{number}\n\n| key | value | standing | source |\n|---|---|---|---|\n"
        + ("".join(rows) + dense)
    )
