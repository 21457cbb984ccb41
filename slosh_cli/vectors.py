"""Copying, filling and looking up without allocation: the kernels run with numba's memory manager switched off."""

from __future__ import annotations

from slosh_cli.compiled import kernel


@kernel
def fill(target, value):
    """Set every entry of the one-dimensional `target`."""
    for i in range(target.size):
        target[i] = value


@kernel
def copy(source, target):
    """Copy the one-dimensional `source` to `target` of the same size."""
    for i in range(target.size):
        target[i] = source[i]


@kernel
def cell_of(knots, place):
    """Number of the cell of the rising `knots` that a `place` lies in; the first or the last one beyond them."""
    low, high = 0, knots.size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if knots[middle] <= place:
            low = middle
        else:
            high = middle
    return low
