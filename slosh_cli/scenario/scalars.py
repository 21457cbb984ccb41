"""Plain scalars of a YAML file by the rules of YAML 1.2, and the numbers of every other table.

PyYAML follows YAML 1.1, where `2.1e11` and `1e5` are text, `010` is eight, `1:30` ninety and `on` true.
"""

from __future__ import annotations

import math
import re

_INTEGER = re.compile(r"[+-]?[0-9]+")
_FLOAT = re.compile(r"[+-]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][+-]?[0-9]+)?")
_SURROGATE = re.compile("[\ud800-\udfff]")
_SPECIAL = {
    **dict.fromkeys(("", "~", "null", "Null", "NULL"), None),
    **dict.fromkeys(("true", "True", "TRUE"), True),
    **dict.fromkeys(("false", "False", "FALSE"), False),
    **dict.fromkeys((".inf", ".Inf", ".INF", "+.inf", "+.Inf", "+.INF"), float("inf")),
    **dict.fromkeys(("-.inf", "-.Inf", "-.INF"), float("-inf")),
    **dict.fromkeys((".nan", ".NaN", ".NAN"), float("nan")),
}


def plain_scalar(text: str) -> str | int | float | None:
    """The value of a scalar written without quotes."""
    if text in _SPECIAL:
        return _SPECIAL[text]
    if _INTEGER.fullmatch(text) and len(text) < 300:
        return int(text)
    return float(text) if _FLOAT.fullmatch(text) else text


def plain_number(text: str) -> float | None:
    """The number that `text` is by the grammar of a scenario, without infinity and nan; None where it is none."""
    value = float(text) if _FLOAT.fullmatch(text) else math.nan
    return value if math.isfinite(value) else None


def well_formed(text: str) -> tuple[str, str]:
    """`text` as UTF-8 can hold it, and the first half of a surrogate pair that stands alone in it, spelt out.

    JSON writes a character beyond U+FFFF as two halves, ``\\ud83d\\ude00``; these are brought together.
    """
    if _SURROGATE.search(text) is None:
        return text, ""
    joined = text.encode("utf-16", "surrogatepass").decode("utf-16", "surrogatepass")
    lone = _SURROGATE.search(joined)
    spelt = joined.encode("utf-8", "backslashreplace").decode("utf-8")
    return spelt, lone.group().encode("ascii", "backslashreplace").decode("ascii") if lone else ""
