/// The looks of the replay page, light and dark, wide and narrow.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_style = R"css(
:root {
  --paper: #f3f4f6; --card: #ffffff; --ink: #1b2330; --soft: #5d6878; --line: #dfe3e8; --accent: #2563c9;
  --on-accent: #ffffff; --sky: #eef2f7; --depth: #d5dde7; --glass: rgba(255, 255, 255, .78);
  --shade: rgba(20, 30, 50, .08);
  --sticking: #1f77d0; --sliding: #e8740c; --open: #8a94a3; --joint: #6d3fc0; --fixed: #b4bcc6;
  --cursor: #d6336c;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #0f1319; --card: #171d26; --ink: #e6eaf0; --soft: #98a4b5; --line: #2a323e; --accent: #6ea8ff;
    --on-accent: #0c1522; --sky: #222b38; --depth: #11161d; --glass: rgba(20, 26, 35, .76);
    --shade: rgba(0, 0, 0, .35);
    --sticking: #4fa3ff; --sliding: #ff9a3d; --open: #8d99aa; --joint: #b79bff; --fixed: #56616f;
    --cursor: #ff6b9d;
  }
}
* { box-sizing: border-box; }
[hidden] { display: none !important; }
html { font: 15px/1.5 system-ui, "Segoe UI", Roboto, "Helvetica Neue", "Noto Sans", sans-serif;
  -webkit-text-size-adjust: 100%; }
body { margin: 0 auto; padding: 24px 28px 40px; max-width: 1560px; background: var(--paper);
  color: var(--ink); }
h1 { margin: 0; font-size: 1.55rem; font-weight: 650; letter-spacing: -.012em; line-height: 1.25; }
h2 { margin: 0 0 .5rem; font-size: 1.05rem; font-weight: 650; }
header p { margin: .3rem 0 0; color: var(--soft); max-width: 78ch; }
header p:empty { display: none; }
.unseen { position: absolute; width: 1px; height: 1px; overflow: hidden; clip-path: inset(50%); }
:focus-visible { outline: 2px solid var(--accent); outline-offset: 2px; }

button, select { font: inherit; color: inherit; border: 1px solid var(--line); border-radius: 8px;
  background: var(--card);
  padding: .3rem .75rem; cursor: pointer; }
button:hover, select:hover { border-color: var(--soft); }
svg { display: block; width: 20px; height: 20px; fill: currentColor; }

#tabs { display: flex; flex-wrap: wrap; gap: 6px; margin: 18px 0 14px; }
#tabs button { border-radius: 999px; color: var(--soft); padding: .32rem .95rem; }
#tabs button[aria-selected=true] { background: var(--accent); border-color: var(--accent);
  color: var(--on-accent);
  font-weight: 600; }

main { display: grid; grid-template-columns: minmax(0, 1fr) minmax(330px, 29%); gap: 16px;
  align-items: stretch; }
main.alone { grid-template-columns: minmax(0, 1fr); }
#stage, #plots, figure { background: var(--card); border: 1px solid var(--line); border-radius: 14px;
  box-shadow: 0 1px 2px var(--shade), 0 8px 24px -18px var(--shade); }
#stage { display: flex; flex-direction: column; overflow: hidden; min-width: 0; }
#caption { margin: 0; padding: .7rem 1.1rem; color: var(--soft); border-bottom: 1px solid var(--line); }
#caption strong { color: var(--ink); font-weight: 650; margin-right: .55em; }
#frame { position: relative; flex: 1; min-height: clamp(300px, 62vh, 760px);
  background: radial-gradient(120% 90% at 50% 18%, var(--sky), var(--depth)); }
#view { position: absolute; inset: 0; width: 100%; height: 100%; touch-action: none; cursor: grab;
  display: block; }
#view:active { cursor: grabbing; }
#view:focus-visible { outline-offset: -3px; }
#fallback { position: absolute; inset: 0; display: grid; place-content: center; margin: 0;
  padding: 2rem max(2rem, calc(50% - 15rem)); text-align: center;
  color: var(--soft); }
#readout, #toggles, #legend { position: absolute; font-size: .8rem; font-variant-numeric: tabular-nums; }
#readout { left: 12px; top: 12px; pointer-events: none; padding: .45rem .7rem; border-radius: 9px;
  background: var(--glass);
  display: grid; grid-template-columns: auto auto; gap: .02rem .8rem; }
#readout span { color: var(--soft); }
#readout b { font-weight: 600; text-align: right; }
#toggles { right: 12px; top: 12px; display: flex; flex-wrap: wrap; justify-content: flex-end; gap: 5px; }
#toggles button { background: var(--glass); padding: .22rem .6rem; font-size: .8rem; color: var(--soft); }
#toggles button[aria-pressed=true] { color: var(--ink); border-color: var(--accent); }
#legend { left: 12px; bottom: 12px; display: flex; flex-wrap: wrap; gap: .15rem .9rem; align-items: center;
  padding: .3rem .7rem; border-radius: 9px; background: var(--glass); max-width: calc(100% - 24px); }
#legend i { display: inline-block; width: 10px; height: 10px; border-radius: 3px; margin-right: .35em; }
#legend b { font-weight: 600; display: inline-block; min-width: 1.3em; text-align: right; }
#legend label { display: flex; align-items: center; gap: .4em; color: var(--soft); }
#legend input { width: 74px; }
.sticking i { background: var(--sticking); } .sliding i { background: var(--sliding);
  } .open i { background: var(--open); }

#transport { display: flex; align-items: center; gap: 8px; padding: 10px 14px;
  border-top: 1px solid var(--line); }
