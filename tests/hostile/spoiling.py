"""Inputs of every kind, spoilt at random: strategies of hypothesis that give the words of a command and its files."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial

from good_files import Good
from hypothesis import strategies as st
from spoilt_histories import Spoil, spoils

LINE_CHANGES = ("drop", "double", "value", "indent", "swap", "insert", "cut", "letter")
VALUES = (
    "", "~", "0", "-1", "1e999", ".nan", ".inf", "1e-300 m", "0.5", "1.5", "12 kN m", "80 km/h", "3 t", "[]", "{}",
    "[1, 2]", "{a: 1}", "true", "no", "modal", "rigid", "shallow-water", "computed", "polygon", "rectangular",
    "use: x", '"\\ud83d"', '"\\e[31m"', "'", "*a", "&a 1", "!!set {a}", "|", "- 1", "$\\frac$", "<script>", "=1+1",
    "../../x", "x" * 300, "1,5 m", "1.000,5 kg", "１ m", "9" * 400, "1e5 m", "5 degC", "0 m", "-3 km/h", "100 %",
    "1 m/m", "2 h", "(", "a: b", "\x07", "\t", "\u202e", "😀",
)  # fmt: skip
"""What may stand after a colon."""
KEYS = (
    "tank.fill", "tank.length", "tank.shape", "tank.liquid.model", "tank.liquid.density", "tank.coefficients",
    "tank.baffles", "tank.coefficients.0.mu", "braking", "braking.torque", "braking.initial_speed", "braking.onset",
    "braking.blocks", "name", "track.rail", "track", "track.unevenness", "track.domain.length", "contact.adhesion",
    "solver.tolerance", "output.interval", "wagon.car_body.mass", "wagon.wheelset", "format", "description",
    "limits", "all.tank.fill", "vehicles.1.tank.fill", "vehicles.999.x", "coupling", "presets", "tank.use",
    "tank..x", ".", "", "x" * 100, "a.b.c.d.e.f", "tank.points.0.0",
)  # fmt: skip
SPECS = (
    "0.3:0.5:0.1",
    "1:2",
    "dry,wet",
    "1,2,3 m",
    ",",
    ":",
    "1:1e6:1",
    "1e999:1:1",
    "[1,2]",
    "{a: 1}",
    "modal,rigid",
    "5:6:0.3 t",
)
PRESETS = (
    "tank-wagon",
    "zacns-like",
    "diesel",
    "k-blocks",
    "uic60-ballast",
    "default",
    "nonsense",
    "",
    "../x",
    "[a]",
    "{}",
    "1",
)
USUAL = ("zacns-like", "diesel", "uic60-ballast", "k-blocks")
CELLS = ("", "0.5", "1e999", "nan", "=1+1", '"', "a", "-", "1,5", "\0", "1 2", "0x1", "9" * 400, "é", "\ud83d"[:0])


@dataclass(frozen=True)
class Given:
    """The words of a command, and the files that lie beside it: texts or bytes, or what is to be done to a history."""

    words: tuple[str, ...]
    files: Mapping[str, str] = field(default_factory=dict)
    history: tuple[str, Spoil] | None = None
    base: str = ""

    def __repr__(self) -> str:
        return f"Given({self.words!r}, {dict(self.files)!r}, {self.history and self.history[0]!r}, {self.base!r})"


@st.composite
def spoilt_text(draw: st.DrawFn, text: str, most: int = 4) -> str:
    """A text with up to `most` changes of its lines."""
    lines = text.splitlines()
    for _ in range(draw(st.integers(1, most))):
        place = draw(st.integers(0, max(len(lines) - 1, 0)))
        line = lines[place] if lines else ""
        head, colon, _rest = line.partition(":")
        value = draw(st.sampled_from(VALUES) | st.text(max_size=20))
        change = draw(st.sampled_from(LINE_CHANGES))
        other = draw(st.integers(0, max(len(lines) - 1, 0)))
        changed: dict[str, list[str]] = {
            "drop": [],
            "double": [line, line],
            "value": [f"{head}{colon} {value}"],
            "indent": [f"{' ' * (other % 7)}{line.lstrip()}"],
            "swap": [lines[other]] if lines else [],
            "insert": [line, f"{' ' * (other % 7)}{draw(st.sampled_from(KEYS))}: {value}"],
            "cut": [line[: other % 30]],
            "letter": [line[: other % 40] + value[:2] + line[other % 40 :]],
        }
        lines[place : place + 1] = changed[change]
    return "\n".join(lines) + "\n"


def _settings() -> st.SearchStrategy[list[str]]:
    one = st.tuples(st.sampled_from(KEYS), st.sampled_from(VALUES) | st.text(max_size=12))
    return st.lists(one.map(lambda pair: f"{pair[0]}={pair[1]}"), min_size=1, max_size=3)


def _given_text(name: str, words: tuple[str, ...], text: str) -> Given:
    return Given((*words, name), {name: text})


@st.composite
def spoilt_csv(draw: st.DrawFn) -> str:
    """A table of an uneven rail with wrong cells."""
    rows = [["x_m", "z_m"], *([f"{n * 0.5}", f"{0.001 * (n % 3)}"] for n in range(20))]
    for _ in range(draw(st.integers(1, 5))):
        row = rows[draw(st.integers(0, len(rows) - 1))]
        row[draw(st.integers(0, 1))] = draw(st.sampled_from(CELLS) | st.text(max_size=6))
    return draw(st.sampled_from(("\n", "\r\n", "\r"))).join(draw(st.sampled_from(",;\t")).join(row) for row in rows)


def strategies(good: Good) -> dict[str, st.SearchStrategy[Given]]:
    """What gives inputs of each kind."""
    uneven = "track.unevenness={file: rail.csv}"
    option: Callable[[str, list[str]], list[str]] = lambda name, texts: [word for one in texts for word in (name, one)]  # noqa: E731
    varied = st.tuples(st.sampled_from(KEYS), st.sampled_from(SPECS) | st.sampled_from(VALUES) | st.text(max_size=12))
    spoilt = [(kind, name, make) for kind in ("run", "train") for name, make in spoils(kind).items()]
    return {
        "scenario": spoilt_text(good.scenario).map(partial(_given_text, "a.yaml", ("check",))),
        "train": spoilt_text(good.train).map(partial(_given_text, "a.yaml", ("check",))),
        "study": spoilt_text(good.study, 3).map(partial(_given_text, "a.yaml", ("sweep", "--dry-run"))),
        "--set": _settings().map(lambda texts: Given(("check", "paper-80-liquid", *option("--set", texts)))),
        "--vary": varied.map(lambda pair: Given(("sweep", "--dry-run", "--vary", f"{pair[0]}={pair[1]}"))),
        "CSV": spoilt_csv().map(lambda text: Given(("check", "paper-80-liquid", "--set", uneven), {"rail.csv": text})),
        "presets": st.tuples(*(st.sampled_from((one, *PRESETS)) | st.just(one) for one in USUAL)).map(
            lambda names: Given(
                ("check", "a.yaml"),
                {
                    "a.yaml": "format: 1\nname: a\n"
                    f"wagon: {{use: {names[0]}}}\ntank: {{use: {names[0]}, fill: 0.8, liquid: {{use: {names[1]}}}}}\n"
                    f"track: {{use: {names[2]}}}\nbraking: {{use: {names[3]}, initial_speed: 80 km/h}}\n"
                },
            )
        ),
        "HDF5": st.sampled_from(spoilt).map(
            lambda one: Given(("plot" if one[0] == "train" else "report", "run.h5", "-o", "out"), {}, one[1:], one[0])
        ),
    }
