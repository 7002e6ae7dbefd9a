#include "engine/telemetry/report_style.hpp"

namespace psygen::telemetry {
namespace {

constexpr std::string_view kStyle = R"css(
:root { color-scheme: light dark;
  --page:#f6f7f9; --card:#ffffff; --text:#1c2430; --soft:#5d6878; --edge:#dfe3e9; --grid:#e8ebf0;
  --warm:#8894a622; --good:#12805c; --fair:#94600a; --bad:#c2332f; --level:#3b4656;
  --c9:#d3d9e1; --c0:#a9b2bf; --c1:#2f6fd0; --c2:#e0742b; --c3:#1f9e77; --c4:#d9a514; --c5:#7a4fc0; --c6:#d0433f;
  --c7:#d1679a; --c8:#5f8f1f; }
@media (prefers-color-scheme: dark) { :root {
  --page:#12161c; --card:#1a2029; --text:#e6eaf0; --soft:#98a4b5; --edge:#2b3440; --grid:#262e39;
  --warm:#aab6c81c; --good:#43c59e; --fair:#e6b450; --bad:#ff7b72; --level:#c3ccd8;
  --c9:#434d5a; --c0:#66717f; --c1:#5b9bf5; --c2:#f0924f; --c3:#3fc196; --c4:#e6bd45; --c5:#a585ea; --c6:#f0716b;
  --c7:#e68bb5; --c8:#93c04a; } }
* { box-sizing:border-box }
body { margin:0; background:var(--page); color:var(--text); font:15px/1.45 system-ui,-apple-system,
  "Segoe UI",Roboto,"DejaVu Sans",sans-serif; font-variant-numeric:tabular-nums }
main { max-width:1120px; margin:0 auto; padding:28px 20px 48px }
h1 { font-size:25px; margin:0; letter-spacing:-.01em; overflow-wrap:anywhere }
h2 { font-size:14px; margin:0 0 8px; color:var(--soft); font-weight:600 }
.lead { margin:4px 0 22px; color:var(--soft) }
.cards { display:grid; grid-template-columns:repeat(auto-fit,minmax(225px,1fr)); gap:12px }
.card,figure,.facts section { background:var(--card); border:1px solid var(--edge);
  border-radius:10px }
.card { padding:13px 16px 12px }
.card b { display:block; font-size:25px; line-height:1.25; font-weight:650; letter-spacing:-.015em }
.card b small { font-size:14px; font-weight:500; color:var(--soft); letter-spacing:0 }
.card span { color:var(--soft); font-size:13px }
.card .label { font-weight:600 }
.good b { color:var(--good) } .fair b { color:var(--fair) } .bad b { color:var(--bad) }
.verdict { background:var(--card); border:1px solid var(--edge); border-left:6px solid var(--c0);
  border-radius:10px; padding:12px 16px 10px; margin-bottom:12px }
.verdict b { font-size:18px } .verdict code { font:inherit; white-space:nowrap } .verdict p { margin:3px 0 } .advice { color:var(--soft) }
.verdict.good { border-left-color:var(--good) } .verdict.fair { border-left-color:var(--fair) }
.verdict.bad { border-left-color:var(--bad) }
figure { margin:14px 0 0; padding:14px 16px 10px; position:relative }
figcaption { font-weight:600; margin-bottom:2px }
.legend { display:flex; flex-wrap:wrap; gap:2px 16px; font-size:13px; color:var(--soft);
  margin:2px 0 4px }
.legend i { display:inline-block; width:11px; height:11px; border-radius:3px; margin-right:6px;
  vertical-align:-1px }
svg { display:block; width:100%; height:auto; overflow:visible }
svg text { font-size:12px; fill:var(--soft) }
text.level { fill:var(--level); font-weight:600; paint-order:stroke; stroke:var(--card);
  stroke-width:4px; stroke-linejoin:round }
.grid { stroke:var(--grid) } .warmup { fill:var(--warm) }
line.level { stroke:var(--level); stroke-dasharray:5 4 }
.cursor { stroke:var(--soft); pointer-events:none }
.line { fill:none; stroke-width:1.4; stroke-linejoin:round } .band { opacity:.28 }
.dashed { stroke-dasharray:5 4 } .ring { fill:none; stroke-width:2 }
.stack { opacity:.88 } .mark { stroke:var(--bad); stroke-width:1.4 }
.note { margin:2px 0 4px; color:var(--soft); font-size:13px }
.readout { position:absolute; pointer-events:none; background:var(--card); border:1px solid
  var(--edge); border-radius:8px; padding:6px 10px; font-size:12.5px; white-space:nowrap;
  box-shadow:0 4px 14px #0003; z-index:1 }
.readout b { display:block }
.facts { display:grid; grid-template-columns:repeat(auto-fit,minmax(300px,1fr)); gap:12px;
  margin-top:14px }
.facts section { padding:14px 16px }
table { border-collapse:collapse; width:100%; font-size:13.5px }
td,th { padding:3px 0; vertical-align:top; border-top:1px solid var(--grid); font-weight:400 }
tr:first-child > * { border-top:0 }
th { text-align:left; color:var(--soft); padding-right:14px; white-space:nowrap }
td { text-align:right; overflow-wrap:anywhere }
.none { color:var(--soft); cursor:help; border-bottom:1px dotted }
)css"
                                    R"css(
.fill0{fill:var(--c0)}.fill1{fill:var(--c1)}.fill2{fill:var(--c2)}.fill3{fill:var(--c3)}
.fill4{fill:var(--c4)}.fill5{fill:var(--c5)}.fill6{fill:var(--c6)}.fill7{fill:var(--c7)}
.fill8{fill:var(--c8)}.fill9{fill:var(--c9)}
.stroke0{stroke:var(--c0)}.stroke1{stroke:var(--c1)}.stroke2{stroke:var(--c2)}
.stroke3{stroke:var(--c3)}.stroke4{stroke:var(--c4)}.stroke5{stroke:var(--c5)}
.stroke6{stroke:var(--c6)}.stroke7{stroke:var(--c7)}.stroke8{stroke:var(--c8)}
.stroke9{stroke:var(--c9)}
.swatch0{background:var(--c0)}.swatch1{background:var(--c1)}.swatch2{background:var(--c2)}
.swatch3{background:var(--c3)}.swatch4{background:var(--c4)}.swatch5{background:var(--c5)}
.swatch6{background:var(--c6)}.swatch7{background:var(--c7)}.swatch8{background:var(--c8)}.swatch9{background:var(--c9)}
@media (max-width:700px) { figure { overflow-x:auto } figure > svg { min-width:640px } }
@media print { figure,.card,.verdict,.facts section { break-inside:avoid } }
)css";

constexpr std::string_view kScript = R"js(
for (const figure of document.querySelectorAll("figure")) {
  const data = JSON.parse(figure.querySelector("script").textContent);
  const svg = figure.querySelector("svg"), cursor = svg.querySelector(".cursor");
  const readout = figure.querySelector(".readout");
  const hide = () => { readout.hidden = true; cursor.setAttribute("visibility", "hidden"); };
  svg.addEventListener("pointerleave", hide);
  svg.addEventListener("pointermove", event => {
    const box = svg.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width * 1000;
    if (!data.x.length || x < 50 || x > 900) return hide();
    let low = 0, high = data.x.length - 1;
    while (low < high) { const middle = (low + high) >> 1;
      if (data.x[middle] < x) low = middle + 1; else high = middle; }
    if (low > 0 && x - data.x[low - 1] < data.x[low] - x) low--;
    cursor.setAttribute("x1", data.x[low]); cursor.setAttribute("x2", data.x[low]);
    cursor.setAttribute("visibility", "visible");
    readout.replaceChildren();
    const add = (tag, text) => { const line = document.createElement(tag);
      line.textContent = text; readout.append(line); };
    add("b", data.t[low].toFixed(2) + " s");
    for (const series of data.series) if (series.v[low] !== null)
      add("div", series.name + ": " + Number(series.v[low].toPrecision(4)) + " " + data.unit);
    readout.hidden = false;
    const outer = figure.getBoundingClientRect();
    let left = event.clientX - outer.left + 16;
    if (left + readout.offsetWidth > outer.width - 8) left -= readout.offsetWidth + 32;
    readout.style.left = left + "px";
    readout.style.top = event.clientY - outer.top + 12 + "px";
  });
}
)js";

}  // namespace

std::string_view report_style() {
  return kStyle;
}

std::string_view report_script() {
  return kScript;
}

}  // namespace psygen::telemetry
