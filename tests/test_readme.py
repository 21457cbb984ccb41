"""What README and reference tell people to type works in an empty folder with the built wheel, in their own order."""

import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import tomllib
import venv
from pathlib import Path

import pytest

from slosh_cli.scenario import parse_scenario
from slosh_cli.version import install_command

ROOT = Path(__file__).parents[1]
PAGES = ("README.md", "docs/scenario.md", "docs/runs.md", "docs/studies.md", "docs/tank.md", "docs/which-liquid.md")
TEXTS = {page: (ROOT / page).read_text(encoding="utf-8") for page in PAGES}
BLOCKS = re.findall(r"^```(\w*)\n(.*?)^```", "\n".join(TEXTS.values()), re.MULTILINE | re.DOTALL)
SHELL = [text for kind, text in BLOCKS if kind in ("", "sh")]
LINES = [line for text in SHELL for line in text.splitlines()]
COMMANDS = [line.partition(" #")[0].strip() for line in LINES if line.startswith("slosh ")]
CLUSTER = [text for text in SHELL if "--cluster" in text]
ON_A_CLUSTER = [command for command in COMMANDS if "--cluster" in command]
CACHE = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")


def run(folder: Path, installed: Path, *words: str, **more: str) -> "subprocess.CompletedProcess[str]":
    """The outcome of a command that finds the programs of the environment `installed` first."""
    left_out = ("PYTHONPATH", "COLUMNS", "VIRTUAL_ENV")
    environment = {key: value for key, value in os.environ.items() if key not in left_out}
    environment["PATH"] = os.pathsep.join([str(installed / "bin"), os.environ["PATH"]])
    environment |= {"MPLBACKEND": "agg", **more}
    child = subprocess.Popen(
        words, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        start_new_session=True,
    )  # fmt: skip
    try:
        out, err = child.communicate(timeout=600)
    finally:
        if child.returncode is None:
            os.killpg(child.pid, signal.SIGKILL)
    return subprocess.CompletedProcess(words, child.returncode, out, err)


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An environment with the wheel and, beside it, the packages of this one; the source tree is out of its sight."""
    scratch = tmp_path_factory.mktemp("wheel")
    build = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-build-isolation", "--quiet", str(ROOT)]
    subprocess.run([*build, "-w", str(scratch)], check=True, cwd=scratch)
    (wheel,) = scratch.glob("*.whl")
    venv.create(scratch / "venv", with_pip=False, symlinks=True)
    (packages,) = (scratch / "venv" / "lib").glob("python*/site-packages")
    others = [path for path in sys.path if path.endswith("site-packages")]
    (packages / "others.pth").write_text("\n".join(others) + "\n", encoding="utf-8")
    python = str(scratch / "venv" / "bin" / "python")
    pip = [sys.executable, "-m", "pip", "--python", python, "install", "--no-deps", "--no-index", "--quiet"]
    subprocess.run([*pip, "--ignore-installed", str(wheel)], check=True, cwd=scratch)
    dask = scratch / "venv" / "bin" / "dask"
    dask.write_text(f'#!/bin/sh\nexec {shlex.quote(python)} -m dask "$@"\n', encoding="utf-8")
    dask.chmod(0o755)
    return scratch / "venv"


def free_port() -> str:
    """A port that nothing on this machine listens on."""
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return str(one.getsockname()[1])


def empty_folder(folder: Path) -> Path:
    """A folder with nothing in it but the files that the pages speak of as the reader's own."""
    folder.mkdir(exist_ok=True)
    (folder / "brake.csv").write_text("time_s,deceleration_m_s2\n0,0\n2,1.5\n")
    (folder / "sway.csv").write_text("time_s,displacement_m\n0,0\n1,0.1\n2,0\n3,-0.1\n4,0\n")
    (study,) = [text for kind, text in BLOCKS if kind == "yaml" and "\nvary:" in text]
    (folder / "study.yaml").write_text(study, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return empty_folder(tmp_path_factory.mktemp("readme"))


def test_the_readme_is_a_front_door() -> None:
    assert len(TEXTS["README.md"].splitlines()) <= 150
    pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"index.md", "validation.md"}
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    assert "docs/index.md" in TEXTS["README.md"]
    assert set(re.findall(r"\]\(([\w.-]+\.md)\)", index.replace("\n", " "))) >= pages


def test_every_link_leads_to_a_file() -> None:
    for page in sorted([ROOT / "README.md", *(ROOT / "docs").glob("*.md")]):
        for link in re.findall(r"\]\((?!https?:)([^)#]+)", page.read_text(encoding="utf-8")):
            made = link == "validation.md"  # when the documentation is built
            assert made or (page.parent / link).is_file(), (page.name, link)


def test_the_pages_have_the_commands_of_every_chapter() -> None:
    assert {shlex.split(command)[1] for command in COMMANDS} >= {
        "init", "check", "run", "plot", "sweep", "tank", "validate",
    }  # fmt: skip


