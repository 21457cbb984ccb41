"""Matrices that couple the nodes of a beam with their neighbours: products, LDU factors and solutions.

A vector (2 n,) holds the deflections of n nodes, then their slopes. A node has two rows of six entries, one row for its
deflection and one for its slope: deflection and slope of the node before, of the node itself, of the node after. Where
the mesh is even the rows repeat, so they are stored once per run of nodes: `rows` (r, 12) for `runs` (r, 4), see below.
The beam's first node has zeros for what lies before it, its last one for what comes after; the neighbour they name is
the node itself.

No pivoting: the rail's matrices have a positive definite symmetric part below the critical speed, which bounds the
growth (Golub and Van Loan, Matrix Computations, section 4.3.3).
"""

from __future__ import annotations

import numpy as np

from slosh_cli.arrays import Cube, Matrix, Unsigned
from slosh_cli.compiled import inner_kernel, kernel, vector_kernel

ENTRIES = 12
"""Entries in the two rows of a node; those of L, D^-1 and U there are as many."""
FIRST, END, BEFORE, AFTER = range(4)
"""A run: its first node, the one past its last, the nodes before and after the first one. Unsigned, as counting from
the end of a vector would keep loops from being vectorised."""


@inner_kernel
def entries(row, k):
    """The twelve entries from place `k` of `row` on as numbers: loops then keep them in registers."""
    return (
        row[k], row[k + 1], row[k + 2], row[k + 3], row[k + 4], row[k + 5],
        row[k + 6], row[k + 7], row[k + 8], row[k + 9], row[k + 10], row[k + 11],
    )  # fmt: skip


@vector_kernel
def by_deflection(row, vector, nodes, before, here, after):
    """Product of a deflection's row (`entries`) with the values of `vector` (2 n,) at three of the n `nodes`."""
    return (
        row[0] * vector[before] + row[1] * vector[nodes + before]
        + row[2] * vector[here] + row[3] * vector[nodes + here]
        + row[4] * vector[after] + row[5] * vector[nodes + after]
    )  # fmt: skip


@vector_kernel
def by_slope(row, vector, nodes, before, here, after):
    """The same with the row of a slope."""
    return (
        row[6] * vector[before] + row[7] * vector[nodes + before]
        + row[8] * vector[here] + row[9] * vector[nodes + here]
        + row[10] * vector[after] + row[11] * vector[nodes + after]
    )  # fmt: skip


