"""Lists and ranges as people write them."""

import pytest

from slosh_cli.errors import ValueRefused
from slosh_cli.study.axis import Axis, _listed, expanded, measured


@pytest.mark.parametrize(
    ("spec", "expected"),
    [
        ("80,160", ("80", "160")),
        ("80", ("80",)),
        (" 80 , 160 ", ("80", "160")),
        ("2.5:10:2.5", ("2.5", "5", "7.5", "10")),
        ("0.2:0.9:0.1", ("0.2", "0.3", "0.4", "0.5", "0.6", "0.7", "0.8", "0.9")),
        ("10:14:1 m", ("10 m", "11 m", "12 m", "13 m", "14 m")),
        ("10 m:12 m:1 m", ("10 m", "11 m", "12 m")),
        ("3:1:-1", ("3", "2", "1")),
        ("5:5:1", ("5",)),
        ("1e3:3e3:1e3 kg", ("1000 kg", "2000 kg", "3000 kg")),
        ("1e-8:3e-8:1e-8", ("0.00000001", "0.00000002", "0.00000003")),
        ("10,12,14 m", ("10 m", "12 m", "14 m")),
        ("10 m,500 mm", ("10 m", "500 mm")),
        ("1:3:1,10 m", ("1 m", "2 m", "3 m", "10 m")),
        ("dry,wet", ("dry", "wet")),
        ("dry,{mu0: 0.2, B: 0.6 s/m}", ("dry", "{mu0: 0.2, B: 0.6 s/m}")),
        ("80,80,160", ("80", "160")),
        ("'a,b',c", ("'a,b'", "c")),
    ],
)  # fmt: skip
def test_lists_and_ranges(spec: str, expected: tuple[str, ...]) -> None:
    assert expanded(spec) == expected


def test_both_ends_of_a_long_range_are_in_and_every_value_is_the_shortest_decimal() -> None:
    values = expanded("0:1:0.001")
    assert len(values) == 1001
    assert [float(value) for value in values] == [k / 1000 for k in range(1001)]


@pytest.mark.parametrize(
    ("spec", "expected"),
    [
        ("80,160", ("80 km/h", "160 km/h")),
        ("10,20 m/s", ("10 m/s", "20 m/s")),
        ("10 m/s,72", ("10 m/s", "72 km/h")),
        ("20:40:10", ("20 km/h", "30 km/h", "40 km/h")),
    ],
)
def test_a_bare_number_takes_the_unit_of_the_option(spec: str, expected: tuple[str, ...]) -> None:
    assert expanded(spec, "km/h") == expected


@pytest.mark.parametrize(
    ("spec", "rule"),
    [
        ("", "must be a list"),
        ("80,,160", "must be a list"),
        ("80,", "must be a list"),
        ("2.5:30", "start:stop:step"),
        ("1:2:3:4", "start:stop:step"),
        ("1:10:0", "leads from start to stop"),
        ("1:10:-1", "leads from start to stop"),
        ("1:10:4", "must reach its stop in whole steps"),
        ("0:1e9:1", "at most 100000 values"),
        ("1:1e400:1e-400", "at most 100000 values"),
        ("10 m:1200 cm:1 m", "one unit in a range"),
    ],
)
def test_what_is_neither_list_nor_range_is_refused(spec: str, rule: str) -> None:
    with pytest.raises(ValueRefused, match=rule):
        expanded(spec)


def test_a_range_that_misses_its_stop_names_one_that_does_not() -> None:
    with pytest.raises(ValueRefused, match=r"`2.5:27.5:2.5`") as caught:
        expanded("2.5:28:2.5")
    assert expanded(caught.value.fix.split("`")[1])[-1] == "27.5"


def test_such_a_range_keeps_its_unit() -> None:
    with pytest.raises(ValueRefused) as caught:
        expanded("10:28:10 m/s", "km/h")
    assert expanded(caught.value.fix.split("`")[1], "km/h") == ("10 m/s", "20 m/s")


def test_lists_of_a_file_become_texts() -> None:
    assert _listed([0.5, 3, "10 m", {"mu0": 0.3, "B": "0.6 s/m"}, [1, 2.5]]) == (
        "0.5", "3", "10 m", "{mu0: 0.3, B: 0.6 s/m}", "[1, 2.5]",
    )  # fmt: skip
    with pytest.raises(ValueRefused, match="at least one value"):
        _listed([])


def test_numbers_and_units_are_told_from_words() -> None:
    assert measured("10 km/h") == (10.0, "km/h")
    assert measured("-2.5e3 N m") == (-2500.0, "N m")
    assert measured("0.5") == (0.5, "")
    assert measured("dry") is None
    assert measured("{mu0: 1}") is None


def test_an_axis_has_a_unit_when_all_its_values_share_it() -> None:
    assert Axis("k", ("10 m", "12 m"), "").unit == "m"
    assert Axis("k", ("10 m", "12 m"), "").plain(1) == 12.0
    mixed = Axis("k", ("10 m", "500 mm"), "")
    assert (mixed.unit, mixed.plain(1)) == ("", "500 mm")
    assert Axis("k", ("0.2", "0.3"), "").plain(0) == 0.2
    assert Axis("k", ("dry", "wet"), "").plain(0) == "dry"


def test_a_table_tells_percentages_as_numbers_and_units_in_one_form() -> None:
    share = Axis("tank.fill", expanded("20:60:20 %"), "")
    assert (share.values, share.unit) == (("20 %", "40 %", "60 %"), "")
    assert [share.plain(place) for place in range(3)] == [0.2, 0.4, 0.6]
    mixed = Axis("tank.fill", ("0.2", "40 %"), "")
    assert [mixed.plain(place) for place in range(2)] == [0.2, 0.4]
    density = Axis("tank.liquid.density", ("830 kg·m⁻³", "900 kg/m3"), "")
    assert (density.unit, density.plain(1)) == ("kg/m^3", 900.0)
    mass = Axis("wagon.car_body.mass", ("21 300 kg", "22.3e3 kg"), "")
    assert (mass.unit, mass.plain(0)) == ("kg", 21300.0)
