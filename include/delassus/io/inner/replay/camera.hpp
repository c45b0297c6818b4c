/// Script of the replay page: vectors, matrices and a camera that turns around a point.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_camera = R"js(
// --- camera: column-major matrices, and an orbit around a target ---------------------------------------

const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const norm = a => Math.hypot(a[0], a[1], a[2]);
const unit = a => { const n = norm(a) || 1; return [a[0] / n, a[1] / n, a[2] / n]; };
const turned = (q, v) => {
  const t = cross(q, add(cross(q, v), v, q[3]));
  return add(v, t, 2);
};

function product(a, b) {
  const m = new Float32Array(16);
  for (let c = 0; c < 4; ++c)
    for (let r = 0; r < 4; ++r)
      for (let k = 0; k < 4; ++k) m[4 * c + r] += a[4 * k + r] * b[4 * c + k];
  return m;
}
const perspective = (angle, aspect, near, far) => {
  const f = 1 / Math.tan(angle / 2);
  return new Float32Array([f / aspect, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1,
                           0, 0, 2 * far * near / (near - far), 0]);
};
const parallel = (radius, near, far) => new Float32Array([1 / radius, 0, 0, 0, 0, 1 / radius, 0, 0,
  0, 0, -2 / (far - near), 0, 0, 0, -(far + near) / (far - near), 1]);
function looking(eye, target, up) {
  const z = unit(add(eye, target, -1)), x = unit(cross(up, z)), y = cross(z, x);
  return new Float32Array([x[0], y[0], z[0], 0, x[1], y[1], z[1], 0, x[2], y[2], z[2], 0,
                           -dot(x, eye), -dot(y, eye), -dot(z, eye), 1]);
}

/// Two horizontal directions for a given vertical.
function horizontal(up) {
  const e1 = unit(cross(Math.abs(up[2]) > 0.5 ? [0, 1, 0] : [0, 0, 1], up));
  return [e1, cross(up, e1)];
}

const opening = 0.6;  // radians, vertically
class Camera {
  /// Looks at a ball, across the direction in which the scene is long.
  home(scene, ball) {
    this.up = scene.up;
    [this.e1, this.e2] = horizontal(this.up);
    this.first = {target: ball.centre, distance: 0, azimuth: ball.azimuth, elevation: ball.elevation};
    this.ball = ball;
    this.reset();
  }
  reset() {
    Object.assign(this, this.first);
    this.distance = this.fitting();
    this.moved = false;
  }
  /// From here the upright cylinder of half height `tall` and radius `wide` fills the picture.
  fitting() {
    const {wide, tall, largest} = this.ball, slope = Math.tan(opening / 2), {elevation} = this.first;
    const upwards = tall * Math.cos(elevation) + wide * Math.sin(elevation) + 1.15 * largest;
    return Math.max(upwards, (wide + 1.15 * largest) / (this.aspect || 1)) / slope + 0.6 * wide;
  }
  resized(aspect) {
    this.aspect = aspect;
    if (!this.moved) this.distance = this.fitting();
  }
  direction() {
    const c = Math.cos(this.elevation);
    return add(add(add([0, 0, 0], this.e1, c * Math.cos(this.azimuth)), this.e2, c * Math.sin(this.azimuth)),
               this.up, Math.sin(this.elevation));
  }
  eye() { return add(this.target, this.direction(), this.distance); }
  matrix() {
    const reach = this.distance + 12 * this.ball.radius;
    return product(perspective(opening, this.aspect, Math.max(this.distance / 200, reach / 20000), reach),
                   looking(this.eye(), this.target, this.up));
  }
  turn(right, up) {
    this.azimuth -= right;
    this.elevation = Math.min(1.55, Math.max(-1.55, this.elevation + up));
    this.moved = true;
  }
  /// Moves the target in the plane of the picture; lengths in heights of the picture.
  pan(right, up) {
    const scale = 2 * this.distance * Math.tan(opening / 2), back = this.direction();
    const x = unit(cross(this.up, back)), y = cross(back, x);
    this.target = add(add(this.target, x, -right * scale), y, -up * scale);
    this.moved = true;
  }
  zoom(factor) {
    const {radius} = this.ball;
    this.distance = Math.min(60 * radius, Math.max(0.02 * radius, this.distance * factor));
    this.moved = true;
  }
}

/// One finger or the left button turns; shift, the right button or two fingers move; wheel and pinch zoom.
function attachPointer(canvas, camera, changed) {
  const down = new Map();
  canvas.addEventListener('contextmenu', e => e.preventDefault());
  canvas.addEventListener('pointerdown', e => {
    canvas.setPointerCapture(e.pointerId);
    down.set(e.pointerId, [e.clientX, e.clientY]);
  });
  const up = e => down.delete(e.pointerId);
  canvas.addEventListener('pointerup', up);
  canvas.addEventListener('pointercancel', up);
  canvas.addEventListener('pointermove', e => {
    const last = down.get(e.pointerId);
    if (!last) return;
    const height = canvas.clientHeight;
    const dx = (e.clientX - last[0]) / height, dy = (e.clientY - last[1]) / height;
    if (down.size >= 2) {
      const other = [...down].find(([id]) => id !== e.pointerId)[1];
      const before = Math.hypot(last[0] - other[0], last[1] - other[1]);
      camera.zoom((before + 1) / (Math.hypot(e.clientX - other[0], e.clientY - other[1]) + 1));
      camera.pan(dx / 2, -dy / 2);
    } else if (e.shiftKey || e.buttons & 6) {
      camera.pan(dx, -dy);
    } else {
      camera.turn(3.2 * dx, 3.2 * dy);
    }
    down.set(e.pointerId, [e.clientX, e.clientY]);
    changed();
  });
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    camera.zoom(Math.exp(Math.max(-100, Math.min(100, e.deltaY * (e.deltaMode ? 16 : 1))) * 0.0018));
    changed();
  }, {passive: false});
}
)js";

}  // namespace delassus::inner
