"""The app as it is started by the command, and a window of it without a browser."""

import json
import os
import re
import subprocess
import sys
import urllib.error
import urllib.request
from contextlib import ExitStack, contextmanager

START = "import sys; sys.argv = ['crumple', 'app', *sys.argv[1:]]; from crumple.cli.main import main; main()"


@contextmanager
def started(path):
    """Gives the start address of an app for a file or a folder."""
    filters = os.environ.get("PYTHONWARNINGS", "")
    process = subprocess.Popen(
        [sys.executable, "-u", "-c", START, str(path), "--no-browser"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # further filters of the environment come last, as those of `make lowest`
        env={**os.environ, "PYTHONWARNINGS": f"error,{filters}".rstrip(",")},
    )
    try:
        process.stdout.readline()
        address = process.stdout.readline().strip()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/#[\w-]+", address), process.stderr.read()
        yield address
    finally:
        process.terminate()
        process.communicate(timeout=60)


def request(base, path="/", data=None, **headers):
    """Status, headers and text of an answer."""
    asked = urllib.request.Request(base + path, data=data, headers=headers)
    try:
        with urllib.request.urlopen(asked, timeout=30) as answer:
            return answer.status, dict(answer.headers), answer.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, dict(error.headers), error.read().decode()


def base_of(address):
    return address.partition("/#")[0]


def token_of(address):
    """Token for the code of a start address."""
    base, _, code = address.partition("/#")
    status, _, text = request(base, "/token", code.encode(), Origin=base)
    assert status == 200
    return json.loads(text)["token"]


class Window:
    """A socket as a window of the app has it."""

    def __init__(self, address, token, origin=None, first=None):
        from websockets.sync.client import connect

        base = base_of(address)
        where = f"{base.replace('http', 'ws')}/window"
        self._open = ExitStack()
        self.socket = self._open.enter_context(
            connect(where, origin=origin or base, max_size=None, open_timeout=30)
        )
        self.socket.send(json.dumps({"token": token}) if first is None else first)

    def tell(self, kind, **content):
        self.socket.send(json.dumps({"kind": kind, **content}))

    def receive(self, *kinds):
        """The next message of one of some kinds."""
        while True:
            message = json.loads(self.socket.recv(timeout=60))
            if message["kind"] in kinds:
                return message

    def solve(self, text, number=1, name="", **more):
        self.tell("solve", number=number, name=name, text=text, **more)
        return self.receive("answer", "refused")

    def close(self):
        self._open.close()
