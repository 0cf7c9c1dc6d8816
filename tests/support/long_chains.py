"""Input files of long chains: of many members, and of one member in many bars."""

HEAD = """crumple: 1
materials:
  steel: {youngs_modulus: 210 GPa, poissons_ratio: 0.3, density: 7850 kg/m^3, yield_stress: 300 MPa}
sections:
  tube: {type: circular_tube, diameter: 40 mm, thickness: 2 mm}
hinge_laws:
  plastic: {type: constant}
"""
BAR = 0.1
"""Length of a bar [m]."""


def chain_of_members(number):
    """Members one after the other, each with a hinge at its first node: a cantilever struck at its tip."""
    rows = ["nodes:"]
    rows += [f"  n{i}: [{i * BAR:.1f} m, 0 m, 0 m]" for i in range(number + 1)]
    rows += ["members:"]
    for i in range(number):
        hinge = f"{{name: h{i}, at: n{i}, offset: 0 mm, law: plastic}}"
        rows += [f"  m{i}:", f"    nodes: [n{i}, n{i + 1}]", "    section: tube", "    material: steel"]
        rows += [f"    hinges: [{hinge}]"]
    return HEAD + "\n".join(rows) + _struck("n0", f"n{number}")


def member_of_bars(number):
    """One member of equal bars with hinges between them: a cantilever struck at its tip."""
    return (
        HEAD
        + f"""nodes:
  root: [0 m, 0 m, 0 m]
  tip: [{number * BAR:.1f} m, 0 m, 0 m]
members:
  beam:
    nodes: [root, tip]
    section: tube
    material: steel
    bars: {{number: {number}, law: plastic}}
    hinges: [{{name: root, at: root, offset: 0 mm, law: plastic}}]"""
        + _struck("root", "tip")
    )


def _struck(root, tip):
    return f"""
supports:
  clamp: {{node: {root}, fix: all}}
masses:
  striker: {{node: {tip}, mass: 1.874 kg}}
impulses:
  - {{node: {tip}, impulse: [0 N*s, 0 N*s, 30 N*s]}}
analysis:
  duration: 60 ms
outputs:
  every: 0.5 ms
  nodes: [{tip}]
  pictures: [0 ms, 60 ms]
"""
