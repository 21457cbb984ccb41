"""LDU of banded matrices with three diagonals either side, and its solutions.

A matrix is stored by diagonals: entry (i, j) at [3 + j - i, i], shape (7, n), zeros where there is no entry. So every
loop runs along the diagonals, and what a row needs of the rows before it stays in registers.

No pivoting: the rail's matrices have a positive definite symmetric part below the critical speed, which bounds the
growth (Golub and Van Loan, Matrix Computations, section 4.3.3).
"""

from __future__ import annotations

from slosh_cli.compiled import vector_kernel


@vector_kernel
def factor_banded(matrix):
    """Replace `matrix` (7, n) by its factors L, D^-1 (on the diagonal) and U, both with unit diagonals."""
    pivot_1 = pivot_2 = pivot_3 = 0.0  # reciprocal pivots of the rows 1, 2 and 3 above
    near_11 = near_12 = near_13 = 0.0  # entries right of the diagonal in the row above: D U
    near_21 = near_22 = near_23 = 0.0  # two rows above
    near_31 = near_32 = near_33 = 0.0  # three rows above
    for i in range(matrix.shape[1]):
        left_3 = matrix[0, i] * pivot_3
        left_2 = (matrix[1, i] - left_3 * near_31) * pivot_2
        left_1 = (matrix[2, i] - left_3 * near_32 - left_2 * near_21) * pivot_1
        pivot = 1.0 / (matrix[3, i] - left_3 * near_33 - left_2 * near_22 - left_1 * near_11)
        near_31, near_32, near_33 = near_21, near_22, near_23
        near_21, near_22, near_23 = near_11, near_12, near_13
        near_11 = matrix[4, i] - left_2 * near_33 - left_1 * near_22
        near_12 = matrix[5, i] - left_1 * near_23
        near_13 = matrix[6, i]
        matrix[0, i], matrix[1, i], matrix[2, i], matrix[3, i] = left_3, left_2, left_1, pivot
        matrix[4, i], matrix[5, i], matrix[6, i] = near_11 * pivot, near_12 * pivot, near_13 * pivot
        pivot_1, pivot_2, pivot_3 = pivot, pivot_1, pivot_2


@vector_kernel
def solve_banded_one(factors, right):
    """Overwrite the right-hand side `right` (n,) with the solution."""
    size = right.size
    one = two = three = 0.0
    for i in range(size):
        value = right[i] - factors[0, i] * three - factors[1, i] * two
        one, two, three = value - factors[2, i] * one, one, two
        right[i] = one
    one = two = three = 0.0
    for i in range(size - 1, -1, -1):
        value = right[i] * factors[3, i] - factors[6, i] * three - factors[5, i] * two
        one, two, three = value - factors[4, i] * one, one, two
        right[i] = one


@vector_kernel
def solve_banded_four(factors, right):
    """Overwrite four right-hand sides `right` (4, n) with their solutions, two and two in one pass."""
    size = right.shape[1]
    for k in range(0, 4, 2):
        a1 = a2 = a3 = b1 = b2 = b3 = 0.0
        for i in range(size):
            far, middle, near = factors[0, i], factors[1, i], factors[2, i]
            a = right[k, i] - far * a3 - middle * a2
            b = right[k + 1, i] - far * b3 - middle * b2
            a1, a2, a3 = a - near * a1, a1, a2
            b1, b2, b3 = b - near * b1, b1, b2
            right[k, i], right[k + 1, i] = a1, b1
        a1 = a2 = a3 = b1 = b2 = b3 = 0.0
        for i in range(size - 1, -1, -1):
            pivot, near, middle, far = factors[3, i], factors[4, i], factors[5, i], factors[6, i]
            a = right[k, i] * pivot - far * a3 - middle * a2
            b = right[k + 1, i] * pivot - far * b3 - middle * b2
            a1, a2, a3 = a - near * a1, a1, a2
            b1, b2, b3 = b - near * b1, b1, b2
            right[k, i], right[k + 1, i] = a1, b1


@vector_kernel
def form_banded(matrix, left, right):
    """The bilinear form `left @ matrix @ right`."""
    size = left.size
    value = 0.0
    for k in range(7):
        for i in range(max(0, 3 - k), min(size, size + 3 - k)):
            value += left[i] * matrix[k, i] * right[i + k - 3]
    return value
