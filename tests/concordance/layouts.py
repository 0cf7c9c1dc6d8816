"""Layouts of one cab frame that are ranked: walls, sides, steels, braces, posts."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise


@dataclass(frozen=True)
class Layout:
    """Side and wall of posts and beam [mm], yield stress [MPa], and what stiffens the frame."""

    post: tuple[float, float] = (50.0, 2.0)
    beam: tuple[float, float] = (50.0, 2.0)
    yield_stress: float = 355.0
    brace: str = ""


LAYOUTS: dict[str, Layout] = {
    "layout_plain": Layout(),
    "layout_posts_1.5": Layout(post=(50.0, 1.5)),
    "layout_posts_2.5": Layout(post=(50.0, 2.5)),
    "layout_posts_3": Layout(post=(50.0, 3.0)),
    "layout_beam_1.5": Layout(beam=(50.0, 1.5)),
    "layout_beam_3": Layout(beam=(50.0, 3.0)),
    "layout_all_1.5": Layout(post=(50.0, 1.5), beam=(50.0, 1.5)),
    "layout_all_2.5": Layout(post=(50.0, 2.5), beam=(50.0, 2.5)),
    "layout_all_3": Layout(post=(50.0, 3.0), beam=(50.0, 3.0)),
    "layout_posts_40": Layout(post=(40.0, 2.5), beam=(40.0, 2.5)),
    "layout_posts_60": Layout(post=(60.0, 2.0), beam=(60.0, 2.0)),
    "layout_posts_60_1.5": Layout(post=(60.0, 1.5), beam=(60.0, 1.5)),
    "layout_soft": Layout(yield_stress=235.0),
    "layout_soft_thick": Layout(post=(50.0, 3.0), beam=(50.0, 3.0), yield_stress=235.0),
    "layout_strong": Layout(yield_stress=500.0),
    "layout_strong_thin": Layout(post=(50.0, 1.5), beam=(50.0, 1.5), yield_stress=500.0),
    "layout_middle_post": Layout(brace="middle post"),
    "layout_middle_post_thin": Layout(post=(50.0, 1.5), beam=(50.0, 1.5), brace="middle post"),
    "layout_near_knee": Layout(brace="near knee"),
    "layout_far_knee": Layout(brace="far knee"),
    "layout_knees": Layout(brace="knees"),
    "layout_knees_thin": Layout(post=(50.0, 1.5), beam=(50.0, 1.5), brace="knees"),
    "layout_sill": Layout(brace="sill"),
    "layout_sill_thin": Layout(post=(50.0, 1.5), beam=(50.0, 1.5), brace="sill"),
}

NODES = {
    "left": (0.0, 0.0),
    "left_low": (0.0, 0.3),
    "left_high": (0.0, 0.75),
    "left_knee": (0.0, 1.0),
    "left_span": (0.25, 1.0),
    "middle": (0.6, 1.0),
    "foot": (0.6, 0.0),
    "right_span": (0.95, 1.0),
    "right_knee": (1.2, 1.0),
    "right_high": (1.2, 0.75),
    "right_low": (1.2, 0.3),
    "right": (1.2, 0.0),
}
"""x and z of all nodes [m]; a layout has those that its members join."""
BRACES = {
    "": (),
    "middle post": (("middle_post", "foot", "middle"),),
    "near knee": (("near_brace", "left_high", "left_span"),),
    "far knee": (("far_brace", "right_high", "right_span"),),
    "knees": (("near_brace", "left_high", "left_span"), ("far_brace", "right_high", "right_span")),
    "sill": (("sill", "left_low", "right_low"),),
}


def layout_text(name: str) -> str:
    """Input of one layout."""
    layout = LAYOUTS[name]
    braces = BRACES[layout.brace]
    joined = {node for _, *ends in braces for node in ends}
    chains = {
        "left_post": ("left", "left_low", "left_high", "left_knee"),
        "beam": ("left_knee", "left_span", "middle", "right_span", "right_knee"),
        "right_post": ("right_knee", "right_high", "right_low", "right"),
    }
    always = {"left", "left_knee", "middle", "right_knee", "right"}
    members = [
        (f"{chain}_{i}", first, last, "beam" if chain == "beam" else "post")
        for chain, along in chains.items()
        for i, (first, last) in enumerate(_neighbours([n for n in along if n in always | joined]), 1)
    ]
    members += [(brace, first, last, "brace") for brace, first, last in braces]
    nodes = dict.fromkeys(node for _, first, last, _ in members for node in (first, last))
    sections = {"post": layout.post, "beam": layout.beam} | ({"brace": (40.0, 2.0)} if braces else {})
    feet = [node for node in ("left", "right", "foot") if node in nodes]
    strike = -0.182 - layout.post[0] / 2000.0
    return "\n".join(
        [
            "crumple: 1",
            f"title: Cab frame for ranking, {name.removeprefix('layout_').replace('_', ' ')}",
            "materials:",
            "  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, "
            f"yield_stress: {layout.yield_stress:g} MPa}}",
            "sections:",
            *(
                f"  {key}: {{type: square_tube, side: {side:g} mm, thickness: {wall:g} mm}}"
                for key, (side, wall) in sections.items()
            ),
            "nodes:",
            *(f"  {node}: [{NODES[node][0]:g} m, 0 m, {NODES[node][1]:g} m]" for node in nodes),
            "members:",
            *(
                f"  {member}: {{nodes: [{first}, {last}], section: {section}, material: steel}}"
                for member, first, last, section in members
            ),
            "hinges: auto",
            "supports:",
            *(f"  clamp_{node}: {{node: {node}, fix: all}}" for node in feet),
            "masses:",
            "  roof: {node: middle, mass: 40 kg}",
            "obstacles:",
            f"  striker: {{type: sphere, point: [{strike:g} m, 0 m, 1 m], radius: 180 mm, mass: 300 kg, "
            "velocity: [4 m/s, 0 m/s, 0 m/s], friction: 0.2}",
            "analysis:",
            "  duration: 120 ms",
            "  shell: {element_size: 20 mm, fine_size: 10 mm, fine_length: 80 mm}",
            "  multibody: {mechanism_check: off}",
            "outputs:",
            "  every: 0.5 ms",
            "  distances:",
            "    intrusion: {from: left_knee, to: right}",
            "",
        ]
    )


def _neighbours(chain: list[str]) -> list[tuple[str, str]]:
    return list(pairwise(chain))
