// Draws the world with WebGL. The surfaces of all things lie in one buffer and are drawn at once: every vertex knows its bone, and a small
// texture says where the bones are. So a frame costs the page next to nothing beside the pixels, and these are cheap enough for browsers
// that draw with the processor: light is computed at the vertices, edges are parts of the surfaces, and the floor comes last, where it is
// seen. Light comes from above and from the eye, so that no side is black.

import { NOWHERE, projection, writeRows } from "./maths.js";
import { Surface, VERTEX, addShape } from "./solids.js";
import { t } from "../texts.js";

const SOLID = `#version 300 es
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 normal;
layout(location = 2) in float bone;
layout(location = 3) in vec4 colour;
layout(location = 4) in vec4 rim;
uniform highp sampler2D bones;
uniform mat4 camera;
uniform vec3 eye;
uniform vec4 tint; // a colour, and how much of it
out lowp vec4 painted;
out highp vec4 edges;
void main() {
  int row = int(bone);
  vec4 a = texelFetch(bones, ivec2(0, row), 0), b = texelFetch(bones, ivec2(1, row), 0), c = texelFetch(bones, ivec2(2, row), 0);
  vec4 p = vec4(place, 1.0);
  vec3 at = vec3(dot(a, p), dot(b, p), dot(c, p));
  vec3 n = vec3(dot(a.xyz, normal), dot(b.xyz, normal), dot(c.xyz, normal));
  float light = 0.42 + 0.38 * max(0.0, dot(n, vec3(0.35, -0.45, 0.82))) + 0.25 * abs(dot(n, normalize(eye - at)));
  edges = rim;
  painted = vec4(mix(colour.rgb, tint.rgb, tint.a) * light, colour.a);
  gl_Position = camera * vec4(at, 1.0);
}`;
const PAINT = `#version 300 es
precision highp float;
in lowp vec4 painted;
in highp vec4 edges;
uniform float cover, shade;
out vec4 pixel;
void main() {
  vec4 wide = fwidth(edges); // metres in a pixel
  vec4 near = edges / max(wide, vec4(1e-5));
  float far = min(min(near.x, near.y), min(near.z, near.w)); // pixels to the nearest edge
  float line = clamp(1.6 - far, 0.0, 1.0) * clamp(0.016 / max(max(wide.x, wide.y), max(wide.z, wide.w)), 0.3, 1.0);
  pixel = vec4(painted.rgb * (1.0 - shade * line), mix(painted.a * cover, painted.a, line * 0.8 * float(cover < 1.0)));
}`;
const PLATE = `#version 300 es
layout(location = 0) in vec2 corner;
uniform mat4 camera;
uniform vec4 area; // x, y, width, height
uniform float height;
out highp vec2 at;
out highp vec2 part;
void main() {
  part = corner;
  at = area.xy + corner * area.zw;
  gl_Position = camera * vec4(at, height, 1.0);
}`;
const TILES = `#version 300 es
precision highp float;
in vec2 at;
uniform vec3 eye, one, other, sky;
out vec4 pixel;
void main() {
  vec2 wide = fwidth(at) + 1e-4; // tiles of a metre, smooth where they are small
  vec2 f = 2.0 * (abs(fract((at - 0.5 * wide) * 0.5) - 0.5) - abs(fract((at + 0.5 * wide) * 0.5) - 0.5)) / wide;
  vec3 tile = mix(one, other, 0.5 - 0.5 * f.x * f.y);
  vec2 away = at - eye.xy;
  pixel = vec4(mix(tile, sky, clamp((dot(away, away) - 60.0) / 500.0, 0.0, 1.0)), 1.0);
}`;
const CELLS = `#version 300 es
precision mediump float;
in highp vec2 part;
uniform sampler2D cells;
out vec4 pixel;
void main() { pixel = texture(cells, part); }`;
const ATTRIBUTES = [[0, 3, "FLOAT", 0], [1, 3, "FLOAT", 12], [2, 1, "FLOAT", 24], [3, 4, "UNSIGNED_BYTE", 28], [4, 4, "FLOAT", 32]];
const GROUND = [-40, -40, 80, 80];
const ABOVE_FLOOR = 0.006; // m, of costmaps
const LEAST_SHARE = 0.02; // of the greatest value of a costmap, that is shown
const PLAIN = [0, 0, 0, 0];

