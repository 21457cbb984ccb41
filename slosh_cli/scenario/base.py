"""The base of every part of a scenario."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict


class Part(BaseModel):
    """A frozen mapping of a scenario: unknown keys are refused, values are SI, names are the YAML keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
