"""Where a fold forms: half its length along the member.

    H_b = 1.276 b^(2/3) t^(1/3)

with b the mid-line width of the compression flange and t the wall, for square tubes b x b x t in bending.
It comes from minimising a mean bending moment in Wierzbicki et al. (1994, part II).
"""

from __future__ import annotations

from crumple.section.section import Axis, Section


def half_fold_length(section: Section, axis: Axis = "y") -> float:
    """Half the length of a bending fold along the member: a fold at a clamp forms about this far from it.

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
