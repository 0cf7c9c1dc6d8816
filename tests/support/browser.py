"""A headless Chromium driven over its debugging pipe: no driver, no websocket, no other package."""

from __future__ import annotations

import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
)
START = """
import os, sys
# the browser wants its pipe at descriptors 3 and 4; the copies far above cannot be hit by the first dup2
read, write = (os.dup(os.dup(os.dup(int(number)))) for number in sys.argv[1:3])
os.dup2(read, 3)
os.dup2(write, 4)
os.execv(sys.argv[3], sys.argv[3:])
"""
PATIENCE = 60.0  # [s] for one answer; a busy machine starts a browser slowly
# with SLOW_FRAMES set, what a page defers to its next frame comes late, as on a busy machine: a test that
# does not wait for it fails always instead of rarely (`make verify`)
SLOW_FRAMES = """
const frame = requestAnimationFrame.bind(window), Observer = ResizeObserver;
window.requestAnimationFrame = (call) => setTimeout(() => frame(call), 300);
window.ResizeObserver = class extends Observer {
  constructor(call) { super((...told) => setTimeout(() => call(...told), 300)); }
};
"""


def find_browser():
    names = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
    return next((path for name in names if (path := shutil.which(name))), None)


# files that the page would save are kept in the page instead
KEEP_FILES = """(() => { window.kept = {}; let last; const make = URL.createObjectURL.bind(URL);
  URL.createObjectURL = (blob) => { last = blob; return make(blob); };
  HTMLAnchorElement.prototype.click = function () {
    const blob = last, kept = window.kept[this.download] = { blob, type: blob.type, size: blob.size };
    blob.text().then((text) => { kept.text = text; }); }; return 1; })()"""


class Browser:
    """One page.  `events` contains the messages that the browser sent by itself, newest last."""

    def __init__(self, path, flags=()):
        self.events = []
        self._answers = {}
        self._unread = b""
        self._number = 0
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self._write = os.pipe()
        self._read, from_browser = os.pipe()
        kept = [flag for flag in FLAGS if not (flags and flag == "--disable-gpu")]
        arguments = [path, *kept, *flags, "--remote-debugging-pipe", f"--user-data-dir={self._profile.name}"]
        self._process = subprocess.Popen(
            [sys.executable, "-c", START, str(to_browser), str(from_browser), *arguments],
            pass_fds=(to_browser, from_browser),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(to_browser)
        os.close(from_browser)
        self._session = None
        try:
            self._open_page()
        except BaseException:
            self.close()
            raise

    def _open_page(self):
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Log", "Runtime"):
            self.call(f"{domain}.enable")
        if os.environ.get("SLOW_FRAMES"):
            self.call("Page.addScriptToEvaluateOnNewDocument", source=f"{{{SLOW_FRAMES}}}")

    def call(self, method, **parameters):
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + PATIENCE
        while self._number not in self._answers:
            self._receive(end)
        answer = self._answers.pop(self._number)
        assert "error" not in answer, answer
        return answer["result"]

    def open(self, url, width, height):
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )
        # what another test set
        self.call("Emulation.setEmulatedMedia", media="")
        self.events.clear()
        self.call("Page.navigate", url=url)
        end = time.monotonic() + PATIENCE
        while not any(event["method"] == "Page.loadEventFired" for event in self.events):
            self._receive(end)

    def settle(self):
        """Wait for the frames that the page has asked for."""
        self.evaluate("new Promise((done) => requestAnimationFrame(() => done(1)))")

    def saved_files(self, buttons, count):
        """Press all buttons of a selector: type, size and text of the `count` files that the page saves."""
        self.evaluate(KEEP_FILES)
        self.evaluate(f"document.querySelectorAll({json.dumps(buttons)}).forEach(b => b.click()); 1")
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            kept = self.evaluate("window.kept")
            if len(kept) == count and all("text" in one for one in kept.values()):
                return kept
            time.sleep(0.05)
        raise TimeoutError(f"the page saved {sorted(kept)}")

    def evaluate(self, script):
        """Value of an expression; of a promise, once it is kept."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer
        return answer["result"]["value"]

    def close(self):
        self._process.terminate()
        self._process.wait(timeout=PATIENCE)
        os.close(self._write)
        os.close(self._read)
        # what the browser's helpers still hold open goes when they end
        self._profile.cleanup()

    def _receive(self, end):
        ready, _, _ = select.select([self._read], [], [], max(end - time.monotonic(), 0.0))
        chunk = os.read(self._read, 1 << 16) if ready else b""
        if not chunk:
            raise TimeoutError(f"the browser did not answer (its exit status: {self._process.poll()})")
        *whole, self._unread = (self._unread + chunk).split(b"\0")
        for text in whole:
            message = json.loads(text)
            if "id" in message:
                self._answers[message["id"]] = message
            else:
                self.events.append(message)
