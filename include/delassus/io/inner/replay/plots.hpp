/// Script of the replay page: energy, residual, sweeps and stage times against time, with a cursor.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_plots = R"js(
// --- plots: one canvas each, the curves drawn once and the cursor over them ----------------------------

const stageColours = ['#4f86c6', '#e39b4f', '#6fae79', '#c76d7e', '#9a86c4', '#c9b24d', '#5aa7ab', '#b0886b',
                      '#8a95a5', '#d48fc0', '#7fb0d9', '#a8a15a'];
const margin = {left: 50, right: 10, top: 8, bottom: 6};
const css = name => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const element = (tag, parent, text = '', attributes = {}) => {
  const e = document.createElement(tag);
  e.textContent = text;
  for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
  parent?.append(e);
  return e;
};

/// Round numbers from low to high, about `count` of them.
function ticks(low, high, count) {
  const raw = (high - low) / count, power = 10 ** Math.floor(Math.log10(raw)), lead = raw / power;
  const step = power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10), list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) list.push(i * step);
  return {list, decimals: Math.max(0, -Math.floor(Math.log10(step) + 1e-9))};
}
const decades = (low, high, count) => {
  const step = Math.max(1, Math.ceil((high - low) / count)), list = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9; ++i) list.push(i * step);
  return list;
};

const prefixes = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ'], [1e-9, 'n'], [1e-12, 'p']];
const prefixFor = size =>
  size > 0 ? prefixes.find(([scale]) => size >= scale) ?? prefixes.at(-1) : prefixes[3];
const finite = list => Array.from(list).filter(Number.isFinite);
const extremes = list => {
  const range = finite(list).reduce(([a, b], x) => [Math.min(a, x), Math.max(b, x)], [Infinity, -Infinity]);
  return range[0] <= range[1] ? range : [0, 0];
};

class Plot {
  /// `axis`: {low, high, marks(count): [[value, label], …]}; `text(i)`: what the heading says of sample i.
  constructor(parent, {title, unit, axis, layers, line, text, legend}) {
    Object.assign(this, {axis, layers, line, text, legend});
    const box = element('section', parent, '', {class: legend ? 'plot tall' : 'plot'});
    const head = element('h3', box);
    element('span', head).append(title + ' ', element('small', null, unit));
    this.value = element('b', head);
    const label = `${title} ${unit} against time`;
    this.area = element('div', box, '', {class: 'area', role: 'img', 'aria-label': label});
    this.canvas = element('canvas', this.area);
    this.still = document.createElement('canvas');
    if (legend) {
      const list = element('ul', box);
      this.entries = legend.map(({name, colour}) => {
        const item = element('li', list);
        element('i', item).style.background = colour;
        item.append(name + ' ');
        return element('span', item);
      });
    }
  }

  x(t) { return margin.left + (t - this.start) / (this.end - this.start || 1) * this.inner; }
  y(v) { return margin.top + (this.axis.high - v) / (this.axis.high - this.axis.low || 1) * this.height; }
  timeAt(clientX) {
    const share = (clientX - this.area.getBoundingClientRect().left - margin.left) / this.inner;
    return this.start + Math.min(1, Math.max(0, share)) * (this.end - this.start);
  }

