"""Ten thousand stops: memory stays flat, journal and table are right."""

from pathlib import Path

import pytest
from many_stops import FLAT, check_reuse, check_table, measure


@pytest.mark.slow
def test_ten_thousand_stops_take_no_more_memory_than_one_thousand(tmp_path: Path) -> None:
    measured = measure(tmp_path, 10_000)
    assert measured.growth < FLAT, measured.report()
    check_table(tmp_path, measured.stops)
    check_reuse(tmp_path, measured.stops)
