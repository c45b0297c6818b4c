/// Script of the replay page: what the graphics card computes for bodies, planes, arrows and lines.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_shaders = R"js(
// --- shaders -------------------------------------------------------------------------------------------

const common = `#version 300 es
precision highp float;
precision highp sampler2DShadow;
uniform mat4 camera, light;
uniform vec3 eye, sun, up;
uniform vec2 screen;
vec3 turn(vec4 q, vec3 v) { return v + 2. * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
`;

const lighting = common + `
uniform sampler2DShadow shadowMap;
uniform float shadowRadius, opacity;
out vec4 result;
// The share of the sun that reaches a point: nine taps of a map that compares, weighted by the card.
float sunlight(vec3 p, vec3 n) {
  vec4 q = light * vec4(p + n * shadowRadius * .004, 1.);
  vec3 at = q.xyz * .5 + .5;
  if (any(lessThan(at, vec3(.002))) || any(greaterThan(at, vec3(.998)))) return 1.;
  float lit = 0.;
  for (int i = 0; i < 9; ++i)
    lit += texture(shadowMap, vec3(at.xy + (vec2(i % 3, i / 3) - 1.) * .001, at.z - .0006));
  float rim = max(abs(q.x), abs(q.y));
  return mix(lit / 9., 1., smoothstep(.85, .99, rim));
}
vec3 shaded(vec3 base, vec3 p, vec3 n) {
  vec3 v = normalize(eye - p);
  float lit = sunlight(p, n), sky = .5 + .5 * dot(n, up);
  vec3 ambient = mix(vec3(.30, .29, .29), vec3(.60, .64, .70), sky);
  vec3 direct = vec3(.95, .90, .82) * max(dot(n, sun), 0.) * lit;
  float gleam = pow(max(dot(n, normalize(sun + v)), 0.), 48.) * .14 * lit;
  float rim = pow(1. - max(dot(n, v), 0.), 4.) * .10 * sky;
  return base * (ambient + direct) + gleam + rim;
}
vec3 displayed(vec3 colour) { return pow(clamp(colour, 0., 1.), vec3(1. / 2.2)); }
`;

const bodyVertex = common + `
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 place;
layout(location = 3) in vec4 rotation;
layout(location = 4) in vec4 size;      // half lengths, and which pattern
layout(location = 5) in vec3 tint;
out vec3 world, facing, local, colour;
flat out vec4 extent;
void main() {
  world = place + turn(rotation, corner * size.xyz);
  facing = turn(rotation, normal / size.xyz);
  local = corner;
  colour = tint;
  extent = size;
  gl_Position = camera * vec4(world, 1.);
}`;

// Patterns show how a body turns: edges of a box, octants of a ball, quarters of what is round about z.
const bodyFragment = lighting + `
in vec3 world, facing, local, colour;
flat in vec4 extent;
float side(float x) { return clamp(x / max(fwidth(x), 1e-5), -1., 1.); }
void main() {
  float tone = 1.;
  if (extent.w == 1.) {
    vec3 d = (1. - abs(local)) * extent.xyz;
    float least = min(d.x, min(d.y, d.z)), most = max(d.x, max(d.y, d.z));
    float edge = d.x + d.y + d.z - least - most, pixel = fwidth(edge);
    float fine = clamp(1. - 7. * pixel / min(extent.x, min(extent.y, extent.z)), 0., 1.);
    tone -= .34 * fine * (1. - smoothstep(.6 * pixel, 1.8 * pixel, edge));
  } else if (extent.w == 2.) {
    tone -= .13 * (.5 + .5 * side(local.x) * side(local.y) * side(local.z));
  } else if (extent.w == 3.) {
    tone -= .13 * (.5 + .5 * side(local.x) * side(local.y));
  }
  vec3 n = normalize(gl_FrontFacing ? facing : -facing);
  result = vec4(displayed(shaded(colour * tone, world, n)), 1.) * opacity;
}`;

const shadowFragment = common + `void main() {}`;

const planeVertex = common + `
layout(location = 0) in vec2 corner;
uniform vec3 centre, across, along;
uniform float radius;
out vec3 world;
void main() {
  world = centre + radius * (corner.x * across + corner.y * along);
  gl_Position = camera * vec4(world, 1.);
}`;