  /// The still part; drawn again when the size or the colours change.
  draw(scene, density, isLast) {
    const {still, area} = this, width = area.clientWidth, bottom = isLast ? 20 : margin.bottom;
    Object.assign(this, {start: scene.start, end: scene.end, density, bottom});
    this.inner = Math.max(10, width - margin.left - margin.right);
    this.height = Math.max(10, area.clientHeight - margin.top - bottom);
    still.width = this.canvas.width = Math.round(width * density);
    still.height = this.canvas.height = Math.round(area.clientHeight * density);
    const c = still.getContext('2d');
    c.scale(density, density);
    c.font = '11px system-ui, sans-serif';
    c.textBaseline = 'middle';
    c.lineWidth = 1;
    c.fillStyle = css('soft');
    c.strokeStyle = css('line');
    const rule = (x0, y0, x1, y1) => { c.beginPath(); c.moveTo(x0, y0); c.lineTo(x1, y1); c.stroke(); };
    c.textAlign = 'right';
    for (const [value, label] of this.axis.marks(Math.max(2, Math.round(this.height / 32)))) {
      const y = Math.round(this.y(value)) + 0.5;
      rule(margin.left, y, margin.left + this.inner, y);
      c.fillText(label, margin.left - 7, y);
    }
    c.textAlign = 'center';
    const times = ticks(scene.start, scene.end, Math.max(2, this.inner / 70));
    for (const t of times.list) {
      const x = Math.round(this.x(t)) + 0.5, floor = margin.top + this.height;
      rule(x, margin.top, x, floor);
      if (isLast) c.fillText(t.toFixed(times.decimals) + ' s', Math.min(x, width - 14), floor + 12);
    }
    c.save();
    c.beginPath();
    c.rect(margin.left, margin.top - 1, this.inner, this.height + 2);
    c.clip();
    this.curves(c, scene.series.time);
    c.restore();
  }

  curves(c, time) {
    if (this.layers) {  // areas stacked upwards
      const below = new Float64Array(time.length);
      for (const {values, colour} of this.layers) {
        c.beginPath();
        for (let i = 0; i < time.length; ++i) c.lineTo(this.x(time[i]), this.y(below[i] + values[i]));
        for (let i = time.length - 1; i >= 0; --i) c.lineTo(this.x(time[i]), this.y(below[i]));
        for (let i = 0; i < time.length; ++i) below[i] += values[i];
        c.fillStyle = colour;
        c.fill();
      }
      return;
    }
    const {values, level} = this.line;
    if (level !== undefined) {
      c.setLineDash([5, 4]);
      c.strokeStyle = css('sliding');
      c.beginPath();
      c.moveTo(margin.left, this.y(level));
      c.lineTo(margin.left + this.inner, this.y(level));
      c.stroke();
      c.setLineDash([]);
    }
    c.beginPath();
    let isDrawing = false;  // what is no number leaves a gap, minus infinity is the floor
    for (let i = 0; i < time.length; ++i) {
      const y = Math.min(this.y(values[i]), margin.top + this.height);
      if (isDrawing && !Number.isNaN(y)) c.lineTo(this.x(time[i]), y); else c.moveTo(this.x(time[i]), y);
      isDrawing = !Number.isNaN(y);
    }
    c.strokeStyle = css('accent');
    c.lineWidth = 1.5;
    c.lineJoin = 'round';
    c.stroke();
  }

  /// The moving part: cursor and numbers at time `t`, sample `i`.
  cursor(t, i) {
    const c = this.canvas.getContext('2d'), x = this.x(t);
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.clearRect(0, 0, this.canvas.width, this.canvas.height);
    c.drawImage(this.still, 0, 0);
    c.scale(this.density, this.density);
    c.strokeStyle = c.fillStyle = css('cursor');
    c.lineWidth = 1.5;
    c.beginPath();
    c.moveTo(x, margin.top - 3);
    c.lineTo(x, margin.top + this.height);
    c.stroke();
    if (this.line && !Number.isNaN(this.line.values[i])) {
      c.beginPath();
      const y = this.y(this.line.values[i]);
      c.arc(x, Math.min(margin.top + this.height, Math.max(margin.top, y)), 3.2, 0, 7);
      c.fill();
    }
    this.value.textContent = this.text(i);
    this.entries?.forEach((entry, k) => entry.textContent = duration(this.layers[k].values[i]));
  }
}

// --- which plots a scene has ---------------------------------------------------------------------------

/// A linear axis around the values, in units of `scale`.
function linearAxis([low, high], scale, fromZero) {
  if (fromZero) low = Math.min(0, low);
  const room = 0.06 * (high - low) || Math.abs(high) * 0.1 || scale;
  const axis = {low: fromZero ? low : low - room, high: high + room};
  axis.marks = count => {
    const {list, decimals} = ticks(axis.low / scale, axis.high / scale, count);
    return list.map(v => [v * scale, v.toFixed(decimals).replace('-', '−')]);
  };
  return axis;
}