export class Renderer {
  // Throws an Error where there is no WebGL.
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: false });
    if (!gl) throw new Error(t("This browser draws no WebGL 2, so the robot's world cannot be shown. Its settings, or another browser, may help."));
    Object.assign(this, { canvas, gl });
    this.frames = 0; // that were drawn
    this.begin();
  }

  // Make everything anew, at first and when the browser has lost it.
  begin() {
    const { gl } = this;
    this.solid = program(gl, SOLID, PAINT);
    this.tiles = program(gl, PLATE, TILES);
    this.cells = program(gl, PLATE, CELLS);
    this.surface = rows(gl);
    this.extra = rows(gl);
    this.plate = gl.createVertexArray();
    gl.bindVertexArray(this.plate);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([0, 0, 1, 0, 0, 1, 1, 1]), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    this.bones = texture(gl);
    this.heat = texture(gl);
    this.costmap = null;
    this.ranges = new Map(); // name → {bone, part: [first, count]}
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    gl.depthFunc(gl.LEQUAL);
  }

  // Have these things (Map name → WorldThing) drawn from now on.
  take(things) {
    const surface = new Surface(8192);
    this.ranges.clear();
    let bone = 1; // 0 is the room
    for (const [name, { links }] of things) {
      const first = surface.count;
      links.forEach(({ shapes }, number) => {
        for (const shape of shapes) addShape(surface, shape, bone + number);
      });
      this.ranges.set(name, { bone, part: [first, surface.count - first] });
      bone += links.length;
    }
    this.places = new Float32Array(bone * 12);
    fill(this.gl, this.surface, surface);
  }

  // Show a WorldCostmap on the floor, or with null none.
  setCostmap(map) {
    this.costmap = map;
    if (!map) return;
    const { gl } = this;
    gl.bindTexture(gl.TEXTURE_2D, this.heat);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, map.columns, map.rows, 0, gl.RGBA, gl.UNSIGNED_BYTE, coloured(map));
  }

  // Draw a frame. view: of the camera. placed: name → poses of links. extra: a Surface of marks, over: of those that nothing hides.
  // ghosts: [{name, poses, colour}], seen through. lit: the name of the thing that stands out. Backs are not drawn: a robot's camera looks
  // out of its own head.
  draw({ view, placed, extra, over, ghosts, lit, colours }) {
    const { gl, canvas } = this;
    const camera = projection(view, canvas.width / canvas.height);
    this.frames++;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(...colours.sky, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.#setBones(placed);
    const { program: solid, at } = this.solid;
    gl.useProgram(solid);
    gl.uniformMatrix4fv(at.camera, false, camera);
    gl.uniform3fv(at.eye, view.eye);
    gl.uniform1f(at.cover, 1);
    gl.uniform1f(at.shade, colours.edge);
    gl.uniform4fv(at.tint, PLAIN);
    gl.enable(gl.CULL_FACE);
    gl.bindVertexArray(this.surface.array);
    const stands = this.ranges.get(lit)?.part ?? [0, 0];
    this.#triangles(0, stands[0]);
    this.#triangles(stands[0] + stands[1], this.surface.count - stands[0] - stands[1]);
    if (stands[1]) {
      gl.uniform4fv(at.tint, [...colours.accent, 0.35]);
      this.#triangles(...stands);
      gl.uniform4fv(at.tint, PLAIN);
    }
    this.#floor(camera, view.eye, colours);
    gl.enable(gl.BLEND);
    gl.depthMask(false);
    if (this.costmap) this.#costmap(camera);
    gl.useProgram(solid);
    this.#marks(extra);
    for (const { name, poses, colour } of ghosts) this.#ghost(name, poses, colour);
    gl.depthMask(true);
    gl.disable(gl.BLEND);
    if (over.count) {
      gl.clear(gl.DEPTH_BUFFER_BIT);
      this.#marks(over);
    }
    gl.bindVertexArray(null);
  }

  #marks(surface) {
    const { gl } = this;
    if (!surface.count) return;
    gl.depthMask(true);
    fill(gl, this.extra, surface, gl.DYNAMIC_DRAW);
    gl.bindVertexArray(this.extra.array);
    this.#triangles(0, surface.count);
    gl.depthMask(false);
  }

  #triangles(first, count) {
    if (count > 0) this.gl.drawElements(this.gl.TRIANGLES, count, this.gl.UNSIGNED_INT, first * 4);
  }

  #floor(camera, eye, { sky, one, other }) {
    const { gl } = this;
    const { program: tiles, at } = this.tiles;
    gl.useProgram(tiles);
    gl.uniformMatrix4fv(at.camera, false, camera);
    gl.uniform3fv(at.eye, eye);
    gl.uniform3fv(at.sky, sky);
    gl.uniform3fv(at.one, one);
    gl.uniform3fv(at.other, other);
    gl.uniform4fv(at.area, GROUND);
    gl.uniform1f(at.height, 0);
    gl.enable(gl.POLYGON_OFFSET_FILL);
    gl.polygonOffset(2, 2);
    gl.disable(gl.CULL_FACE);
    gl.bindVertexArray(this.plate);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.disable(gl.POLYGON_OFFSET_FILL);
  }

  #costmap(camera) {
    const { gl } = this;
    const { x, y, resolution, columns, rows: high } = this.costmap;
    const { program: cells, at } = this.cells;
    gl.useProgram(cells);
    gl.uniformMatrix4fv(at.camera, false, camera);
    gl.uniform4fv(at.area, [x, y, columns * resolution, high * resolution]);
    gl.uniform1f(at.height, ABOVE_FLOOR);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.heat);
    gl.bindVertexArray(this.plate);
    gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    gl.bindTexture(gl.TEXTURE_2D, this.bones);
  }

  #ghost(name, poses, colour) {
    const { gl } = this;
    const range = this.ranges.get(name);
    if (!range) return;
    const { at } = this.solid;
    poses.forEach((pose, number) => writeRows(pose, this.places, (range.bone + number) * 12));
    this.#send();
    gl.uniform4fv(at.tint, [...colour, 1]);
    gl.uniform1f(at.cover, 0.3);
    gl.bindVertexArray(this.surface.array);
    this.#triangles(...range.part);
    gl.uniform1f(at.cover, 1);
    gl.uniform4fv(at.tint, PLAIN);
  }

  #setBones(placed) {
    writeRows(NOWHERE, this.places, 0);
    for (const [name, { bone }] of this.ranges) {
      const poses = placed.get(name) ?? [];
      for (let number = 0; number < poses.length; number++) writeRows(poses[number], this.places, (bone + number) * 12);
    }
    this.#send();
  }

  #send() {
    const { gl } = this;
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.bones);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, 3, this.places.length / 12, 0, gl.RGBA, gl.FLOAT, this.places);
  }
}

