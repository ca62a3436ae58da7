"""A headless Chromium, driven by its own protocol over two pipes: no package, no port."""

import base64
import json
import os
import shutil
import subprocess
import tempfile
import time

NAMES = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"]


def installed():
    """The browser of this machine, or nothing."""
    return os.environ.get("HADAR_CHROMIUM") or next(filter(None, map(shutil.which, NAMES)), None)


class Browser:
    """One browser with a profile of its own."""

    def __init__(self, program):
        # The browser reads its file 3 and writes its file 4.
        (own_read, self.to), (self.back, own_write) = os.pipe(), os.pipe()
        self.profile = tempfile.mkdtemp(prefix="hadar-page-")
        shell = f"exec 3<&{own_read} 4>&{own_write}; exec \"$0\" \"$@\""
        flags = ["--headless=new", "--remote-debugging-pipe", "--no-sandbox", "--disable-gpu", "--no-first-run",
                 f"--user-data-dir={self.profile}", "--force-color-profile=srgb", "--hide-scrollbars"]
        self.process = subprocess.Popen(["bash", "-c", shell, program, *flags], pass_fds=[own_read, own_write],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(own_read)
        os.close(own_write)
        self.number, self.rest, self.events = 0, b"", []

    def call(self, method, session=None, **parameters):
        """Asks for something and waits for the answer; events meanwhile are kept."""
        self.number += 1
        asked = {"id": self.number, "method": method, "params": parameters}
        if session:
            asked["sessionId"] = session
        os.write(self.to, json.dumps(asked).encode() + b"\0")
        while True:
            said = self.message()
            if said.get("id") == self.number:
                if "error" in said:
                    raise RuntimeError(f"{method}: {said['error']['message']}")
                return said["result"]
            self.events.append(said)

    def message(self):
        while b"\0" not in self.rest:
            part = os.read(self.back, 1 << 20)
            if not part:
                raise RuntimeError("the browser is gone")
            self.rest += part
        text, self.rest = self.rest.split(b"\0", 1)
        return json.loads(text)

    def page(self, url, width=1280, height=900):
        return Page(self, url, width, height)

    def close(self):
        self.process.kill()
        self.process.wait()
        shutil.rmtree(self.profile, ignore_errors=True)


class Page:
    """A page; what goes wrong in it is in `errors()`, every address it asked for in `requests()`."""

    def __init__(self, browser, url, width, height):
        self.browser = browser
        target = browser.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = browser.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ["Page", "Runtime", "Network", "Log", "DOM", "Accessibility"]:
            self.call(f"{domain}.enable")
        self.sized(width, height)
        self.call("Page.navigate", url=url)

    def call(self, method, **parameters):
        return self.browser.call(method, self.session, **parameters)

    def sized(self, width, height, scale=1):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=scale,
                  mobile=width < 600)

    def js(self, expression):
        """The value of an expression, which may be a promise."""
        result = self.call("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            raise RuntimeError(f"{expression}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def until(self, expression, seconds=300):
        """Waits until an expression is true; the limit only ends a check that hangs."""
        end = time.monotonic() + seconds
        while not self.js(expression):
            if time.monotonic() > end:
                raise AssertionError(f"after {seconds} s still not: {expression}")
            time.sleep(0.02)

    def key(self, name, code, number, modifiers=0):
        for kind in ["keyDown", "keyUp"]:
            self.call("Input.dispatchKeyEvent", type=kind, key=name, code=code, windowsVirtualKeyCode=number,
                      modifiers=modifiers)

    def picture(self, path, whole=False):
        shot = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)
        with open(path, "wb") as file:
            file.write(base64.b64decode(shot["data"]))

    def printed(self, path):
        pdf = self.call("Page.printToPDF", printBackground=True, preferCSSPageSize=True)
        with open(path, "wb") as file:
            file.write(base64.b64decode(pdf["data"]))

    def own(self, method):
        return [said["params"] for said in self.browser.events
                if said.get("sessionId") == self.session and said.get("method") == method]

    def errors(self):
        logged = [said["entry"]["text"] for said in self.own("Log.entryAdded") if said["entry"]["level"] == "error"]
        thrown = [said["exceptionDetails"]["text"] for said in self.own("Runtime.exceptionThrown")]
        return logged + thrown

    def requests(self):
        return [said["request"]["url"] for said in self.own("Network.requestWillBeSent")]

    def names(self):
        """Role and name of everything that a screen reader can operate."""
        nodes = self.call("Accessibility.getFullAXTree")["nodes"]
        wanted = {"button", "textbox", "combobox", "slider", "link"}
        role = [(node.get("role", {}).get("value"), node.get("name", {}).get("value", "")) for node in nodes
                if not node.get("ignored")]
        return [(kind, name) for kind, name in role if kind in wanted]
