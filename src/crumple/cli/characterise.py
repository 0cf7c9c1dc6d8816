"""`crumple characterise SECTION --material ...`: the law of a member or a joint from a shell sub-model."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from crumple.cli.console.characterise_file import JOINT_HELP, characterise_file, joint_of
from crumple.cli.console.named import MATERIAL_HELP, SECTION_HELP

if TYPE_CHECKING:
    from crumple.characterisation import Characterised, LawCurve, TJoint
    from crumple.characterisation.sub_model import SubModel
    from crumple.hinge.measured.place_hash import Direction
    from crumple.material import Material
    from crumple.section import Section

ROTATIONS = (0, 1, 2, 5, 10, 15, 20, 25, 30, 40, 50, 60)
"""Rotations of the table [deg]."""
WHOLE = 0.97
"""Share of the rotation asked for from which a law is whole."""
LOADS = ("bending", "torsion", "crush", "out-of-plane")
SMALLEST, LARGEST = 0.0872, 1.0473
"""Plastic rotation up to which a law can be requested: 5 to 60 degrees [rad], with room for rounding."""


def characterise(
    section: Annotated[
        str | None,
        typer.Argument(
            help=f"An input file: all its members, corners and T-joints. Or one section. {SECTION_HELP}",
            show_default=False,
        ),
    ] = None,
    *,
    material: Annotated[
        str | None, typer.Option(help=f"Of a section. {MATERIAL_HELP}", show_default=False)
    ] = None,
    load: Annotated[
        str,
        typer.Option(
            help="What folds it: bending; torsion or crush of a straight member; out-of-plane of a corner or "
            "T-joint."
        ),
    ] = "bending",
    axis: Annotated[
        str, typer.Option(help="Bending axis y or z, along the moment vector; y compresses the width.")
    ] = "y",
    sense: Annotated[str, typer.Option(help="Sense of the printed curve: + or -; + closes a corner.")] = "+",
    angle: Annotated[
        str | None,
        typer.Option(
            help="A mitred corner in place of a straight member: angle between the axes of its two members, "
            "'90 deg' for a right-angled one. The axis is then normal to its plane.",
            show_default=False,
        ),
    ] = None,
    chord: Annotated[
        str | None,
        typer.Option(
            help="A welded T-joint in place of a straight member: section of the chord, on whose face across "
            "its z axis the member ends at a right angle, its width along the chord. Load bending turns it "
            "in the plane of both, out-of-plane about the chord.",
            show_default=False,
        ),
    ] = None,
    about: Annotated[
        str,
        typer.Option(
            help="Direction of the moment of load out-of-plane at a corner: its bisector, or the tangent "
            "across it."
        ),
    ] = "bisector",
    joint: Annotated[
        str | None, typer.Option(metavar="FILE[:NODE]", help=JOINT_HELP, show_default=False)
    ] = None,
    to: Annotated[str, typer.Option(help="Plastic rotation at which the law ends.")] = "30 deg",
    converge: Annotated[
        bool, typer.Option(help="Solve two finer meshes too and state the error; some six times the work.")
    ] = False,
    interaction: Annotated[
        bool,
        typer.Option(
            help="Bend a straight member with axial force (0.2 of squash), shortened in a fixed ratio, and "
            "about 45 deg too, or a corner in and out of its plane at once, and state the error of the "
            "couplings of hinges; some seven times the work.",
        ),
    ] = False,
    store: Annotated[Path, typer.Option(metavar="FOLDER", help="Folder of the law files.")] = Path("laws"),
    threads: Annotated[
        int | None,
        typer.Option(help="Threads for a section; by default all cores.", min=1, show_default=False),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(
            help="Sub-models of an input file solved at a time; by default one a core.",
            min=1,
            show_default=False,
        ),
    ] = None,
    only_list: Annotated[
        bool,
        typer.Option("--list", help="List what an input file needs and the time it takes; solve nothing."),
    ] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON in place of the table.")] = False,
) -> None:
    """Solve a shell sub-model of a section, and keep the hinge law that it gives as a law file."""
    from crumple.characterisation import LawStore
    from crumple.characterisation.coupling.oblique_corner import COUPLED
    from crumple.errors import InputError, Problem
    from crumple.portable import available_cores

    asked = None
    if joint is not None:
        loads = {"--load": load != "bending", "--axis": axis != "y", "--sense": sense != "+"}
        others = {"--angle": angle, "--chord": chord, "--interaction": interaction, "--json": as_json}
        asked = joint_of(joint, section, material, {**others, **loads})
    elif section is None:
        todo = "give a section with --material, an input file such as frame.yaml, or --joint"
        raise InputError(Problem("there is nothing to characterise", todo=todo, where="SECTION"))
    file = asked.file if asked is not None else Path(section or "")
    if asked is not None or (material is None and file.suffix.lower() in {".yaml", ".yml"}):
        largest, count = _largest(to), workers or available_cores()
        characterise_file(
            file, store, largest, workers=count, converge=converge, only_list=only_list, joint=asked
        )
        return
    section = str(section)
    if material is None:
        todo = "add --material, or give an input file such as frame.yaml"
        raise InputError(Problem("a section needs its material", section, "", todo, "--material"))
    if only_list:
        what, todo = "a section has nothing to list", "omit --list, or give an input file without --material"
        raise InputError(Problem(what, section, "an input file", todo, "--list"))
    model = _model(section, material, _Place(load, axis, sense, angle, to, chord, about))
    laws = LawStore(store)
    law = laws.law(model)
    lacking = converge and law is not None and law.validity.uncertainty is None
    member = model.load == "bending" and angle is None and chord is None
    corner = model.load == "out-of-plane" and about == "bisector" and chord is None
    if interaction and not (member or corner):
        what = "--interaction is for straight members in bending, and for corners about their bisector"
        todo = "leave it out"
        raise InputError(Problem(what, model.title, "", todo, "--interaction"))
    lacking = lacking or (
        interaction and law is not None and not {"axial_tension", *COUPLED}.intersection(dict(law.origin))
    )
    if law is None or lacking:
        laws.prepare([model])
        done = _solved(model, threads, converge=converge, interaction=interaction)
        law = done.law
        path = laws.keep(model, law)
        _picture(done, path)
    if as_json:
        _print_json(model, law, laws.path(model))
    else:
        _show(model, law, laws.path(model))


class _Place(NamedTuple):
    """Place and load as given."""

    load: str
    axis: str
    sense: str
    angle: str | None
    to: str
    chord: str | None = None
    about: str = "bisector"


def _model(section: str, material: str, given: _Place) -> SubModel:
    from crumple.characterisation import Bending, Crush, OutOfPlane, Torsion
    from crumple.characterisation.out_of_plane import usual_resolution
    from crumple.cli.console.named import material_of, section_of
    from crumple.errors import InputError, Problem
    from crumple.section.section import checked_axis

    senses = {"+": 1, "-": -1}
    if given.sense not in senses:
        raise InputError(Problem("the sense is unknown", given.sense, "+ or -", "choose one", "--sense"))
    if given.load not in LOADS:
        raise InputError(Problem("the load is unknown", given.load, ", ".join(LOADS), "choose one", "--load"))
    sense, largest, corner = senses[given.sense], _largest(given.to), _corner(given.angle)
    shape, (metal, _) = section_of(section), material_of(material)
    if given.chord is not None:
        return _t_joint(shape, section_of(given.chord), metal, given)
    if given.load == "bending":
        return Bending(shape, metal, checked_axis(given.axis), sense, corner, largest)
    if given.load == "out-of-plane" and corner is not None:
        about = _direction(given)
        place = shape, metal, checked_axis(given.axis), corner, about, largest
        return OutOfPlane(*place, resolution=usual_resolution(shape, about))
    if (given.load == "out-of-plane") != (corner is not None):
        what, todo = (
            "the load does not fit the place",
            "add --angle for out-of-plane, leave it out for others",
        )
        raise InputError(Problem(what, given.load, "", todo, "--load"))
    return Crush(shape, metal) if given.load == "crush" else Torsion(shape, metal, sense, largest)


def _t_joint(branch: Section, chord: Section, metal: Material, given: _Place) -> TJoint:
    """Welded T-joint."""
    from crumple.characterisation import TJoint
    from crumple.errors import InputError, Problem
    from crumple.section.shapes.rectangular_tube import RectangularTube

    if not (isinstance(branch, RectangularTube) and isinstance(chord, RectangularTube)):
        what, todo = "welded T-joints are characterised for rectangular tubes", "give two of them"
        came = f"{branch.title} on {chord.title}"
        raise InputError(Problem(what, came, "rectangular_tube", todo, "--chord"))
    if given.angle is not None or given.load not in {"bending", "out-of-plane"}:
        came = given.load if given.angle is None else f"--angle {given.angle}"
        what, todo = "a T-joint is at a right angle, and bends", "leave out --angle, and --load or give one"
        raise InputError(Problem(what, came, "--load bending or out-of-plane", todo, "--chord"))
    largest = _largest(given.to)
    return TJoint(branch, chord, metal, "in" if given.load == "bending" else "across", largest)


def _direction(given: _Place) -> Direction:
    """Direction of the moment out of a corner's plane."""
    from crumple.errors import InputError, Problem
    from crumple.hinge.measured.place_hash import DIRECTIONS

    for one in DIRECTIONS:
        if given.about == one:
            return one
    allowed = " or ".join(DIRECTIONS)
    raise InputError(Problem("the direction is unknown", given.about, allowed, "choose one", "--about"))


