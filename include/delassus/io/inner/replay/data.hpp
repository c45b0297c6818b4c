/// Script of the replay page: reads the recordings back into numbers and puts numbers into words.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_data = R"js(
// --- data: from base64 and 16-bit words to numbers -----------------------------------------------------

const page = JSON.parse(document.getElementById('replay-data').textContent);

const bytes = text => {
  const raw = atob(text), out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
  return out;
};
const words = text => new Uint16Array(bytes(text).buffer);

/// The last two words mean minus infinity, the logarithm of zero, and no number.
const series = ([low, high, text]) => Float64Array.from(words(text), w =>
  w === 65535 ? NaN : w === 65534 ? -Infinity : low + (high - low) * w / 65533);

/// Everything of one scene, decoded once, when its tab is first opened.
function openScene(scene) {
  if (scene.opened) return scene.opened;
  const counts = words(scene.contactCounts), lineCounts = words(scene.lineCounts);
  const opened = {
    name: scene.name, caption: scene.caption, up: scene.up, times: scene.times, shapes: scene.shapes,
    low: scene.low, step: scene.high.map((h, k) => (h - scene.low[k]) / 65535),
    positions: words(scene.positions), rotations: words(scene.rotations),
    contacts: words(scene.contacts), states: bytes(scene.contactStates), impulse: scene.impulse / 32767,
    lines: words(scene.lines), contactStart: [0], contactTotal: [], lineStart: [0],
    width: scene.series.width, tolerance: scene.series.tolerance,
  };
  for (let f = 0; f < scene.times.length; ++f) {
    opened.contactStart.push(opened.contactStart[f] + counts[2 * f]);
    opened.contactTotal.push(counts[2 * f + 1]);
    opened.lineStart.push(opened.lineStart[f] + lineCounts[f]);
  }
  // A moving body has a place in the position stream, and one in the rotation stream unless it is a particle.
  let moving = 0, turning = 0;
  opened.bodies = scene.bodies.map(([shape, colour, ...pose]) => {
    const body = {shape: scene.shapes[shape], colour, moving: -1, turning: -1,
                  position: [0, 0, 0], rotation: [0, 0, 0, 1]};
    if (pose.length) {
      body.position = pose.slice(0, 3);
      body.rotation = pose.slice(3);
    } else {
      body.moving = moving++;
      if (body.shape.kind !== 'particle') body.turning = turning++;
    }
    return body;
  });
  opened.moving = moving;
  opened.turning = turning;
  const {time, energy, residual, sweeps, stages} = scene.series;
  opened.series = {time: series(time), energy: series(energy), residual: series(residual),
                   sweeps: series(sweeps),
                   stages: stages.map(([name, packed]) => ({name, values: series(packed)}))};
  const measured = opened.series.time;
  opened.start = Math.min(scene.times[0], measured.length ? measured[0] : Infinity);
  opened.end = Math.max(scene.times.at(-1), measured.length ? measured.at(-1) : -Infinity);
  return scene.opened = opened;
}

const point = (scene, list, i, out = [0, 0, 0]) => {
  for (let k = 0; k < 3; ++k) out[k] = scene.low[k] + scene.step[k] * list[i + k];
  return out;
};

/// An end of line `i` at time `t`: on the way to where the next frame has it, if that has the same lines.
function linePoint(scene, frame, i, end, t) {
  const {times, lineStart} = scene, count = lineStart[frame + 1] - lineStart[frame];
  const at = point(scene, scene.lines, 6 * i + end);
  if (frame + 1 >= times.length || lineStart[frame + 2] - lineStart[frame + 1] !== count) return at;
  const share = Math.min(1, Math.max(0, (t - times[frame]) / (times[frame + 1] - times[frame])));
  const next = point(scene, scene.lines, 6 * (i + count) + end);
  return at.map((x, k) => x + share * (next[k] - x));
}

/// Three words: two bits say which component was the largest and left out, the others hold 15 bits each.
function rotation(list, i, out) {
  const largest = (list[i] & 1) << 1 | (list[i + 1] & 1);
  let sum = 0;
  for (let k = 0; k < 4; ++k) {
    if (k === largest) continue;
    out[k] = ((list[i++] >> 1) / 32767 - 0.5) * Math.SQRT2;
    sum += out[k] * out[k];
  }
  out[largest] = Math.sqrt(Math.max(0, 1 - sum));
  return out;
}

/// The last entry of an ascending list that is not above `value`.
function indexAt(list, value) {
  let low = 0, high = list.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (list[middle] <= value) low = middle; else high = middle - 1;
  }
  return Math.max(0, low);
}

/// Writes position and rotation of every moving body at time `t`, between frames on the straight line.
const from = [0, 0, 0], to = [0, 0, 0], turnFrom = [0, 0, 0, 1], turnTo = [0, 0, 0, 1];
function poseAt(scene, t) {
  const f = indexAt(scene.times, t), next = Math.min(f + 1, scene.times.length - 1);
  const passed = next > f ? (t - scene.times[f]) / (scene.times[next] - scene.times[f]) : 0;
  const share = Math.min(1, Math.max(0, passed));
  for (const body of scene.bodies) {
    if (body.moving < 0) continue;
    point(scene, scene.positions, 3 * (f * scene.moving + body.moving), from);
    point(scene, scene.positions, 3 * (next * scene.moving + body.moving), to);
    for (let k = 0; k < 3; ++k) body.position[k] = from[k] + share * (to[k] - from[k]);
    if (body.turning < 0) continue;
    const a = rotation(scene.rotations, 3 * (f * scene.turning + body.turning), turnFrom);
    const b = rotation(scene.rotations, 3 * (next * scene.turning + body.turning), turnTo);
    const near = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] < 0 ? -share : share;
    let size = 0;
    for (let k = 0; k < 4; ++k) size += (body.rotation[k] = (1 - share) * a[k] + near * b[k]) ** 2;
    for (let k = 0; k < 4; ++k) body.rotation[k] /= Math.sqrt(size);
  }
  return f;
}

// --- numbers as a person writes them -------------------------------------------------------------------

const raised = n => String(n).replace(/./g, c => c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]);

/// Three digits; powers of ten beyond a million and below a thousandth.
function human(x, digits = 3) {
  if (!Number.isFinite(x)) return '–';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size >= 1e6 || size < 1e-3) {
    const [head, power] = x.toExponential(digits - 1).split('e');
    return `${head.replace('-', '−')} × 10${raised(Number(power))}`;
  }
  return x.toFixed(Math.max(0, digits - 1 - Math.floor(Math.log10(size)))).replace('-', '−');
}

/// Milliseconds in the unit that suits them.
const duration = ms => ms === 0 ? '0' : ms < 1e-3 ? human(ms * 1e6) + ' ns' : ms < 1 ? human(ms * 1e3) + ' µs'
  : ms < 1e3 ? human(ms) + ' ms' : human(ms / 1e3) + ' s';

const energyText = x => {
  const size = Math.abs(x);
  return size >= 1e6 ? human(x / 1e6, 4) + ' MJ' : size >= 1e3 ? human(x / 1e3, 4) + ' kJ'
    : size < 1 && size >= 1e-3 ? human(x * 1e3, 4) + ' mJ' : human(x, 4) + ' J';
};
)js";

}  // namespace delassus::inner
