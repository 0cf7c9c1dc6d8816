"""`crumple completion SHELL`: the script by which a shell completes commands, options and file names."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

VARIABLE = "_CRUMPLE_COMPLETE"
"""Environment variable by which the shell asks; set, the program answers and ends."""


class Shell(StrEnum):
    """Shells with completion."""

    BASH = "bash"
    ZSH = "zsh"
    FISH = "fish"


def completion(shell: Annotated[Shell, typer.Argument(help="Which shell.", show_default=False)]) -> None:
    """Print the completion script of a shell: eval "$(crumple completion bash)" in ~/.bashrc."""
    from typer.completion import get_completion_script  # type: ignore[attr-defined]

    typer.echo(get_completion_script(prog_name="crumple", complete_var=VARIABLE, shell=shell.value))


def prepare_answers() -> None:
    """Let the program answer if a shell asks; the library does so itself only with its own options."""
    from os import environ

    if VARIABLE in environ:
        from typer.completion import completion_init  # type: ignore[attr-defined]

        completion_init()
