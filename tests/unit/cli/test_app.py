"""`crumple app` says what it lacks, and serves one folder."""

import importlib.util
import os
import socket

import pytest

from crumple.cli import app as verb


def test_a_missing_package_is_named_with_its_extra(run_command, monkeypatch):
    known = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "uvicorn" else known(name))
    code, _, err = run_command("app")
    assert code == 2
    assert "pip install 'crumple[app]'" in err
    assert "uvicorn" in err


@pytest.mark.parametrize("missing", ["none.yaml", "none/x.yaml"])
def test_a_missing_file_is_refused(run_command, tmp_path, missing):
    pytest.importorskip("starlette")
    pytest.importorskip("uvicorn")
    pytest.importorskip("websockets")
    code, _, err = run_command("app", tmp_path / missing)
    assert code == 2
    assert "there is no such" in err


@pytest.mark.skipif(not hasattr(os, "fork"), reason="another end of programs")
def test_nothing_is_left_when_it_is_ended(tmp_path, monkeypatch):
    for package in ("starlette", "uvicorn", "websockets"):
        pytest.importorskip(package)
    from tests.support.app import base_of, request, started

    monkeypatch.setenv("TMPDIR", str(tmp_path))
    (tmp_path / "served").mkdir()
    with started(tmp_path / "served") as address:
        assert request(base_of(address))[0] == 200
        (private,) = tmp_path.glob("crumple-*")
        assert [one.name for one in private.iterdir()] == ["open.html"]
    assert list(tmp_path.glob("crumple-*")) == []


def test_a_port_in_use_is_refused(run_command, tmp_path):
    for package in ("starlette", "uvicorn", "websockets"):
        pytest.importorskip(package)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        code, _, err = run_command("app", tmp_path, "--port", taken.getsockname()[1])
    assert code == 2
    assert "this port cannot be used" in err


def test_the_folder_of_a_file_is_served(tmp_path):
    (tmp_path / "a.yaml").touch()
    assert verb._opened(tmp_path / "a.yaml") == (tmp_path, "a.yaml")
    assert verb._opened(tmp_path) == (tmp_path, "")


def test_the_start_page_is_for_this_user_alone_and_goes_with_the_server(monkeypatch, tmp_path):
    pytest.importorskip("starlette")
    uvicorn = pytest.importorskip("uvicorn")
    from crumple.app import serve

    shown = []

    def show(address, page):
        shown.append((page, page.read_text(), page.stat().st_mode & 0o77, page.parent.stat().st_mode & 0o77))
        assert address in page.read_text()

    monkeypatch.setattr(uvicorn.Server, "run", lambda self, sockets: sockets[0].getsockname())
    serve(tmp_path, "", 0, show)
    ((page, _, readable, entered),) = shown
    assert (readable, entered) == (0, 0)
    assert not page.exists()
