# SPDX-License-Identifier: LGPL-2.1-or-later
"""A browser without a window, driven over two pipes by the Chrome DevTools Protocol; nothing listens on a port."""

import base64
import fcntl
import itertools
import json
import os
import shutil
import subprocess

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome", "chrome"))), None)
_FLAGS = (
    "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync", "--force-device-scale-factor=1",
)  # fmt: skip


def take_picture(url, file, folder, width, height):
    """Take a picture of a page by ``--screenshot``, as users do."""
    size = f"--window-size={width},{height}"
    command = [CHROMIUM, *_FLAGS, f"--user-data-dir={folder}", size, f"--screenshot={file}", url]
    subprocess.run(command, check=True, capture_output=True, timeout=300)


class Page:
    """A page of a browser of its own: real mouse events, scripts and pictures."""

    def __init__(self, folder, width, height):
        ours, theirs = os.pipe(), os.pipe()  # what the browser reads from fd 3, and what it writes to fd 4
        self._write, self._read, self._left = ours[1], theirs[0], b""
        self._numbers, self.events = itertools.count(1), []

        def connect():
            read, write = (fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (ours[0], theirs[1]))  # clear of 3 and 4
            os.dup2(read, 3)
            os.dup2(write, 4)

        command = [CHROMIUM, *_FLAGS, f"--user-data-dir={folder}", "--remote-debugging-pipe", "about:blank"]
        quiet = subprocess.DEVNULL
        self._process = subprocess.Popen(
            command, stdin=quiet, stdout=quiet, stderr=quiet, preexec_fn=connect, close_fds=False
        )
        os.close(ours[0])
        os.close(theirs[1])
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Network", "Runtime", "Log"):
            self.call(f"{domain}.enable")
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.call("Emulation.setDeviceMetricsOverride", **metrics)

    _session = None

    def call(self, method, **params):
        """Call a method; return its result, and keep the events that come before it."""
        number = next(self._numbers)
        message = {"id": number, "method": method, "params": params}
        message |= {"sessionId": self._session} if self._session else {}
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._message()
            if answer.get("id") == number:
                assert "error" not in answer, answer["error"]
                return answer["result"]
            self.events.append(answer)

    def _message(self):
        while b"\0" not in self._left:
            more = os.read(self._read, 1 << 16)
            assert more, "the browser has ended"
            self._left += more
        text, _, self._left = self._left.partition(b"\0")
        return json.loads(text)

    def open(self, url):
        """Open an address, and wait until it is loaded."""
        self.events.clear()
        self.call("Page.navigate", url=url)
        while not any(each["method"] == "Page.loadEventFired" for each in self.events):
            self.events.append(self._message())

    def value(self, expression):
        """The value of a JavaScript expression."""
        found = self.call("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in found, found["exceptionDetails"]
        return found["result"].get("value")

    def mouse(self, kind, x, y, **more):
        """Move the mouse, press or release a button, or turn the wheel."""
        self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)

    def click(self, place, count=1):
        """Press and release the left button; the second click of two has the count 2."""
        for kind in ("mousePressed", "mouseReleased"):
            self.mouse(kind, *place, button="left", clickCount=count)

    def drag(self, first, last, button="left", modifiers=0):
        """Drag from one point to another in steps."""
        held = {"button": button, "buttons": {"left": 1, "right": 2}[button], "modifiers": modifiers}
        self.mouse("mousePressed", *first, clickCount=1, **held)
        for share in (0.25, 0.5, 0.75, 1.0):
            x, y = (a + share * (b - a) for a, b in zip(first, last, strict=True))
            self.mouse("mouseMoved", x, y, **held)
        self.mouse("mouseReleased", *last, clickCount=1, button=button, modifiers=modifiers)

    def picture(self, file):
        """Write a picture of what the window shows."""
        file.write_bytes(base64.b64decode(self.call("Page.captureScreenshot")["data"]))
        return file

    def close(self):
        """End the browser."""
        self._session = None
        self.call("Browser.close")
        self._process.wait(timeout=60)
        os.close(self._write)
        os.close(self._read)
