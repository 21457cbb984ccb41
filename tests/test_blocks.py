"""Blocks: one pointer for kernels, with fields, parts, rows of parts and methods."""

import copy
import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numba.core.errors import TypingError

from slosh_cli.arrays import Flags, Integers, Matrix, Tesseract, Unsigned, Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel, kernel


class Spring(Block):
    stiffness: float

    @inner_kernel
    def force(self, place):
        """N, at a place in m."""
        return -self.stiffness * place


class Stop(Block):
    """A second class with the same kernel; it counts how often it was asked."""

    gap: float
    asked: int

    @inner_kernel
    def force(self, place):
        """N, at a place in m."""
        self.asked += 1
        return 0.0 if place < self.gap else -1e6 * (place - self.gap)


class Mass(Block):
    weight: float
    count: int
    places: Vector
    holder: Spring | Stop

    @property
    def last(self) -> float:
        return float(self.places[-1])


class Chain(Block):
    masses: tuple[Mass, ...]
    total: float


class Arrays(Block):
    vector: Vector
    matrix: Matrix
    tesseract: Tesseract
    flags: Flags
    integers: Integers
    unsigned: Unsigned


def mass(size: int = 2, holder: Block | None = None) -> Mass:
    held = Spring(stiffness=3.0) if holder is None else holder
    return Mass(weight=1.5, count=7, places=np.arange(size, dtype=float), holder=held)


@kernel
def sum_up(chain):
    """Total weight, and how many places there are; counts the masses up."""
    masses, places = chain.masses, 0
    chain.total = 0.0
    for k in range(len(masses)):
        one = masses[k]
        chain.total += one.weight
        one.count += 1
        for i in range(one.places.size):
            one.places[i] += 0.5
            places += 1
    return places


@kernel
def hold(block, place):
    """The force of the holder, by its class."""
    return block.holder.force(place)


def test_fields_come_back_and_arrays_are_shared():
    places, spring = np.array([1.0, 2.0]), Spring(stiffness=3.0)
    block = Mass(weight=1, count=np.int64(7), places=places, holder=spring)
    assert (block.weight, block.count) == (1.0, 7)
    assert isinstance(block.weight, float)
    assert isinstance(block.count, int)
    assert block.places is places
    assert block.holder is spring
    assert block.last == 2.0


def test_numbers_are_set_from_python_and_from_kernels():
    block = mass()
    chain = Chain(masses=(block,), total=-1.0)
    block.weight, block.count = 4, 10
    assert sum_up(chain) == 2
    assert (chain.total, block.count) == (4.0, 11)
    assert block.places.tolist() == [0.5, 1.5]


def test_blocks_of_different_sizes_make_a_row_for_one_compiled_kernel():
    compiled = len(sum_up.signatures)
    for sizes in ((1,), (3, 0), (1, 2, 50)):
        chain = Chain(masses=tuple(mass(size) for size in sizes), total=0.0)
        assert sum_up(chain) == sum(sizes)
        assert chain.total == 1.5 * len(sizes)
        assert [one.count for one in chain.masses] == len(sizes) * [8]
    assert len(sum_up.signatures) <= max(compiled, 1)


def test_arrays_of_all_kinds_reach_kernels():
    @kernel
    def read(block):
        return (
            block.vector[1],
            block.matrix[1, 0],
            block.tesseract[0, 1, 0, 1],
            block.flags[1],
            block.integers[2],
            (block.unsigned[0, 1]),
        )

    block = Arrays(
        vector=[1, 2],
        matrix=np.arange(4.0).reshape(2, 2).T,
        tesseract=np.arange(16.0).reshape(2, 2, 2, 2),
        flags=np.array([False, True]),
        integers=np.array([1, 2, 3], dtype=np.int32),
        unsigned=np.array([[1, 2**63]], dtype=np.uint64),
    )
    assert read(block) == (2.0, 1.0, 5.0, True, 3, 2**63)


def test_a_method_is_that_of_the_class():
    stop = Stop(gap=0.5, asked=0)
    assert hold(mass(), 2.0) == -6.0
    assert hold(mass(holder=stop), 2.0) == -1.5e6
    assert hold(mass(holder=stop), 0.25) == 0.0
    assert stop.asked == 2
    assert Spring(stiffness=2.0).stiffness == 2.0


def test_a_row_holds_one_kind_and_is_not_empty():
    with pytest.raises(TypeError, match="same kind"):
        Chain(masses=(mass(), mass(holder=Stop(gap=1.0, asked=0))), total=0.0)
    with pytest.raises(TypeError, match="one or more"):
        Chain(masses=(), total=0.0)


@pytest.mark.parametrize("given", [{}, {"stiffnes": 1.0}, {"stiffness": 1.0, "damping": 1.0}])
def test_missing_and_wrong_fields_are_refused(given):
    with pytest.raises(TypeError, match="Spring takes stiffness, but"):
        Spring(**given)


