"""The app as it is started: who may speak to it, what it answers, and what does not end it."""

import json
import re
import socket
import urllib.parse
from contextlib import ExitStack

import pytest

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")
pytest.importorskip("websockets")

from tests.support.app import Window, base_of, request, started, token_of
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from crumple.app.start_texts import start_text

TUBE = start_text("tube_bending")


@pytest.fixture(scope="module", name="place")
def _place(tmp_path_factory):
    outer = tmp_path_factory.mktemp("outer")
    place = outer / "opened"
    place.mkdir()
    (place / "tube.yaml").write_text(TUBE)
    (outer / "curve.csv").write_text("rotation [rad], moment [N*m]\n0, 1000\n1, 500\n")
    (place / "inner.csv").write_text("rotation [rad], moment [N*m]\n0, 1000\n1, 500\n")
    (place / "link.csv").symlink_to(outer / "curve.csv")
    laws = outer / "laws"
    laws.mkdir()
    (laws / "one.law.yaml").write_text("secret")
    (place / "laws").mkdir()
    (place / "laws" / "one.law.yaml").symlink_to(laws / "one.law.yaml")
    return place


@pytest.fixture(scope="module", name="app")
def _app(place):
    with started(place / "tube.yaml") as address:
        yield address, token_of(address)


@pytest.fixture(scope="module", name="window")
def _window(app):
    """One for all tests that do not end it: the start of its processes takes longer than most of them."""
    window = Window(*app)
    window.receive("welcome")
    yield window
    window.close()


def test_it_listens_on_this_machine_alone(app):
    port = urllib.parse.urlsplit(base_of(app[0])).port
    others = {info[4][0] for info in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)}
    for other in others - {"127.0.0.1"}:
        with pytest.raises(OSError, match="refused"), socket.create_connection((other, port), timeout=5):
            pass


def test_the_page_has_a_strict_policy_and_no_cookies(app):
    status, headers, text = request(base_of(app[0]))
    assert status == 200
    policy = headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert policy.count("script-src 'self';") == 1
    assert headers["x-frame-options"] == "DENY"
    assert headers["referrer-policy"] == "no-referrer"
    assert not any(name.lower() == "set-cookie" for name in headers)
    # another nonce at every load, and no script in the page itself
    assert request(base_of(app[0]))[1]["content-security-policy"] != policy
    assert "<script>" not in text
    assert " style=" not in text
    assert re.search(r"<[^>]* on\w+=", text) is None


@pytest.mark.parametrize("path", ["/app.js", "/codemirror.js", "/three.js", "/viewer.js", "/app.css"])
def test_its_scripts_are_served(app, path):
    status, headers, text = request(base_of(app[0]), path)
    assert status == 200
    assert headers["x-content-type-options"] == "nosniff"
    assert len(text) > 1000


@pytest.mark.parametrize(
    "path",
    [
        "/../pyproject.toml",
        "/%2e%2e/server.py",
        "/app.html.jinja",
        "/tube.yaml",
        "/vendor/README.md",
        "//etc/passwd",
    ],
)
def test_nothing_else_is(app, path):
    assert request(base_of(app[0]), path)[0] == 404


@pytest.mark.parametrize("host", ["crumple.example", "127.0.0.1", "localhost:1", "[::1]:80", ""])
def test_another_host_is_refused(app, host):
    assert request(base_of(app[0]), Host=host)[0] in (400, 403)


@pytest.mark.parametrize(
    "origin", ["http://crumple.example", "null", "http://127.0.0.1:1", "https://127.0.0.1"]
)
def test_another_origin_is_refused(app, origin):
    base = base_of(app[0])
    assert request(base, "/token", b"x", Origin=origin)[0] == 403
    assert request(base, "/", Origin=origin)[0] == 403
    with pytest.raises(InvalidStatus, match="403"):
        Window(*app, origin=origin)


def test_a_code_works_once_and_never_without_origin(app):
    address, _ = app
    base, _, code = address.partition("/#")
    assert request(base, "/token", code.encode(), Origin=base)[0] == 403
    assert request(base, "/token", code.encode())[0] == 403
    assert request(base, "/token", b"x" * 2000, Origin=base)[0] == 413
    assert request(base, "/token", Origin=base)[0] == 405


