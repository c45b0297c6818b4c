/// Script of the replay page: tabs, playing, scrubbing, keys, and the loop that draws what has changed.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_controls = R"js(
// --- controls ------------------------------------------------------------------------------------------

const $ = id => document.getElementById(id);
const scenes = page.scenes, tabs = $('tabs'), scrub = $('scrub'), plotsBox = $('plots');
const camera = new Camera();
const now = {scene: null, index: -1, time: 0, playing: false, speed: 1};
let plots = [], view = null, drawn = false, plotsDrawn = false;

const changed = () => { drawn = false; };
const clampTime = t => Math.min(now.scene.end, Math.max(now.scene.start, t));

function seek(t) {
  now.time = clampTime(t);
  changed();
}
function play(on) {
  now.playing = on && now.scene.end > now.scene.start;
  if (now.playing && now.time >= now.scene.end) now.time = now.scene.start;
  $('play').setAttribute('aria-label', now.playing ? 'Pause' : 'Play');
  const sign = now.playing ? 'M6.5 5h4v14h-4zM13.5 5h4v14h-4z' : 'M7 4.5v15l12.5-7.5z';
  $('play').querySelector('path').setAttribute('d', sign);
  changed();
}
function stepFrames(count) {
  const {times} = now.scene, at = indexAt(times, now.time + 1e-9);
  play(false);
  seek(times[Math.min(times.length - 1, Math.max(0, at + count))]);
}

function openTab(index, time) {
  if (!scenes[index]) return;
  now.index = index;
  now.scene = openScene(scenes[index]);
  now.time = clampTime(time ?? now.scene.start);
  [...tabs.children].forEach((tab, i) => {
    tab.setAttribute('aria-selected', i === index);
    tab.tabIndex = i === index ? 0 : -1;
  });
  $('replay').setAttribute('aria-labelledby', 'tab' + index);
  $('caption').replaceChildren(element('strong', null, now.scene.name), now.scene.caption);
  [scrub.min, scrub.max] = [now.scene.start, now.scene.end];
  view?.open(now.scene);
  $('legend').hidden = !view?.has.contacts;
  for (const key of ['contacts', 'joints'])
    document.querySelector(`[data-toggle=${key}]`).hidden = !view?.has[key];
  makePlots();
  writeNote();
  changed();
}

function makePlots() {
  plotsBox.replaceChildren();
  plots = plotsOf(now.scene).map(spec => new Plot(plotsBox, spec));
  plotsBox.hidden = !plots.length;
  $('replay').classList.toggle('alone', !plots.length);
  plotsDrawn = false;
  for (const plot of plots) {
    const follow = e => seek(plot.timeAt(e.clientX));
    plot.area.addEventListener('pointerdown', e => {
      plot.area.setPointerCapture(e.pointerId);
      play(false);
      follow(e);
    });
    plot.area.addEventListener('pointermove', e => { if (e.buttons) follow(e); });
  }
}

function writeNote() {
  const {scene} = now, resolution = Math.max(...scene.step) / 2, {width} = scene;
  const most = Math.max(0, ...scene.contactTotal), shown = Math.min(page.contacts, most);
  const fine = resolution >= 1e-4 ? human(resolution * 1e3, 2) + ' mm' : human(resolution * 1e6, 2) + ' µm';
  $('note').textContent = `At most ${page.rate} frames a second` +
    (resolution > 0 ? `; positions to ${fine} in this scene. ` : '. ') +
    (shown < most ? `Of up to ${most} contacts at once the ${shown} of largest impulse are kept. ` : '') +
    (width > 1 ? `A plotted point stands for ${width} steps: the largest residual and sweeps, ` +
      'the mean time, the last energy.' : '');
}

// --- drawing what has changed --------------------------------------------------------------------------

function draw() {
  const {scene, time} = now;
  if (!plotsDrawn) {
    const density = Math.min(devicePixelRatio || 1, 3);
    plots.forEach((plot, i) => plot.draw(scene, density, i === plots.length - 1));
    plotsDrawn = true;
  }
  const sample = indexAt(scene.series.time, time);
  for (const plot of plots) plot.cursor(time, sample);
  const count = view?.draw(time);
  if (count) {
    const shown = count.open + count.sliding + count.sticking;
    for (const state of states) document.querySelector(`#legend .${state} b`).textContent = count[state];
    const contacts = shown < count.total ? `${count.total}, ${shown} largest shown` : count.total;
    const rows = [['bodies', scene.moving], ...(view.has.contacts ? [['contacts', contacts]] : [])];
    const cells = rows.flatMap(([name, value]) => [element('span', null, name), element('b', null, value)]);
    $('readout').replaceChildren(...cells);
  }
  const share = (time - scene.start) / (scene.end - scene.start || 1);
  scrub.value = time;
  scrub.style.setProperty('--done', `${100 * share}%`);
  scrub.setAttribute('aria-valuetext', `${time.toFixed(2)} seconds`);
  $('clock').replaceChildren(element('b', null, time.toFixed(2) + ' s'), ` of ${scene.end.toFixed(2)} s`);
}

