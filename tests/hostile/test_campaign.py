"""Two thousand inputs of every kind, spoilt at random: the answer is always one of ours. `make fuzz` tries more."""

import pytest
from fuzzing import SHARES, judged
from good_files import Good
from hypothesis import HealthCheck, given, settings
from spoiling import strategies

INPUTS = 2_000


@pytest.mark.parametrize("kind", SHARES)
def test_every_answer_is_one_of_ours(kind: str, good: Good) -> None:
    count = INPUTS * SHARES[kind] // 100
    tried = []

    @settings(
        max_examples=count, derandomize=True, deadline=None, database=None, suppress_health_check=list(HealthCheck)
    )
    @given(strategies(good)[kind])
    def search(one: object) -> None:
        tried.append(one)
        found = judged(one, good)  # type: ignore[arg-type]
        assert not found.faults, found.faults

    search()
    assert len(tried) >= min(count, 50)
