/// Script of the replay page: triangles of the unit solids, and how large a body and a scene are.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_solids = R"js(
// --- solids: lists of (corner, normal), six numbers a vertex -------------------------------------------

/// Triangles of a quadrangle a b c d, the normals given by `normal` at each corner.
function quad(out, corners, normal) {
  for (const i of [0, 1, 2, 0, 2, 3]) out.push(...corners[i], ...normal(corners[i]));
}

/// Edges of length 2 around the origin.
function boxSolid() {
  const out = [];
  for (let axis = 0; axis < 3; ++axis) {
    for (const side of [-1, 1]) {
      const at = (u, v) => {
        const p = [0, 0, 0];
        p[axis] = side;
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v * side;
        return p;
      };
      const n = [0, 0, 0];
      n[axis] = side;
      quad(out, [at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)], () => n);
    }
  }
  return out;
}

/// Radius 1, `rings` from pole to pole.
function sphereSolid(rings) {
  const out = [], at = (i, j) => {
    const a = Math.PI * i / rings, b = Math.PI * j / rings;
    return [Math.sin(a) * Math.cos(b), Math.sin(a) * Math.sin(b), Math.cos(a)];
  };
  for (let i = 0; i < rings; ++i)
    for (let j = 0; j < 2 * rings; ++j)
      quad(out, [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)], p => p);
  return out;
}

/// Along z from z0 to z1, its radius going from r0 to r1; closed at both ends where it has a radius.
function coneSolid(z0, r0, z1, r1, sides) {
  const out = [], slope = (r0 - r1) / (z1 - z0);
  for (let i = 0; i < sides; ++i) {
    const at = (k, r, z) => {
      const a = 2 * Math.PI * (i + k) / sides;
      return [r * Math.cos(a), r * Math.sin(a), z];
    };
    const sideNormal = k => {
      const a = 2 * Math.PI * (i + k) / sides;
      return unit([Math.cos(a), Math.sin(a), slope]);
    };
    const c = [at(0, r0, z0), at(1, r0, z0), at(1, r1, z1), at(0, r1, z1)];
    for (const k of [0, 1, 2, 0, 2, 3]) out.push(...c[k], ...sideNormal(k === 1 || k === 2 ? 1 : 0));
    for (const p of [[0, 0, z0], c[1], c[0]]) if (r0 > 0) out.push(...p, 0, 0, -1);
    for (const p of [[0, 0, z1], c[3], c[2]]) if (r1 > 0) out.push(...p, 0, 0, 1);
  }
  return out;
}

/// Faces are polygons, counter-clockwise from outside.
function hullSolid({vertices, faces}) {
  const out = [], at = i => vertices.slice(3 * i, 3 * i + 3);
  for (const face of faces) {
    const a = at(face[0]);
    let n = [0, 0, 0];
    for (let k = 1; k + 1 < face.length; ++k)
      n = add(n, cross(add(at(face[k]), a, -1), add(at(face[k + 1]), a, -1)));
    n = unit(n);
    for (let k = 1; k + 1 < face.length; ++k)
      for (const p of [a, at(face[k]), at(face[k + 1])]) out.push(...p, ...n);
  }
  return out;
}

/// An arrow along z: the shaft ends at z = 1, the head at z = 2; the shader stretches each.
const arrowSolid = () => [...coneSolid(0, 0.42, 1, 0.42, 10), ...coneSolid(1, 1, 2, 0, 14)];

// --- sizes ---------------------------------------------------------------------------------------------

/// Radius of the ball around a shape's origin that holds it, m.
function radiusOf(shape) {
  const [a, b, c] = shape.size;
  switch (shape.kind) {
    case 'box': return Math.hypot(a, b, c) / 2;
    case 'capsule': return a + b / 2;
    case 'cylinder': return Math.hypot(a, b / 2);
    case 'cone': return Math.max(0.75 * b, Math.hypot(a, b / 4));
    case 'ellipsoid': return Math.max(a, b, c);
    case 'hull': {
      let r = 0;
      for (let i = 0; i < shape.vertices.length; i += 3)
        r = Math.max(r, norm(shape.vertices.slice(i, i + 3)));
      return r;
    }
    case 'half_space': case 'none': return 0;
    default: return a;
  }
}

const quantile = (list, share) => list.length ? list[Math.round(share * (list.length - 1))] : 0;

/// The ball in which the moving bodies spend their time, leaving out the few that fly away, and the side
/// from which it is seen best: across its longer horizontal direction.
function sceneBall(scene) {
  const axes = [...horizontal(scene.up), scene.up];
  const along = [[], [], []], lows = [[], [], []], highs = [[], [], []];
  const stride = Math.max(1, Math.floor(scene.times.length / 40));
  const some = scene.bodies.filter(b => b.moving >= 0 && radiusOf(b.shape) > 0);
  const seen = some.length ? some : scene.bodies.filter(b => radiusOf(b.shape) > 0);
  for (let f = 0; f < scene.times.length; f += stride) {
    poseAt(scene, scene.times[f]);
    axes.forEach((axis, k) => {
      const list = seen.map(body => dot(axis, body.position));
      along[k].push(...list);
      list.sort((a, b) => a - b);
      lows[k].push(quantile(list, 0.02));
      highs[k].push(quantile(list, 0.98));
    });
  }
  const radii = seen.map(body => radiusOf(body.shape)).sort((a, b) => a - b);

  const [x, y] = along, n = x.length || 1;
  const mx = x.reduce((s, v) => s + v, 0) / n, my = y.reduce((s, v) => s + v, 0) / n;
  let xx = 0, xy = 0, yy = 0;
  for (let i = 0; i < x.length; ++i) {
    xx += (x[i] - mx) ** 2;
    xy += (x[i] - mx) * (y[i] - my);
    yy += (y[i] - my) ** 2;
  }
  const longer = Math.hypot(xx - yy, 2 * xy) / (xx + yy || 1);
  let azimuth = longer > 0.5 ? Math.atan2(2 * xy, xx - yy) / 2 - Math.PI / 2 + 0.3 : -1.05;
  if (Math.sin(azimuth) > 0) azimuth += Math.PI;

  // Of many bodies, what is high up for a short while before it falls counts half.
  let centre = [0, 0, 0];
  const largest = quantile(radii, 0.95) || 1, half = [0, 0, 0];
  axes.forEach((axis, k) => {
    lows[k].sort((a, b) => a - b);
    highs[k].sort((a, b) => a - b);
    const low = quantile(lows[k], 0.05), high = quantile(highs[k], 0.95);
    const top = k === 2 && seen.length > 20 ? (quantile(highs[k], 0.6) + high) / 2 : high;
    centre = add(centre, axis, (low + top) / 2);
    half[k] = (top - low) / 2;
  });
  const wide = Math.hypot(half[0], half[1]), elevation = half[2] > wide ? 0.2 : 0.36;
  return {centre, radius: 0.86 * norm(half) + 1.15 * largest, wide, tall: half[2], largest, azimuth,
          elevation, body: quantile(radii, 0.5) || 1, lowest: quantile(lows[2], 0) - largest};
}
)js";

}  // namespace delassus::inner