/// A slow machine gets fewer pixels: after ten frames in a row that took more than 1/15 s.
let last = 0, slow = 0;
function tick(stamp) {
  if (now.playing && last) {
    slow = stamp - last > 66 ? slow + 1 : 0;
    if (slow > 10 && view && view.quality > 0.4) [view.quality, slow] = [view.quality * 0.75, 0];
    now.time += Math.min(0.1, (stamp - last) / 1e3) * now.speed;
    if (now.time > now.scene.end) now.time = now.scene.start;
    drawn = false;
  }
  last = stamp;
  if (!drawn && now.scene) {
    drawn = true;
    draw();
  }
  requestAnimationFrame(tick);
}

// --- what a person can do ------------------------------------------------------------------------------

scenes.forEach((scene, i) => {
  const tab = element('button', tabs, scene.name, 
    {type: 'button', role: 'tab', id: 'tab' + i, 'aria-controls': 'replay'});
  tab.addEventListener('click', () => openTab(i));
});
tabs.addEventListener('keydown', e => {
  const move = {ArrowRight: 1, ArrowLeft: -1}[e.key];
  if (!move) return;
  e.stopPropagation();
  openTab((now.index + move + scenes.length) % scenes.length);
  tabs.children[now.index].focus();
});

$('play').addEventListener('click', () => play(!now.playing));
$('back').addEventListener('click', () => stepFrames(-1));
$('forth').addEventListener('click', () => stepFrames(1));
$('speed').addEventListener('change', e => { now.speed = Number(e.target.value); });
scrub.addEventListener('input', () => {
  play(false);
  seek(Number(scrub.value));
});
$('home').addEventListener('click', () => { camera.reset(); changed(); });
$('arrows').addEventListener('input', e => {
  if (view) view.stretch = 2 ** Number(e.target.value);
  changed();
});

function toggle(key) {
  if (!view) return;
  view.show[key] = !view.show[key];
  document.querySelector(`[data-toggle=${key}]`).setAttribute('aria-pressed', view.show[key]);
  changed();
}
for (const button of document.querySelectorAll('[data-toggle]'))
  button.addEventListener('click', () => toggle(button.dataset.toggle));

const stepBack = e => stepFrames(e.shiftKey ? -10 : -1), stepOn = e => stepFrames(e.shiftKey ? 10 : 1);
const keys = {
  ' ': () => play(!now.playing),
  ArrowLeft: stepBack, ArrowRight: stepOn, ',': stepBack, '.': stepOn, '<': stepBack, '>': stepOn,
  ';': stepBack, ':': stepOn,
  Home: () => seek(now.scene.start), End: () => seek(now.scene.end),
  a: () => camera.turn(-0.1, 0), d: () => camera.turn(0.1, 0),
  w: () => camera.turn(0, 0.08), s: () => camera.turn(0, -0.08),
  '+': () => camera.zoom(0.9), '=': () => camera.zoom(0.9), '-': () => camera.zoom(1 / 0.9),
  r: () => camera.reset(), c: () => toggle('contacts'), j: () => toggle('joints'), x: () => toggle('glass'),
};
addEventListener('keydown', e => {
  const target = e.target, isButton = target.tagName === 'BUTTON' || target.tagName === 'SELECT';
  if (!now.scene || e.ctrlKey || e.metaKey || e.altKey || target.id === 'arrows') return;
  if (isButton && (e.key === ' ' || target.tagName === 'SELECT')) return;
  if (target.closest('.wide') && e.key.startsWith('Arrow')) return;
  const action = keys[e.key.length === 1 ? e.key.toLowerCase() : e.key];
  if (action) action(e);
  else if (e.key >= '1' && e.key <= '9') openTab(Number(e.key) - 1);
  else return;
  e.preventDefault();
  changed();
});

// --- start ---------------------------------------------------------------------------------------------

function start() {
  const canvas = $('view');
  try {
    view = new View(canvas, camera);
  } catch (reason) {
    canvas.hidden = $('toggles').hidden = $('legend').hidden = $('readout').hidden = true;
    $('fallback').hidden = false;
  }
  if (view) {
    attachPointer(canvas, camera, changed);
    canvas.addEventListener('webglcontextlost', () => {
      view = null;
      $('fallback').hidden = false;
    });
  }
  const resize = new ResizeObserver(() => { plotsDrawn = false; changed(); });
  resize.observe(canvas);
  resize.observe(plotsBox);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    view?.readTheme();
    plotsDrawn = false;
    changed();
  });
  // The address may name a scene and a time: #3/2.5 opens the third at 2.5 s.
  const [, index, time] = location.hash.match(/^#(\d+)(?:\/([\d.]+))?$/) ?? [];
  if (!scenes.length) {
    $('replay').hidden = $('keys').hidden = tabs.hidden = true;
    return;
  }
  openTab(scenes[index - 1] ? index - 1 : 0, time && Number(time));
  if (!time && !matchMedia('(prefers-reduced-motion: reduce)').matches) play(true);
  requestAnimationFrame(tick);
}
start();
)js";

}  // namespace delassus::inner
