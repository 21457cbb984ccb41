"""What is installed is what was locked, no code comes from data, and the same sources give the same packages."""

import ast
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from importlib.metadata import packages_distributions, requires
from pathlib import Path

import pytest
from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "slosh_cli"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
EXTRAS = PROJECT["optional-dependencies"]
TREES = {
    path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
    for path in sorted(PACKAGE.rglob("*.py"))
}
LOCKS = {
    "requirements.lock": PROJECT["dependencies"] + EXTRAS["dev"],
    ".ci/docs.lock": PROJECT["dependencies"] + EXTRAS["docs"],
    ".ci/validation.lock": PROJECT["dependencies"] + EXTRAS["validation"],
    ".ci/oldest.lock": PROJECT["dependencies"],
}
"""Lock files, and what of pyproject.toml each of them is made from."""

OWN_PICKLES = "kernel_store.py"
"""Compiled kernels, read from a folder and files that nobody but the user can have written."""


def locked(name: str) -> dict[str, tuple[str, list[str]]]:
    """Version and hashes of every package of a lock; where versions differ by Python, those of the oldest."""
    text = re.sub(r"^ *#.*\n", "", (ROOT / name).read_text(encoding="utf-8"), flags=re.MULTILINE).replace("\\\n", " ")
    found: dict[str, tuple[str, list[str]]] = {}
    for line in text.splitlines():
        requirement, *hashes = line.split("--hash=")
        wanted = Requirement(requirement)
        (pin,) = wanted.specifier
        assert pin.operator == "==", line
        if wanted.marker is None or wanted.marker.evaluate({"python_version": "3.11", "python_full_version": "3.11.7"}):
            found[canonicalize_name(wanted.name)] = (pin.version, [one.strip() for one in hashes])
    return found


@pytest.mark.parametrize("lock", LOCKS)
def test_every_package_of_a_lock_has_its_hashes(lock: str) -> None:
    found = locked(lock)
    assert len(found) > 30
    for name, (_, hashes) in found.items():
        assert hashes, name
        assert all(re.fullmatch(r"sha256:[0-9a-f]{64}", one) for one in hashes), name


@pytest.mark.parametrize("lock", LOCKS)
def test_a_lock_has_what_the_project_asks_for(lock: str) -> None:
    found = locked(lock)
    for text in LOCKS[lock]:
        wanted = Requirement(text)
        assert canonicalize_name(wanted.name) in found, f"{lock} lacks {text}; run `make lock`"
        version, _ = found[canonicalize_name(wanted.name)]
        assert wanted.specifier.contains(version), f"{lock} has {version} for {text}; run `make lock`"


def test_locks_of_one_environment_agree() -> None:
    first = locked("requirements.lock")
    for other in (".ci/docs.lock", ".ci/validation.lock"):
        found = locked(other)
        assert not {name for name in first.keys() & found.keys() if first[name] != found[name]}, other


def test_the_oldest_lock_has_the_oldest_versions_that_the_project_allows() -> None:
    found = locked(".ci/oldest.lock")
    for wanted in map(Requirement, PROJECT["dependencies"]):
        (least,) = wanted.specifier
        assert least.operator == ">="
        version, _ = found[canonicalize_name(wanted.name)]
        assert f"{version}.0.0".startswith(f"{least.version}."), f"{wanted}, but {version} is the oldest that is tried"


def test_make_installs_by_hashes_and_nothing_else() -> None:
    recipes = subprocess.run(
        ["make", "--dry-run", "--always-make", "docs"], cwd=ROOT, capture_output=True, text=True, check=True
    )
    installs = [line for line in recipes.stdout.splitlines() if " install " in line]
    assert len(installs) == 3
    for line in installs:
        assert "--require-hashes --only-binary :all: -r " in line or "--no-deps --no-build-isolation -e ." in line


def calls(module: str) -> Iterator[str]:
    """Every call of a module as it is written, without what it is called on where that is an expression."""
    for node in ast.walk(TREES[module]):
        if isinstance(node, ast.Call):
            yield ast.unparse(node.func)


