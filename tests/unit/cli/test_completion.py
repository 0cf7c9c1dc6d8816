"""Shells complete commands, options and choices of the program."""

import os
import shutil
import subprocess
import sys

import pytest

ASK = "import sys; sys.argv = ['crumple']; from crumple.cli.main import main; main()"


def asked(line, shell):
    """What the program answers to a shell that completes a line."""
    words = {"COMP_WORDS": line, "COMP_CWORD": str(len(line.split(" ")) - 1)}
    words |= {"_TYPER_COMPLETE_ARGS": line, "_TYPER_COMPLETE_FISH_ACTION": "get-args"}
    environment = {**os.environ, **words, "_CRUMPLE_COMPLETE": f"complete_{shell}"}
    done = subprocess.run(
        [sys.executable, "-c", ASK], check=False, capture_output=True, text=True, env=environment
    )
    return done.stdout


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("crumple char", "characterise"),
        ("crumple run --fid", "--fidelity"),
        ("crumple run --fidelity sh", "shell"),
    ],
)
def test_commands_options_and_choices_are_completed(shell, line, found):
    assert found in asked(line, shell)


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_script_asks_the_program(run_command, shell):
    code, out, _ = run_command("completion", shell)
    assert code == 0
    assert f"_CRUMPLE_COMPLETE=complete_{shell}" in out
    if path := shutil.which(shell):
        # the shell itself reads it
        subprocess.run([path, "-n"], input=out, text=True, check=True)


def test_bash_completes_with_the_script(run_command, tmp_path):
    if shutil.which("bash") is None or os.name == "nt":
        pytest.skip("no bash")
    (tmp_path / "completion").write_text(run_command("completion", "bash")[1])
    program = tmp_path / "crumple"
    program.write_text(f'#!/bin/sh\nexec {sys.executable} -c "{ASK}" "$@"\n')
    program.chmod(0o755)
    line = (
        f"source {tmp_path / 'completion'}; COMP_WORDS=(crumple lay); COMP_CWORD=1;"
        " _crumple_completion crumple; echo ${COMPREPLY[@]}"
    )
    environment = {**os.environ, "PATH": f"{tmp_path}:{os.environ['PATH']}"}
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, env=environment, check=True)
    assert done.stdout.strip() == "layouts"


def test_an_unknown_shell_is_refused(run_command):
    code, _, err = run_command("completion", "tcsh")
    assert code == 2
    assert "bash" in err
