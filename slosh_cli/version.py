"""The version of the program, read by the build and stamped into every result, and how its extras are installed."""

__version__ = "0.1.0"


def install_command(extra: str) -> str:
    """The command that installs what an `extra` of the program needs, wherever the program itself came from."""
    from importlib.metadata import PackageNotFoundError, requires  # a message needs it, nothing else

    try:
        found = [line.partition(";") for line in requires("slosh-cli") or ()]
    except PackageNotFoundError:
        found = []
    names = [name.strip() for name, _, marker in found if f"'{extra}'" in marker.replace('"', "'")]
    return " ".join(["python -m pip install", *(f"'{name}'" for name in names or (f".[{extra}]",))])
