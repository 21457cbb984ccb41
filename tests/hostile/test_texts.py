"""Scenarios, trains and studies that are no text, no YAML, far too much of it, or steer something."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from answer import Answer, answer
from good_files import Good

MANY = ",".join(f"k{n}: 1" for n in range(9_900))
BOMB = "".join(f"{b}: &{b} [{','.join([f'*{a}'] * 9)}]\n" for a, b in zip("abcdefg", "bcdefgh", strict=True))
SPOILT: dict[str, Callable[[str], str | bytes]] = {
    "nothing": lambda text: "",
    "a list": lambda text: "- 1\n" * 10,
    "100 MB": lambda text: b"x" * 100_000_000,
    "a zero byte": lambda text: text + "# \0\n",
    "UTF-16": lambda text: text.encode("utf-16"),
    "UTF-32": lambda text: text.encode("utf-32"),
    "half a character": lambda text: text.encode() + b"# \xed\xa0\xbd\n",
    "half a pair in a key": lambda text: text + '"\\ud83d": 1\n',
    "half a pair in a value": lambda text: text + 'x: "\\ude00"\n',
    "tabs": lambda text: text.replace("  ", "\t"),
    "aliases of aliases": lambda text: "a: &a [x,x,x,x,x,x,x,x,x]\n" + BOMB + text,
    "brackets": lambda text: f"{text}x: {'[' * 4_000}{']' * 4_000}\n",
    "braces": lambda text: f"{text}x: {'{a: ' * 3_000}1{'}' * 3_000}\n",
    "indentation": lambda text: text + "x:\n" + "".join(" " * n + "a:\n" for n in range(1, 900)),
    "490,000 items": lambda text: f"{text}x: [{'1,' * 490_000}1]\n",
    "19,000 items": lambda text: f"{text}x: [{'1,' * 19_000}1]\n",
    "9,900 merged keys": lambda text: f"m: &m {{{MANY}}}\n{text}<<: *m\n",
    "9,900 merges": lambda text: f"m: &m {{a: 1}}\n{text}x: {{<<: [{'*m,' * 9_900}*m]}}\n",
    "90,000 unknown keys": lambda text: text + "".join(f"k{n}: 1\n" for n in range(90_000)),
    "9,000 unknown keys": lambda text: text + "".join(f"key_{n}: 1\n" for n in range(9_000)),
    "unknown keys inside": lambda text: text + "".join(f"u{n}: {{{MANY[:500]}}}\n" for n in range(100)),
    "the same key": lambda text: text + "name: a\n" * 9_000,
    "a key of 900,000 letters": lambda text: f"{text}{'k' * 900_000}: 1\n",
    "a value of 900,000 letters": lambda text: f"{text}k: {'v' * 900_000}\n",
    "400,000 words": lambda text: f"{text}k: {'a ' * 400_000}\n",
    "escapes": lambda text: f'{text}k: "{chr(92)}u0041{chr(92)}e[31m"\n',
    "keys that steer": lambda text: f'{text}"{chr(92)}e[31mred": "{chr(92)}x07"\n',
    "keys from right to left": lambda text: f'{text}"a\u202eb": 1\n',
    "code": lambda text: text + 'x: !!python/object/apply:os.system ["id"]\n',
    "a set": lambda text: text + "x: !!set {a, b}\n",
    "documents": lambda text: "---\n" * 10_000,
    "colons": lambda text: ":" * 900_000,
    "question marks": lambda text: "? " * 100_000,
    "anchors": lambda text: text + "x: " + "&a " * 10_000 + "\n",
}
IN_ALL = ("nothing", "100 MB", "half a pair in a key", "brackets", "9,900 merged keys", "9,000 unknown keys", "tabs")
"""What trains and studies are spoilt by, too; the reader is the same for all."""
SOUND: dict[str, Callable[[str], str | bytes]] = {
    "a mark in front": lambda text: b"\xef\xbb\xbf" + text.encode(),
    "line ends of another system": lambda text: text.replace("\n", "\r\n"),
    "200,000 comments": lambda text: text + "# a\n" * 200_000,
    "900,000 empty lines": lambda text: text + "\n" * 900_000,
}
NAMES = (
    "../../x",
    "CON",
    "-rf",
    "..",
    ".",
    "a/b",
    "~",
    "$HOME",
    "a\\\\b",
    "n" * 300,
    "",
    " ",
    "\\e[31m",
    "\\ud83d\\ude00",
)
NUMBERS = (
    "1e999",
    "-1e999",
    "9" * 5_000,
    "1e-999",
    ".nan",
    ".inf",
    "1e999 m",
    f"{'9' * 5_000} t",
    "0x7f",
    "1__0",
    "1:30",
)


def told(kind: str, content: str | bytes, good: Good, folder: Path, code: int | None = None) -> Answer:
    """What `slosh` says to a file of such a kind."""
    file = folder / "given.yaml"
    file.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8", "surrogatepass"))
    return answer(*(["sweep", "--dry-run"] if kind == "study" else ["check"]), file, code=code)


@pytest.mark.parametrize(
    ("kind", "name"),
    [("scenario", name) for name in SPOILT]
    + [(kind, name) for kind in ("train", "study") for name in SPOILT if name in IN_ALL],
)
def test_a_spoilt_text_is_refused(kind: str, name: str, good: Good, folder: Path) -> None:
    found = told(kind, SPOILT[name](getattr(good, kind)), good, folder, code=2)
    lines = found.err.splitlines()
    more = re.fullmatch("and [0-9,]+ more problems?", lines[-1])
    assert len(lines) <= 20 or more


@pytest.mark.parametrize(("kind", "name"), zip(("scenario", "train", "study", "scenario"), SOUND, strict=True))
def test_what_is_only_unusual_is_read(kind: str, name: str, good: Good, folder: Path) -> None:
    told(kind, SOUND[name](getattr(good, kind)), good, folder, code=0)


@pytest.mark.parametrize("kind", ["scenario", "train", "study"])
def test_a_name_that_cannot_name_a_folder_is_refused(kind: str, good: Good, folder: Path) -> None:
    for name in NAMES:
        text = re.sub(
            "^name: .*", f'name: "{name}"'.replace("\\", r"\\"), getattr(good, kind), count=1, flags=re.MULTILINE
        )
        found = told(kind, text, good, folder)
        assert found.code == (0 if name == "CON" else 2), name


@pytest.mark.parametrize("number", NUMBERS)
def test_a_number_beyond_all_is_refused(number: str, good: Good, folder: Path) -> None:
    for key in ("  length: 15.5 m", "  fill: 0.5"):
        assert key in good.scenario
        told("scenario", good.scenario.replace(key, f"{key.partition(':')[0]}: {number}"), good, folder, code=2)
    (folder / "sound.yaml").write_text(good.scenario, encoding="utf-8")
    answer("check", "sound.yaml", "--set", f"tank.length={number}", code=2)
