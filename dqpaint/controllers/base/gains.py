"""Named numbers -> the checked gains of a law, with their units."""

from typing import Annotated, Any, ClassVar, Literal, TypeVar, get_args, get_origin

from pydantic import BaseModel, ConfigDict, Field

from dqpaint.controllers.base.matrices import LARGEST_GAIN, LEAST_GAIN, Value

Gain = Annotated[float, Field(ge=LEAST_GAIN, le=LARGEST_GAIN, allow_inf_nan=False)]
WHOLE_RUN = "it is one for a whole run"


class Gains(BaseModel):
    """The gains of one law, in SI units; each field's description says the unit.

    A field that is a `Literal` is a choice between forms of the law.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
    constant: ClassVar[dict[str, str]] = {}  # gains that cannot change on the way, and why

    def as_dict(self) -> dict[str, Value | str]:
        """The gains as a summary shows them: the ones given, then those that follow from them."""
        values = {name: getattr(self, name) for name in type(self).model_fields}
        return {name: value for name, value in values.items() if value is not None}

    @property
    def error_point(self) -> Literal["base", "tool"]:
        """Where the error is that `disturbance_bounds` are about."""
        return "base"

    @property
    def bounded_in_steps(self) -> bool:
        """Whether `dqpaint.metrics` knows what becomes of these bounds in steps."""
        return False

    @property
    def gammas(self) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """gamma_O1, gamma_O2 and gamma_T1, gamma_T2 [s] of a law that promises (3.26)."""
        return None

    def disturbance_bounds(self) -> tuple[float, float] | None:
        """Bounds [s] on the effect of disturbances, where the law guarantees any.

        Of ||1 - r_e||_2 / ||v_w||_2 and of ||p_e||_2 / ||v_t||_2, for an unmodelled twist v.
        """
        return None


G = TypeVar("G", bound=Gains)


def choices_of(model: type[Gains], name: str) -> tuple[str, ...]:
    """The words between which a field chooses; none for a number."""
    kind: Any = model.model_fields[name].annotation
    return get_args(kind) if get_origin(kind) is Literal else ()


def list_gains(model: type[Gains]) -> str:
    """Name, default and unit of every gain, as text."""
    return (
        ", ".join(
            f"{name}{'' if f.default is None else f' = {shown(f.default)}'} ({f.description})"
            for name, f in model.model_fields.items()
        )
        or "none"
    )


def shown(value: Any) -> str:
    """A default as lists show it."""
    return value if isinstance(value, str) else f"{value:g}"
