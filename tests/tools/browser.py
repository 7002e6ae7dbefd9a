"""Looks at pages in headless Chromium, without network. For tests of pages; not a test itself.

Speaks Chromium's DevTools protocol over two pipes. Waits for events and never for a time.
"""
import atexit
import fcntl
import json
import os
import subprocess
import tempfile

# Helpers for the scripts below. Events are those of a mouse.
TOOLS = """
const all = (what, from = document) => [...from.querySelectorAll(what)];
const point = (plot, type, share) => {
  const place = all(".drawing", plot)[0], box = place.getBoundingClientRect();
  const grid = all(".grid", plot)[0], left = +grid.getAttribute("x1"), right = +grid.getAttribute("x2");
  place.dispatchEvent(new PointerEvent(type, {bubbles: true, button: 0, pointerId: 1,
    clientX: box.left + left + share * (right - left), clientY: box.top + 60}));
};
const click = (plot, share) => { point(plot, "pointerdown", share); point(plot, "pointerup", share); };
const drag = (plot, from, to) => { point(plot, "pointerdown", from); point(plot, "pointermove", to); point(plot, "pointerup", to); };
const shown = () => document.getElementById("range").textContent;
const panel = () => document.getElementById("row");
const press = text => all("button").find(b => b.textContent.startsWith(text)).click();
const result = {};
"""


class Browser:
    """A running Chromium; ends with the program."""

    def __init__(self):
        self.profile = tempfile.TemporaryDirectory()
        (reads, to_browser), (from_browser, writes) = os.pipe(), os.pipe()
        # Chromium reads from file 3 and writes to file 4, which may be among these.
        low, high = (reads, writes), [fcntl.fcntl(fd, fcntl.F_DUPFD, 10) for fd in (reads, writes)]
        self.process = subprocess.Popen(
            ["bash", "-c", f'exec "$@" 3<&{high[0]} 4>&{high[1]}',
             "chromium", "chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
             "--remote-debugging-pipe", f"--user-data-dir={self.profile.name}",
             "--host-resolver-rules=MAP * ~NOTFOUND"],
            pass_fds=high, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for fd in (*low, *high):
            os.close(fd)
        self.out, self.into = os.fdopen(to_browser, "wb", 0), os.fdopen(from_browser, "rb")
        self.calls, self.events = 0, []
        atexit.register(self.close)

    def close(self):
        self.call("Browser.close")
        self.process.wait()
        self.profile.cleanup()

    def receive(self):
        message = bytearray()
        while not message.endswith(b"\0"):
            byte = self.into.read(1)
            assert byte, "Chromium has ended"
            message += byte
        return json.loads(message[:-1])

    def call(self, method, session=None, **params):
        """Returns the result of a method. Keeps events that arrive before it."""
        self.calls += 1
        message = {"id": self.calls, "method": method, "params": params}
        if session:
            message["sessionId"] = session
        self.out.write(json.dumps(message).encode() + b"\0")
        while (answer := self.receive()).get("id") != self.calls:
            self.events.append(answer)
        assert "error" not in answer, f"{method}: {answer['error']}"
        return answer["result"]

    def wait_for(self, method):
        while not any(event.get("method") == method for event in self.events):
            self.events.append(self.receive())

    def take(self, method):
        return [event["params"] for event in self.events if event.get("method") == method]


_browser = None


def look(page, script, width=1280):
    """Runs a script, which may await, after a page has loaded, and returns what it leaves in `result`.

    Fails on any error of the page's scripts or this one, and when the page wants anything but itself
    and pictures beside it.
    """
    global _browser
    _browser = _browser or Browser()
    b = _browser
    b.events = []
    target = b.call("Target.createTarget", url="about:blank")["targetId"]
    session = b.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
    for domain in ("Page", "Runtime", "Network", "Log"):
        b.call(f"{domain}.enable", session)
    b.call("Emulation.setDeviceMetricsOverride", session, width=width, height=900, deviceScaleFactor=1,
           mobile=False)
    address = page.resolve().as_uri()
    b.call("Page.navigate", session, url=address)
    b.wait_for("Page.loadEventFired")
    answer = b.call("Runtime.evaluate", session, returnByValue=True, awaitPromise=True,
                    expression="(async () => {" + TOOLS + script + "return result; })()")
    errors = [e["exceptionDetails"] for e in b.take("Runtime.exceptionThrown")]
    errors += [e["entry"]["text"] for e in b.take("Log.entryAdded") if e["entry"]["level"] == "error"]
    errors += [f"loads {e['request']['url']}" for e in b.take("Network.requestWillBeSent")
               if not is_beside(address, e["request"]["url"])]
    b.call("Target.closeTarget", targetId=target)
    assert "exceptionDetails" not in answer, answer["exceptionDetails"]
    assert errors == [], errors
    return answer["result"]["value"]


def is_beside(page, url):
    return url.startswith(("data:", "about:", page.rsplit("/", 1)[0] + "/"))
