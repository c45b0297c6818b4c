/// Script of the replay page: draws one moment of a scene with WebGL 2.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_view = R"js(
// --- view: one moment of a scene -----------------------------------------------------------------------

const linear = hex => [1, 3, 5].map(i => (parseInt(hex.slice(i, i + 2), 16) / 255) ** 2.2);
const palette = ['#7d9cc4', '#d7a06c', '#8db38a', '#c98b93', '#a695c7', '#d2bd70', '#78b1b4', '#b59b89']
  .map(linear);
const theme = name => linear(getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim());
const states = ['open', 'sliding', 'sticking'];

class View extends Graphics {
  constructor(canvas, camera) {
    super(canvas);
    this.camera = camera;
    this.show = {contacts: true, joints: true, glass: false};
    this.stretch = this.quality = 1;
    this.programs = {
      body: this.program(bodyVertex, bodyFragment), shadow: this.program(bodyVertex, shadowFragment),
      plane: this.program(planeVertex, planeFragment), arrow: this.program(arrowVertex, arrowFragment),
      line: this.program(lineVertex, lineFragment),
    };
    this.solids = {box: this.solid(boxSolid()), cylinder: this.solid(coneSolid(-1, 1, 1, 1, 36)),
                   cone: this.solid(coneSolid(-0.25, 1, 0.75, 0, 36)),
                   ball: this.solid(sphereSolid(24)), plainBall: this.solid(sphereSolid(12)),
                   drop: this.solid(sphereSolid(7))};
    this.arrows = this.mesh(arrowSolid(), [3, 3], [3, 3, 4]);
    this.lines = this.mesh([0, -1, 1, -1, 1, 1, 0, -1, 1, 1, 0, 1], [2], [3, 3, 4]);
    this.plane = this.mesh([-1, -1, 1, -1, 1, 1, -1, -1, 1, 1, -1, 1], [2], []);
    this.makeShadowMap(2048);
    this.readTheme();
  }

  readTheme() {
    const names = ['sticking', 'sliding', 'open', 'joint', 'fixed'];
    this.colours = Object.fromEntries(names.map(n => [n, theme(n)]));
    this.isDark = matchMedia('(prefers-color-scheme: dark)').matches;
    this.ground = this.isDark ? [0.17, 0.20, 0.245] : [0.925, 0.94, 0.955];
    this.lineInk = this.isDark ? [0.75, 0.82, 0.92] : [0.25, 0.31, 0.40];
  }

  /// Prepares a scene: hulls become solids, the camera goes home, arrows get a length that suits most.
  open(scene) {
    this.scene = scene;
    this.ball = scene.ball ??= sceneBall(scene);
    for (const shape of scene.shapes) if (shape.kind === 'hull') shape.solid ??= this.solid(hullSolid(shape));
    this.camera.home(scene, this.ball);
    const {e1, e2, azimuth} = this.camera, a = azimuth - 0.75;
    this.sun = unit(add(add(scene.up, e1, 0.78 * Math.cos(a)), e2, 0.78 * Math.sin(a)));
    const r = this.ball.radius * 1.5, far = this.ball.radius * 6;
    this.light = product(parallel(r, 0, 2 * far),
                         looking(add(this.ball.centre, this.sun, far), this.ball.centre, e1));
    const sizes = [], stride = Math.max(1, Math.floor(scene.states.length / 4000));
    for (let i = 0; i < scene.states.length; i += stride)
      sizes.push(norm([0, 1, 2].map(k => scene.contacts[6 * i + 3 + k] - 32768)) * scene.impulse);
    sizes.sort((x, y) => x - y);
    this.arrowScale = 1.9 * this.ball.body / (quantile(sizes.filter(s => s > 0), 0.92) || 1);
    const {contactTotal} = scene;
    this.has = {contacts: contactTotal.some(n => n > 0), joints: scene.lineStart.at(-1) > 0};
  }

  // --- the lists of one moment -------------------------------------------------------------------------

