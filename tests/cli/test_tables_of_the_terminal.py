"""Tables at every width of a terminal: a number is never cut, whatever else has to give way."""

import re

import pytest
from rich import box
from rich.table import Table
from stand_ins import Slosh

from slosh_cli.cli.output import show

WIDTHS = [60, 80, 120]
NUMBERS = ["1234.56", "664.18", "0.61", "12345.7", "1.23e-07", "99999.99", "18.4", "26.2"]


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("no_wrap", [True, False])
def test_no_number_is_cut(
    width: int, no_wrap: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A name gives way first, and the table is wider than the terminal where that is not enough."""
    monkeypatch.setenv("COLUMNS", str(width))
    table = Table(box=box.SIMPLE_HEAD, show_edge=False)
    table.add_column("vehicle", overflow="fold")
    for number in range(len(NUMBERS)):
        table.add_column(f"answer {number}\n/ (km/h)", justify="right", no_wrap=no_wrap)
    table.add_row("a wagon of a name as long as this_one_without_any_space_in_it", *NUMBERS)
    show(table)
    printed = capsys.readouterr().out
    assert "…" not in printed
    assert set(NUMBERS) <= set(printed.split())


def test_the_tables_of_a_run_and_a_sweep_hold_their_numbers(slosh: Slosh, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same numbers stand on a narrow terminal and on a wide one."""
    rigid = ["--set", "tank.liquid.model=rigid", "--set", "solver.tolerance=1e-3"]
    shown = "unloading,distance,braking_time_s,weight_N,energy_residual,first_lock"
    sweep = ["sweep", "paper-80-solid", "--vary", "braking.torque=5000.25,6000.5 N m", "--show", shown, "--jobs", "1"]
    found = []
    for columns in (200, *WIDTHS):
        monkeypatch.setenv("COLUMNS", str(columns))
        run = slosh("run", "paper-80-solid", *rigid, "--no-figures", "-o", "run").out.partition("solver time")
        told = slosh(*sweep, "-o", "sweep")
        assert told.code == 0, told.err
        printed = f"{run[0]}{run[2].partition('wheel')[2]}{told.out.partition('  table')[0]}"
        assert "…" not in printed
        found.append(sorted(re.findall(r"\d+\.\d+", printed)))
    assert len(found[0]) > 20
    assert all(numbers == found[0] for numbers in found)
