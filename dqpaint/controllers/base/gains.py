"""Named numbers -> the checked gains of a law, with their units."""

from typing import Annotated, ClassVar, TypeVar

from pydantic import BaseModel, ConfigDict, Field

LEAST_GAIN, LARGEST_GAIN = (
    1e-9,
    1e9,
)  # beyond these a gain is a slip, and its reciprocal soon no number
Gain = Annotated[float, Field(ge=LEAST_GAIN, le=LARGEST_GAIN, allow_inf_nan=False)]
Value = float | tuple[float, ...]


class Gains(BaseModel):
    """The gains of one law, in SI units; each field's description says the unit."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    constant: ClassVar[dict[str, str]] = {}  # gains that cannot change on the way, and why

    def as_dict(self) -> dict[str, Value]:
        """The gains as a summary shows them: the ones given, then those that follow from them."""
        values = {name: getattr(self, name) for name in type(self).model_fields}
        return {name: value for name, value in values.items() if value is not None}

    def disturbance_bounds(self) -> tuple[float, float] | None:
        """Bounds [s] on the effect of disturbances, where the law guarantees any.

        Of ||1 - r_e||_2 / ||v_w||_2 and of ||p_e||_2 / ||v_t||_2, for an unmodelled twist v.
        """
        return None


G = TypeVar("G", bound=Gains)


def list_gains(model: type[Gains]) -> str:
    """Name, default and unit of every gain, as text."""
    fields = model.model_fields.items()
    return (
        "none"
        if not model.model_fields
        else ", ".join(
            f"{name}{'' if f.default is None else f' = {f.default:g}'} ({f.description})"
            for name, f in fields
        )
    )