const planeFragment = lighting + `
uniform vec3 centre, across, along, normal, ground, ink;
uniform float radius, spacing;
uniform bool isPatch;
in vec3 world;
float grid(vec2 p, float width) {
  vec2 pixel = fwidth(p), d = abs(fract(p - .5) - .5) / pixel;
  vec2 fade = clamp(.9 - 2.2 * pixel, 0., 1.);
  vec2 line = (1. - smoothstep(vec2(width * .5), vec2(width * .5 + 1.), d)) * fade;
  return max(line.x, line.y);
}
void main() {
  float far = length(world - centre) / radius;
  bool front = dot(eye - centre, normal) > 0.;
  vec2 p = vec2(dot(world, across), dot(world, along)) / spacing;
  float line = max(.4 * grid(p, .1), .8 * grid(p / 5., .5));
  vec2 edge = vec2(1.) - abs(vec2(dot(world - centre, across), dot(world - centre, along))) / radius;
  float rim = min(edge.x, edge.y);
  if (isPatch) line = max(line, 2. * (1. - smoothstep(0., 2. * fwidth(rim), rim))), far = 0.;
  vec3 colour = mix(ground, ink, .17 * line * (1. - far));
  float lit = front ? sunlight(world, normal) : 1.;
  colour *= mix(.68, 1., lit);
  float alpha = (1. - smoothstep(.18, 1., far)) * (front ? 1. : .16);
  result = vec4(colour * alpha, alpha) * opacity;
}`;

const arrowVertex = common + `
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 place;
layout(location = 3) in vec3 arrow;
layout(location = 4) in vec4 tint;      // colour, and radius of the head
out vec3 facing, world, colour;
void main() {
  float size = length(arrow), width = min(tint.w, .22 * size), head = min(.55 * size, 2.6 * width);
  vec3 z = arrow / max(size, 1e-12), aside = abs(z.z) > .7 ? vec3(0, 1, 0) : vec3(0, 0, 1);
  vec3 x = normalize(cross(aside, z));
  mat3 frame = mat3(x, cross(z, x), z);
  float height = corner.z <= 1. ? corner.z * (size - head) : size - head + (corner.z - 1.) * head;
  world = place + frame * vec3(corner.xy * width, height);
  facing = frame * normal;
  colour = tint.rgb;
  gl_Position = camera * vec4(world, 1.);
}`;

const arrowFragment = common + `
uniform float opacity;
in vec3 facing, world, colour;
out vec4 result;
void main() {
  vec3 n = normalize(facing);
  float light = .72 + .28 * dot(n, normalize(sun + normalize(eye - world)));
  result = vec4(pow(colour * light, vec3(1. / 2.2)), 1.) * opacity;
}`;

// A line of constant width on the screen with round ends; a dot where both ends coincide.
const lineVertex = common + `
layout(location = 0) in vec2 corner;    // 0 … 1 along, −1 … 1 across
layout(location = 1) in vec3 first;
layout(location = 2) in vec3 second;
layout(location = 3) in vec4 tint;      // colour, and half width in pixels
out vec2 pixel;
flat out vec2 ends;
flat out float half_width;
out vec3 colour;
void main() {
  vec4 a = camera * vec4(first, 1.), b = camera * vec4(second, 1.);
  float nearest = 1e-4;
  if (a.w < nearest) a = mix(b, a, (b.w - nearest) / max(b.w - a.w, 1e-9));
  if (b.w < nearest) b = mix(a, b, (a.w - nearest) / max(a.w - b.w, 1e-9));
  vec2 pa = a.xy / a.w * screen * .5, pb = b.xy / b.w * screen * .5;
  float size = length(pb - pa);
  vec2 along = size > 1e-3 ? (pb - pa) / size : vec2(1, 0), across = vec2(-along.y, along.x);
  half_width = tint.w;
  float reach = half_width + 1.5;
  pixel = vec2(corner.x < .5 ? -reach : size + reach, corner.y * reach);
  ends = vec2(0, size);
  vec4 p = corner.x < .5 ? a : b;
  p.xy += (along * (corner.x < .5 ? -reach : reach) + across * corner.y * reach) / screen * 2. * p.w;
  p.z -= .0006 * p.w;
  colour = tint.rgb;
  gl_Position = p;
}`;

const lineFragment = common + `
uniform float opacity;
in vec2 pixel;
flat in vec2 ends;
flat in float half_width;
in vec3 colour;
out vec4 result;
void main() {
  float d = length(pixel - vec2(clamp(pixel.x, ends.x, ends.y), 0.));
  float alpha = clamp(half_width + .5 - d, 0., 1.) * opacity;
  if (alpha < .01) discard;
  result = vec4(pow(colour, vec3(1. / 2.2)) * alpha, alpha);
}`;

)js";

}  // namespace delassus::inner
