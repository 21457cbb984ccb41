"""Kept machine code is that of these sources, written by this user, whole; or it is not run."""

import ast
import os
import pickle
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from itertools import cycle
from pathlib import Path
from tempfile import mkdtemp
from types import FunctionType

import pytest

import slosh_cli
from slosh_cli.blocks import Block
from slosh_cli.kernel_store import KernelStore, digest, known_as, source_files
from slosh_cli.wagon.brake import Brake

PACKAGE = Path(slosh_cli.__file__).parent
BUILD = "0123456789abcdef"
NOBODY = 65534

PROBE = """
from slosh_cli.compiled import kernel

@kernel
def twice(brake):
    torque, _ = brake.torque(0, 1.0, 0.0)
    return 2.0 * torque
"""
ASK = """
from slosh_cli import compiled
from slosh_cli.wagon.brake import torque_brake
from slosh_cli.wagon.probe import twice
value = twice(torque_brake(100.0, 0.5).replaced(breaks=1))
print(value, sum(twice.stats.cache_hits.values()), bool(compiled.not_kept()))
"""
"""Prints the torque that the compiled code gives, how often it was kept code, and whether nothing can be kept."""


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """The package in a place of its own, with a kernel that calls one in another file."""
    shutil.copytree(PACKAGE, tmp_path / "copy" / "slosh_cli", ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "copy/slosh_cli/wagon/probe.py").write_text(PROBE)
    return tmp_path / "copy"


def ask(copy: Path, *command: str, **environment: object) -> tuple[float, int, bool]:
    """What the probe answers in a process of its own: torque, kernels that were kept, nothing can be kept."""
    site = [path for path in sys.path if path.endswith("site-packages")]
    given = {"PYTHONPATH": os.pathsep.join([str(copy), *site]), "PYTHONDONTWRITEBYTECODE": "1"}
    given |= {name: str(value) for name, value in environment.items()}
    cleared = {"NUMBA_CACHE_DIR": "", "XDG_CACHE_HOME": ""}
    run = subprocess.run(
        [*(command or (sys.executable,)), "-c", ASK], cwd="/", env=os.environ | cleared | given,
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert run.returncode == 0, run.stderr
    assert run.stderr == ""
    value, hits, unkept = run.stdout.split()
    return float(value), int(hits), unkept == "True"


def edit_the_callee(copy: Path) -> None:
    file = copy / "slosh_cli/wagon/brake.py"
    text = file.read_text()
    assert "return pull * value," in text
    file.write_text(text.replace("return pull * value,", "return 0.5 * pull * value,"))


def places_that_refuse(folder: Path) -> dict[str, dict[str, object]]:
    (folder / "file").write_text("")
    return {
        "a file in place of the folder": {"XDG_CACHE_HOME": folder / "file"},
        "a device": {"NUMBA_CACHE_DIR": "/dev/null"},
    }


def test_an_edited_callee_counts_where_nothing_can_be_kept(copy: Path, tmp_path: Path) -> None:
    before = sorted(copy.rglob("*"))
    refusing = places_that_refuse(tmp_path)
    for environment in refusing.values():
        assert ask(copy, **environment) == (200.0, 0, True)
    edit_the_callee(copy)
    for environment in refusing.values():
        assert ask(copy, **environment) == (100.0, 0, True)
    assert sorted(copy.rglob("*")) == before  # and nothing beside the sources


def test_kernels_are_kept_where_that_is_possible_and_an_edited_callee_counts(copy: Path, tmp_path: Path) -> None:
    home = {"XDG_CACHE_HOME": tmp_path / "cache"}
    assert ask(copy, **home) == (200.0, 0, False)
    assert ask(copy, **home) == (200.0, 1, False)
    edit_the_callee(copy)
    assert ask(copy, **home) == (100.0, 0, False)
    assert len(list((tmp_path / "cache/slosh/kernels").iterdir())) == 2


def test_damaged_files_are_compiled_anew_and_replaced(copy: Path, tmp_path: Path) -> None:
    home = {"NUMBA_CACHE_DIR": tmp_path / "cache"}
    ask(copy, **home)
    files = sorted((tmp_path / "cache").rglob("*.nbc"))
    assert len(files) >= 2
    for file, damage in zip(files, cycle((_one_bit_turned, lambda content: content[:-7])), strict=False):
        file.write_bytes(damage(file.read_bytes()))
    assert ask(copy, **home) == (200.0, 0, False)
    assert ask(copy, **home) == (200.0, 1, False)


def _one_bit_turned(content: bytes) -> bytes:
    middle = len(content) // 2
    return content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :]


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="needs root, to step down from")
def test_a_user_without_a_home_can_run_and_kernels_of_others_are_not_run(copy: Path) -> None:
    open_to_all = Path(mkdtemp())  # pytest's own folder lets nobody in
    try:
        shutil.copytree(copy, open_to_all / "copy")
        open_to_all.chmod(0o755)
        nobody = _python_of_nobody()
        home = {"HOME": "/nonexistent"}
        assert ask(open_to_all / "copy", *nobody, **home) == (200.0, 0, True)
        edit_the_callee(open_to_all / "copy")
        assert ask(open_to_all / "copy", *nobody, **home) == (100.0, 0, True)
        shared = open_to_all / "shared"
        shared.mkdir()
        shared.chmod(0o1777)
        cache = {"NUMBA_CACHE_DIR": shared}
        assert ask(open_to_all / "copy", *nobody, **cache) == (100.0, 0, False)
        assert ask(open_to_all / "copy", **cache) == (100.0, 0, False)  # root does not run what nobody wrote
        assert ask(open_to_all / "copy", *nobody, **cache) == (100.0, 1, False)
    finally:
        shutil.rmtree(open_to_all)


