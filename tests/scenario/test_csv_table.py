"""Tables as spreadsheets and people write them: read with the right numbers, or refused with line, rule and remedy."""

import codecs
import math
import pickle
import time
from pathlib import Path

import pytest

from slosh_cli.errors import ScenarioError
from slosh_cli.scenario.csv_table import Table, read_table

NAMES = ("time_s", "force_N")
HEAD = "time_s,force_N\n"
WANTED = {"time_s": [0.0, 1.5], "force_N": [0.0, -981.25]}
PLAIN = HEAD + "0,0\n1.5,-981.25\n"
GERMAN = "time_s;force_N\n0,0;0,0\n1,5;-981,25\n"
BOM = "\ufeff"


def put(folder: Path, content: str | bytes) -> Path:
    path = folder / "t.csv"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


READ = {
    "plain": PLAIN,
    "as Excel writes it": PLAIN.replace("\n", "\r\n"),
    "as an old Macintosh writes it": PLAIN.replace("\n", "\r"),
    "no line end at the end": PLAIN.rstrip(),
    "byte order mark": BOM + PLAIN,
    "German Excel": GERMAN,
    "German Excel with a byte order mark": BOM + GERMAN.replace("\n", "\r\n"),
    "semicolons and decimal points": GERMAN.replace(",", "."),
    "tabs": PLAIN.replace(",", "\t"),
    "tabs and decimal commas": GERMAN.replace(";", "\t"),
    "Unicode text of Excel": codecs.BOM_UTF16_LE + GERMAN.replace(";", "\t").encode("utf-16-le"),
    "UTF-16, the other way round": codecs.BOM_UTF16_BE + PLAIN.encode("utf-16-be"),
    "UTF-32": codecs.BOM_UTF32_LE + PLAIN.encode("utf-32-le"),
    "Excel's own line": "sep=;\r\n" + GERMAN,
    "Excel's own line before commas": 'remark,time_s,force_N\n"a;b",0,0\n"c",1.5,-981.25\n',
    "comments and empty lines": f'# a "table"\n\n#x,"open\n{HEAD}\n0,0\n  # now\n \n1.5,-981.25\n\n',
    "other columns, in another order": "remark,force_N,time_s\nat rest,0,0\n,-981.25,1.5\n",
    "quoted": '"time_s","force_N"\n"0","0"\n"1.5","-981.25"\n',
    "quoted line ends and quotes": 'time_s,remark,force_N\n0,"a\n# ""b"", c\n",0\n1.5,d,-981.25\n',
    "a quoted line end in the head": 'time_s,"re\nmark",force_N\n0,,0\n1.5,,-981.25\n',
    "blanks round cells": " time_s , force_N \n 0 ,0 \n1.5,\t-981.25\n",
    "empty cells behind": "time_s,force_N,,\n0,0,,\n1.5,-981.25,,\n,,,\n",
    "empty cells beyond the head": HEAD + "0,0,\n1.5,-981.25,,,\n",
    "powers of ten": HEAD + "0,0e0\n15e-1,-9.8125E+2\n",
    "a cell as long as cells may be": f'time_s,remark,force_N\n0,"{"x" * 131_000}",0\n1.5,,-981.25\n',
}


@pytest.mark.parametrize("name", READ)
def test_read_with_the_right_numbers(name: str, tmp_path: Path) -> None:
    assert read_table(put(tmp_path, READ[name]), NAMES).columns == WANTED


def test_lines_are_those_of_the_file(tmp_path: Path) -> None:
    text = '# first\n\ntime_s,remark,force_N\n0,"a\nb\n",0\n# between\n1,,2\n2,"c\nd",4\n3,,6\n'
    assert read_table(put(tmp_path, text), NAMES).lines == [4, 8, 9, 11]


