"""What many test files share: the command line in this process, and a browser of each kind."""

import os
import sys

import pytest
from tests.support.browser import Browser, find_browser

from crumple.cli import main as command

# without these flags the browser itself warns that it draws WebGL in software
WEBGL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
NO_WEBGL = ("--disable-webgl", "--disable-3d-apis")


def _started(flags, drawing):
    path = find_browser()
    if path is None:
        # on a developer's machine a browser may be missing; where the project is checked it may not
        assert not os.environ.get("CI"), "no Chromium found, and CI is set"
        pytest.skip("no Chromium found")
    browser = Browser(path, flags)
    browser.wanted = drawing
    yield browser
    browser.close()


@pytest.fixture(scope="session", name="webgl_browser")
def _webgl_browser():
    yield from _started(WEBGL, "webgl")


@pytest.fixture(scope="session", name="canvas_browser")
def _canvas_browser():
    yield from _started(NO_WEBGL, "2d")


@pytest.fixture(scope="session", name="browser")
def _browser(webgl_browser):
    return webgl_browser


@pytest.fixture(params=["webgl", "canvas"], name="either_browser")
def _either_browser(request):
    return request.getfixturevalue(f"{request.param}_browser")


@pytest.fixture(name="run_command")
def _run_command(monkeypatch, capsys):
    """Call the command with arguments; gives exit code, standard output, standard error."""

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["crumple", *map(str, arguments)])
        monkeypatch.setenv("COLUMNS", "120")
        code = 0
        try:
            command.main()
        except SystemExit as stop:
            code = int(stop.code or 0)
        out, err = capsys.readouterr()
        assert "Traceback" not in out + err
        return code, out, err

    return call