def _python_of_nobody() -> list[str]:
    """Words that start this version of Python as a user without rights; skips the test where there is none."""
    down = ["setpriv", f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"]
    site = [path for path in sys.path if path.endswith("site-packages")]
    version = f"import sys, numba; assert sys.version_info[:2] == {sys.version_info[:2]!r}"
    for python in (sys.executable, "/usr/bin/python3"):
        words = [*down, python]
        environment = os.environ | {"PYTHONPATH": os.pathsep.join(site), "NUMBA_CACHE_DIR": ""}
        if (
            shutil.which("setpriv")
            and not subprocess.run(
                [*words, "-c", version], env=environment, cwd="/", capture_output=True, check=False
            ).returncode
        ):
            return words
    pytest.skip("no Python that nobody may run")


# --- the store itself


@pytest.fixture
def store(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> KernelStore:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "cache"))
    found = KernelStore(BUILD)
    assert (found.folder, found.trouble) == (tmp_path / "cache" / BUILD, "")
    return found


def test_what_was_kept_comes_back_for_its_own_name_and_signature_alone(store: KernelStore) -> None:
    store.save("module.f-1", ("float64",), [1, 2], pickle.dumps)
    store.save("module.f-1", ("int64",), [3], pickle.dumps)
    assert store.load("module.f-1", ("float64",)) == [1, 2]
    assert store.load("module.f-1", ("int64",)) == [3]
    assert store.load("module.f-1", ("bool",)) is None
    assert store.load("module.g-1", ("int64",)) is None
    assert KernelStore(BUILD).load("module.f-1", ("int64",)) == [3]
    assert KernelStore("f" * 16).load("module.f-1", ("int64",)) is None


def test_a_file_that_is_another_signatures_is_not_taken(store: KernelStore) -> None:
    store.save("module.f-1", 1, "one", pickle.dumps)
    store.save("module.f-1", 2, "two", pickle.dumps)
    assert store.folder is not None
    one, two = store.folder.glob("*.nbc")
    shutil.copyfile(one, two)
    assert sorted([store.load("module.f-1", 1) or "", store.load("module.f-1", 2) or ""])[0] == ""


