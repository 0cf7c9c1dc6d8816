"""The first example in Python: the model of 01_tube_bending.yaml, and the same answer."""

import crumple

structure = crumple.Structure(
    materials={"steel": crumple.Material("steel", 210e9, 0.3, 7850.0, 488e6)},
    sections={"tube": crumple.RectangularTube(width=0.050, depth=0.025, thickness=0.00265)},
    nodes={"root": (0, 0, 0), "tip": (1, 0, 0)},
    members={
        "tube": {
            "nodes": ("root", "tip"),
            "section": "tube",
            "material": "steel",
            "hinges": [{"name": "root", "at": "root", "law": "kecman"}],
        }
    },
    supports={"clamp": {"node": "root", "fix": "all"}},
    masses={"payload": {"node": "tip", "mass": "6 kg"}},
    initial_velocity=[{"rotation": "15 rad/s", "axis": (0, -1, 0)}],
)
analysis = crumple.Analysis(
    title="Steel tube thrown at 15 rad/s, bending about its weak axis",
    structure=structure,
    duration="100 ms",
    outputs={
        "every": "0.5 ms",
        "nodes": ["tip"],
        "section_rotations": {"tip_rotation": {"member": "tube", "to": "1 m"}},
        "pictures": [0, 0.02, 0.04, 0.06, 0.08, 0.1],
    },
)

if __name__ == "__main__":
    result = crumple.solve(analysis)
    hinge = result.hinges["root"]
    print(f"{result.status.value}: rotation {hinge.rotation_max:.4f} rad, energy {hinge.energy:.1f} J")
