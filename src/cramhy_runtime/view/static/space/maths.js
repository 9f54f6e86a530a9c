// Places and directions. A pose is [x, y, z, w, i, j, k]: a position in metres and a quaternion, the real part first. Vectors are arrays of
// three numbers. Matrices are for WebGL: sixteen numbers, column by column.

export const NOWHERE = Object.freeze([0, 0, 0, 1, 0, 0, 0]);

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const times = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => times(a, 1 / (length(a) || 1));

// v, turned by the quaternion of a pose.
export function turned(pose, v) {
  const [, , , w, i, j, k] = pose;
  const u = [i, j, k];
  const t = times(cross(u, v), 2);
  return add(add(v, times(t, w)), cross(u, t));
}

// v, turned back.
export const turnedBack = ([x, y, z, w, i, j, k], v) => turned([x, y, z, w, -i, -j, -k], v);

// Where something is that is at `b` in the frame `a`.
export function compose(a, b) {
  const [x, y, z] = turned(a, b);
  const [, , , aw, ai, aj, ak] = a;
  const [, , , bw, bi, bj, bk] = b;
  return [
    a[0] + x, a[1] + y, a[2] + z,
    aw * bw - ai * bi - aj * bj - ak * bk,
    aw * bi + ai * bw + aj * bk - ak * bj,
    aw * bj - ai * bk + aj * bw + ak * bi,
    aw * bk + ai * bj - aj * bi + ak * bw,
  ];
}

// On the way from one pose to another; share: 0 to 1.
export function blend(a, b, share) {
  const side = a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6] < 0 ? -1 : 1;
  const mixed = a.map((value, index) => value + ((index < 3 ? b[index] : side * b[index]) - value) * share);
  const size = Math.hypot(mixed[3], mixed[4], mixed[5], mixed[6]) || 1;
  return mixed.map((value, index) => (index < 3 ? value : value / size));
}

// The pose of a joint that turns about `axis` by `angle`.
export const turnAbout = (axis, angle) => [0, 0, 0, Math.cos(angle / 2), ...times(axis, Math.sin(angle / 2))];

export const sameness = (a, b) => Math.hypot(...a.map((value, index) => value - b[index]));

// The quaternion, as a pose, whose z axis lies along `v`.
export function along(v) {
  const [x, y, z] = unit(v);
  if (z < -0.999999) return [0, 0, 0, 0, 1, 0, 0];
  const w = Math.sqrt((1 + z) / 2);
  return [0, 0, 0, w, -y / (2 * w), x / (2 * w), 0];
}

// How far something is turned about the vertical axis, degrees.
export const yaw = ([, , , w, i, j, k]) => (Math.atan2(2 * (w * k + i * j), 1 - 2 * (j * j + k * k)) * 180) / Math.PI;

// The rows of the 3 x 4 matrix of a pose, written into `out` from `start` on.
export function writeRows(pose, out, start) {
  const [x, y, z, w, i, j, k] = pose;
  out[start] = 1 - 2 * (j * j + k * k);
  out[start + 1] = 2 * (i * j - w * k);
  out[start + 2] = 2 * (i * k + w * j);
  out[start + 3] = x;
  out[start + 4] = 2 * (i * j + w * k);
  out[start + 5] = 1 - 2 * (i * i + k * k);
  out[start + 6] = 2 * (j * k - w * i);
  out[start + 7] = y;
  out[start + 8] = 2 * (i * k - w * j);
  out[start + 9] = 2 * (j * k + w * i);
  out[start + 10] = 1 - 2 * (i * i + j * j);
  out[start + 11] = z;
}

// What a view {eye, right, up, ahead, opening} projects with: world to clip space. opening: the height of the picture, rad.
export function projection({ eye, right, up, ahead, opening }, aspect, near = 0.05, far = 60) {
  const high = 1 / Math.tan(opening / 2);
  const wide = high / aspect;
  const a = (far + near) / (far - near);
  const b = (-2 * far * near) / (far - near);
  const [r, u, d] = [-dot(right, eye), -dot(up, eye), -dot(ahead, eye)];
  return new Float32Array([
    wide * right[0], high * up[0], a * ahead[0], ahead[0],
    wide * right[1], high * up[1], a * ahead[1], ahead[1],
    wide * right[2], high * up[2], a * ahead[2], ahead[2],
    wide * r, high * u, a * d + b, d,
  ]);
}
