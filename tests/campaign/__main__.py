"""Random wagons and trains, side by side: `python -m tests.campaign --wagons 1000 --trains 50`.

A line for every violation, with the seed that repeats it, and a table in the end. `--seed wagon:17` repeats one, with
its overrides. The numbers of all runs go to `outputs/campaign/`.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import asdict
from pathlib import Path

from .judge import Verdict, judge_train, judge_wagon
from .trains import train
from .wagons import wagon

FOLDER = Path(__file__).parents[2] / "outputs" / "campaign"
KINDS = {"wagon": (wagon, judge_wagon), "train": (train, judge_train)}
NOTED_EVERY = 50


def judged(kind: str, seed: int, thorough: bool) -> Verdict:
    """The verdict on what a seed gives."""
    draw, judge = KINDS[kind]
    return judge(seed, draw(seed), thorough)


def campaign(cases: list[tuple[str, int, bool]], jobs: int) -> Iterator[tuple[str, Verdict]]:
    """The verdicts on cases of kind, seed and whether to compare, as they come."""
    with ProcessPoolExecutor(jobs) as pool:
        waiting = {pool.submit(judged, *case): case[0] for case in cases}
        for done in as_completed(waiting):
            yield waiting.pop(done), done.result()


def table(found: list[tuple[str, Verdict]]) -> str:
    """How the runs ended, and of each thing looked at how often it was, and how often it was broken."""
    lines = ["", "| ended | runs |", "|---|---|"]
    ends = Counter(f"{kind}: {one.outcome.split(';')[0]}" for kind, one in found)
    lines += [f"| {end} | {count} |" for end, count in sorted(ends.items())]
    lines += ["", "| looked at | runs | broken |", "|---|---|---|"]
    looked = Counter((kind, what) for kind, one in found for what in set(one.looked_at))
    broken = Counter((kind, what) for kind, one in found for what in {broke.kind for broke in one.violations})
    for kind, what in sorted(looked.keys() | broken.keys()):
        lines.append(f"| {kind}: {what} | {looked[kind, what]} | {broken[kind, what]} |")
    return "\n".join(lines)


def repeat(case: str) -> None:
    """Run one case again and tell its overrides."""
    kind, _, seed = case.partition(":")
    sys.stdout.write(json.dumps(KINDS[kind][0](int(seed)), indent=1) + "\n")
    verdict = judged(kind, int(seed), True)
    sys.stdout.write(f"{verdict.outcome} {verdict.traits}\n" + "".join(f"{one}\n" for one in verdict.violations))


def main() -> None:
    """Run, tell, count."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--wagons", type=int, default=200)
    parser.add_argument("--trains", type=int, default=10)
    parser.add_argument("--first", type=int, default=0, help="seed of the first wagon and train")
    parser.add_argument("--every", type=int, default=4, help="compare every so many with other runs")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", help="repeat one case, such as wagon:17")
    given = parser.parse_args()
    if given.seed:
        return repeat(given.seed)
    counts = {"wagon": given.wagons, "train": given.trains}
    seeds = [(kind, seed) for kind, count in counts.items() for seed in range(given.first, given.first + count)]
    cases = [(kind, seed, seed % given.every == 0) for kind, seed in seeds]
    found: list[tuple[str, Verdict]] = []
    FOLDER.mkdir(parents=True, exist_ok=True)
    with (FOLDER / f"runs-{given.first}.jsonl").open("w", encoding="utf-8") as kept:
        for kind, verdict in campaign(cases, given.jobs):
            found.append((kind, verdict))
            kept.write(json.dumps({"kind": kind} | asdict(verdict)) + "\n")
            kept.flush()
            for one in verdict.violations:
                sys.stdout.write(f"{kind}:{verdict.seed} {one}\n")
            if len(found) % NOTED_EVERY == 0:
                sys.stderr.write(f"{len(found)} of {len(cases)}\n")
            sys.stdout.flush()
    sys.stdout.write(table(found) + "\n")
    return None


if __name__ == "__main__":
    main()