def _corner(angle: str | None) -> float | None:
    """Angle of a corner [rad]."""
    from crumple.cli.console.named import quantity_of
    from crumple.errors import InputError, Problem
    from crumple.hinge.corner.in_plane import LARGEST

    corner = None if angle is None else quantity_of("--angle", angle, "rad")
    if corner is not None and not 0.0 < corner <= LARGEST:
        allowed, todo = "above 0 deg, at most 100 deg", "0 would be a straight member: leave --angle out"
        raise InputError(
            Problem("the angle of the corner is out of range", angle or "", allowed, todo, "--angle")
        )
    return corner


def _largest(to: str) -> float:
    """Plastic rotation at which a law ends [rad]."""
    from crumple.cli.console.named import quantity_of
    from crumple.errors import InputError, Problem

    largest = quantity_of("--to", to, "rad")
    if not SMALLEST <= largest <= LARGEST:
        raise InputError(Problem("the rotation is out of range", to, "5 deg to 60 deg", "", "--to"))
    return largest


def _solved(model: SubModel, threads: int | None, *, converge: bool, interaction: bool) -> Characterised:
    from crumple.characterisation import characterise as characterised
    from crumple.cli.console.progress import progress_bar
    from crumple.portable import available_cores, exit_code_of_stop, stop_on_interrupt

    with stop_on_interrupt() as cancel, progress_bar(model.title) as bar:

        def progress(what: str, share: float) -> None:
            bar.describe(f"{model.title}: {what}, {share:.0%}")
            bar(share)

        cores = threads or available_cores()
        try:
            return characterised(
                model,
                converge=converge,
                interaction=interaction,
                threads=cores,
                progress=progress,
                cancel=cancel,
            )
        except KeyboardInterrupt:
            typer.echo("Stopped; no law was stored.", err=True)
            raise typer.Exit(exit_code_of_stop()) from None