def test_a_kernel_is_held_once_it_was_kept(store: KernelStore) -> None:
    store.save("slosh_cli.solver.advance.advance_all-12", 1, 1, pickle.dumps)
    store.save("slosh_cli.solver.advance._step-12", 1, 1, pickle.dumps)
    assert not store.holds("advance.advance")  # what it calls may be kept, it must still be compiled
    store.save("slosh_cli.solver.advance.advance-99", 1, 1, pickle.dumps)
    assert store.holds("advance.advance")
    assert not store.holds("cells.cells")


def test_the_kernels_that_commands_ask_for_are_there() -> None:
    """What the announcements look for by name."""
    from slosh_cli.solver import advance, excite_kernels

    for module, name in ((advance, "advance"), (excite_kernels, "modal_history"), (excite_kernels, "cells_history")):
        assert callable(getattr(module, name))


@pytest.mark.parametrize(
    "damage", [lambda content: content[:-7], lambda _: b"", lambda _: b"garbage" * 50, _one_bit_turned]
)
def test_a_damaged_file_is_not_taken_and_is_replaced(store: KernelStore, damage: Callable[[bytes], bytes]) -> None:
    store.save("module.f-1", 1, "one", pickle.dumps)
    assert store.folder is not None
    (file,) = store.folder.glob("*.nbc")
    file.write_bytes(damage(file.read_bytes()))
    assert store.load("module.f-1", 1) is None
    store.save("module.f-1", 1, "one", pickle.dumps)
    assert store.load("module.f-1", 1) == "one"


@pytest.mark.skipif(os.name != "posix", reason="owners and permission bits")
def test_what_others_can_write_is_not_run(store: KernelStore, monkeypatch: pytest.MonkeyPatch) -> None:
    store.save("module.f-1", 1, "one", pickle.dumps)
    assert store.folder is not None
    (file,) = store.folder.glob("*.nbc")
    file.chmod(0o664)
    assert store.load("module.f-1", 1) is None
    file.chmod(0o644)
    assert store.load("module.f-1", 1) == "one"
    store.folder.chmod(0o777)
    other = KernelStore(BUILD)
    assert other.folder == store.folder.with_name(f"{BUILD}-{os.geteuid()}")
    assert other.load("module.f-1", 1) is None
    store.folder.chmod(0o755)
    monkeypatch.setattr(os, "geteuid", lambda: 4321)  # somebody else comes
    if file.stat().st_uid:
        assert KernelStore(BUILD).load("module.f-1", 1) is None


@pytest.mark.skipif(os.name != "posix", reason="links")
def test_a_link_in_place_of_the_folder_is_not_followed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / BUILD).symlink_to(tmp_path / "elsewhere")
    assert KernelStore(BUILD).folder != tmp_path / BUILD