@pytest.mark.parametrize("module", TREES)
def test_no_code_comes_from_data(module: str) -> None:
    runs_code = {"eval", "exec", "compile", "__import__", "yaml.load", "yaml.unsafe_load", "yaml.full_load"}
    runs_code |= {"os.system", "os.popen", "marshal.loads", "marshal.load", "shelve.open", "pd.read_pickle"}
    assert not runs_code & set(calls(module))
    if module != OWN_PICKLES:
        assert not {name for name in calls(module) if re.search(r"\b(c?loud)?pickle\.|^(loads|Unpickler)$", name)}
    for node in ast.walk(TREES[module]):
        if isinstance(node, ast.keyword):
            assert node.arg not in {"allow_pickle", "shell"}, node.lineno
    imported = {alias.name.partition(".")[0] for node in ast.walk(TREES[module]) if isinstance(node, ast.Import)
                for alias in node.names}  # fmt: skip
    assert not imported & {"torch", "dill", "joblib", "marshal", "shelve", "cloudpickle"}
    assert "pickle" not in imported or module == OWN_PICKLES


def test_yaml_makes_plain_values_only() -> None:
    from slosh_cli.scenario import yaml_text

    bases = {base.__name__ for base in yaml_text._Loader.__mro__}
    assert "SafeLoader" in bases
    assert not bases & {"FullLoader", "UnsafeLoader", "Loader"}


def needed() -> set[str]:
    """Distributions that come with slosh where no extra is asked for."""
    found, ahead = set(), ["slosh-cli"]
    while ahead:
        name = canonicalize_name(ahead.pop())
        if name in found:
            continue
        found.add(name)
        for text in requires(name) or []:
            wanted = Requirement(text)
            if wanted.marker is None or wanted.marker.evaluate({**default_environment(), "extra": ""}):
                ahead.append(wanted.name)
    return found


ALONE = """
import importlib, pkgutil, sys
class Blocked:
    def find_spec(self, name, path=None, target=None):
        if name.partition(".")[0] in BLOCKED:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
sys.meta_path.insert(0, Blocked())
import slosh_cli
for one in pkgutil.walk_packages(slosh_cli.__path__, "slosh_cli."):
    importlib.import_module(one.name)
from slosh_cli.cli import main
sys.argv = ["slosh", "check", SCENARIO]
main()
"""


def test_nothing_but_the_dependencies_is_needed() -> None:
    base = needed()
    others = {
        module
        for module, owners in packages_distributions().items()
        if not base & {canonicalize_name(owner) for owner in owners} and not module.startswith("_")
    }
    assert {"distributed", "dask", "xarray", "pytest"} <= others
    code = f"BLOCKED = {others!r}\nSCENARIO = {str(ROOT / 'scenarios' / 'paper_80.yaml')!r}\n{ALONE}"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    assert "paper-80" in run.stdout


def built(sources: Path, out: Path, **environment: str) -> dict[str, str]:
    """Digests of the sdist and the wheel built from `sources`, by their names."""
    run = [sys.executable, "-m", "hatchling", "build", "-d", str(out)]
    subprocess.run(run, cwd=sources, check=True, capture_output=True, env={**os.environ, **environment})
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in out.iterdir()}


def test_the_same_sources_give_the_same_packages_byte_for_byte(tmp_path: Path) -> None:
    """From a copy of other times, rights, order, time zone and language."""
    left_out = shutil.ignore_patterns(".git", ".venv", ".*_cache", "outputs", "__pycache__", ".hypothesis", ".ci-venv")
    copy = shutil.copytree(ROOT, tmp_path / "copy", ignore=left_out, copy_function=shutil.copyfile)
    (copy / "outputs").mkdir()
    shutil.copyfile(ROOT / "outputs" / ".gitkeep", copy / "outputs" / ".gitkeep")
    again = shutil.copytree(copy, tmp_path / "again", copy_function=shutil.copyfile)
    for path in again.rglob("*"):
        path.chmod(0o700 if path.is_dir() else 0o600)
        os.utime(path, (1e9, 1e9))
    epoch = {"SOURCE_DATE_EPOCH": "1700000000"}
    here = built(copy, tmp_path / "first", TZ="UTC", LANG="C", PYTHONHASHSEED="1", **epoch)
    there = built(again, tmp_path / "second", TZ="Asia/Tokyo", LANG="C.UTF-8", PYTHONHASHSEED="2", **epoch)
    assert len(here) == 2
    assert here == there
