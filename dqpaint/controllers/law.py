"""What a control law is: a function of what it sees, and its gains."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Generic, NamedTuple, TypeVar, cast

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from dqpaint.dq import Floats
from dqpaint.errors import UsageError
from dqpaint.registry import Registry

LEAST, MOST = 1e-9, 1e9  # beyond these a gain is a slip, and its reciprocal soon no number
Gain = Annotated[float, Field(ge=LEAST, le=MOST, allow_inf_nan=False)]


class Gains(BaseModel):
    """The gains of one law, in SI units; each field's description says the unit."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    def shown(self) -> dict[str, float]:
        """The gains as a summary shows them: the ones given, then those that follow from them."""
        return {name: getattr(self, name) for name in type(self).model_fields}


G = TypeVar("G", bound=Gains)


class Seen(NamedTuple):
    """What a law sees at one control step; arrays of any leading shape.

    Attributes:
        pose: measured pose (..., 8), its sign arbitrary.
        pose_d: desired pose (..., 8).
        twist_d: desired spatial twist (..., 6) [rad/s, m/s].
        acceleration_d: its plain derivative (..., 6) [rad/s^2, m/s^2].
        jacobian: J_w (..., 6, n), xi = J_w q_dot.
        posture: measured joint angles (..., n) [rad].
        time: since the drawing began [s].
        period: of the control [s].
    """

    pose: Floats
    pose_d: Floats
    twist_d: Floats
    acceleration_d: Floats
    jacobian: Floats
    posture: Floats
    time: float
    period: float


@dataclass(frozen=True)
class Controller(Generic[G]):
    """A named law: what it sees and its gains to a commanded spatial twist (..., 6)."""

    name: str
    source: str
    gains: type[G]
    law: Callable[[Seen, G], Floats]

    @property
    def summary(self) -> str:
        """The first sentence of the law's own docstring."""
        return (self.law.__doc__ or "").strip().splitlines()[0].rstrip(".")

    def read_gains(self, given: dict[str, float]) -> G:
        """The gains with the given ones replaced.

        Raises:
            UsageError: an unknown name or a value outside its range; lists the law's own.
        """
        try:
            return self.gains(**cast(dict[str, Any], given))
        except ValidationError as problem:
            first = problem.errors()[0]
            name = str(first["loc"][0])
            if first["type"] == "extra_forbidden":
                text = f"controller '{self.name}' has no gain named '{name}'"
            else:
                value = f"gain '{name}' of controller '{self.name}' is {first['input']}"
                text = f"{value}; a gain is a number from {LEAST:g} to {MOST:g}"
            raise UsageError(f"{text}; its gains: {self.list_gains()}") from None

    def list_gains(self) -> str:
        """Name, default and unit of every gain, in words."""
        fields = self.gains.model_fields.items()
        return ", ".join(f"{name} = {f.default:g} ({f.description})" for name, f in fields)


CONTROLLERS: Registry[Controller[Any]] = Registry("controller")


def controller(
    name: str, source: str, gains: type[G]
) -> Callable[[Callable[[Seen, G], Floats]], Callable[[Seen, G], Floats]]:
    """A decorator that registers the law below it."""

    def record(law: Callable[[Seen, G], Floats]) -> Callable[[Seen, G], Floats]:
        CONTROLLERS.add(name)(Controller(name, source, gains, law))
        return law

    return record
