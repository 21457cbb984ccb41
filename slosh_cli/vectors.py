"""Copying and filling without allocation: the kernels run with numba's memory manager switched off."""

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
