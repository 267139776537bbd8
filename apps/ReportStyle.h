// How the page of a report looks, on light and dark screens and on paper.
#pragma once

namespace app {

inline constexpr const char* reportStyle = R"css(
:root { --ground: #f5f3ee; --paper: #ffffff; --ink: #1c2530; --soft: #5c6773; --line: #e3dfd6; --accent: #a8480f; --over: #b3261e; }
@media (prefers-color-scheme: dark) {
  :root { --ground: #12161b; --paper: #1a2027; --ink: #e7ebef; --soft: #9ba7b3; --line: #2f3842; --accent: #ffab70; --over: #ff8a80; }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink); font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "DejaVu Sans", sans-serif; }
main { max-width: 1280px; margin: 0 auto; padding: 32px 24px 64px; }
header { display: grid; grid-template-columns: minmax(0, 1fr) minmax(0, 420px); gap: 32px; align-items: center; }
header figure { padding: 0; overflow: hidden; }
.kind { margin: 0; color: var(--accent); font-weight: 600; letter-spacing: .06em; text-transform: uppercase; font-size: 13px; }
h1 { font-size: clamp(26px, 4vw, 40px); line-height: 1.15; margin: 4px 0 16px; overflow-wrap: anywhere; }
h2 { font-size: 22px; margin: 48px 0 12px; }
h3 { font-size: 16px; margin: 0 0 6px; }
.summary { font-size: 18px; margin: 0 0 16px; }
.errors { margin: 0 0 16px; color: var(--soft); }
.facts, .keys { list-style: none; margin: 0; padding: 0; display: flex; flex-wrap: wrap; gap: 6px 10px; }
.facts li { background: var(--paper); border: 1px solid var(--line); border-radius: 99px; padding: 2px 12px; font-size: 14px; color: var(--soft); }
.note { border-left: 3px solid var(--accent); padding: 4px 12px; color: var(--soft); font-size: 15px; }
.findings { display: grid; grid-template-columns: repeat(auto-fit, minmax(160px, 1fr)); gap: 14px; margin-top: 28px; }
.finding { background: var(--paper); border: 1px solid var(--line); border-top: 4px solid var(--c); border-radius: 8px; padding: 12px 16px; }
.finding h3 { color: var(--soft); font-weight: 500; font-size: 14px; }
.finding p { margin: 0; font-size: 14px; color: var(--soft); overflow-wrap: anywhere; }
.finding .value { font-size: 28px; font-weight: 650; color: var(--ink); line-height: 1.25; }
.finding .value small { font-size: 14px; font-weight: 400; color: var(--soft); }
.finding .who { color: var(--ink); font-weight: 600; margin-bottom: 4px; }
.wide { overflow-x: auto; background: var(--paper); border: 1px solid var(--line); border-radius: 8px; }
table { border-collapse: collapse; width: 100%; font-size: 13.5px; font-variant-numeric: tabular-nums; }
th, td { padding: 7px 7px; text-align: right; white-space: nowrap; border-top: 1px solid var(--line); }
thead th { border-top: 0; color: var(--soft); font-weight: 500; vertical-align: bottom; padding-bottom: 4px; }
thead .group { color: var(--ink); font-weight: 600; text-align: left; }
.group, .first { border-left: 1px solid var(--line); }
tbody th, thead th:first-child { text-align: left; }
tbody th { font-weight: 600; position: sticky; left: 0; background: var(--paper); z-index: 1; }
tbody th small { display: block; padding-left: 24px; font-weight: 400; color: var(--soft); }
thead tr:first-child th:first-child { position: sticky; left: 0; background: var(--paper); z-index: 1; }
td.best { font-weight: 700; }
td.over, .problem { color: var(--over); }
td.problem { text-align: left; white-space: normal; min-width: 420px; }
.caption, figcaption { color: var(--soft); font-size: 14px; }
.caption a { color: var(--accent); }
.chip { display: inline-block; width: 16px; height: 0; border-top: 4px solid var(--c); border-radius: 2px; margin-right: 8px; vertical-align: middle; }
.chip.dashed { border-top-style: dashed; border-top-width: 3px; }
figure { margin: 0; background: var(--paper); border: 1px solid var(--line); border-radius: 8px; padding: 14px 16px; min-width: 0; }
.plots { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 500px), 1fr)); gap: 16px; }
.plots figure { display: flex; flex-direction: column; }
.plots figcaption { margin-top: 8px; }
.keys { font-size: 12.5px; gap: 0 14px; color: var(--soft); margin-bottom: 8px; }
.keys .chip { margin-right: 5px; }
svg.plot { width: 100%; height: auto; }
svg.plot [fill="black"] text, svg.plot [fill="rgb(1,2,3)"] text { fill: var(--soft); }
svg.plot [stroke="rgb(  1,   2,   3)"] { stroke: var(--soft); }
svg.plot [stroke="rgb(  1,   2,   4)"] { stroke: var(--line); }
img { max-width: 100%; height: auto; display: block; }
header img { width: 100%; }
.pictures { display: grid; grid-template-columns: repeat(auto-fit, minmax(min(100%, 500px), 1fr)); gap: 16px; }
.pictures figure { padding: 10px; }
.pair { display: grid; grid-template-columns: 1fr 1fr; gap: 8px; }
.pair img { border-radius: 4px; }
figcaption { margin-top: 8px; }
figcaption b { color: var(--ink); font-weight: 600; }
dl { display: grid; grid-template-columns: max-content minmax(0, 1fr); gap: 6px 20px; margin: 0; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
code { background: var(--paper); border: 1px solid var(--line); border-radius: 4px; padding: 1px 5px; font-size: 14px; overflow-wrap: anywhere; }
@media (max-width: 820px) { header { grid-template-columns: 1fr; gap: 20px; } main { padding: 20px 14px 48px; } }
@media (max-width: 520px) { dl { grid-template-columns: 1fr; gap: 0; } dd { margin-bottom: 10px; } tbody th { min-width: 128px; white-space: normal; } }
@media print { body { background: #fff; } figure, .finding, .wide { break-inside: avoid; } }
)css";

}  // namespace app
