"""What is kept besides an answer: files that may fail one by one, and the folder they go to."""

import hashlib
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.errors import SloshError

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario, TankScenario
    from slosh_cli.scenario.train_file import TrainScenario

_OUTPUTS: Final = Path("outputs")
_LONGEST: Final = 80
"""Characters of a folder's name that tell what was set; more are told by a hash."""


class Keeping:
    """The files of one answer. One that fails costs itself alone: `failures` tell of it, `causes` are the errors."""

    def __init__(self) -> None:
        self.failures: list[str] = []
        self.causes: list[Exception] = []

    @contextmanager
    def part(self, what: str) -> Iterator[None]:
        """Let the block write `what`; whatever goes wrong in it is noted and does not go further."""
        try:
            yield
        except Exception as error:  # of any library: the answer is there, and must be told
            from slosh_cli.results.files import words_of

            first = error.__cause__ if isinstance(error.__cause__, OSError) else error
            system = words_of(first) if isinstance(first, OSError) else None
            kind = "" if isinstance(error, SloshError | OSError) else f"{type(error).__name__}: "
            self.failures.append(f"{what} could not be written: {kind}{system or error}")
            self.causes.append(error)

    def keep(
        self,
        folder: Path,
        owned: Sequence[str],
        together: Mapping[str, Callable[[Path], object]],
        then: Mapping[str, Callable[[Path], object]],
    ) -> list[str]:
        """Write files into `folder`; returns those of the names `owned` that are there afterwards, as paths.

        together: file name -> what writes it to a path; they appear at once, and what an earlier command left of
        `owned` goes, unless none of them could be written. then: figure -> what draws it into a folder, one after the
        other.
        """
        from slosh_cli.results.files import FileError, staging

        begun = False
        with self.part(str(folder)):
            with staging(folder, owned=owned) as stage:
                for name, write in together.items():
                    with self.part(str(folder / name)):
                        write(stage / name)
                if not any(stage.iterdir()) and any((folder / name).is_file() for name in owned):
                    raise FileError("there is room for none of the files; what an earlier command left there stays")
            begun = True
        if not begun:  # what lies there is of an earlier command, as it was
            return []
        for name, draw in then.items():
            with self.part(f"the figure {folder / name}"):
                draw(folder)
        return [str(folder / name) for name in owned if (folder / name).is_file()]


def by_kind(files: Sequence[str], **kinds: str) -> dict[str, Any]:
    """Files as the JSON object names them: `kinds` is kind -> file name, all others are figures."""
    named = {kind: file for kind, name in kinds.items() for file in files if Path(file).name == name}
    return named | {"figures": [file for file in files if file not in named.values()]}


def default_folder(name: str, settings: Sequence[str] | None = None) -> Path:
    """``outputs/NAME``, or ``outputs/NAME-braking.torque=12-kN-m`` where `settings` (KEY=VALUE) were given.

    Who sets the name says by it what the settings are.
    """
    by_key = {text.partition("=")[0].strip(): text.strip() for text in settings or ()}
    told = sorted(text for key, text in by_key.items() if key != "description")
    if not told or "name" in by_key:
        return _OUTPUTS / name
    words = "-".join(re.sub(r"[^\w.=+,-]+", "-", text) for text in told)
    if len(words) > _LONGEST:
        words = f"{words[: _LONGEST - 9]}-{hashlib.sha256(' '.join(told).encode()).hexdigest()[:8]}"
    return _OUTPUTS / f"{name}-{words.rstrip('-.')}"


def free_folder(default: Path, fits: Callable[[Path], bool], note: Callable[[str], None]) -> Path:
    """`default`, or it with a number where it holds the results of something else: nothing is overwritten.

    `fits` says whether a folder is free for this work, or holds earlier results of the same; `note` is told of another.
    """
    number, folder = 1, default
    while folder.exists() and not fits(folder):
        number += 1
        folder = default.with_name(f"{default.name}-{number}")
    if folder != default:
        note(f"{default} holds the results of other settings; these go to {folder}")
    return folder


def folder_of_run(
    scenario: "Scenario | TankScenario | TrainScenario",
    given: Path | None,
    settings: Sequence[str] | None,
    files: Sequence[str],
    note: Callable[[str], None],
    prescribed: str = "",
) -> Path:
    """The folder that takes `files`: that `given`, else one of its own, unless there lies a run of the same scenario.

    The first of `files` is the history, which says what it is of; `prescribed` is what else tells it from others.
    Raises FileError where the folder cannot take the files.
    """
    from slosh_cli.results.files import try_targets
    from slosh_cli.results.hdf5 import is_of

    def fits(folder: Path) -> bool:
        history = folder / files[0]
        return not history.exists() or is_of(history, scenario, prescribed)

    folder = given or free_folder(default_folder(scenario.name, settings), fits, note)
    try_targets(folder, files)
    return folder