  listBodies() {
    const {scene} = this, planes = [];
    const ball = scene.bodies.length > 60 ? this.solids.plainBall : this.solids.ball;
    for (const solid of this.allSolids()) solid.list.length = 0;
    scene.bodies.forEach((body, i) => {
      const {kind, size, solid} = body.shape, p = body.position, q = body.rotation;
      const tint = body.colour >= 0 ? palette[body.colour % 8] : body.moving < 0 ? this.colours.fixed
        : palette[kind === 'particle' ? 0 : i % 8];
      const put = (mesh, at, x, y, z, pattern) => mesh.list.push(...at, ...q, x, y, z, pattern, ...tint);
      if (kind === 'box') put(this.solids.box, p, size[0] / 2, size[1] / 2, size[2] / 2, 1);
      else if (kind === 'sphere') put(ball, p, size[0], size[0], size[0], 2);
      else if (kind === 'particle') put(this.solids.drop, p, size[0], size[0], size[0], 0);
      else if (kind === 'cylinder') put(this.solids.cylinder, p, size[0], size[0], size[1] / 2, 3);
      else if (kind === 'cone') put(this.solids.cone, p, size[0], size[0], size[1], 3);
      else if (kind === 'ellipsoid') put(ball, p, size[0], size[1], size[2], 2);
      else if (kind === 'hull') put(solid, p, 1, 1, 1, 0);
      else if (kind === 'half_space') planes.push(this.planeOf(body));
      else if (kind === 'capsule') {
        const end = turned(q, [0, 0, size[1] / 2]);
        put(this.solids.cylinder, p, size[0], size[0], size[1] / 2, 3);
        for (const side of [-1, 1]) put(ball, add(p, end, side), size[0], size[0], size[0], 3);
      }
    });
    const isLevel = plane => dot(plane.normal, scene.up) > 0.999;
    if (!planes.some(isLevel) && !this.hasFloor())
      planes.unshift({normal: scene.up, offset: this.ball.lowest});
    for (const plane of planes) plane.isPatch = !isLevel(plane);
    this.planes = planes;
  }
  hasFloor() {
    const isWide = shape => shape.kind === 'box' && Math.max(...shape.size) > this.ball.radius;
    return this.scene.bodies.some(body => body.moving < 0 && isWide(body.shape));
  }
  planeOf(body) {
    const [x, y, z, offset] = body.shape.size, normal = turned(body.rotation, [x, y, z]);
    return {normal, offset: offset + dot(normal, body.position)};
  }
  allSolids() {
    return [...Object.values(this.solids), ...this.scene.shapes.filter(s => s.solid).map(s => s.solid)];
  }

  /// Arrows and dots of the contacts, lines of the joints; returns how many contacts are in which state.
  listMarks(frame, t) {
    const {scene, arrows, lines, ball} = this, count = {open: 0, sliding: 0, sticking: 0};
    const pixel = this.canvas.width / (this.canvas.clientWidth || 1);
    arrows.list.length = lines.list.length = 0;
    for (let i = scene.contactStart[frame]; i < scene.contactStart[frame + 1]; ++i) {
      const state = states[scene.states[i]], colour = this.colours[state];
      ++count[state];
      if (!this.show.contacts) continue;
      const p = point(scene, scene.contacts, 6 * i);
      const impulse = [3, 4, 5].map(k => (scene.contacts[6 * i + k] - 32768) * scene.impulse);
      const size = norm(impulse), length = Math.min(size * this.arrowScale * this.stretch, 7 * ball.body);
      lines.list.push(...p, ...p, ...colour, 2.2 * pixel);
      if (length > 0.03 * ball.body)
        arrows.list.push(...p, ...impulse.map(x => x * length / size), ...colour, 0.1 * ball.body);
    }
    if (this.show.joints)
      for (let i = scene.lineStart[frame]; i < scene.lineStart[frame + 1]; ++i) {
        const a = linePoint(scene, frame, i, 0, t), b = linePoint(scene, frame, i, 3, t);
        const isDot = norm(add(a, b, -1)) < 0.01 * ball.body;
        lines.list.push(...a, ...b, ...this.colours.joint, (isDot ? 3.6 : 1.7) * pixel);
      }
    return count;
  }

  // --- drawing -----------------------------------------------------------------------------------------

