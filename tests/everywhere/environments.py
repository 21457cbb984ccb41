"""Environments from the lock files, one for each Python there is; the answers that each of them gives."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from . import say
from .comparison import compared

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "outputs" / "everywhere"
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
OLDEST = ("3.11", ".ci/oldest.lock")
PLAIN_PROCESSOR = {"NUMBA_CPU_NAME": "generic", "NUMBA_CPU_FEATURES": ""}
"""Kernels for any processor of the family, without the instructions of this one."""


def python_of(release: str) -> str | None:
    """An interpreter of that release: on the path, or where pyenv keeps them."""
    homes = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    candidates = [*map(str, sorted(homes.glob(f"{release}.*/bin/python"))), shutil.which(f"python{release}")]
    for one in filter(None, candidates):
        asked = subprocess.run([one, "--version"], capture_output=True, text=True, check=False)
        if re.match(rf"Python {re.escape(release)}\.", asked.stdout):
            return one
    return None


def uv(*words: str | Path) -> None:
    """Run uv; it installs what the hashes of a lock allow, and wheels only."""
    subprocess.run([Path(sys.executable).with_name("uv"), *words], check=True)


def answers_in(name: str, python: str, lock: str, more: dict[str, str]) -> Path:
    """The file with the answers that an environment of this lock gives; one of an earlier call is not taken."""
    home, file = FOLDER / name, FOLDER / f"{name}.json"
    uv("venv", "--quiet", "--clear", "--python", python, home / "venv")
    own = home / "venv" / "bin" / "python"
    uv("pip", "sync", "--quiet", "--python", own, "--require-hashes", "--only-binary", ":all:", ROOT / lock)
    environment = os.environ | {"XDG_CACHE_HOME": str(home / "cache"), **more}
    with file.open("w", encoding="utf-8") as out:
        subprocess.run([own, "-m", "tests.everywhere"], cwd=ROOT, env=environment, stdout=out, check=True)
    return file


def everywhere() -> int:
    """Print the comparison of all environments; 1 where an answer differs by more than it may."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    wanted = [("oldest", *OLDEST, {}), ("plain-processor", "3.11", "requirements.lock", PLAIN_PROCESSOR)]
    wanted += [(f"locked-{release}", release, "requirements.lock", {}) for release in PYTHONS]
    found = [(name, python_of(release), release, lock, more) for name, release, lock, more in wanted]
    for name, python, release, lock, _ in found:
        missing = f"not tried, there is no Python {release} on this machine"
        say(f"{name}: {missing if python is None else f'{python}, {lock}'}")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        files = list(pool.map(lambda one: answers_in(*one), [(a, b, d, e) for a, b, _, d, e in found if b is not None]))
    files.sort(key=lambda file: not file.stem.startswith("locked"))
    return compared(files)
