"""Structure to a mesh of thin shells, and the explicit stepper that moves it.

`solve_shell(structure, run)` is the way in; `mesh_of` and `lower` show the mesh and the model that a
structure becomes, `report_of` the quality of the mesh.
"""

from crumple.shell.mesh.mesh import Mesh, Tube, mesh_of
from crumple.shell.mesh.quality import MeshReport, report_of
from crumple.shell.model.model import ShellCase, lower
from crumple.shell.solve import solve_shell, start_notes
from crumple.shell.stepping import LongRun, Moment, ShellRun

__all__ = [
    "LongRun",
    "Mesh",
    "MeshReport",
    "Moment",
    "ShellCase",
    "ShellRun",
    "Tube",
    "lower",
    "mesh_of",
    "report_of",
    "solve_shell",
    "start_notes",
]
