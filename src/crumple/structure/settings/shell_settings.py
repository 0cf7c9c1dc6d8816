"""Settings of the shell solver."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, model_validator

from crumple.registry.quantity import (
    NUMBER,
    Dimension,
    Fraction,
    FrictionCoefficient,
    NonNegativeLength,
    PositiveLength,
    PositiveTime,
)
from crumple.registry.refusal import refuse
from crumple.structure.schema.spec import Name, Spec


def _on_or_off(given: Any) -> Any:
    return {True: "on", False: "off"}[given] if isinstance(given, bool) else given


Switch = Annotated[Literal["on", "off"], BeforeValidator(_on_or_off)]
Growth = Annotated[float, replace(NUMBER, example="1.15", above=1.0, at_most=2.0)]
SafetyFactor = Annotated[float, replace(NUMBER, example="0.9", above=0.0, at_most=1.0)]
HourglassCoefficient = Annotated[float, replace(NUMBER, example="0.01", at_least=0.0, at_most=0.2)]
DrillStiffness = Annotated[float, replace(NUMBER, example="0.01", at_least=0.0, at_most=0.05)]
Damping = Annotated[float, Dimension("a damping rate", "1/s", "10 1/s", at_least=0.0)]


class FinePlace(Spec):
    """A place of a member with a fine mesh around it."""

    member: Name
    """Member."""
    at: NonNegativeLength
    """Distance from the member's first node."""


class ShellSettings(Spec):
    """Settings of the shell solver: mesh, element, contact and stepper."""

    element_size: PositiveLength = 5e-3
    """Length of the elements; where a finer size is given, that of the elements far from the fine zones."""
    fine_size: PositiveLength | None = None
    """Length of the elements near supports, joints and hinge places, and around every section."""
    fine_length: PositiveLength | None = None
    """How far the fine mesh reaches to both sides of such a place; without it twice the largest side."""
    growth: Growth = 1.15
    """Largest ratio of the lengths of neighbouring elements between fine and coarse."""
    coarse_sections: Switch = "off"
    """Divide sections half as finely where the elements are longer than twice the fine size, again where they
    are longer than four times it, and so on: fewer elements, with triangles where both meet."""
    t_joints: Literal["welded"] | None = None
    """How three rectangular tubes are joined of which two lie in line with one section: `welded`, the third
    one's walls to the face that they meet, so that the face can yield; without it all ends are one rigid
    body, as where members are held or loaded at the node."""
    fine_at: tuple[FinePlace, ...] = ()
    """Further places with a fine mesh."""
    weld_pitch: PositiveLength | None = None
    """Distance of the spots along lines of spot welds; without it every node of a line is tied."""
    imperfection: NonNegativeLength = 0.0
    """Largest pseudo-random shift of each wall node across its wall: without it, a perfect mesh under axial
    load folds unlike any real tube."""
    thickness_points: Annotated[int, Field(ge=1, le=10, strict=True)] = 5
    """Points through the thickness."""
    thickness_rule: Literal["gauss", "lobatto"] = "gauss"
    """Rule that places them; Gauss is exact for higher powers, Lobatto (2 or more) has points on the
    surfaces."""
    element: Literal["belytschko-tsay", "stabilised"] = "belytschko-tsay"
    """Quadrilateral with one point: held by hourglass coefficients, or by the metal's own stiffness."""
    thickness_update: Switch = "on"
    """Let the walls become thinner where they are stretched and thicker where they are compressed."""
    hourglass: Literal["stiffness", "viscous"] = "stiffness"
    """What holds the modes that the point of a belytschko-tsay element cannot see."""
    hourglass_coefficient: HourglassCoefficient = 0.01
    """How strongly they are held."""
    warping_correction: Switch = "off"
    """Bending terms of elements whose corners do not lie in one plane: needed for twisted members; costs a
    fifth of the time."""
    drill_stiffness: DrillStiffness = 0.01
    """With the warping correction: stiffness against rotation of a corner about the wall's normal, over shear
    modulus times volume."""
    safety_factor: SafetyFactor = 0.9
    """Share of the stable time step that is used."""
    mass_scaling: PositiveTime | None = None
    """Time step below which elements are made heavier instead; the added mass is reported."""
    minimum_time_step: PositiveTime = 1e-10
    """A stable time step below it ends the run with a status."""
    self_contact: Switch = "on"
    """Contact of walls with walls."""
    contact_friction: FrictionCoefficient = 0.0
    """Coulomb coefficient between walls."""
    damping: Damping = 0.0
    """Damping force over momentum."""
    energy_residual_bound: Fraction = 0.01
    """Energy residual above which the status marks the result as not reliable."""

    @model_validator(mode="after")
    def _rule_has_points(self) -> ShellSettings:
        if self.thickness_rule == "lobatto" and self.thickness_points == 1:
            refuse("Lobatto's rule has at least two points", key="thickness_points", allowed="2 to 10")
        return self

    @model_validator(mode="after")
    def _nothing_idle(self) -> ShellSettings:
        """Refuse keys that have no effect with the others."""
        graded = self.fine_size is not None
        needs: dict[str, tuple[bool, str, str]] = {
            **dict.fromkeys(
                ("fine_length", "growth", "fine_at"),
                (graded, "all elements have one size", "add 'fine_size'"),
            ),
            "coarse_sections": (graded, "coarse sections lie away from fine ones", "add 'fine_size'"),
            **dict.fromkeys(
                ("hourglass", "hourglass_coefficient"),
                (
                    self.element != "stabilised",
                    "the stabilised element holds itself",
                    "choose the other element",
                ),
            ),
            "drill_stiffness": (
                self.warping_correction == "on",
                "nothing bends by the drill without the warping correction",
                "add 'warping_correction: on'",
            ),
        }
        for key, (works, why, todo) in needs.items():
            if not works and getattr(self, key) != type(self).model_fields[key].default:
                refuse(f"'{key}' would have no effect: {why}", key=key, todo=f"{todo}, or omit it")
        return self

    @model_validator(mode="after")
    def _fine_is_finer(self) -> ShellSettings:
        if self.fine_size is not None and self.fine_size > self.element_size:
            refuse(
                "the fine size is larger than the element size",
                key="fine_size",
                allowed=f"at most {1e3 * self.element_size:g} mm",
                todo="exchange them",
            )
        return self
