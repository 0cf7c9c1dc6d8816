"""Axes of a hinge, the law of each, and their interaction."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import BeforeValidator, Field, model_validator

from crumple.hinge.registry import AXIAL, DEFAULT_TORSION, TORSION, options_of
from crumple.registry.keys import Key, sentence_on
from crumple.registry.quantity import PositiveAngle, PositiveForce, PositiveLength
from crumple.registry.refusal import refuse
from crumple.structure.keys.law import LawReference
from crumple.structure.schema.registered import Registered
from crumple.structure.schema.spec import Spec
from crumple.units import format_quantity

BendingAxis = Literal["y", "z"]
"""Section axis that the moment vector of a hinge lies along."""
HingeAxis = Literal["x", "y", "z"]
"""Axis of a hinge's rotation; x is twist."""
CouplingName = Literal["section", "ellipsoid", "none", "ball", "tension-flange"]


if TYPE_CHECKING:
    AxialName = str
else:
    # pydantic checks and lists the names
    AxialName = Literal[*AXIAL]


class Twist(Registered):
    """Resistance of a hinge in torsion."""

    tag: ClassVar[str] = "law"
    default_type: ClassVar[str | None] = DEFAULT_TORSION

    law: str = DEFAULT_TORSION
    """Law of the torque against the twist."""

    @classmethod
    def types(cls) -> Iterable[str]:
        """Laws of torsion."""
        return TORSION

    @classmethod
    def keys_of_type(cls, kind: str) -> tuple[Key, ...]:
        """Options of a law."""
        return options_of(TORSION[kind])

    @classmethod
    def sentence_of(cls, kind: str) -> str:
        """What a law is."""
        return sentence_on(TORSION[kind])


class AxialSlip(Spec):
    """Resistance of a hinge along its member: yield in tension, folding in compression."""

    law: AxialName | None = None
    """Law of axial crushing over the stretch of member that the hinge stands for; without it, and without
    'mean', a stored law, else the walls yield in both senses and do not fold."""
    peak: PositiveForce | None = None
    """Largest force in compression, in place of a law."""
    mean: PositiveForce | None = None
    """Mean force over the stroke."""
    stroke: PositiveLength | None = None
    """Shortening at which the folds are closed."""
    tension: PositiveForce | None = None
    """Force in tension; without it that at which all walls yield."""

    @property
    def yields(self) -> bool:
        """Whether it names no folding: a stored law is used if there is one, else the walls yield."""
        return self.law is None and self.mean is None

    @model_validator(mode="after")
    def _whole(self) -> AxialSlip:
        forces = {"peak": self.peak, "mean": self.mean, "stroke": self.stroke}
        given = [name for name, value in forces.items() if value is not None]
        if self.law is not None and given:
            refuse("a law and given forces exclude each other", key=given[0], todo="remove one of them")
        if given and len(given) < len(forces):
            missing = next(name for name in forces if name not in given)
            refuse(
                f"axial folding needs '{missing}'", allowed="peak, mean and stroke together", todo="add it"
            )
        if self.peak is not None and self.mean is not None and self.mean > self.peak:
            refuse(
                "the mean force is above the peak",
                key="mean",
                allowed=f"at most {format_quantity(self.peak, 'N')}",
                todo="give a higher peak or a lower mean",
            )
        return self


class AxisLaws(Spec):
    """Laws of single bending axes, where they differ."""

    y: LawReference | None = None
    """Bending about y."""
    z: LawReference | None = None
    """Bending about z."""


def _yes(given: Any) -> Any:
    """`true` means with all defaults, `false` not at all."""
    if isinstance(given, bool):
        return {True: {}, False: None}[given]
    if given is not None and not isinstance(given, Mapping | Spec):
        refuse(
            "this does not say whether the hinge changes its length",
            allowed="true, false, or keys such as {law: NAME}",
            todo="write true or false without quotation marks, or keys",
        )
    return given


