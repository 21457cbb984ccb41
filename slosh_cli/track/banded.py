"""LU of row-wise banded matrices with three diagonals either side, and its solutions.

No pivoting: the rail's matrices have a positive definite symmetric part below the critical speed, which bounds the
growth (Golub and Van Loan, Matrix Computations, section 4.3.3).
"""

from __future__ import annotations

from slosh_cli.compiled import kernel


@kernel
def factor_banded(matrix):
    """Replace `matrix` (n, 7), entry (i, j) at [i, 3 + j - i], by its factors; the diagonal holds reciprocals."""
    size = matrix.shape[0]
    for k in range(size):
        pivot = 1.0 / matrix[k, 3]
        matrix[k, 3] = pivot
        for below in range(1, min(4, size - k)):
            factor = matrix[k + below, 3 - below] * pivot
            matrix[k + below, 3 - below] = factor
            matrix[k + below, 4 - below] -= factor * matrix[k, 4]
            matrix[k + below, 5 - below] -= factor * matrix[k, 5]
            matrix[k + below, 6 - below] -= factor * matrix[k, 6]


@kernel
def solve_banded_one(factors, right):
    """Overwrite the right-hand side `right` (n,) with the solution."""
    size = factors.shape[0]
    for i in range(1, size):
        total = right[i]
        for j in range(max(0, i - 3), i):
            total -= factors[i, 3 + j - i] * right[j]
        right[i] = total
    for i in range(size - 1, -1, -1):
        total = right[i]
        for j in range(i + 1, min(size, i + 4)):
            total -= factors[i, 3 + j - i] * right[j]
        right[i] = total * factors[i, 3]


@kernel
def solve_banded_four(factors, right):
    """Overwrite four right-hand sides `right` (n, 4) with their solutions in one pass."""
    size = factors.shape[0]
    for i in range(1, size):
        for j in range(max(0, i - 3), i):
            factor = factors[i, 3 + j - i]
            for k in range(4):
                right[i, k] -= factor * right[j, k]
    for i in range(size - 1, -1, -1):
        for j in range(i + 1, min(size, i + 4)):
            factor = factors[i, 3 + j - i]
            for k in range(4):
                right[i, k] -= factor * right[j, k]
        pivot = factors[i, 3]
        for k in range(4):
            right[i, k] *= pivot


@kernel
def multiply_banded(matrix, vector, scale, result):
    """Add `scale * matrix @ vector` to `result` (n,)."""
    size = matrix.shape[0]
    for i in range(size):
        total = 0.0
        for j in range(max(0, i - 3), min(size, i + 4)):
            total += matrix[i, 3 + j - i] * vector[j]
        result[i] += scale * total


@kernel
def form_banded(matrix, left, right):
    """The bilinear form `left @ matrix @ right`."""
    size = matrix.shape[0]
    value = 0.0
    for i in range(size):
        total = 0.0
        for j in range(max(0, i - 3), min(size, i + 4)):
            total += matrix[i, 3 + j - i] * right[j]
        value += left[i] * total
    return value
