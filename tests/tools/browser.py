"""Looks at a page in headless Chromium, without network. For tests of pages; not a test itself."""
import html
import json
import re
import subprocess
import tempfile

# Nothing may be loaded but pictures beside the page.
POLICY = ("<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
          "'unsafe-inline'; script-src 'unsafe-inline'; img-src file:\">")
# Before the page's own scripts: errors are kept.
ERRORS = """<script>window.errors = [];
addEventListener("error", event => errors.push(String(event.message ?? "a file does not load")), true);
addEventListener("securitypolicyviolation", event => errors.push("loads " + event.blockedURI));
</script>"""
# What the scripts below stand on. Events are those of a mouse.
TOOLS = """<script>
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
FINISH = """
result.errors = errors;
parent.postMessage(JSON.stringify(result), "*");
"""
# Around the page, because a window of the browser is never narrower than 500 pixels.
FRAME = """<!DOCTYPE html><body><script>
addEventListener("message", event => document.body.append(
  Object.assign(document.createElement("pre"), {{id: "result", textContent: event.data}})));
</script><iframe src="{page}" width="{width}" height="900" style="border:0"></iframe></body>"""


def look(page, script, width=1280, delay_ms=0):
    """Runs a script after those of the page, and returns what it leaves in `result`."""
    text = page.read_text(encoding="utf-8")
    end = f"setTimeout(() => {{ {FINISH} }}, {delay_ms})</script>"
    text = text.replace("<head>", "<head>" + POLICY + ERRORS, 1)
    text = text.replace("</body>", TOOLS + script + end + "</body>", 1)
    copy = page.with_name("page_with_test.html")
    copy.write_text(text, encoding="utf-8")
    frame = page.with_name("frame_with_test.html")
    frame.write_text(FRAME.format(page=copy.name, width=width), encoding="utf-8")
    with tempfile.TemporaryDirectory() as profile:
        done = subprocess.run(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
             f"--user-data-dir={profile}", "--window-size=1400,1000", "--virtual-time-budget=20000",
             "--host-resolver-rules=MAP * ~NOTFOUND", "--dump-dom", frame.as_uri()],
            capture_output=True, text=True, check=False)
    found = re.search(r'<pre id="result">(.*?)</pre>', done.stdout, re.S)
    assert found, f"the page did not come to its end\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}"
    result = json.loads(html.unescape(found.group(1)))
    assert result["errors"] == [], result["errors"]
    return result
