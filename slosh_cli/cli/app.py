"""The command tree. A new command NAME is a key of _COMMANDS and a module NAME here with a function NAME_command.

What has commands of its own is a `typer.Typer` instead of a function.
"""

from importlib import import_module
from typing import Annotated, Final

import typer

from slosh_cli.cli.output import say
from slosh_cli.version import __version__

_COMMANDS: Final = {
    "init": "tutorial", "presets": "presets", "check": "scenario", "run": "runs", "sweep": "studies", "find": "find",
    "optimum": "find", "compare": "which-liquid", "tank": "tank", "plot": "gallery", "report": "tutorial",
    "animate": "gallery", "schema": "keys", "validate": "theory",
}  # fmt: skip
"""In the order of the help, each with the page of the documentation that shows it."""

_EPILOG: Final = (
    "Exit codes: 0 done, 1 a validation fell short, 2 the input is wrong, 3 a run ended without an answer, "
    "130 interrupted.\n\n"
    "Documentation in the source tree: docs/tutorial.md (your wagon in 20 minutes), docs/index.md (all pages), "
    "docs/keys.md, docs/commands.md and docs/answers.md (every key, command and answer); `make docs` builds them."
)


def tree(word: str = "") -> typer.Typer:
    """The tree; where `word`, the first one given, is a command, that command alone: the others take time to set up."""
    # Plain help without markup: rich would take longer to load than everything else that --help needs.
    app = typer.Typer(
        name="slosh",
        epilog=_EPILOG,
        rich_markup_mode=None,
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback(invoke_without_command=True)(_slosh)
    for command in (word,) if word in _COMMANDS else _COMMANDS:
        found = getattr(import_module(f"slosh_cli.cli.{command}"), f"{command}_command")
        page = f"Documentation: docs/{_COMMANDS[command]}.md in the source tree."
        if isinstance(found, typer.Typer):
            for inner in found.registered_commands:
                inner.epilog = page
            app.add_typer(found, name=command, epilog=page)
        else:
            app.command(command, epilog=page)(found)
    return app


def _slosh(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version and exit.")] = False,
) -> None:
    """Tank wagons with a sloshing liquid, braking on a real track.

    Start with `slosh init --wagon zacns-like --load '60 %'`, look at the scenario it writes, then `slosh run` it.
    """
    if version:
        say(f"slosh {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        say(context.get_help())
