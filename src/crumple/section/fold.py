"""Length of a fold, and the place of the hinge that stands for it.

    H_b = 1.276 b^(2/3) t^(1/3)

with b the mid-line width of the compression flange and t the wall, for square tubes b x b x t in bending.
It comes from minimising a mean bending moment in Wierzbicki et al. (1994, part II).
"""

from __future__ import annotations

from crumple.section.section import Axis, Section

FROM_FACE = 0.7
"""Distance of a hinge from a rigid face over half the length of its fold [-]."""


def half_fold_length(section: Section, axis: Axis = "y") -> float:
    """Half the length of a bending fold along the member.

    Parameters
    ----------
    section
        Tube; its mid-line flange width and its wall thickness are used.
    axis
        Axis of bending.

    Returns
    -------
    float
        H_b [m].

    Notes
    -----
    The formula was written for square tubes, and read in a public text that quotes it.  Its use for
    rectangles (b taken as the compression flange) and for circular tubes (b taken as the mid-line
    diameter) is an assumption made here.  For the 50x25x2.65 mm tube bent about its weak axis it gives
    23.1 mm; finite elements give the fold 21 to 23 mm from the clamp.

    References
    ----------
    Wierzbicki, Recke, Abramowicz, Gholami & Huang, Computers & Structures 51 (1994) 625-641.
    docs/theory/half_fold_length.md.  Verified in tests/unit/section/test_fold.py.
    """
    thickness = section.thickness
    width = section.flange_width(axis) - thickness
    return float(1.276 * width ** (2.0 / 3.0) * thickness ** (1.0 / 3.0))


def fold_distance(section: Section, axis: Axis = "y") -> float:
    """Distance of a hinge from a clamp or the face of a rigid joint [m]: `FROM_FACE` of half a fold length.

    Parameters
    ----------
    section, axis
        As for `half_fold_length`.

    Notes
    -----
    A fixed hinge at 0.63 to 0.75 of half a fold takes the work of the fold, in shells of cantilevers of
    three rectangular tubes up to 10 degrees; the fold itself turns about places from 0.6 to 0.95.

    References
    ----------
    Derived here: docs/theory/half_fold_length.md, docs/theory/tube_library.md (folds at a rigid face).
    """
    return FROM_FACE * half_fold_length(section, axis)