NUMBER, REMEDY = "must be a finite number", "write the number alone"
POINT, MARK = "write a decimal point, or part the cells by semicolons", "write every number with the decimal mark"
# fmt: off
REFUSED: dict[str, tuple[str | bytes, list[tuple[int | None, str, str, str, str]]]] = {
    "underscore": (HEAD + "0,1_000\n", [(2, "force_N", NUMBER, "`1_000`", REMEDY)]),
    "blank inside": (HEAD + "0,1 000\n", [(2, "force_N", NUMBER, "`1 000`", REMEDY)]),
    "unit": (HEAD + "0 s,0\n", [(2, "time_s", NUMBER, "`0 s`", REMEDY)]),
    "nan": (HEAD + "0,nan\n", [(2, "force_N", NUMBER, "`nan`", REMEDY)]),
    "infinity": (HEAD + "0,inf\n", [(2, "force_N", NUMBER, "`inf`", REMEDY)]),
    "beyond all numbers": (HEAD + "0,1e999\n", [(2, "force_N", NUMBER, "`1e999`", REMEDY)]),
    "digits of another script": (HEAD + "0,٣\n", [(2, "force_N", NUMBER, "`٣`", REMEDY)]),
    "empty cell": (HEAD + "0,\n", [(2, "force_N", NUMBER, "an empty cell", REMEDY)]),
    "missing cell": (HEAD + "0\n", [(2, "force_N", NUMBER, "an empty cell", REMEDY)]),
    "one cell too many": (
        HEAD + "0,0,7\n", [(2, "", "as many cells as the head, 2, parted by comma", "3", "decimal point")],
    ),
    "decimal commas parted by commas": (
        HEAD + "0,5,1,5\n", [(2, "", "as many cells as the head", "4", "part the cells by semicolons")],
    ),
    "quoted decimal commas parted by commas": (
        HEAD + '"0,5",1\n', [(2, "time_s", NUMBER, "`0,5`", POINT)],
    ),
    "thousands parted by commas": (HEAD + '0,"1,000"\n', [(2, "force_N", NUMBER, "`1,000`", POINT)]),
    "thousands parted by points": (
        "time_s;force_N\n0,5;1.000\n", [(2, "force_N", NUMBER, "`1.000`", MARK)],
    ),
    "both marks in a number": ("time_s;force_N\n0;1.000,5\n", [(2, "force_N", NUMBER, "`1.000,5`", MARK)]),
    "two decimal marks": (
        "time_s\tforce_N\n0.5\t1\n1,5\t2\n", [(3, "time_s", NUMBER, "`1,5`", MARK)],
    ),
    "rows parted by something else": (
        "time_s;force_N\n0,0\n", [(2, "force_N", NUMBER, "an empty cell", REMEDY)],
    ),
    "several": (
        HEAD + "x,0\n0,0\n1,y\n",
        [(2, "time_s", NUMBER, "`x`", REMEDY), (4, "force_N", NUMBER, "`y`", REMEDY)],
    ),
    "line after a quoted line end": (
        'time_s,remark,force_N\n0,"a\nb",0\n1,"c\nd",x\n', [(4, "force_N", NUMBER, "`x`", REMEDY)],
    ),
    "another head": (
        "t,F\n0,0\n",
        [(1, "", "must have the columns time_s and force_N", "the head `t,F`", "comma, semicolon or tab")],
    ),
    "parted by blanks": (
        "time_s force_N\n0 0\n",
        [(1, "", "must have the columns", "the head `time_s force_N`", "comma, semicolon or tab")],
    ),
    "a misspelt column": (
        "time_s,force_kN\n0,0\n", [(1, "", "must have the columns", "`time_s,force_kN`", "write `force_N` instead of")],
    ),
    "a column twice": (
        "time_s,force_N,time_s\n0,0,0\n", [(1, "time_s", "once each", "`time_s` 2 times", "keep one of them")],
    ),
    "no row": (HEAD, [(None, "", "must have at least one row", "none", "below line 1")]),
    "empty file": ("", [(None, "", "must have the columns", "an empty file", "write the head `time_s,force_N`")]),
    "only comments": ("# a\n", [(None, "", "must have the columns", "an empty file", "write the head")]),
    "open quote": (HEAD + '0,0\n1,"2\n3,4\n', [(3, "", "must be valid CSV", "unexpected end", "close every quote")]),
    "letters behind a quote": (HEAD + '0,"1"2\n', [(2, "", "must be valid CSV", "expected", "close every quote")]),
    "a cell longer than cells may be": (
        HEAD + f'0,0\n1,"{"9" * 200_000}"\n', [(3, "", "must be valid CSV", "field larger", "close every quote")],
    ),
    "zero bytes": (PLAIN + "\0", [(4, "", "must be text in UTF-8", "a zero byte", "CSV UTF-8")]),
    "UTF-16 without a mark": (
        PLAIN.encode("utf-16-le"), [(1, "", "must be text in UTF-8", "a zero byte", "CSV UTF-8")],
    ),
    "half of UTF-16": (
        codecs.BOM_UTF16_LE + PLAIN.encode("utf-16-le")[:-1], [(3, "", "must be text", "byte", "CSV UTF-8")],
    ),
    "another encoding": (
        "# für\ntime_s,force_N\n0,0\n".encode("latin-1"), [(1, "", "must be text in UTF-8", "0xfc", "CSV UTF-8")],
    ),
    "a workbook": (b"PK\x03\x04 and so on", [(None, "", "must be a CSV file", "a spreadsheet", "CSV UTF-8")]),
}
# fmt: on


