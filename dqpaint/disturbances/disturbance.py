"""What a disturbance is, and how one is made from its name and values."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.registry import Registry

Values = Mapping[str, float | str]


class Disturbance(BaseModel):
    """One disturbance; its fields are its values in SI units, each description says the unit.

    A value that is given without a name is the first field's.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    def twist(self, t: Floats, period: float, rng: np.random.Generator) -> Floats:
        """The tool's unmodelled velocity (N, 6) from each time (N,) [s] to the next.

        Angular first [rad/s], then of the tool's own point [m/s], along the axes of the base.

        Raises:
            UsageError: a value that does not go with the period.
        """
        return np.zeros((len(t), 6))


DISTURBANCES: Registry[type[Disturbance]] = Registry("disturbance")


def make_disturbances(given: Mapping[str, Values]) -> dict[str, Disturbance]:
    """Disturbances by their names, from the values given for each.

    Raises:
        UsageError: an unknown disturbance, an unknown value, or one outside its range.
    """
    return {name: _make(name, DISTURBANCES[name], values) for name, values in given.items()}


def _make(name: str, model: type[Disturbance], values: Values) -> Disturbance:
    named: dict[str, Any] = dict(values)
    if "" in named:
        named.setdefault(next(iter(model.model_fields)), named.pop(""))
    try:
        return model.model_validate(named)
    except ValidationError as problem:
        first = problem.errors()[0]
        field = ".".join(str(part) for part in first["loc"])
        if first["type"] == "extra_forbidden":
            fault = f"has no value named '{field}'"
        elif field:
            fault = f"{field} {first['input']!r} {first['msg'].removeprefix('Input ')}"
        else:
            fault = first["msg"].removeprefix("Value error, ")
        fields = model.model_fields.items()
        known = ", ".join(f"{word} ({field.description})" for word, field in fields)
        raise UsageError(f"disturbance '{name}': {fault}; its values: {known}") from None