@vector_kernel
def pair_sums(run, left, right):
    """Sums over a run's nodes of what `left` (2 n,) has at a node times what `right` has around it.

    In the order of `entries`: with a matrix's entries they make its bilinear form.
    """
    nodes = np.uint64(left.size // 2)
    first, first_before, first_after = run[FIRST], run[BEFORE], run[AFTER]
    a = b = c = d = e = f = g = h = k = m = n = o = 0.0
    for i in range(run[END] - first):
        before, here, after = first_before + i, first + i, first_after + i
        w, s = left[here], left[nodes + here]
        a += w * right[before]
        b += w * right[nodes + before]
        c += w * right[here]
        d += w * right[nodes + here]
        e += w * right[after]
        f += w * right[nodes + after]
        g += s * right[before]
        h += s * right[nodes + before]
        k += s * right[here]
        m += s * right[nodes + here]
        n += s * right[after]
        o += s * right[nodes + after]
    return a, b, c, d, e, f, g, h, k, m, n, o


@vector_kernel
def weighed(row, k, sums):
    """The twelve entries from place `k` of `row` on, each times its `pair_sums`, in sum."""
    a, b, c, d, e, f, g, h, m, n, o, p = sums
    return (
        row[k] * a + row[k + 1] * b + row[k + 2] * c + row[k + 3] * d + row[k + 4] * e + row[k + 5] * f
        + row[k + 6] * g + row[k + 7] * h + row[k + 8] * m + row[k + 9] * n + row[k + 10] * o + row[k + 11] * p
    )  # fmt: skip


@kernel
def factor_rows(runs: Unsigned, rows: Matrix, factors: Matrix) -> None:
    """Factor the matrix of the first 12 columns of `rows` into L, D^-1 and U with unit diagonals: `factors` (12, n).

    Unknowns are eliminated node by node, the deflection first. By node: the deflection's two entries of L, its D^-1,
    its three of U, then the slope's three of L, its D^-1, its two of U.
    """
    # of the node before: reciprocal pivots, and the entries of D U right of them
    pivot_w = pivot_s = w_to_slope = w_to_next = w_to_next_slope = s_to_next = s_to_next_slope = 0.0
    for run in range(runs.shape[0]):
        w_1, w_2, w_3, w_4, w_5, w_6, s_1, s_2, s_3, s_4, s_5, s_6 = entries(rows[run], 0)
        for i in range(runs[run, FIRST], runs[run, END]):
            far, s_far = w_1 * pivot_w, s_1 * pivot_w
            near, s_middle = (w_2 - far * w_to_slope) * pivot_s, (s_2 - s_far * w_to_slope) * pivot_s
            # the node's own 2 x 2 block, both pivots found side by side
            own = w_3 - far * w_to_next - near * s_to_next
            right = w_4 - far * w_to_next_slope - near * s_to_next_slope
            below = s_3 - s_far * w_to_next - s_middle * s_to_next
            own_s = s_4 - s_far * w_to_next_slope - s_middle * s_to_next_slope
            pivot_w, pivot_s = 1.0 / own, own / (own * own_s - below * right)
            s_near = below * pivot_w
            w_to_slope, w_to_next, w_to_next_slope = right, w_5, w_6
            s_to_next, s_to_next_slope = s_5 - s_near * w_5, s_6 - s_near * w_6
            factors[0, i], factors[1, i], factors[2, i] = far, near, pivot_w
            factors[3, i], factors[4, i], factors[5, i] = right * pivot_w, w_5 * pivot_w, w_6 * pivot_w
            factors[6, i], factors[7, i], factors[8, i], factors[9, i] = s_far, s_middle, s_near, pivot_s
            factors[10, i], factors[11, i] = s_to_next * pivot_s, s_to_next_slope * pivot_s


@vector_kernel
def solve_one(factors, right):
    """Overwrite the right-hand side `right` (2 n,) with the solution; `factors` by `factor_rows`."""
    nodes = factors.shape[1]
    deflection, slope = right[:nodes], right[nodes:]
    w = s = 0.0
    for i in range(nodes):
        rest = slope[i] - factors[6, i] * w - factors[7, i] * s
        w = deflection[i] - factors[0, i] * w - factors[1, i] * s
        s = rest - factors[8, i] * w
        deflection[i], slope[i] = w, s
    w = s = 0.0
    for i in range(nodes - 1, -1, -1):
        rest = deflection[i] * factors[2, i] - factors[4, i] * w - factors[5, i] * s
        s = slope[i] * factors[9, i] - factors[10, i] * w - factors[11, i] * s
        w = rest - factors[3, i] * s
        deflection[i], slope[i] = w, s


@vector_kernel
def solve_four(factors: Matrix, right: Cube) -> None:
    """`solve_one` for four right-hand sides `right` (n, 2, 4): deflection and slope of node after node."""
    nodes = factors.shape[1]
    w_1 = w_2 = w_3 = w_4 = s_1 = s_2 = s_3 = s_4 = 0.0
    for i in range(nodes):
        far, near = factors[0, i], factors[1, i]
        s_far, s_middle, s_near = factors[6, i], factors[7, i], factors[8, i]
        w, s = right[i, 0], right[i, 1]
        rest_1, rest_2 = s[0] - s_far * w_1 - s_middle * s_1, s[1] - s_far * w_2 - s_middle * s_2
        rest_3, rest_4 = s[2] - s_far * w_3 - s_middle * s_3, s[3] - s_far * w_4 - s_middle * s_4
        w_1, w_2 = w[0] - far * w_1 - near * s_1, w[1] - far * w_2 - near * s_2
        w_3, w_4 = w[2] - far * w_3 - near * s_3, w[3] - far * w_4 - near * s_4
        s_1, s_2, s_3, s_4 = rest_1 - s_near * w_1, rest_2 - s_near * w_2, rest_3 - s_near * w_3, rest_4 - s_near * w_4
        w[0], w[1], w[2], w[3] = w_1, w_2, w_3, w_4
        s[0], s[1], s[2], s[3] = s_1, s_2, s_3, s_4
    w_1 = w_2 = w_3 = w_4 = s_1 = s_2 = s_3 = s_4 = 0.0
    for i in range(nodes - 1, -1, -1):
        pivot, near, next_w, next_s = factors[2, i], factors[3, i], factors[4, i], factors[5, i]
        s_pivot, s_next_w, s_next_s = factors[9, i], factors[10, i], factors[11, i]
        w, s = right[i, 0], right[i, 1]
        rest_1, rest_2 = w[0] * pivot - next_w * w_1 - next_s * s_1, w[1] * pivot - next_w * w_2 - next_s * s_2
        rest_3, rest_4 = w[2] * pivot - next_w * w_3 - next_s * s_3, w[3] * pivot - next_w * w_4 - next_s * s_4
        s_1, s_2 = s[0] * s_pivot - s_next_w * w_1 - s_next_s * s_1, s[1] * s_pivot - s_next_w * w_2 - s_next_s * s_2
        s_3, s_4 = s[2] * s_pivot - s_next_w * w_3 - s_next_s * s_3, s[3] * s_pivot - s_next_w * w_4 - s_next_s * s_4
        w_1, w_2, w_3, w_4 = rest_1 - near * s_1, rest_2 - near * s_2, rest_3 - near * s_3, rest_4 - near * s_4
        w[0], w[1], w[2], w[3] = w_1, w_2, w_3, w_4
        s[0], s[1], s[2], s[3] = s_1, s_2, s_3, s_4
