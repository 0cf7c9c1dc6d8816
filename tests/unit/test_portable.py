"""What differs between operating systems: as it is here, and as Windows would have it."""

import errno
import io
import os
import signal
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from crumple import portable
from crumple.hinge.law_use import LawUse
from crumple.portable import (
    available_cores,
    console_takes_all,
    exit_code_of_stop,
    reader_left,
    replacing,
    stop_on_interrupt,
    write_text,
)

EXAMPLE = Path(__file__).parents[2] / "examples" / "01_tube_bending.yaml"


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="no process can be bound to a core here")
def test_a_process_that_is_bound_to_one_core_has_one():
    bind = "import os; os.sched_setaffinity(0, [min(os.sched_getaffinity(0))])"
    code = f"{bind}; from crumple.portable import available_cores; print(available_cores())"
    assert (
        subprocess.run([sys.executable, "-c", code], check=True, capture_output=True).stdout.strip() == b"1"
    )


def test_cores_where_no_process_is_bound(monkeypatch):
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 6)
    assert available_cores() == 6
    monkeypatch.setattr(os, "cpu_count", lambda: None)
    assert available_cores() == 1


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_is_a_wish_to_stop(number, code):
    before = signal.getsignal(number)
    with stop_on_interrupt() as asked:
        assert not asked()
        signal.raise_signal(number)
        assert asked()
        assert exit_code_of_stop() == code
        # a second one is Python's own
        assert signal.getsignal(number) is before
    assert signal.getsignal(number) is before


def test_a_replaced_file_is_whole_or_the_old_one(tmp_path):
    path = tmp_path / "folder" / "file.txt"
    write_text(path, "old µ\n")
    assert path.read_bytes() == "old µ\n".encode()
    with pytest.raises(ValueError, match="broken"), replacing(path) as temporary:  # noqa: PT012
        temporary.write_text("half", encoding="utf-8")
        raise ValueError("broken")
    assert path.read_bytes() == "old µ\n".encode()
    assert [each.name for each in path.parent.iterdir()] == ["file.txt"]


@pytest.mark.skipif(portable.WINDOWS, reason="permissions are another thing there")
def test_a_new_file_has_the_permissions_of_any(tmp_path):
    before = os.umask(0o027)
    try:
        write_text(tmp_path / "file", "")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "file").stat().st_mode) == 0o640


@pytest.mark.parametrize(
    ("windows", "refusals", "moved"), [(True, 3, True), (True, 10**9, False), (False, 1, False)]
)
def test_windows_may_refuse_to_replace_for_a_moment(tmp_path, monkeypatch, windows, refusals, moved):
    replace, left = Path.replace, refusals

    def refusing(self, target):
        nonlocal left
        left -= 1
        if left >= 0:
            raise PermissionError(errno.EACCES, "open in another program", str(target))
        return replace(self, target)

    monkeypatch.setattr(Path, "replace", refusing)
    monkeypatch.setattr(portable, "WINDOWS", windows)
    monkeypatch.setattr(portable, "PATIENCE", 0.1)
    if moved:
        write_text(tmp_path / "file", "text")
        assert (tmp_path / "file").read_text() == "text"
    else:
        with pytest.raises(PermissionError):
            write_text(tmp_path / "file", "text")
        assert list(tmp_path.iterdir()) == []


def test_a_reader_that_left(monkeypatch):
    invalid, in_file = OSError(errno.EINVAL, "invalid"), OSError(errno.EINVAL, "invalid", "a.csv")
    for windows in (False, True):
        monkeypatch.setattr(portable, "WINDOWS", windows)
        assert reader_left(BrokenPipeError(errno.EPIPE, "broken pipe"))
        assert reader_left(invalid) is windows
        assert not reader_left(in_file)
        assert not reader_left(PermissionError(errno.EACCES, "refused"))


@pytest.mark.parametrize(
    ("encoding", "shown"),
    [("ascii", "Tr?ger -5 deg, ?"), ("cp1252", "Träger -5°, ?"), ("utf-8", "Träger −5°, 梁")],
)
def test_consoles_that_lack_characters(monkeypatch, encoding, shown):
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(written, encoding=encoding))
    monkeypatch.setattr(sys, "stderr", io.TextIOWrapper(io.BytesIO(), encoding=encoding))
    portable.prepare_consoles()
    print("Träger −5°, 梁", end="", flush=True)
    assert written.getvalue().decode(encoding) == shown
    assert console_takes_all() is (encoding == "utf-8")


@pytest.mark.parametrize("more", [[], ["--json"]])
def test_a_run_prints_its_title_on_any_console(tmp_path, more):
    """The standard output of Windows, where it goes to a file, has 256 characters."""
    text = EXAMPLE.read_text(encoding="utf-8").replace("title: Steel", "title: Träger −5 梁", 1)
    assert "梁" in text
    (tmp_path / "tube.yaml").write_text(text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "crumple", "run", "tube.yaml", *more],
        cwd=tmp_path,
        env=os.environ | {"PYTHONIOENCODING": "cp1252"},
        capture_output=True,
        check=False,
    )
    assert (done.returncode, done.stderr) == (0, b"")
    assert (b"Tr\\u00e4ger \\u22125 \\u6881" if more else b"Tr\xe4ger -5 ?") in done.stdout


@pytest.mark.skipif(portable.WINDOWS, reason="quotes of POSIX shells")
def test_commands_that_are_suggested_have_quotes_where_paths_have_blanks():
    assert portable.command_line("crumple", "run", Path("my tube.yaml")) == "crumple run 'my tube.yaml'"
    use = LawUse("formula", "abc", command="crumple characterise INPUT:tube")
    assert "crumple characterise 'my tube.yaml':tube" in use.sentence("my tube.yaml")
    assert "crumple characterise tube.yaml:tube" in use.sentence("tube.yaml")