@pytest.mark.parametrize(
    "first", ["", "{}", '{"token": "x"}', '{"token": ["x"]}', "[]", "null", "[" * 5000, b"\0"]
)
def test_without_the_token_the_socket_is_closed(app, first):
    window = Window(*app, first=first)
    with pytest.raises(ConnectionClosed) as ended:
        window.receive("welcome")
    assert ended.value.rcvd.code == 4003


def test_a_window_is_welcomed_and_another_one_gets_a_code(app):
    address, _ = app
    window = Window(*app)
    welcome = window.receive("welcome")
    assert welcome["files"] == ["tube.yaml"]
    assert welcome["first"] == "tube.yaml"
    assert "sections" in welcome["schema"]["properties"]
    window.tell("code")
    base = base_of(address)
    other = Window(address, token_of(f"{base}/#{window.receive('code')['code']}"))
    other.receive("welcome")
    other.close()
    window.close()


def test_sockets_without_the_token_keep_no_window_out(app):
    with ExitStack() as sockets:
        where = f"{base_of(app[0]).replace('http', 'ws')}/window"
        for _ in range(5):
            sockets.enter_context(connect(where, origin=base_of(app[0]), open_timeout=30))
        window = Window(*app)
        assert window.receive("welcome")
        window.close()


def test_four_windows_are_enough(app, window):
    windows = [Window(*app) for _ in range(3)]
    for one in windows:
        one.receive("welcome")
    with pytest.raises(ConnectionClosed) as ended:
        Window(*app).receive("welcome")
    assert ended.value.rcvd.code == 4001
    windows.pop().close()
    for _ in range(100):
        try:
            again = Window(*app)
            again.receive("welcome")
            break
        except ConnectionClosed:
            continue
    windows.append(again)
    for one in windows:
        one.close()


def test_a_text_is_solved(window):
    answer = window.solve(TUBE, numbers=True)
    assert answer["problems"] == []
    assert json.loads(answer["scene"]["header"])["format"] == "crumple-scene"
    assert answer["sentences"][0].startswith("The structure absorbed 783.7 J")
    assert {one["path"]: one["value"] for one in answer["numbers"]}["sections.tube.thickness"] == 2.65
    assert answer["curves"]["all"][0]["name"] == "energy.dissipated"
    figures = window.receive("figures")["figures"]
    assert figures[0]["panels"][0]["svg"].lstrip().startswith("<svg")


def test_mistakes_have_their_line_and_no_path_of_this_machine(window, place):
    text = TUBE.replace("section: tube", "section: tub")
    answer = window.solve(text, name="tube.yaml")
    (problem,) = answer["problems"]
    assert text.splitlines()[problem["line"] - 1].strip() == "section: tub"
    assert problem["file"] == "tube.yaml"
    assert str(place) not in json.dumps(answer)
    assert "scene" not in answer


@pytest.mark.parametrize("name", ["../curve.csv", "link.csv", "/etc/passwd"])
def test_paths_in_the_text_do_not_leave_the_folder(window, place, name):
    for inside, refused in (("inner.csv", False), (name, True)):
        law = f"{{type: table, file: {inside}}}"
        answer = window.solve(TUBE.replace("law: kecman", f"law: {law}"))
        told = json.dumps(answer["problems"])
        assert ("outside the folder" in told) == refused, told


@pytest.mark.parametrize("store", ["../laws", "laws", "laws/one.law.yaml"])
def test_stores_of_laws_do_not_leave_the_folder(window, store):
    answer = window.solve(TUBE + f"\nlaws: {store}\n")
    told = json.dumps(answer["problems"])
    assert "outside the folder" in told
    assert "secret" not in told