GIVEN = {"weight": 1.0, "count": 1, "places": np.zeros(2), "holder": Spring(stiffness=1.0)}


@pytest.mark.parametrize(
    "wrong",
    [
        {"places": np.zeros((2, 2))},
        {"places": 1.0},
        {"places": np.zeros(2, dtype=complex)},
        {"places": np.array(["1"])},
        {"count": 1.5},
        {"weight": np.zeros(2)},
        {"holder": None},
        {"holder": (Spring(stiffness=1.0),)},
    ],
    ids=range(8),
)
def test_fields_of_a_wrong_kind_are_refused(wrong):
    with pytest.raises(TypeError):
        Mass(**GIVEN | wrong)


def test_arrays_are_not_rounded_to_fit():
    given = {name: getattr(Arrays.blank(2), name) for name in ("vector", "matrix", "tesseract", "flags", "unsigned")}
    with pytest.raises(TypeError, match="integers must be of int64, but is of float64"):
        Arrays(**given, integers=np.array([0.5]))
    with pytest.raises(TypeError, match="flags must be of bool"):
        Arrays(**given | {"flags": np.array([2.0])}, integers=np.zeros(1, dtype=np.int64))


@pytest.mark.parametrize("masses", [mass(), (1.0,), [mass()]])
def test_what_is_no_tuple_of_blocks_makes_no_row(masses):
    with pytest.raises(TypeError, match="masses must be"):
        Chain(masses=masses, total=0.0)


def test_only_numbers_are_set():
    block = mass()
    with pytest.raises(TypeError):
        block.count = 1.5
    for name in ("places", "holder", "height"):
        with pytest.raises(AttributeError, match=f"Mass has no number '{name}'"):
            setattr(block, name, 1.0)
    with pytest.raises(AttributeError, match="no number 'height'"):
        _ = block.height
    assert block.count == 7


def test_kernels_set_no_arrays_and_no_parts():
    @kernel
    def put(block, places):
        block.places = places

    with pytest.raises(TypingError, match="places is no number"):
        put(mass(), np.zeros(2))


def test_a_replaced_block_is_another_and_shares_what_stays():
    block = mass()
    other = block.replaced(weight=9.0)
    assert (other.weight, other.count) == (9.0, 7)
    assert other.places is block.places
    assert other.holder is block.holder
    other.count = 0
    assert (block.weight, block.count) == (1.5, 7)
    assert Chain(masses=(block, block), total=0.0).replaced(masses=(other,)).masses == (other,)


def test_blank_fields_are_zero():
    block = Mass.blank(3, count=2, holder=Spring.blank())
    assert (block.weight, block.count, block.holder.stiffness) == (0.0, 2, 0.0)
    assert block.places.tolist() == [0.0, 0.0, 0.0]
    arrays = Arrays.blank(2)
    assert arrays.matrix.shape == (2, 2)
    assert (arrays.flags.dtype, arrays.integers.dtype, arrays.unsigned.dtype) == (np.bool_, np.int64, np.uint64)


@pytest.mark.parametrize("duplicate", [copy.copy, copy.deepcopy, pickle.dumps])
def test_a_block_is_its_address_and_is_not_copied(duplicate):
    with pytest.raises(TypeError, match="use `replaced`"):
        duplicate(mass())


PROBE = """
import numpy as np
from slosh_cli.arrays import Vector
from slosh_cli.blocks import Block
from slosh_cli.compiled import inner_kernel, kernel

class Part(Block):
    places: Vector

    @inner_kernel
    def sum(self):
        total = 0.0
        for i in range(self.places.size):
            total += self.places[i]
        return total

class Whole(Block):
    parts: tuple[Part, ...]

@kernel
def sums(whole):
    total = 0.0
    for k in range(len(whole.parts)):
        total += whole.parts[k].sum()
    return total
"""
ASK = """
import sys
import numpy as np
from probe import Part, Whole, sums
sizes = [int(size) for size in sys.argv[1:]]
print(sums(Whole(parts=tuple(Part(places=np.ones(size)) for size in sizes))), sum(sums.stats.cache_hits.values()))
"""


def test_a_second_process_finds_the_kernel_for_blocks_of_other_sizes(tmp_path: Path):
    (tmp_path / "probe.py").write_text(PROBE)

    def ask(*sizes: str) -> str:
        paths = os.pathsep.join([str(tmp_path), str(Path(__file__).parents[1])])
        environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "cache"), "PYTHONPATH": paths}
        words = [sys.executable, "-c", ASK, *sizes]
        return subprocess.run(words, env=environment, cwd=tmp_path, capture_output=True, text=True, check=True).stdout

    assert ask("2", "3").split() == ["5.0", "0"]
    assert ask("4").split() == ["4.0", "1"]
