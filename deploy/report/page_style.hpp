// The look of the page, light and dark, and the few lines by which a legend points at its line.
#pragma once

namespace eciton::report {

constexpr const char* page_style = R"css(
:root { color-scheme: light dark; --paper: #fcfcfb; --card: #ffffff; --ink: #1d1c1a; --quiet: #66645f; --rule: #e4e3df;
  --limit: #c2352f; --k0: #2a78d6; --k1: #e06326; --k2: #159a6b; --k3: #c28400; --k4: #5a49bd; --k5: #d4588a;
  --k6: #3d8b22; --k7: #d03b3b; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #161615; --card: #1e1e1c; --ink: #ecebe8; --quiet: #a09e97; --rule: #383733; --limit: #f0716b;
    --k0: #5a9cf0; --k1: #ee8552; --k2: #3cbf8f; --k3: #dba53a; --k4: #a297f0; --k5: #ea86ad; --k6: #74bd57;
    --k7: #ee7b7b; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--paper); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif; }
main { max-width: 1120px; margin: 0 auto; padding: 40px 20px 80px; }
h1 { font-size: 28px; line-height: 1.2; margin: 0 0 4px; letter-spacing: -0.01em; }
h2 { font-size: 18px; margin: 44px 0 10px; }
h3 { font-size: 15px; margin: 0 0 8px; font-weight: 600; }
.under { color: var(--quiet); margin: 0; }
.partial { display: inline-block; margin: 12px 0 0; padding: 2px 10px; border: 1px solid var(--limit);
  border-radius: 999px; color: var(--limit); }
.card { background: var(--card); border: 1px solid var(--rule); border-radius: 10px; padding: 16px 18px;
  margin: 0 0 16px; }
.wide { overflow-x: auto; }
.wide svg { display: block; width: 100%; min-width: 620px; }
table { border-collapse: collapse; width: 100%; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 5px 8px; text-align: right; border-bottom: 1px solid var(--rule); white-space: nowrap; }
th { color: var(--quiet); font-weight: 500; }
th:first-child, td:first-child { text-align: left; padding-left: 0; }
tr:last-child td { border-bottom: 0; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 18px; margin: 0; font-size: 13.5px; }
dt { color: var(--quiet); } dd { margin: 0; overflow-wrap: anywhere; }
ul { margin: 0; padding-left: 18px; }
svg text { font-size: 12px; fill: var(--ink); }
svg .tick { fill: var(--quiet); } svg .name { font-weight: 600; } svg .figure { font-variant-numeric: tabular-nums; }
.grid { stroke: var(--rule); stroke-width: 1; }
.line { fill: none; stroke-width: 2; stroke-linejoin: round; }
.dashed { stroke-dasharray: 6 4; }
.band { stroke: none; opacity: 0.22; }
.whisker { stroke: var(--ink); stroke-width: 1.3; }
.limit { stroke: var(--limit); stroke-width: 1.5; stroke-dasharray: 5 4; }
.legend { display: flex; flex-wrap: wrap; gap: 4px 18px; margin: 0 0 8px; font-size: 13.5px; }
.legend span { cursor: default; } .legend small { color: var(--quiet); }
.legend i { display: inline-block; width: 18px; height: 0; border-top: 3px solid; margin: 0 7px 4px 0; }
.legend i.dashed { border-top-style: dashed; }
.faint { opacity: 0.15; }
.c0 { --k: var(--k0); } .c1 { --k: var(--k1); } .c2 { --k: var(--k2); } .c3 { --k: var(--k3); }
.c4 { --k: var(--k4); } .c5 { --k: var(--k5); } .c6 { --k: var(--k6); } .c7 { --k: var(--k7); }
.line { stroke: var(--k); } .fill, .band { fill: var(--k); } .legend i { border-color: var(--k); }
@media print { .card { break-inside: avoid; } }
)css";

constexpr const char* page_script = R"js(
for (const key of document.querySelectorAll(".legend span")) {
  const lines = key.closest(".card").querySelectorAll("path.line");
  const mine = "s" + key.dataset.line;
  key.addEventListener("pointerenter", () => lines.forEach(l => l.classList.toggle("faint", !l.classList.contains(mine))));
  key.addEventListener("pointerleave", () => lines.forEach(l => l.classList.remove("faint")));
}
)js";

}  // namespace eciton::report
