"""What is known of an arm's motors and gears, as a table of its card."""

from typing import Annotated

from pydantic import Field

from dqpaint.robots.model.fields import Part, Positive

NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]


class DriveTrain(Part):
    """Motors and gears: one number for each joint, at the joint's side of the gear.

    Only what a source says is there; the plant `servo` assumes the rest, and tells so.

    Attributes:
        source: where the numbers are from.
        gear: the ratio N.
        reflected_inertia_kg_m2: N^2 J of the rotor.
        viscous_Nm_s_rad: friction by rate.
        friction_Nm: Coulomb friction.
        stiffness_Nm_rad: of the gear, or of a series elastic joint's spring.
        hold_Nm_rad: stiffness of a loop around the joint's angle, where a servo has one.
        backlash_deg: the whole gap.
        ripple_Nm: amplitude of the torque's ripple.
    """

    source: str
    gear: tuple[Positive, ...] = ()
    reflected_inertia_kg_m2: tuple[Positive, ...] = ()
    viscous_Nm_s_rad: tuple[NotNegative, ...] = ()
    friction_Nm: tuple[NotNegative, ...] = ()
    stiffness_Nm_rad: tuple[Positive, ...] = ()
    hold_Nm_rad: tuple[Positive, ...] = ()
    backlash_deg: tuple[NotNegative, ...] = ()
    ripple_Nm: tuple[NotNegative, ...] = ()

    def wrong_length(self, joints: int) -> str:
        """The name of a row that has not one number a joint; empty if all have."""
        rows = {name: row for name, row in self if name != "source"}
        return next((name for name, row in rows.items() if row and len(row) != joints), "")