class HingeAxes(Spec):
    """Axes of a hinge, their laws, and its fracture."""

    axis: BendingAxis | None = None
    """Section axis that the moment vector lies along; without it the one across the plane of bending."""
    law: LawReference | None = None
    """Name of a hinge law or of a law type, or a law itself; without it, or `auto`, a stored law, else the
    library (automatic hinges of tubes) or the formula of the section's shape, else an estimate."""
    axes: Annotated[tuple[HingeAxis, ...], Field(min_length=1, max_length=3)] | None = None
    """All section axes that it turns about, in place of `axis`: y and z bend, x is twist."""
    laws: AxisLaws | None = None
    """Laws of single bending axes in place of `law`."""
    twist: Twist | None = None
    """What it carries in twist, with x among the axes; without it a stored law, else the plastic torque;
    of open sections with the warping that the ends of the member hold."""
    axial: Annotated[AxialSlip | None, BeforeValidator(_yes, json_schema_input_type=bool | AxialSlip)] = None
    """Whether it also yields or folds along the member; `true`: folds by a stored law, else yields. Automatic
    hinges of a straight run between supports and of braced members do so unless this is `false`; those of
    structures that an impact at the start would stop if lengths stayed also do; those of elastic members also
    where an obstacle strikes a rigid joint, at mitred corners that obstacles may press, and where a run shows
    forces beyond what folds or yields the walls. Braced tubes, and those of such structures, fold by the law
    of their section."""
    coupling: CouplingName | None = None
    """How its axes share the capacity: the interaction of the section's walls (default), an ellipsoid, none,
    a ball (one curve over the angle of rotation), or a fold about its tension flange."""
    fracture: PositiveAngle | None = None
    """Plastic rotation at which it breaks."""

    @model_validator(mode="after")
    def _axes_fit(self) -> HingeAxes:
        if self.axes is None:
            if self.twist is not None:
                refuse("'twist' needs x among the axes", key="twist", todo="write axes: [x, y], or remove it")
            return self
        if self.axis is not None:
            refuse("'axis' and 'axes' exclude each other", key="axis", todo="remove 'axis'")
        if len(set(self.axes)) < len(self.axes):
            refuse("an axis is given twice", key="axes", allowed="x, y and z, each at most once")
        if not self.bending:
            refuse("a hinge bends about y or z at least", key="axes", todo="add y or z")
        if self.twist is not None and "x" not in self.axes:
            refuse("'twist' needs x among the axes", key="twist", todo="add x to the axes, or remove it")
        return self

    @model_validator(mode="after")
    def _keys_act(self) -> HingeAxes:
        """Keys that would change nothing."""
        if self.coupling is not None and self.single:
            refuse(
                "'coupling' needs several axes, and this hinge has one",
                key="coupling",
                todo="remove it, or give several 'axes' (as [y, z]), or add 'axial'",
            )
        about: tuple[BendingAxis, ...] = self.bending or ((self.axis,) if self.axis is not None else ())
        if self.laws is None or not about:
            return self
        for axis in ("y", "z"):
            if axis not in about and getattr(self.laws, axis) is not None:
                refuse(
                    f"this law is for {axis}, but the hinge has no axis {axis}",
                    key="laws",
                    todo=f"remove it, or add {axis} to the axes",
                )
        if self.law is not None and all(getattr(self.laws, axis) is not None for axis in about):
            refuse(
                "'law' has no effect: every axis has a law under 'laws'",
                key="law",
                todo="remove it, or one of 'laws'",
            )
        return self

    @property
    def single(self) -> bool:
        """Whether it has one component alone."""
        return len(self.axes or ()) < 2 and self.axial is None

    @property
    def bending(self) -> tuple[BendingAxis, ...]:
        """Bending axes among `axes`, in their order."""
        return tuple(axis for axis in self.axes or () if axis != "x")

    @property
    def plain(self) -> bool:
        """Whether it bends about one axis and does nothing else."""
        return self.single and self.fracture is None

    def law_about(self, axis: BendingAxis) -> LawReference | None:
        """Law of a bending axis as the input refers to it."""
        own = None if self.laws is None else getattr(self.laws, axis)
        return self.law if own is None else own
