"""What `slosh find` and `slosh optimum` do and say once they know what is asked for."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from slosh_cli.cli.exit_codes import ExitCode
from slosh_cli.cli.output import complain, note, say, say_json, warn

if TYPE_CHECKING:
    from slosh_cli.application.finding import Search, Searched

_HELD: Final = {
    "end": "at the end of the range: it may go on beyond",
    "limit": "where a limit holds it: beyond, a stop is outside",
    "jump": "beside a jump: just beyond, the answer is another",
    "gap": "beside stops without an answer",
    "inside": "inside the range",
}


def search_and_tell(
    search: "Search",
    jobs: int | None,
    output: Path | None,
    overrides: Sequence[str] | None,
    *,
    figures: bool,
    as_json: bool,
) -> ExitCode:
    """Carry out the search, keep table and figure, tell what was found."""
    from slosh_cli.application.finding import carry_out_search, keep_search
    from slosh_cli.application.keeping import Keeping, default_folder
    from slosh_cli.cli.keeping import told
    from slosh_cli.cli.progress import announce_solver, counting

    base = search.span.study([search.span.low])
    note(f"{search.span.key} from {search.span.words}")
    announce_solver(base.liquids)
    with counting("stops") as progress:
        found = carry_out_search(search, threads=jobs, progress=progress)
    keeping = Keeping()
    folder = output or default_folder(base.name, overrides)
    files = keep_search(found, folder, keeping, figures=figures)
    if as_json:
        say_json(found.as_dict() | {"files": files, "warnings": list(keeping.failures)})
    else:
        for line in _lines(found):
            say(line)
        say("\n" + "\n".join(f"  {kind:8} {file}" for kind, file in files.items() if kind != "figures"))
        say(f"  figures  {', '.join(files['figures'])}")
    _tell_unanswered(found)
    answered = found.kind not in ("none", "gap") or found.best is not None
    if not answered:
        complain(_nothing(found))
    return told(keeping, ExitCode.DONE if answered else ExitCode.NO_ANSWER)


def _lines(found: "Searched") -> list[str]:
    """What was found, in sentences, then both sides."""
    search = found.search
    if found.best is not None:
        low, high = found.flat or (found.best.x, found.best.x)
        lines = [f"{'Largest' if search.most else 'Least'} at {search.span.key} {_side(found, found.best)}"]
        lines.append(f"It lies {_HELD[found.kind]}.")
        if high > low and found.kind == "inside":
            lines.append(
                f"From {search.span.text(low, 6)} to {search.span.text(high, 6)} the solver sees no difference."
            )
        return lines
    one = found.passage
    if one is None:
        return []
    said = {
        "crossing": f"{search.asked.words} at {search.span.key} {found.text}",
        "change": f"{search.asked.words} at {search.span.key} {found.text}",
        "jump": f"No value gives {search.asked.words}: the answer jumps over it at {search.span.text(one.x, 6)}",
        "gap": f"{search.asked.words} lies among stops without an answer",
    }
    lines = [said[found.kind], f"  below: {_side(found, one.below)}", f"  above: {_side(found, one.above)}"]
    if len(found.passages) > 1:
        places = ", ".join(search.span.text(other.x, 4) for other in found.passages)
        lines.append(
            f"It is passed {len(found.passages)} times in the scan, near {places}; this is number "
            f"{search.crossing}, --crossing N asks for another."
        )
    return lines


def _side(found: "Searched", sample: Any) -> str:
    """``19.6 kN m: braking distance / m 334.33``, with what else there is to know."""
    told = found.side(sample)
    asked, search_key = found.search.asked, found.search.span.key
    what, unit = asked.label.partition(" / ")[0], "" if asked.unit == "1" else f" {asked.unit}"
    value = "no answer" if told["answer"] is None else f"{what} {told['answer']:.6g}{unit}"
    distance = told["braking_distance_m"]
    more = "" if distance is None or what == "braking distance" else f", braking distance {distance:.2f} m"
    torque = sample.row.get("torque_kN_m")
    if torque is not None and search_key.startswith("braking.") and search_key != "braking.torque":
        more += f", {torque:.4g} kN m per wheel at the initial speed"
    more += "" if told["status"] == "stopped" else f" ({told['status']})"
    return f"{found.search.span.text(sample.x, 7)}: {value}{more}"


def _tell_unanswered(found: "Searched") -> None:
    """Stops without an answer, by how they ended; each kind with one reason."""
    groups: dict[str, list[Any]] = {}
    for one in found.samples:
        if one.status != "stopped":
            groups.setdefault(one.status, []).append(one)
    for status, stops in groups.items():
        span = found.search.span
        warn(f"{len(stops)} of {len(found.samples)} stops ended with {status}, from {span.text(stops[0].x, 6)} to "
             f"{span.text(stops[-1].x, 6)}: {stops[0].reason}")  # fmt: skip


def _nothing(found: "Searched") -> str:
    """Why there is no answer, with what was seen at both ends."""
    search, ends = found.search, (found.samples[0], found.samples[-1])
    words = search.asked.words if not search.limits else f"a stop within {', '.join(o.words for o in search.limits)}"
    lines = [f"No answer: {words} was not found for {search.span.key} from {search.span.words}"]
    if found.kind == "gap":
        lines = [f"No answer: stops between have none where {words} is passed"]
    elif found.passages:
        lines = [f"No answer: {words} is passed {len(found.passages)} times, not {search.crossing}"]
    lines += [f"  at {_side(found, one)}" for one in ends]
    if found.kind == "none" and not found.passages and search.span.low > 0.0:
        wider = f"{0.5 * search.span.low:g}:{2.0 * search.span.high:g} {search.span.unit}".rstrip()
        lines.append(f"It may lie beyond: try a wider range, such as `--vary '{search.span.key}={wider}'`")
    return "\n".join(lines)