def test_files_are_opened_saved_and_kept_as_drafts(window, place):
    (place / "mine.yaml").write_text(TUBE)
    window.tell("open", name="mine.yaml")
    opened = window.receive("opened")
    window.tell("draft", name="mine.yaml", text="draft")
    window.receive("kept")
    window.tell("open", name="mine.yaml")
    assert window.receive("opened")["draft"] == "draft"
    window.tell("save", name="mine.yaml", text="a: 1\n", seen=opened["seen"])
    assert "mine.yaml" in window.receive("saved")["files"]
    assert (place / "mine.yaml").read_text() == "a: 1\n"
    window.tell("save", name="mine.yaml", text="a: 2\n", seen=opened["seen"])
    assert "changed by another program" in window.receive("refused")["what"]
    for kind in ("open", "draft", "save"):
        window.tell(kind, name="../x.yaml", text="", seen="")
        assert "outside" in window.receive("refused")["what"]
    (place / "mine.yaml").unlink()


# fmt: off
MEANINGLESS = [
    "",
    "x",
    "[]",
    "3",
    "null",
    '{"kind": []}',
    '{"kind": "none"}',
    '{"kind": "solve"}',
    "[" * 100_000,
    '{"kind": "solve", "number": "x", "text": "", "name": ""}',
    '{"kind": "save", "name": 3, "text": "", "seen": 1}',
    '{"kind": "solve", "number": 1, "text": 3, "name": ""}',
    '{"kind": "beside", "number": 1, "names": 3}',
    '{"kind": "start", "name": "../x"}',
    '{"kind": "solve", "number": 1e999, "text": "", "name": ""}',
    '{"kind": "open", "name": {"a": 1}}',
    r'{"kind": "draft", "name": "a.yaml", "text": "\ud800"}',
]
# fmt: on


def test_messages_that_mean_nothing_are_refused_and_end_nothing(window):
    for message in MEANINGLESS:
        window.socket.send(message)
        assert window.receive("refused")["what"], message
    assert window.solve(TUBE)["problems"] == []


def test_a_text_of_no_encoding_is_no_defect(window):
    window.socket.send(r'{"kind": "solve", "number": 1, "name": "", "text": "a: \ud800"}')
    assert window.receive("answer")["problems"]


def test_a_message_above_one_megabyte_ends_its_window_alone(app, window):
    other = Window(*app)
    with pytest.raises(ConnectionClosed) as ended:
        other.solve("#" * 1_000_001)
    assert ended.value.rcvd.code == 1009
    other.close()
    assert window.solve(TUBE)["problems"] == []


def test_bytes_end_their_window_alone(app, window):
    other = Window(*app)
    other.socket.send(b"\0\1")
    with pytest.raises(ConnectionClosed):
        other.receive("refused")
    other.close()
    assert window.solve(TUBE)["problems"] == []


def test_layouts_are_shown_side_by_side(window, place):
    window.tell("beside", number=7, name="", text=TUBE.replace("2.65 mm", "3 mm"), names=["tube.yaml"])
    answer = window.receive("answer")
    assert [one["name"] for one in json.loads(answer["scene"]["header"])["models"]] == ["unsaved", "tube"]
    assert [one.partition(":")[0] for one in answer["sentences"]] == ["unsaved", "tube"]


def test_a_shell_check_runs_beside_solves_and_can_be_cancelled(window):
    window.tell("shell", name="", text=TUBE)
    assert 0.0 <= window.receive("progress")["share"] < 1.0
    assert window.solve(TUBE)["problems"] == []
    window.tell("shell", name="", text=TUBE)
    assert "cancel it first" in window.receive("refused")["what"]
    window.tell("cancel")
    assert window.receive("shell")["stopped"]
    short = TUBE.replace("duration: 100 ms", "duration: 1 ms\n  shell: {element_size: 25 mm}")
    window.tell("shell", name="", text=short.partition("  pictures")[0])
    found = window.receive("shell")
    models = json.loads(found["scene"]["header"])["models"]
    assert [one["name"] for one in models] == ["multibody", "shell"]
    assert "shell run" in found["headline"]
    window.tell("shell", name="", text=TUBE.replace("section: tube", "section: tub"))
    assert window.receive("shell")["problems"][0]["line"] > 0
