"""Kernels as the Python that they are written in: a test that calls one a few times need not compile it."""

from typing import Any

import pytest


def as_python(patch: pytest.MonkeyPatch, *owners: Any) -> None:
    """Let the kernels of modules and of classes of blocks be plain functions as long as the `patch` lasts.

    A module has its own and those that it imports; what these call is plain only if their module is given as well.
    """
    for owner in owners:
        for name, value in list(vars(owner).items()):
            if hasattr(value, "py_func"):
                patch.setattr(owner, name, value.py_func)