def test_a_full_disk_keeps_nothing_and_says_so(store: KernelStore, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    store.save("module.f-1", 1, "one", pickle.dumps)
    assert "No space left on device" in store.trouble
    assert store.folder is not None
    assert list(store.folder.iterdir()) == []


def test_without_a_home_or_sources_nothing_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def nowhere(*_: object) -> Path:
        raise RuntimeError("Could not determine home directory.")

    for variable in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME", "LOCALAPPDATA"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setattr(Path, "home", nowhere)
    lost = KernelStore(BUILD)
    assert (lost.folder, lost.trouble) == (None, "there is no home folder")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    unknown = KernelStore("")
    assert (unknown.folder, unknown.trouble) == (None, "the program's own sources cannot be read")
    assert list(tmp_path.iterdir()) == []


def test_builds_that_nobody_has_used_for_long_go(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NUMBA_CACHE_DIR", "")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    kernels = tmp_path / "slosh" / "kernels"
    old, recent, foreign = kernels / ("a" * 16), kernels / ("b" * 16), kernels / "notes"
    for folder in (old, recent, foreign):
        folder.mkdir(parents=True)
        (folder / "x.nbc").write_text("x")
    long_ago = time.time() - 100 * 86400
    for folder in (old, foreign):
        os.utime(folder, (long_ago, long_ago))
    KernelStore(BUILD)
    assert {folder.name for folder in kernels.iterdir()} == {recent.name, foreign.name, BUILD}


# --- what the digest covers


def _imports(file: Path) -> Iterator[tuple[str, str, str]]:
    """(module, name, name in here) of all that a module takes from the program, type checking left out."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("slosh_cli"):
            yield from ((str(node.module), alias.name, alias.asname or alias.name) for alias in node.names)
        elif isinstance(node, ast.Import):
            assert not any(alias.name.startswith("slosh_cli") for alias in node.names), f"{file}: import names"


KERNELS = {"kernel", "inner_kernel", "vector_kernel"}


def _with_kernels() -> list[Path]:
    files = sorted(PACKAGE.rglob("*.py"))
    return [file for file in files if ("slosh_cli.compiled", True) in {(m, n in KERNELS) for m, n, _ in _imports(file)}]


def _names_for_kernels(file: Path) -> set[str]:
    """Names that a module uses in kernels, in classes or at its top: all but what only plain functions use."""

    def names(node: ast.AST) -> Iterator[str]:
        if isinstance(node, ast.FunctionDef) and not KERNELS & {ast.unparse(one) for one in node.decorator_list}:
            return
        if isinstance(node, ast.Name):
            yield node.id
        for inner in ast.iter_child_nodes(node):
            yield from names(inner)

    return set(names(ast.parse(file.read_text(encoding="utf-8"))))


def test_every_kernel_lies_in_a_package_that_the_digest_covers() -> None:
    assert len(_with_kernels()) >= 15
    assert set(_with_kernels()) <= set(source_files(PACKAGE))


def test_no_constant_and_no_type_of_a_kernel_comes_from_outside_the_digest() -> None:
    """A number becomes part of the machine code, the fields of a block or a named tuple decide what it reads."""
    covered, reached = source_files(PACKAGE), _with_kernels()
    for file in reached:
        used = _names_for_kernels(file)
        for module, name, name_here in _imports(file):
            if name_here not in used:
                continue
            value = getattr(import_module(module), name)
            plain = isinstance(value, type) and not issubclass(value, tuple | Block)
            if plain or module == "slosh_cli.compiled" or isinstance(value, FunctionType):
                continue
            source = PACKAGE.parent.joinpath(*module.split(".")).with_suffix(".py")
            assert source in covered, f"{file} takes {name} from {module}"
            reached += [source] if source not in reached else []
    assert len(reached) > len(_with_kernels())


def test_the_digest_changes_with_every_byte_of_every_source(tmp_path: Path) -> None:
    shutil.copytree(PACKAGE, tmp_path / "p", ignore=shutil.ignore_patterns("__pycache__"))
    root = tmp_path / "p"
    files = source_files(root)
    first = digest(files, root, "1.0")
    assert digest(files, root, "1.1") != first
    for file in files:
        content = file.read_bytes()
        file.write_bytes(content + b"#")
        assert digest(files, root, "1.0") != first
        file.write_bytes(content)
    assert digest(files, root, "1.0") == first


FOREIGN = """
from slosh_cli.blocks import Block

class Mine(Block):
    {fields}
"""


def test_kernels_made_for_a_foreign_class_go_with_its_source(tmp_path: Path) -> None:
    """A block of a script or a test lies outside the build: with other fields its kernels must not be used again."""
    names = []
    for place, fields in (("a", "one: float"), ("b", "one: float"), ("c", "other: int")):
        file = tmp_path / place / "foreign.py"
        file.parent.mkdir()
        file.write_text(FOREIGN.format(fields=fields))
        spec = spec_from_file_location("foreign", file)
        assert spec is not None
        assert spec.loader is not None
        module = module_from_spec(spec)
        sys.modules["foreign"] = module
        spec.loader.exec_module(module)
        names.append(module.Mine.blank().kind.name)
    del sys.modules["foreign"]
    assert names[0] == names[1] != names[2]
    assert "@" not in known_as(Brake)
    assert known_as(type("Made", (Brake,), {"__module__": "made_up"})).startswith("made_up.Made@")
