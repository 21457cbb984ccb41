"""Constants of TR-BDF2 as a singly diagonally implicit method, see `step`."""

from __future__ import annotations

import math

GAMMA = 2.0 - math.sqrt(2.0)
"""The middle stage lies at this part of the step."""
DIAGONAL = 0.5 * GAMMA
OUTER = 0.25 * math.sqrt(2.0)
"""Weights of start and middle; the end has `DIAGONAL`."""
ERROR_START = (4.0 * OUTER - 1.0) / 3.0
ERROR_MIDDLE = -1.0 / 3.0
ERROR_END = 2.0 * DIAGONAL / 3.0
"""Weights less those of the third-order companion."""
