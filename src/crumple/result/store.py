"""Write a result to a folder and read it back."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from crumple.errors import InputError, Problem
from crumple.portable import replacing, write_text
from crumple.result.format import FORMAT
from crumple.result.histories import histories_csv
from crumple.result.result import Result
from crumple.result.scatter import BANDS, bands_csv
from crumple.result.summary import summary_json
from crumple.result.vtkhdf import FILE_NAME, read_vtkhdf, write_vtkhdf

if TYPE_CHECKING:
    import h5py


def write(result: Result, directory: Path | str) -> None:
    """Write summary.json, histories.csv, result.vtkhdf and, of a result with a scatter, bands.csv.

    Each file appears whole or not at all; files of an earlier run are replaced.

    Parameters
    ----------
    result
        Of either fidelity, complete or not.
    directory
        Made when absent.

    Raises
    ------
    OSError
        If the folder cannot be written.
    """
    folder = Path(directory)
    with replacing(folder / FILE_NAME) as temporary:
        write_vtkhdf(result, temporary)
    write_text(folder / "histories.csv", histories_csv(result))
    if result.scatter is not None and result.scatter.bands:
        write_text(folder / BANDS, bands_csv(result.scatter))
    # last, so that a summary means that everything else is there
    write_text(folder / "summary.json", summary_json(result))


def read(path: Path | str) -> Result:
    """Read a result back, equal bit for bit to the one that was written.

    Parameters
    ----------
    path
        The folder given to `write`, or the result.vtkhdf in it.

    Raises
    ------
    InputError
        If there is no such file, or it is damaged, or written by another program or by a newer Crumple.
    """
    import h5py  # noqa: PLC0415  (0.1 s, and only needed here)

    place = Path(path)
    file_path = place / FILE_NAME if place.is_dir() else place
    if not file_path.is_file():
        raise InputError(
            Problem(
                "there is no result here",
                came=str(place),
                allowed=f"a folder with {FILE_NAME}, or that file itself",
            )
        )
    try:
        with h5py.File(file_path, "r") as file:
            _check_origin(file, file_path)
            return read_vtkhdf(file)
    except (OSError, KeyError, ValueError, TypeError, AttributeError, RuntimeError, MemoryError) as error:
        raise InputError(
            Problem(
                "the result file cannot be read: it is damaged or not a result of Crumple",
                came=f"{type(error).__name__}: {str(error)[:200]}",
                todo="solve the analysis again",
                file=str(file_path),
            )
        ) from error


def _check_origin(file: h5py.File, path: Path) -> None:
    """Refuse other programs' files and newer formats, each with its own message."""
    if "crumple" not in file or "format" not in file["crumple"].attrs:
        raise InputError(
            Problem("this file was not written by Crumple", allowed=f"a {FILE_NAME}", file=str(path))
        )
    version = int(file["crumple"].attrs["format"])
    if version > FORMAT:
        raise InputError(
            Problem(
                "this result was written by a newer Crumple",
                came=f"format {version}",
                allowed=f"format {FORMAT} or older",
                todo="update Crumple",
                file=str(path),
            )
        )
