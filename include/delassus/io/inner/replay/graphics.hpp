/// Script of the replay page: programs, meshes and the shadow map on the graphics card.
#pragma once

#include <string_view>

namespace delassus::inner {

inline constexpr std::string_view replay_graphics = R"js(
// --- graphics: what WebGL 2 needs before it draws -------------------------------------------------------

class Graphics {
  /// Throws when there is no WebGL 2.
  constructor(canvas) {
    this.canvas = canvas;
    const gl = this.gl = canvas.getContext('webgl2', {antialias: true, alpha: true});
    if (!gl) throw new Error('no WebGL 2');
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(vertex, fragment) {
    const gl = this.gl, program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    const uniforms = {};
    for (let i = 0; i < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); ++i) {
      const {name} = gl.getActiveUniform(program, i);
      uniforms[name] = gl.getUniformLocation(program, name);
    }
    return {program, uniforms};
  }

  /// Vertices with attributes of the given widths, then instances with the attributes that follow.
  mesh(vertices, widths, instanceWidths) {
    const gl = this.gl, array = gl.createVertexArray(), stride = widths.reduce((a, b) => a + b);
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(vertices), gl.STATIC_DRAW);
    let place = 0;
    const attributes = (list, whole, divisor) => list.reduce((offset, width) => {
      gl.enableVertexAttribArray(place);
      gl.vertexAttribPointer(place, width, gl.FLOAT, false, 4 * whole, 4 * offset);
      gl.vertexAttribDivisor(place++, divisor);
      return offset + width;
    }, 0);
    attributes(widths, stride, 0);
    const width = instanceWidths.reduce((a, b) => a + b, 0), instances = width ? gl.createBuffer() : null;
    if (width) gl.bindBuffer(gl.ARRAY_BUFFER, instances);
    attributes(instanceWidths, width, 1);
    return {array, corners: vertices.length / stride, instances, width, count: 0, list: []};
  }
  solid(vertices) { return this.mesh(vertices, [3, 3], [3, 4, 4, 3]); }

  /// Depths seen from the sun, in a texture that compares when it is read.
  makeShadowMap(size) {
    const gl = this.gl;
    this.shadowSize = size;
    this.shadowMap = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.shadowMap);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT24, size, size);
    for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
      [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE],
      [gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE], [gl.TEXTURE_COMPARE_FUNC, gl.LEQUAL]])
      gl.texParameteri(gl.TEXTURE_2D, key, value);
    this.shadowFrame = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.shadowFrame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.shadowMap, 0);
    gl.drawBuffers([gl.NONE]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /// Sends the instances listed for the next picture.
  upload(mesh) {
    const gl = this.gl;
    mesh.count = mesh.list.length / mesh.width;
    if (!mesh.count) return;
    gl.bindBuffer(gl.ARRAY_BUFFER, mesh.instances);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(mesh.list), gl.DYNAMIC_DRAW);
  }
  drawInstances(mesh) {
    if (!mesh.count) return;
    this.gl.bindVertexArray(mesh.array);
    this.gl.drawArraysInstanced(this.gl.TRIANGLES, 0, mesh.corners, mesh.count);
  }
}
)js";

}  // namespace delassus::inner
