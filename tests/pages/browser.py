"""A page in a real browser: Debian's chromium without a window, driven over two pipes with the DevTools
protocol.

    with Browser() as browser:
        page = browser.open("report.html", width=360, dark=True)
        page.evaluate("document.title")
        page.picture("report.png")

No port is opened. `page.complaints` lists the browser's errors and warnings.
"""

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time

PROGRAM = "chromium"
PATIENCE = 60  # timeout of an answer [s]


class Fault(Exception):
    """An error reported by the browser or by the page's script."""


class Browser:
    def __init__(self):
        self.profile = tempfile.mkdtemp(prefix="peclet-browser-")
        to_browser, self.commands = os.pipe()
        self.answers, from_browser = os.pipe()
        # The browser reads from descriptor 3 and writes to 4, for any numbers of the pipes here.
        into = [os.dup2(to_browser, 100), os.dup2(from_browser, 101)]
        words = [
            PROGRAM,
            "--headless=new",
            "--no-sandbox",
            "--disable-gpu",
            "--remote-debugging-pipe",
            "--hide-scrollbars",
        ]
        words += ["--no-first-run", "--disable-extensions", f"--user-data-dir={self.profile}", "about:blank"]
        self.process = subprocess.Popen(
            ["/bin/bash", "-c", 'exec "$@" 3<&100 4>&101', "bash", *words],
            pass_fds=into,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for descriptor in (to_browser, from_browser, *into):
            os.close(descriptor)
        self.number, self.unread, self.pages = 0, b"", {}

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            self.call("Browser.close")
        except Fault:
            self.process.kill()
        self.process.wait(PATIENCE)
        os.close(self.commands)
        os.close(self.answers)
        shutil.rmtree(self.profile, ignore_errors=True)

    def read(self, until):
        """Returns the next message, or None if none arrives by `until`."""
        while b"\0" not in self.unread:
            ready, _, _ = select.select([self.answers], [], [], max(0, until - time.monotonic()))
            if not ready:
                return None
            data = os.read(self.answers, 1 << 16)
            if not data:
                raise Fault(f"{PROGRAM} has ended")
            self.unread += data
        text, self.unread = self.unread.split(b"\0", 1)
        return json.loads(text)

    def call(self, method, session=None, **parameters):
        self.number += 1
        message = {"id": self.number, "method": method, "params": parameters}
        if session:
            message["sessionId"] = session
        os.write(self.commands, json.dumps(message).encode() + b"\0")
        until = time.monotonic() + PATIENCE
        while True:
            answer = self.read(until)
            if answer is None:
                raise Fault(f"{method}: no answer for {PATIENCE} s")
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise Fault(f"{method}: {answer['error']['message']}")
                return answer["result"]
            page = self.pages.get(answer.get("sessionId"))
            if page:
                page.hear(answer)

    def open(self, path, width=1100, height=900, dark=False, touch=False):
        """Opens a file, or the address of a server on this machine."""
        address = path if path.startswith("http://127.0.0.1:") else "file://" + os.path.abspath(path)
        return Page(self, address, width, height, dark, touch)


class Page:
    def __init__(self, browser, address, width, height, dark, touch):
        self.browser, self.complaints, self.loaded = browser, [], False
        self.allowed = ("file:", "data:", "about:") + ((address,) if address.startswith("http:") else ())
        target = browser.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        browser.pages[self.session] = self
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        # Requests to other hosts appear as complaints.
        self.resize(width, height, touch)
        features = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.call("Emulation.setEmulatedMedia", features=features)
        begun = time.monotonic()
        refused = self.call("Page.navigate", url=address).get("errorText")
        if refused:
            raise Fault(f"{address}: {refused}")
        while not self.loaded:
            message = browser.read(begun + PATIENCE)
            if message is None:
                raise Fault(f"{address} is not there after {PATIENCE} s")
            if message.get("sessionId") == self.session:
                self.hear(message)
        # The first frame is drawn, which is what a user waits for.
        self.evaluate("new Promise(done => requestAnimationFrame(() => setTimeout(done, 0)))")
        self.seconds = time.monotonic() - begun

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def hear(self, message):
        method, said = message.get("method"), message.get("params", {})
        if method == "Page.loadEventFired":
            self.loaded = True
        elif method == "Runtime.exceptionThrown":
            details = said["exceptionDetails"]
            self.complaints.append(details.get("exception", {}).get("description", details["text"]))
        elif method == "Runtime.consoleAPICalled" and said["type"] in ("error", "warning", "assert"):
            self.complaints.append(" ".join(str(one.get("value", one.get("description"))) for one in said["args"]))
        elif method == "Log.entryAdded" and said["entry"]["level"] in ("error", "warning"):
            self.complaints.append(said["entry"]["text"])
        elif method == "Network.requestWillBeSent":
            if not said["request"]["url"].startswith(self.allowed):
                self.complaints.append("asks for " + said["request"]["url"])
        elif method == "Page.javascriptDialogOpening":
            self.complaints.append("opens a dialog: " + said["message"])
            raise Fault(self.complaints[-1])

    def wait_for(self, expression, seconds=PATIENCE):
        """Returns the value of an expression as soon as it is true."""
        until = time.monotonic() + seconds
        while True:
            value = self.evaluate(expression)
            if value:
                return value
            if time.monotonic() > until:
                raise Fault(f"not so after {seconds} s: {expression[:200]}")
            time.sleep(0.05)

    def evaluate(self, expression):
        """Returns the value of a JavaScript expression, awaited if it is a promise."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            details = answer["exceptionDetails"]
            raise Fault(f"{expression[:80]}: {details.get('exception', {}).get('description', details['text'])}")
        return answer["result"].get("value")

    def resize(self, width, height=900, touch=False):
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": touch}
        self.call("Emulation.setDeviceMetricsOverride", **size)

    def press(self, key):
        for kind in ("keyDown", "keyUp"):
            text = {"text": " "} if key == " " else {"text": "\r"} if key == "Enter" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code="Space" if key == " " else key, **text)

    def picture(self, path, whole=True):
        answer = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(path, "wb") as file:
            file.write(base64.b64decode(answer["data"]))

    def print(self, path):
        answer = self.call("Page.printToPDF", printBackground=True, preferCSSPageSize=False)
        with open(path, "wb") as file:
            file.write(base64.b64decode(answer["data"]))
