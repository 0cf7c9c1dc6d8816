"""What the engineer describes, once, for every solver; plain frozen data in SI.

`Structure` has named ``materials``, ``sections``, ``nodes`` (positions), ``members``, ``hinge_laws``,
``supports``, ``masses``, ``obstacles``, and the lists ``initial_velocity``, ``impulses``, ``loads``, and
``gravity``.
For a solver:

- ``structure.frame_of(member)`` -> `Frame` (origin, axes as rows x y z, length, ``position(station)``);
- ``structure.section_of(member)`` and ``structure.material_of(member)`` -> objects of those rooms;
- ``placed_hinges(structure)`` -> `PlacedHinge` per hinge: member, station, position, direction, law, record;
  elastic joints, which have no plastic law, are among them: ``plastic_hinges(structure)`` leaves them out;
- ``support.held`` -> freedoms held at zero, ``support.driven`` -> functions of time by driven freedom;
- `MultibodySettings`, `ShellSettings` and `Outputs` -> settings of a run.
"""

from crumple.structure.bending import across_plane, driven_across, planar
from crumple.structure.change import changed, value_at
from crumple.structure.checks.checks import output_problems, problems_in, shell_problems
from crumple.structure.checks.limit_checks import history_problems
from crumple.structure.checks.obstacle_checks import stage_problems
from crumple.structure.geometry import Frame, frame_of
from crumple.structure.hinges.asked import any_automatic
from crumple.structure.hinges.corner_laws import corners_without_law
from crumple.structure.hinges.elastic_members import rigid_for_long, with_elastic_members
from crumple.structure.hinges.hinges import placed_hinges, plastic_hinges, shares_left_out
from crumple.structure.hinges.joint_reach import joint_reach
from crumple.structure.hinges.joints.placed_hinge import PlacedHinge
from crumple.structure.hinges.law_use import law_types_of, law_use_about, law_uses, used_texts, with_used_laws
from crumple.structure.hinges.places import HingePlace, hinge_places, member_hinge_places
from crumple.structure.hinges.struck.dented_tubes import DentedTube, dented_tubes
from crumple.structure.hinges.struck_folds import dent_at_fold
from crumple.structure.keys.joint import Joint
from crumple.structure.keys.law import LawKeys, Regularisation, Stops
from crumple.structure.keys.load import ForceComponents, Load, Mass, MomentComponents, NodalImpulse
from crumple.structure.keys.material import MaterialSpec
from crumple.structure.keys.member import AutomaticHinges, Bars, Hinge, Member, Stretch
from crumple.structure.keys.motion import FREEDOMS, InitialVelocity, Motion, Support
from crumple.structure.keys.obstacles import (
    CylinderObstacle,
    MemberContact,
    Obstacle,
    PlaneObstacle,
    SphereObstacle,
    Travel,
    Turning,
    gap,
)
from crumple.structure.keys.outputs import Distance, Filter, Outputs, SectionForce, SectionRotation
from crumple.structure.keys.section import ShapeSpec
from crumple.structure.keys.spot_welds import SpotWelds
from crumple.structure.keys.stages import Stage, Until, time_in_motion
from crumple.structure.keys.walls import WallSectionSpec, WallSpec, WeldSpec
from crumple.structure.schema.mapping import FrozenMapping
from crumple.structure.settings.multibody_settings import MultibodySettings
from crumple.structure.settings.shell_settings import FinePlace, ShellSettings
from crumple.structure.settings.stored_laws import StoredLaws
from crumple.structure.struck_places import struck_places
from crumple.structure.structure import Structure

__all__ = [
    "FREEDOMS",
    "AutomaticHinges",
    "Bars",
    "CylinderObstacle",
    "DentedTube",
    "Distance",
    "Filter",
    "FinePlace",
    "ForceComponents",
    "Frame",
    "FrozenMapping",
    "Hinge",
    "HingePlace",
    "InitialVelocity",
    "Joint",
    "LawKeys",
    "Load",
    "Mass",
    "MaterialSpec",
    "Member",
    "MemberContact",
    "MomentComponents",
    "Motion",
    "MultibodySettings",
    "NodalImpulse",
    "Obstacle",
    "Outputs",
    "PlacedHinge",
    "PlaneObstacle",
    "Regularisation",
    "SectionForce",
    "SectionRotation",
    "ShapeSpec",
    "ShellSettings",
    "SphereObstacle",
    "SpotWelds",
    "Stage",
    "Stops",
    "StoredLaws",
    "Stretch",
    "Structure",
    "Support",
    "Travel",
    "Turning",
    "Until",
    "WallSectionSpec",
    "WallSpec",
    "WeldSpec",
    "across_plane",
    "any_automatic",
    "changed",
    "corners_without_law",
    "dent_at_fold",
    "dented_tubes",
    "driven_across",
    "frame_of",
    "gap",
    "hinge_places",
    "history_problems",
    "joint_reach",
    "law_types_of",
    "law_use_about",
    "law_uses",
    "member_hinge_places",
    "output_problems",
    "placed_hinges",
    "planar",
    "plastic_hinges",
    "problems_in",
    "rigid_for_long",
    "shares_left_out",
    "shell_problems",
    "stage_problems",
    "struck_places",
    "time_in_motion",
    "used_texts",
    "value_at",
    "with_elastic_members",
    "with_used_laws",
]
