/// The layout of the replay page. {{names}} are filled in by `replay_page`.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_layout = R"html(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy"
  content="default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:">
<link rel="icon" href="data:,">
<title>{{title}}</title>
<style>
{{style}}</style>
</head>
<body>
<header>
  <h1>{{title}}</h1>
  <p>{{introduction}}</p>
</header>

<nav id="tabs" role="tablist" aria-label="Scenes"></nav>

<main id="replay" role="tabpanel">
  <section id="stage" aria-label="Replay">
    <p id="caption"></p>
    <div id="frame">
      <canvas id="view" tabindex="0"
        aria-label="The scene in 3-D. Drag to turn, with shift to move, wheel to zoom."></canvas>
      <p id="fallback" hidden>This browser offers no WebGL 2, so the scene cannot be drawn here.
        The plots and the tables need none.</p>
      <div id="readout" aria-live="off"></div>
      <div id="toggles" role="group" aria-label="What is drawn">
        <button type="button" data-toggle="contacts" aria-pressed="true" title="Contact impulses (C)">
          Impulses</button>
        <button type="button" data-toggle="joints" aria-pressed="true" title="Joints (J)">Joints</button>
        <button type="button" data-toggle="glass" aria-pressed="false" title="See through the bodies (X)">
          X-ray</button>
        <button type="button" id="home" title="Back to the first view (R)">Reset view</button>
      </div>
      <div id="legend">
        <span class="sticking"><i></i><b></b> sticking</span>
        <span class="sliding"><i></i><b></b> sliding</span>
        <span class="open"><i></i><b></b> open</span>
        <label title="Length of the arrows">arrows
          <input id="arrows" type="range" min="-2" max="2" step="0.25" value="0"
            aria-label="Length of the arrows"></label>
      </div>
    </div>
    <div id="transport">
      <button type="button" id="play" aria-label="Play" title="Play or pause (space)">
        <svg viewBox="0 0 24 24" aria-hidden="true"><path d="M7 4.5v15l12.5-7.5z"/></svg></button>
      <button type="button" id="back" class="plain" aria-label="Frame back" title="Frame back (, or left)">
        <svg viewBox="0 0 24 24" aria-hidden="true"><path d="M6 5h2.6v14H6zM19 5v14L9.6 12z"/></svg></button>
      <button type="button" id="forth" class="plain" aria-label="One frame on" title="Frame on (. or right)">
        <svg viewBox="0 0 24 24" aria-hidden="true"><path d="M15.4 5H18v14h-2.6zM5 5v14l9.4-7z"/></svg>
      </button>
      <input id="scrub" type="range" min="0" value="0" step="any" aria-label="Time">
      <output id="clock" for="scrub"></output>
      <label class="plain"><span class="unseen">Speed</span>
        <select id="speed" title="Speed">
          <option value="0.05">1/20 ×</option><option value="0.1">1/10 ×</option>
          <option value="0.25">1/4 ×</option><option value="0.5">1/2 ×</option>
          <option value="1" selected>1 ×</option><option value="2">2 ×</option><option value="4">4 ×</option>
        </select></label>
    </div>
  </section>
  <section id="plots" aria-label="Against time"></section>
</main>

<section id="tables" aria-label="Tables">{{tables}}</section>

<footer>
  <p id="note"></p>
  <p id="keys"><span><kbd>space</kbd> play</span>
    <span><kbd>,</kbd><kbd>.</kbd> frame by frame, with <kbd>shift</kbd> ten at once</span>
    <span><kbd>1</kbd>…<kbd>9</kbd> scene</span>
    <span><kbd>w</kbd><kbd>a</kbd><kbd>s</kbd><kbd>d</kbd> turn</span> <span><kbd>+</kbd><kbd>−</kbd> zoom</span>
    <span><kbd>r</kbd> first view</span> <span><kbd>c</kbd> impulses</span> <span><kbd>j</kbd> joints</span>
    <span><kbd>x</kbd> x-ray</span></p>
</footer>
<noscript><p>The replay needs JavaScript; the tables above do not.</p></noscript>
<script type="application/json" id="replay-data">{{data}}</script>
<script>
{{script}}</script>
</body>
</html>
)html";

}  // namespace delassus::inner