@pytest.mark.parametrize("name", REFUSED)
def test_refused_in_the_words_of_a_scenario(name: str, tmp_path: Path) -> None:
    content, expected = REFUSED[name]
    path = put(tmp_path, content)
    with pytest.raises(ScenarioError) as caught:
        read_table(path, NAMES)
    error = caught.value
    assert [(problem.line, problem.key) for problem in error.problems] == [entry[:2] for entry in expected]
    for problem, (line, _, rule, given, fix) in zip(error.problems, expected, strict=True):
        assert rule in problem.rule
        assert given in problem.given
        assert fix in problem.fix
        assert problem.text(str(path)).startswith(f"{path}:{line}: " if line else f"{path}: ")
    assert str(pickle.loads(pickle.dumps(error))) == str(error)


def test_a_table_that_is_not_there(tmp_path: Path) -> None:
    put(tmp_path, PLAIN)
    with pytest.raises(ScenarioError, match=r"must exist; given a path with no file; write `.*t\.csv`"):
        read_table(tmp_path / "t1.csv", NAMES)
    with pytest.raises(ScenarioError, match="must be a file; given a folder"):
        read_table(tmp_path, NAMES)


def test_who_reads_a_table_may_have_rules_of_his_own(tmp_path: Path) -> None:
    def judge(table: Table) -> None:
        for line, force in zip(table.lines, table.columns["force_N"], strict=True):
            if force < 0.0:
                table.refuse(line, "force_N", "must not be negative", f"`{force:g}`", "write 0 or more")

    with pytest.raises(ScenarioError) as caught:
        read_table(put(tmp_path, PLAIN + "x,1\n"), NAMES, judge)
    assert [(problem.line, problem.key) for problem in caught.value.problems] == [(3, "force_N"), (4, "time_s")]


def test_a_hundred_thousand_bad_rows_are_counted(tmp_path: Path) -> None:
    path = put(tmp_path, HEAD + "x,0\n" * 100_000)
    began = time.process_time()
    with pytest.raises(ScenarioError) as caught:
        read_table(path, NAMES)
    assert time.process_time() - began < 2.0
    assert len(str(caught.value).splitlines()) == 21
    assert str(caught.value).endswith("and 99,980 more problems")


def test_a_long_table_is_read_in_seconds(tmp_path: Path) -> None:
    path = put(tmp_path, HEAD + "".join(f"{i / 100},{math.sin(i)!r}\n" for i in range(100_000)))
    began = time.process_time()
    columns = read_table(path, NAMES).columns
    assert time.process_time() - began < 3.0
    assert columns["force_N"] == [math.sin(i) for i in range(100_000)]
