"""The base of every part of a scenario."""

from pydantic import BaseModel, ConfigDict


class Part(BaseModel):
    """A frozen mapping of a scenario: unknown keys are refused, values are SI, names are the YAML keys.

    Validators are built at first use, for a whole scenario at once. `model_construct` makes a constant of a part
    without building one.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, defer_build=True)