#transport button { padding: .35rem; line-height: 0; }
#play { background: var(--accent); color: var(--on-accent); border-color: var(--accent); border-radius: 50%;
  padding: .5rem; }
#play:hover { filter: brightness(1.08); }
.plain { border-color: transparent; background: none; }
#transport select { padding: .25rem .3rem; }
#clock { font-variant-numeric: tabular-nums; white-space: nowrap; color: var(--soft); min-width: 8.6em;
  text-align: right; }
#clock b { color: var(--ink); font-weight: 600; }
input[type=range] { appearance: none; -webkit-appearance: none; background: none; height: 22px; margin: 0;
  cursor: pointer; }
#scrub { flex: 1; min-width: 60px; --done: 0%; }
input[type=range]::-webkit-slider-runnable-track { height: 5px; border-radius: 3px; background: var(--line); }
input[type=range]::-moz-range-track { height: 5px; border-radius: 3px; background: var(--line); }
#scrub::-webkit-slider-runnable-track { background: linear-gradient(90deg, var(--accent) var(--done),
  var(--line) var(--done)); }
#scrub::-moz-range-progress { height: 5px; border-radius: 3px; background: var(--accent); }
input[type=range]::-webkit-slider-thumb { -webkit-appearance: none; width: 15px; height: 15px;
  margin-top: -5px;
  border-radius: 50%; background: var(--accent); border: 2px solid var(--card);
  box-shadow: 0 0 0 1px var(--accent); }
input[type=range]::-moz-range-thumb { width: 11px; height: 11px; border-radius: 50%;
  background: var(--accent);
  border: 2px solid var(--card); box-shadow: 0 0 0 1px var(--accent); }

#plots { display: flex; flex-direction: column; padding: 4px 14px 8px; min-width: 0; }
.plot { flex: 1 1 0; display: flex; flex-direction: column; min-height: 128px; padding-top: 8px; }
.plot.tall { flex-grow: 1.75; }
.plot + .plot { border-top: 1px solid var(--line); }
.plot h3 { display: flex; justify-content: space-between; gap: 1em; margin: 0; font-size: .83rem;
  font-weight: 600; }
.plot h3 span { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.plot h3 small { font-weight: 400; color: var(--soft); font-size: inherit; }
.plot h3 b { font-variant-numeric: tabular-nums; font-weight: 600; white-space: nowrap; }
.plot div.area { position: relative; flex: 1; min-height: 78px; cursor: crosshair; touch-action: pan-y; }
.plot canvas { position: absolute; inset: 0; width: 100%; height: 100%; }
.plot ul { display: flex; flex-wrap: wrap; gap: 0 .8rem; list-style: none; margin: 0; padding: 0 0 4px;
  font-size: .74rem;
  color: var(--soft); font-variant-numeric: tabular-nums; }
.plot li i { display: inline-block; width: 9px; height: 9px; border-radius: 2px; margin-right: .35em; }
.plot p { margin: auto; color: var(--soft); font-size: .85rem; }

#tables { display: flex; flex-wrap: wrap; gap: 16px; margin-top: 16px; }
figure { margin: 0; padding: 16px 18px; flex: 1 1 auto; min-width: 0; max-width: 100%; }
figcaption { color: var(--soft); font-size: .87rem; margin-top: .6rem; max-width: 90ch; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th, td { padding: .38rem .7rem; text-align: left; white-space: nowrap; border-bottom: 1px solid var(--line);
  font-weight: 400; }
th:first-child, td:first-child { padding-left: 0; }
thead th { color: var(--soft); font-size: .83rem; white-space: normal; vertical-align: bottom;
  line-height: 1.3; }
tbody th { font-weight: 600; }
tbody tr:last-child > * { border-bottom: 0; }
tbody tr:hover > * { background: color-mix(in srgb, var(--accent) 7%, transparent); }
.number { text-align: right; }
sup { font-size: .75em; line-height: 0; }

footer { color: var(--soft); font-size: .83rem; margin-top: 18px; }
footer p { margin: .3rem 0; max-width: 110ch; }
kbd { font: inherit; font-size: .78rem; border: 1px solid var(--line); border-bottom-width: 2px;
  border-radius: 5px;
  padding: 0 .35em; margin: 0 .1em; background: var(--card); }
footer span { white-space: nowrap; margin-right: .9em; }

@media (max-width: 980px) {
  main { grid-template-columns: minmax(0, 1fr); }
  #frame { min-height: clamp(280px, 52vh, 560px); }
  .plot, .plot.tall { flex: none; min-height: 0; }
  .plot div.area { flex: none; height: 96px; }
  .plot.tall div.area { height: 140px; }
  thead th { white-space: nowrap; }
}
@media (max-width: 600px) {
  body { padding: 16px 12px 32px; }
  h1 { font-size: 1.3rem; }
  #tabs { flex-wrap: nowrap; overflow-x: auto; margin: 14px -12px 10px; padding: 2px 12px;
    scrollbar-width: none; }
  #tabs button { flex: none; }
  #toggles { top: auto; bottom: 44px; left: 8px; right: 8px; justify-content: flex-start; }
  #legend { left: 8px; bottom: 8px; gap: .1rem .6rem; }
  #legend label { display: none; }
  #view { height: calc(100% - 78px); }
  #readout { left: 8px; top: 8px; }
  #transport { gap: 5px; padding: 8px 10px; flex-wrap: wrap; }
  #scrub { order: -1; flex-basis: 100%; }
  #clock { flex: 1; }
  #plots { padding: 4px 10px 8px; }

  #keys { display: none; }
}
)css";
}  // namespace delassus::inner
