"""Every malformed scenario, for the tests of loader and command line (their form: malformed_case)."""

from malformed_case import Case, Expected
from malformed_files import FILES, OVERRIDES, SEVERAL, YAML_SYNTAX
from malformed_structure import CHOICES, CROSS_RULES, DUPLICATES, POLYGONS
from malformed_values import RANGES, SHAPES_AND_TYPES, UNITS, UNKNOWN_KEYS

CASES: tuple[Case, ...] = (
    *UNKNOWN_KEYS,
    *UNITS,
    *RANGES,
    *SHAPES_AND_TYPES,
    *DUPLICATES,
    *CHOICES,
    *POLYGONS,
    *CROSS_RULES,
    *YAML_SYNTAX,
    *FILES,
    *OVERRIDES,
    *SEVERAL,
)
"""Their names are unique; `case.write(folder)` gives the path to load with `case.overrides`."""

__all__ = ["CASES", "Case", "Expected"]
