"""Numbers as people write them: thousands in groups, decimal commas, powers of ten, the signs of word processors."""

from __future__ import annotations

import re
from typing import Final, NamedTuple

NUMBER_PATTERN: Final = r"[+-]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?"
"""A number as YAML and every programming language write it."""
_SIGNS: Final = str.maketrans(
    {
        **dict.fromkeys("\u00a0\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u3000", " "),
        **dict.fromkeys("\u200b\u2060\ufeff", None),
        **dict.fromkeys("\u2212\u2010\u2011\u2013\ufe63\uff0d", "-"),
        **dict.fromkeys("\u00b7\u22c5\u2219\u2022\u00d7", "*"),
        **dict.fromkeys("\u2215\u2044", "/"),
        **dict.fromkeys("\u2019\u02bc", "'"),
        **dict.fromkeys("\u00b5\u03bc", "u"),
        "\u00b0": "deg",
    }
)
_RAISED: Final = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻", "0123456789+-")
_SUPERSCRIPT = re.compile("[⁰¹²³⁴⁵⁶⁷⁸⁹⁺⁻]+")

_GROUP = r"[1-9][0-9]{0,2}"
_FORMS: Final = (
    ("spaces", rf"{_GROUP}(?P<gap>[ '])[0-9]{{3}}(?:(?P=gap)[0-9]{{3}})*(?:[.,][0-9]+)?"),
    ("points", rf"{_GROUP}(?:(?:\.[0-9]{{3}})+,[0-9]+|(?:\.[0-9]{{3}}){{2,}})"),
    ("commas", rf"{_GROUP}(?:(?:,[0-9]{{3}})+\.[0-9]+|(?:,[0-9]{{3}}){{2,}})"),
    ("comma", r"[0-9]+,[0-9]+"),
    ("plain", r"[0-9]+\.?[0-9]*|\.[0-9]+"),
)
_NUMBER = re.compile(
    r"(?P<sign>[+-]?)(?:(?P<ten>10(?:\^|\*\*))(?P<alone>[+-]?[0-9]{1,3})|(?:"
    + "|".join(f"(?P<{name}>{form})" for name, form in _FORMS)
    + r")(?:[eE](?P<exponent>[+-]?[0-9]+)|\s*[x*]\s*10(?:\^|\*\*)(?P<power>[+-]?[0-9]{1,3}))?)(?![0-9.,'_])"
)
_THOUSANDS = re.compile(rf"{_GROUP},[0-9]{{3}}")


class Numeral(NamedTuple):
    """A number at the start of a text and what follows it.

    `readings` are the numbers, written plainly, that the text can mean: two where a single comma can part
    thousands or decimals (``1,000``).
    """

    readings: tuple[str, ...]
    rest: str


def plain_signs(text: str) -> str:
    """`text` with spaces, minus signs, dots, micro and degree signs and superscripts in ASCII: ``m⁻³`` is ``m^-3``."""
    if text.isascii():
        return text
    return _SUPERSCRIPT.sub(lambda match: f"^{match.group().translate(_RAISED)}", text).translate(_SIGNS)


def read_number(text: str) -> Numeral | None:
    """The number that `text`, in plain signs, begins with; None where there is none or it goes on strangely."""
    match = _NUMBER.match(text)
    if match is None:
        return None
    sign, rest = match["sign"], re.sub(r"^\*(?!\*)\s*", "", text[match.end() :].strip())  # 0.2·g is 0.2 g
    if match["ten"]:
        return Numeral((f"{sign}1e{int(match['alone'])}",), rest)
    power = match["exponent"] or match["power"]
    tail = f"e{power}" if power else ""
    name, written = next((name, match[name]) for name, _ in _FORMS if match[name])
    return Numeral(tuple(f"{sign}{number}{tail}" for number in _readings(name, written)), rest)


def _readings(form: str, written: str) -> tuple[str, ...]:
    """The plain decimal numbers that a number of one form can mean."""
    if form == "spaces":
        return (written.replace(" ", "").replace("'", "").replace(",", "."),)
    if form == "points":
        return (written.replace(".", "").replace(",", "."),)
    if form == "commas":
        return (written.replace(",", ""),)
    if form == "comma":
        decimal = written.replace(",", ".")
        return (written.replace(",", ""), decimal) if _THOUSANDS.fullmatch(written) else (decimal,)
    return (written,)