  /// Draws time `t`; returns the counts of contacts by state and how many there were in all.
  draw(t) {
    const {gl, canvas} = this, density = Math.min(devicePixelRatio || 1, 2) * this.quality;
    const width = Math.max(1, Math.round(canvas.clientWidth * density));
    const height = Math.max(1, Math.round(canvas.clientHeight * density));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    this.camera.resized(width / height);

    const frame = poseAt(this.scene, t);
    this.listBodies();
    const count = this.listMarks(frame, t);
    for (const mesh of [...this.allSolids(), this.arrows, this.lines]) this.upload(mesh);

    this.drawShadows();
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.screen = [width, height];
    this.matrix = this.camera.matrix();

    const glass = this.show.glass;
    if (!glass) this.drawBodies(1);
    gl.enable(gl.BLEND);
    for (const plane of this.planes) this.drawPlane(plane);
    gl.depthMask(false);
    if (glass) {
      gl.enable(gl.CULL_FACE);
      this.drawBodies(0.3);
      gl.disable(gl.CULL_FACE);
    }
    gl.depthFunc(gl.GREATER);  // first what bodies hide, faintly
    this.drawMarks(0.22);
    gl.depthMask(true);
    gl.depthFunc(gl.LESS);
    this.drawMarks(1);
    gl.disable(gl.BLEND);
    return {...count, total: this.scene.contactTotal[frame]};
  }

  use({program, uniforms}, matrix, opacity = 1) {
    const gl = this.gl;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.camera, false, matrix);
    if (uniforms.light) gl.uniformMatrix4fv(uniforms.light, false, this.light);
    const vectors = {eye: this.camera.eye(), sun: this.sun, up: this.scene.up};
    for (const [name, value] of Object.entries(vectors))
      if (uniforms[name]) gl.uniform3fv(uniforms[name], value);
    if (uniforms.screen) gl.uniform2fv(uniforms.screen, this.screen);
    if (uniforms.opacity) gl.uniform1f(uniforms.opacity, opacity);
    if (uniforms.shadowRadius) gl.uniform1f(uniforms.shadowRadius, this.ball.radius);
    return uniforms;
  }
  drawShadows() {
    const gl = this.gl;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
    gl.viewport(0, 0, this.shadowSize, this.shadowSize);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(1.5, 2);
    this.use(this.programs.shadow, this.light);
    for (const solid of this.allSolids()) this.drawInstances(solid);
    gl.disable(gl.POLYGON_OFFSET_FILL);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }
  drawBodies(opacity) {
    this.use(this.programs.body, this.matrix, opacity);
    for (const solid of this.allSolids()) this.drawInstances(solid);
  }
  /// A level plane is a ground that fades away; any other one a square, clear only when seen from behind.
  drawPlane({normal, offset, isPatch}) {
    const gl = this.gl, u = this.use(this.programs.plane, this.matrix);
    const {centre, radius} = this.ball, [across, along] = horizontal(normal);
    const raw = radius / 4, power = 10 ** Math.floor(Math.log10(raw));
    const foot = add(centre, normal, offset - dot(normal, centre));
    gl.depthMask(isPatch && dot(add(this.camera.eye(), foot, -1), normal) > 0);
    gl.uniform1i(u.isPatch, isPatch);
    gl.uniform3fv(u.centre, foot);
    gl.uniform3fv(u.normal, normal);
    gl.uniform3fv(u.across, across);
    gl.uniform3fv(u.along, along);
    gl.uniform3fv(u.ground, this.ground);
    gl.uniform3fv(u.ink, this.lineInk);
    gl.uniform1f(u.radius, isPatch ? 1.35 * radius : 6.5 * radius);
    gl.uniform1f(u.spacing, power * (raw < 2 * power ? 1 : raw < 5 * power ? 2 : 5) / 2);
    gl.bindVertexArray(this.plane.array);
    gl.drawArrays(gl.TRIANGLES, 0, 6);
  }
  drawMarks(opacity) {
    this.use(this.programs.arrow, this.matrix, opacity);
    this.drawInstances(this.arrows);
    this.use(this.programs.line, this.matrix, opacity);
    this.drawInstances(this.lines);
  }
}
)js";

}  // namespace delassus::inner
