"""The same answer everywhere, the long part.

python -m tests.everywhere                        answers of all stops as JSON
python -m tests.everywhere compare A.json B.json  how far B is from A
python -m tests.everywhere environments           both, in environments of their own: oldest and newest versions of the
                                                  dependencies, every Python found (`make everywhere`)
"""

import argparse
import json
import sys
from pathlib import Path


def main() -> int:
    """Exit code 1 where an answer differs by more than it may."""
    parser = argparse.ArgumentParser(prog="python -m tests.everywhere")
    parser.add_argument("what", nargs="?", default="answers", choices=["answers", "compare", "environments"])
    parser.add_argument("files", nargs="*", type=Path)
    parser.add_argument("--only", action="append", help="a stop by name (repeatable); none: all")
    given = parser.parse_args()
    if given.what == "answers":
        from .answers import STOPS, TANKS, TRAINS, collected

        json.dump(collected(given.only or [*STOPS, *TANKS, *TRAINS]), sys.stdout, indent=1)
        return 0
    if given.what == "compare":
        from .comparison import compared

        return compared(given.files)
    from .environments import everywhere

    return everywhere()


if __name__ == "__main__":
    sys.exit(main())
