"""Small dense systems in place and without allocation: LU with partial pivoting, and LDL^T of definite ones."""

from __future__ import annotations

from slosh_cli.compiled import kernel


@kernel
def factor_dense(matrix, pivots):
    """Replace `matrix` (n, n) by its LU factors, row exchanges into `pivots` (n,)."""
    size = matrix.shape[0]
    for k in range(size):
        best = k
        for i in range(k + 1, size):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        pivots[k] = best
        if best != k:
            for j in range(size):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        reciprocal = 1.0 / matrix[k, k]
        for i in range(k + 1, size):
            factor = matrix[i, k] * reciprocal
            matrix[i, k] = factor
            if factor != 0.0:
                for j in range(k + 1, size):
                    matrix[i, j] -= factor * matrix[k, j]


@kernel
def solve_dense(factors, pivots, right):
    """Overwrite `right` (n,) with the solution."""
    size = factors.shape[0]
    for k in range(size):
        best = pivots[k]
        if best != k:
            right[k], right[best] = right[best], right[k]
    for i in range(1, size):
        total = right[i]
        for j in range(i):
            total -= factors[i, j] * right[j]
        right[i] = total
    for i in range(size - 1, -1, -1):
        total = right[i]
        for j in range(i + 1, size):
            total -= factors[i, j] * right[j]
        right[i] = total / factors[i, i]


@kernel
def factor_symmetric(matrix):
    """Replace the lower half of a definite symmetric `matrix` (n, n) by L and, on the diagonal, by D^-1."""
    size = matrix.shape[0]
    for k in range(size):
        pivot = 1.0 / matrix[k, k]
        matrix[k, k] = pivot
        for i in range(k + 1, size):
            factor = matrix[i, k] * pivot
            for j in range(k + 1, i + 1):
                matrix[i, j] -= factor * matrix[j, k]
        for i in range(k + 1, size):
            matrix[i, k] *= pivot


@kernel
def solve_symmetric(factors, right):
    """Overwrite `right` (n,) with the solution; `factors` by `factor_symmetric`."""
    size = right.size
    for i in range(1, size):
        total = right[i]
        for j in range(i):
            total -= factors[i, j] * right[j]
        right[i] = total
    for i in range(size):
        right[i] *= factors[i, i]
    for i in range(size - 1, 0, -1):
        value = right[i]
        for j in range(i):
            right[j] -= factors[i, j] * value