def _picture(done: Characterised, path: Path) -> None:
    """Draw the folded sub-model beside its law file; without the picture the law is as good."""
    from crumple.portable import refusal_of
    from crumple.report.figures.shape import deformation

    drawing, picture = deformation(done.result), path.with_suffix(".svg")
    try:
        if drawing is not None:
            picture.write_text(drawing, encoding="utf-8")
    except OSError as error:
        typer.echo(f"No picture: {picture} cannot be written: {refusal_of(error)}", err=True)


def _curve(model: SubModel, law: Any) -> LawCurve:
    """Curve of a law in the sense of the model."""
    import numpy as np

    from crumple.characterisation import LawCurve

    rotation, moment = (np.array(one) for one in law.points(model.sense))
    work = np.concatenate([[0.0], np.cumsum(0.5 * (moment[1:] + moment[:-1]) * np.diff(rotation))])
    return LawCurve(rotation, moment, work, law.elastic_stiffness)


def _print_json(model: SubModel, law: Any, path: Path) -> None:
    import json

    curve = _curve(model, law)
    keys, units = ("rotation", "moment"), {"rotation": "rad, plastic", "moment": "N*m"}
    if law.slip:
        keys, units = ("shortening", "force"), {"shortening": "m, plastic", "force": "N"}
    else:
        units["elastic_stiffness"] = "N*m/rad"
    content = {
        "title": law.title,
        "law_file": str(path),
        "origin": dict(law.origin),
        "error": law.validity.uncertainty,
        "elastic_stiffness": law.elastic_stiffness,
        "curve": {
            keys[0]: curve.rotation.tolist(),
            keys[1]: curve.moment.tolist(),
            "energy": curve.energy.tolist(),
        },
        "units": {**units, "energy": "J"},
    }
    typer.echo(json.dumps(content, indent=2, allow_nan=False))


def _show(model: SubModel, law: Any, path: Path) -> None:
    import numpy as np
    from rich.console import Console
    from rich.table import Table

    curve = _curve(model, law)
    console = Console(highlight=False)
    console.print(law.title, style="bold", markup=False)
    table = Table()
    for heading in ("Shortening, mm", "Force, kN") if law.slip else ("Plastic rotation, deg", "Moment, N*m"):
        table.add_column(heading, justify="right")
    table.add_column("Energy, J", justify="right")
    scale, end = (1e-3, 1e-3) if law.slip else (1.0, float(np.deg2rad(1.0))), curve.rotation[-1]
    every = np.linspace(0.0, end, 11) / scale[1] if law.slip else np.array(ROTATIONS)
    for at in every[every * scale[1] <= end * (1.0 + 1e-9)].tolist():
        moment, energy = curve.moment_at(at * scale[1]), curve.energy_at(at * scale[1])
        table.add_row(f"{at:.4g}", f"{moment * scale[0]:.4g}", f"{energy:.4g}")
    console.print(table)
    reach = law.validity.rotation_max
    if not law.slip and reach < WHOLE * model.largest:
        ends, asked = (f"{np.rad2deg(angle):.3g} deg" for angle in (reach, model.largest))
        text = f"The law ends at {ends}, not at {asked}: the walls also turn beside the fold. Hinges hold"
        console.print(f"{text} its last moment beyond, with a caution.", markup=False)
    for key, text in law.origin:
        console.print(f"{key}: {text}", style="dim", markup=False)
    error = law.validity.uncertainty
    text = "not estimated (--converge)" if error is None else f"{error:.1%} of the energy"
    console.print(f"Error from the mesh: {text}", markup=False)
    console.print(
        f"Law file: {path}   {_use(model, path)}",
        soft_wrap=True,
        markup=False,
    )


def _use(model: SubModel, path: Path) -> str:
    """How a structure uses the law."""
    if model.load == "bending":
        return f"use it with `law: {{type: file, file: {path.name}}}`"
    return f"use it with `--laws {path.parent}`"
