#include "engine/telemetry/page_style.hpp"

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
svg { display:block; width:100%; height:auto } .drawing svg { overflow:visible }
svg text { font-size:12px; fill:var(--soft) }
text.level { fill:var(--level); font-weight:600; paint-order:stroke; stroke:var(--card);
  stroke-width:4px; stroke-linejoin:round }
.grid { stroke:var(--grid) } .warmup { fill:var(--warm) }
line.level { stroke:var(--level); stroke-dasharray:5 4 }
.cursor { stroke:var(--soft); pointer-events:none }
.line { fill:none; stroke-width:1.4; stroke-linejoin:round } .band { opacity:.28 }
.dashed { stroke-dasharray:5 4 } .ring { fill:none; stroke-width:2 }
.plot .drawing { touch-action:pan-y; user-select:none; cursor:crosshair }
.picked { stroke:var(--text); stroke-width:1.4; pointer-events:none } .selection { fill:var(--c1); opacity:.22 }
.pin { fill:var(--text) } .p { stroke:var(--level); stroke-dasharray:5 4 }
.tools { position:sticky; top:0; z-index:3; display:flex; flex-wrap:wrap; align-items:center;
  gap:4px 14px; background:var(--page); padding:8px 0; margin-top:10px; font-size:13.5px;
  border-bottom:1px solid var(--edge) }
.tools[hidden] { display:none } .tools .hint { color:var(--soft) } .buttons { white-space:nowrap }
button { font:inherit; font-size:13px; color:var(--text); background:var(--card);
  border:1px solid var(--edge); border-radius:7px; padding:3px 10px; cursor:pointer }
button:hover { border-color:var(--soft) } button:disabled { opacity:.45; cursor:default }
.buttons button + button { margin-left:6px }
.slowest { display:flex; flex-wrap:wrap; gap:6px; align-items:center; font-size:13px;
  color:var(--soft); margin:4px 0 6px }
#row { position:fixed; left:0; right:0; bottom:0; z-index:4; max-height:46vh; overflow:auto;
  background:var(--card); border-top:1px solid var(--edge); box-shadow:0 -6px 24px #0004 }
#row .inner { max-width:1120px; margin:0 auto; padding:10px 20px 14px }
#row header { display:flex; flex-wrap:wrap; gap:6px 10px; align-items:center; margin-bottom:6px }
#row header b { font-size:16px; margin-right:auto }
#row .columns { display:grid; gap:6px 28px; grid-template-columns:repeat(auto-fit,minmax(250px,1fr)) }
#row img { max-width:100%; border-radius:6px; display:block } #row h3 { font-size:13px; margin:2px 0 4px }
#row .bar { height:5px; margin-top:8px; border-radius:3px; background:var(--c1) } #row .wait .bar { background:var(--c0) }
#row .bars td:first-child { text-align:left; width:42% } #row .bars td:last-child { width:90px }
.open { padding-bottom:48vh } .percentiles { overflow-x:auto } .percentiles td,.percentiles th { padding:3px 8px; text-align:right }
.percentiles th:first-child { text-align:left }
.command { margin:-14px 0 18px; font-size:13px } .command code,.facts code { overflow-wrap:anywhere;
  font:12.5px/1.4 ui-monospace,"DejaVu Sans Mono",monospace }
.key { color:#fff; border-radius:4px; padding:0 6px; font-weight:600 }
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
@media print { .tools,#row,.slowest { display:none } figure,.card,.verdict,.facts section { break-inside:avoid } }
)css";

}  // namespace

std::string_view page_style() {
  return kStyle;
}

}  // namespace psygen::telemetry