// The cells of a WorldCostmap as bytes of colours: from blue over green to yellow, and nothing where it is next to 0.
export function coloured({ cells }) {
  const bytes = new Uint8Array(cells.length * 4);
  for (let index = 0; index < cells.length; index++) {
    const share = cells[index] / 255;
    if (share < LEAST_SHARE) continue;
    bytes[4 * index] = 255 * Math.min(1, Math.max(0, 2.2 * share - 1.1));
    bytes[4 * index + 1] = 255 * (0.15 + 0.7 * share);
    bytes[4 * index + 2] = 255 * Math.max(0.1, 0.75 - 0.75 * share);
    bytes[4 * index + 3] = 255 * (0.15 + 0.7 * Math.sqrt(share));
  }
  return bytes;
}

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(`WebGL does not take the page's programs: ${gl.getShaderInfoLog(shader)}`);
    }
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new Error(`WebGL does not take the page's programs: ${gl.getProgramInfoLog(made)}`);
  }
  const at = {};
  const count = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS) ?? 0;
  for (let number = 0; number < count; number++) {
    const { name } = gl.getActiveUniform(made, number);
    at[name] = gl.getUniformLocation(made, name);
  }
  return { program: made, at };
}

// A buffer for rows of vertices, and how they are laid out.
function rows(gl) {
  const array = gl.createVertexArray();
  const [buffer, numbers] = [gl.createBuffer(), gl.createBuffer()];
  gl.bindVertexArray(array);
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, numbers);
  for (const [place, parts, type, offset] of ATTRIBUTES) {
    gl.enableVertexAttribArray(place);
    gl.vertexAttribPointer(place, parts, gl[type], type === "UNSIGNED_BYTE", VERTEX, offset);
  }
  return { array, buffer, numbers, count: 0 };
}

function fill(gl, row, { bytes, vertices, numbers, count }, use = gl.STATIC_DRAW) {
  gl.bindVertexArray(row.array);
  gl.bindBuffer(gl.ARRAY_BUFFER, row.buffer);
  gl.bufferData(gl.ARRAY_BUFFER, bytes.subarray(0, vertices * VERTEX), use);
  gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, numbers.subarray(0, count), use);
  row.count = count;
}

function texture(gl) {
  const made = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, made);
  for (const what of ["MIN_FILTER", "MAG_FILTER"]) gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${what}`], gl.NEAREST);
  for (const what of ["WRAP_S", "WRAP_T"]) gl.texParameteri(gl.TEXTURE_2D, gl[`TEXTURE_${what}`], gl.CLAMP_TO_EDGE);
  return made;
}
