"""The command tree. A new command is one module here: a function `register(app)`, named in `_MODULES`."""

from typing import Annotated, Final

import typer

from slosh_cli.cli import check, init, plot, run, schema, sweep, tank, validate
from slosh_cli.cli.output import say
from slosh_cli.version import __version__

_MODULES: Final = (init, check, run, sweep, tank, plot, schema, validate)

_EPILOG: Final = (
    "Exit codes: 0 done, 1 a validation fell short, 2 the input is wrong, 3 a run ended without an answer, "
    "130 interrupted."
)

# Plain help without markup: rich would take longer to load than everything else that --help needs.
app = typer.Typer(
    name="slosh",
    epilog=_EPILOG,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.callback(invoke_without_command=True)
def slosh(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Print the version and leave.")] = False,
) -> None:
    """Tank wagons with a sloshing liquid, braking on a real track.

    Start with `slosh init`, look at the scenario it writes, then `slosh run` it.
    """
    if version:
        say(f"slosh {__version__}")
        raise typer.Exit
    if context.invoked_subcommand is None:
        say(context.get_help())


for _module in _MODULES:
    _module.register(app)