/// A logarithmic axis; the values are log₁₀ already.
function logAxis([low, high], label) {
  if (high - low < 1) [low, high] = [Math.floor(low - 0.05), Math.ceil(high + 0.05)];
  const axis = {low: low - 0.25, high: high + 0.25};
  axis.marks = count => decades(axis.low, axis.high, count).map(v => [v, label(v)]);
  return axis;
}

/// Energy, or its change where that is small beside it.
function energyPlot(values) {
  const range = extremes(values), size = Math.max(Math.abs(range[0]), Math.abs(range[1]));
  const first = finite(values)[0] ?? 0;
  if (range[1] - range[0] >= 1e-3 * size) {
    const [scale, prefix] = prefixFor(size);
    return {title: 'Energy', unit: prefix + 'J', axis: linearAxis(range, scale), line: {values},
            text: i => energyText(values[i])};
  }
  const change = values.map(v => v - first), [low, high] = extremes(change);
  const [scale, prefix] = prefixFor(Math.max(-low, high));
  return {title: 'Energy', unit: `change from ${energyText(first)}, in ${prefix}J`,
          axis: linearAxis([low, high], scale), line: {values: change},
          text: i => `${change[i] > 0 ? '+' : ''}${human(change[i] / scale)} ${prefix}J`};
}

function sweepsPlot(values) {
  const sorted = finite(values).sort((a, b) => a - b), most = sorted.at(-1) ?? 0;
  const text = i => Number.isFinite(values[i]) ? `${Math.round(values[i])}` : '–';
  if (most < 100 || most < 30 * quantile(sorted, 0.5))
    return {title: 'Sweeps', unit: 'a step', axis: linearAxis([0, most || 1], 1, true), line: {values}, text};
  const logs = values.map(v => Math.log10(Math.max(v, 1)));
  return {title: 'Sweeps', unit: 'a step, logarithmic', line: {values: logs}, text,
          axis: logAxis([0, Math.log10(most)], v => String(10 ** v))};
}

function stagesPlot(stages) {
  const layers = stages.map(({values}, k) => ({values, colour: stageColours[k % stageColours.length]}));
  const total = Array.from(stages[0].values, (_, i) => stages.reduce((sum, s) => sum + s.values[i], 0));
  const sorted = finite(total).sort((a, b) => a - b), most = sorted.at(-1) ?? 0;
  const high = Math.min(quantile(sorted, 0.99), 3 * quantile(sorted, 0.9)) || most || 1e-3;  // rare peaks are cut
  const scale = high >= 1 ? 1 : 1e-3, axis = linearAxis([0, high], scale, true);
  const peaks = most > axis.high ? `, peaks to ${duration(most)}` : '';
  return {title: 'Time per step', unit: (scale === 1 ? 'ms, by stage' : 'µs, by stage') + peaks, layers, axis,
          text: i => duration(total[i]),
          legend: stages.map(({name}, k) => ({name, colour: layers[k].colour}))};
}

function plotsOf({series, tolerance}) {
  const {energy, residual, sweeps} = series, list = [];
  const stages = series.stages.filter(s => s.values.length);
  if (energy.length) list.push(energyPlot(energy));
  if (residual.length) {
    const level = tolerance > 0 ? Math.log10(tolerance) : undefined;
    const known = finite(residual);
    const range = extremes(level === undefined ? known : [...known, level]);
    const bound = level === undefined ? '' : `, tolerance ${human(tolerance, 1).replace('1 × ', '')}`;
    list.push({title: 'Residual', unit: 'relative' + bound, axis: logAxis(range, v => '10' + raised(v)),
               line: {values: residual, level}, text: i => human(10 ** residual[i])});
  }
  if (sweeps.length) list.push(sweepsPlot(sweeps));
  if (stages.length) list.push(stagesPlot(stages));
  return list;
}
)js";

}  // namespace delassus::inner
