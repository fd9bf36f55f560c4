"""Headless Chromium for tests of pages: opens a file, acts on it as a person does, looks at what it shows.

Speaks the DevTools protocol over a pair of pipes (--remote-debugging-pipe: JSON, each message ended by a zero
byte), so that no driver and no port are needed. WebGL is rendered in software.
"""
import base64
import io
import json
import os
import pathlib
import select
import subprocess
import tempfile
import time

import matplotlib.image
import numpy

OPTIONS = ("--headless", "--no-sandbox", "--disable-quic", "--no-first-run",
           "--disable-background-networking", "--disable-component-update", "--disable-sync",
           "--disable-gpu-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
           "--enable-unsafe-swiftshader", "--force-device-scale-factor=1", "--remote-debugging-pipe")
KEY_CODES = {
    " ": 32,
    "End": 35,
    "Home": 36,
    "ArrowLeft": 37,
    "ArrowUp": 38,
    "ArrowRight": 39,
    "ArrowDown": 40
}


class Browser:
    """One page. `problems` collects console errors, warnings of the page's own and uncaught exceptions."""

    def __init__(self, width=800, height=600):
        self.problems = []
        self._number = 0
        self._buffer = b""
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        to_browser, self._write = os.pipe()
        self._read, from_browser = os.pipe()
        # Chromium reads from descriptor 3 and writes to 4. bash, as sh redirects only numbers of one digit.
        command = [
            "/bin/bash", "-c", f'exec "$@" 3<&{to_browser} 4>&{from_browser}', "sh", "chromium", *OPTIONS,
            f"--window-size={width},{height}", f"--user-data-dir={self._profile.name}", "about:blank"
        ]
        self._process = subprocess.Popen(command,
                                         pass_fds=(to_browser, from_browser),
                                         stderr=subprocess.DEVNULL,
                                         stdout=subprocess.DEVNULL)
        os.close(to_browser)
        os.close(from_browser)
        self._session = None
        targets = self.send("Target.getTargets")["targetInfos"]
        target = next(info["targetId"] for info in targets if info["type"] == "page")
        self._session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.send(f"{domain}.enable")
        self.resize(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.terminate()
        try:
            self._process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._write)
        os.close(self._read)
        self._profile.cleanup()

    def send(self, method, **parameters):
        """A command and its answer; events that come before it are looked at."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._receive()
            if answer.get("id") == self._number:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']['message']}")
                return answer["result"]
            self._note(answer)

    def _receive(self, timeout_s=120):
        end = time.monotonic() + timeout_s
        while b"\0" not in self._buffer:
            if not select.select([self._read], [], [], max(0, end - time.monotonic()))[0]:
                raise TimeoutError(f"Chromium has not answered for {timeout_s} s")
            data = os.read(self._read, 1 << 20)
            if not data:
                raise RuntimeError("Chromium ended")
            self._buffer += data
        message, self._buffer = self._buffer.split(b"\0", 1)
        return json.loads(message)

    def _note(self, event):
        method, parameters = event.get("method"), event.get("params", {})
        if method == "Runtime.exceptionThrown":
            details = parameters["exceptionDetails"]
            self.problems.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in ("error", "assert"):
            self.problems.append(" ".join(
                str(part.get("value", part.get("description"))) for part in parameters["args"]))
        elif method == "Log.entryAdded" and parameters["entry"]["level"] == "error":
            self.problems.append(parameters["entry"]["text"])

    def resize(self, width, height):
        self.send("Emulation.setDeviceMetricsOverride",
                  width=width,
                  height=height,
                  deviceScaleFactor=1,
                  mobile=False)

    def open(self, path):
        self.send("Page.navigate", url=pathlib.Path(path).resolve().as_uri())

    def value(self, expression):
        """What an expression, or the promise it returns, comes to in the page."""
        result = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in result:
            raise RuntimeError(result["exceptionDetails"].get("exception", {}).get("description", expression))
        return result["result"].get("value")

    def wait_for(self, expression, timeout_s=60):
        end = time.monotonic() + timeout_s
        while not self.value(expression):
            if time.monotonic() > end:
                raise TimeoutError(
                    f"{expression} has not come true in {timeout_s} s; problems: {self.problems}")
            time.sleep(0.02)

    def press(self, key, shift=False):
        for kind in ("keyDown", "keyUp"):
            self.send("Input.dispatchKeyEvent",
                      type=kind,
                      key=key,
                      modifiers=8 if shift else 0,
                      windowsVirtualKeyCode=KEY_CODES.get(key, ord(key[0].upper())),
                      **({
                          "text": key
                      } if len(key) == 1 and kind == "keyDown" else {}))

    def click(self, x, y):
        for kind in ("mousePressed", "mouseReleased"):
            self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)

    def drag(self, x, y, to_x, to_y):
        self.send("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="left", clickCount=1)
        for share in (0.3, 0.6, 1):
            self.send("Input.dispatchMouseEvent",
                      type="mouseMoved",
                      x=x + share * (to_x - x),
                      y=y + share * (to_y - y),
                      button="left")
        self.send("Input.dispatchMouseEvent",
                  type="mouseReleased",
                  x=to_x,
                  y=to_y,
                  button="left",
                  clickCount=1)

    def place(self, selector):
        """x, y, width, height of an element in the window, scrolled to where it can be seen."""
        return self.value(f"""(() => {{
            const element = document.querySelector({json.dumps(selector)});
            element.scrollIntoView({{block: "nearest", behavior: "instant"}});
            const box = element.getBoundingClientRect();
            return [box.x, box.y, box.width, box.height];
        }})()""")

    def picture(self, selector=None):
        """The window, or an element of it, as (height, width, 3) in [0, 1]."""
        clip = {}
        if selector:
            x, y, width, height = self.place(selector)
            scroll_x, scroll_y = self.value("[window.scrollX, window.scrollY]")
            clip = {
                "clip": {
                    "x": x + scroll_x,
                    "y": y + scroll_y,
                    "width": width,
                    "height": height,
                    "scale": 1
                }
            }
        data = self.send("Page.captureScreenshot", format="png", **clip)["data"]
        return matplotlib.image.imread(io.BytesIO(base64.b64decode(data)))[..., :3]


def blank_reason(picture, least_deviation=0.02, least_colours=64):
    """Why a picture counts as blank, or nothing where it shows something."""
    deviation = float(picture.std(axis=(0, 1)).max())
    colours = len(numpy.unique(numpy.rint(255 * picture).astype(int).reshape(-1, 3), axis=0))
    if deviation < least_deviation:
        return f"standard deviation {deviation:.4f}, expected at least {least_deviation}"
    if colours < least_colours:
        return f"{colours} colours, expected at least {least_colours}"
    return None
