"""How long a stop takes beside other ways of computing it, and beside what no way can do without: `make bench`.

Every contestant solves the same stop, the paper's wagon with its liquid from 160 km/h with 5 kN m on every wheel. The
modules named `bench_...` are tests for pytest-benchmark; the others are the contestants, the tables and the figures.
"""
