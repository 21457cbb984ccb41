"""Mutants differ from the module in one place each, and in the places that matter."""

import ast

from everywhere.mutants import difference, mutants

MODULE = '''
"""A module."""

LIMIT = 3.0


@kernel
def held(load: float, rate: float = 0.0) -> float:
    """A docstring."""
    if load <= LIMIT and not rate:
        return -load
    load += 2
    note(load)
    raise ValueError(load + 1)
'''


def test_each_mutant_changes_one_place() -> None:
    found = [difference(MODULE, mutant) for _, mutant in mutants(MODULE)]
    assert len(set(found)) == len(found) == 10
    assert all(ast.parse(mutant) for _, mutant in mutants(MODULE))
    text = "\n".join(found)
    for line in ("if load > LIMIT and (not rate)", "if load <= LIMIT or not rate", "if load <= LIMIT and rate",
                 "if False", "return load", "load -= 2", "load += 3", "pass",
                 "def held(load: float, rate: float=1.0) -> float:"):  # fmt: skip
        assert f"+{line}" in text.replace("+    ", "+").replace("+    ", "+"), line
    assert "load + 2" not in text.replace("load += 2", "")


def test_every_other_mutant_is_a_part_of_all() -> None:
    assert list(mutants(MODULE, 2)) == list(mutants(MODULE))[::2]
