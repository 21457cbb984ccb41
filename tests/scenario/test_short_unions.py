"""A part that may be written in short can be a union whose members have a tag or none."""

from typing import Annotated, Literal

import pytest

from slosh_cli.errors import ValueRefused
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.leaves import Number, Range
from slosh_cli.scenario.short import Short


class Plain(Part):
    share: Annotated[float, Number(Range(0.0, 1.0), "0.5")]


class Tagged(Part):
    form: Literal["steep"] = "steep"
    rate: Annotated[float, Number(Range(0.0, 9.0), "3")]


def test_a_wrong_word_is_answered_with_the_form_of_every_member():
    short = Short({"half": Plain(share=0.5)}, whole=Plain | Tagged)
    with pytest.raises(ValueRefused) as refused:
        short.parse("nothing")
    assert "a mapping of share or a mapping with its `form`" in refused.value.rule
