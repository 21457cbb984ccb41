"""Why a tank's slosh coefficients cannot be computed."""

from __future__ import annotations

from typing import ClassVar

from slosh_cli.errors import SloshError


class TankError(SloshError):
    """The shape or fill of a tank is outside what the computed coefficients can represent."""

    code: ClassVar[str] = "tank"