def test_every_line_for_a_shell_is_run_somewhere() -> None:
    """Here, but for setting up (`make`: the gate; `pip`: the fixture `installed`)."""
    others = [line for text in SHELL if text not in CLUSTER for line in text.splitlines() if line[:6] != "slosh "]
    assert {line.partition(" #")[0].strip() for line in others} == {
        "make run", "make test", "pip install .", "python -m pip install '.[cluster]'",
    }  # fmt: skip
    targets = ["run", "test"]
    subprocess.run(["make", "--dry-run", *targets], cwd=ROOT, check=True, capture_output=True)


def test_what_runs_here_is_the_wheel(installed: Path, tmp_path: Path) -> None:
    code = (
        "import slosh_cli; from slosh_cli.scenario.packaged import packaged_scenarios; "
        "print(slosh_cli.__file__, *packaged_scenarios().values(), sep='\\n')"
    )
    outcome = run(tmp_path, installed, "python", "-c", code)
    program, *scenarios = map(Path, outcome.stdout.split())
    (packages,) = (installed / "lib").glob("python*/site-packages")
    assert program == packages / "slosh_cli" / "__init__.py", outcome.stderr
    assert {path.name for path in scenarios} == {path.name for path in (ROOT / "scenarios").glob("*.yaml")}
    assert {path.parent for path in scenarios} == {packages / "slosh_cli" / "scenarios"}
    found = run(tmp_path, installed, "sh", "-c", "command -v slosh").stdout.strip()
    assert Path(found) == installed / "bin" / "slosh"


@pytest.mark.parametrize("command", [command for command in COMMANDS if command not in ON_A_CLUSTER])
def test_every_command_works(folder: Path, installed: Path, command: str) -> None:
    outcome = run(folder, installed, "sh", "-c", command)
    assert outcome.returncode == 0, outcome.stderr
    assert "Traceback" not in outcome.stderr


def test_the_presets_of_the_page_make_a_scenario() -> None:
    (presets,) = [text for kind, text in BLOCKS if kind == "yaml" and "use:" in text]
    contact = "{youngs_modulus: 210 GPa, poisson_ratio: 0.3, rail_crown_radius: 0.3 m, kalker_c11: 4.12, adhesion: dry}"
    scenario = parse_scenario(f"format: 1\nname: mine\n{presets}contact: {contact}\n")
    assert scenario.wagon.car_body.mass == 14e3


def test_the_python_example_works_outside_a_checkout(installed: Path, tmp_path: Path) -> None:
    (example,) = [text for kind, text in BLOCKS if kind == "python"]
    outcome = run(tmp_path, installed, "python", "-c", example)
    assert outcome.returncode == 0, outcome.stderr
    assert re.match(r"stopped \d+\.\d+ m\n", outcome.stdout)


BATCH_SYSTEM = {
    "sbatch": 'until [ -s "$HOME/scheduler.json" ]; do sleep 0.1; done; bash "$1" &',
    "srun": 'exec "$@"',
}
"""Programs of a batch system that has one machine, this one, and starts a job as soon as there is a scheduler."""
ENDING = "status=$?; trap '' TERM; kill 0; exit $status"
"""Ends what a script has left running, with the exit code of its last command."""


@pytest.mark.parametrize("block", CLUSTER, ids=["by hand", "batch system"])
def test_a_cluster_of_this_machine_alone_works(installed: Path, tmp_path: Path, block: str) -> None:
    for name, does in BATCH_SYSTEM.items():
        (tmp_path / name).write_text(f"#!/bin/sh\n{does}\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    folder = empty_folder(tmp_path / "reader")
    assert run(folder, installed, "slosh", "init", "-o", "my_wagon.yaml").returncode == 0
    here = block.replace("that-machine:8786", "127.0.0.1:8786").replace("8786", free_port())
    here = re.sub(r"^(dask [^&#\n]*)(#.*)?$", r"\1 &", here, flags=re.MULTILINE)
    here = here.replace("--nworkers 4 --nthreads 8", "--nworkers 1 --nthreads 2")
    places = {"HOME": str(tmp_path), "TMPDIR": str(tmp_path), "XDG_CACHE_HOME": CACHE, "SLURM_CPUS_PER_TASK": "2"}
    path = os.pathsep.join([str(tmp_path), str(installed / "bin"), os.environ["PATH"]])
    outcome = run(folder, installed, "bash", "-c", f"{here}\n{ENDING}", PATH=path, **places)
    assert outcome.returncode == 0, outcome.stderr
    table = (folder / "outputs/fill-and-adhesion/braking_distance.csv").read_text(encoding="utf-8")
    assert table.count("stopped") == 64, outcome.stderr


@pytest.mark.parametrize("extra", ["cluster", "validation"])
def test_the_command_that_installs_an_extra_names_what_the_package_index_has(extra: str) -> None:
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    needed = tomllib.loads(text)["project"]["optional-dependencies"][extra]
    assert install_command(extra) == "python -m pip install " + " ".join(f"'{name}'" for name in needed)
