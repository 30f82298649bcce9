// SPDX-License-Identifier: GPL-3.0-or-later
// Positions and poses of the data as objects of three.js. A pose is tx ty tz qx qy qz qw, world
// from camera; the camera looks along z, x points right and y down.

export function positionAt(poses, index) {
  return new THREE.Vector3(poses[7 * index], poses[7 * index + 1], poses[7 * index + 2]);
}

export function rotationAt(poses, index) {
  return new THREE.Quaternion(poses[7 * index + 3], poses[7 * index + 4], poses[7 * index + 5],
    poses[7 * index + 6]);
}

// Index of the last stamp that is not later than `time`; 0 before the first.
export function indexAt(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (times[middle] <= time) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

// Index of the stamp nearest to `time`.
export function nearestAt(times, time) {
  const index = indexAt(times, time);
  return index + 1 < times.length && times[index + 1] - time < time - times[index] ? index + 1
    : index;
}

// Splits the numbers 0 to n - 1 of stamped positions where no pose is known for long: gaps of more
// than five times the usual step.
export function pieces(times) {
  const steps = [];
  for (let i = 1; i < times.length; ++i) {
    steps.push(times[i] - times[i - 1]);
  }
  const usual = [...steps].sort((a, b) => a - b)[Math.floor(steps.length / 2)] || 0;
  const result = [];
  let begin = 0;
  for (let i = 1; i <= times.length; ++i) {
    if (i === times.length || (usual > 0 && steps[i - 1] > 5 * usual)) {
      result.push([begin, i]);
      begin = i;
    }
  }
  return result;
}

// Centre and radius of a box that leaves out the outermost 4 % of the coordinates on each side.
export function robustBounds(points) {
  const lists = [[], [], []];
  const step = Math.max(1, Math.floor(points.length / 3 / 20000));
  for (let i = 0; i + 2 < points.length; i += 3 * step) {
    if (Number.isFinite(points[i] + points[i + 1] + points[i + 2])) {
      lists.forEach((list, axis) => list.push(points[i + axis]));
    }
  }
  if (lists[0].length === 0) {
    return { centre: new THREE.Vector3(), radius: 1 };
  }
  const range = lists.map((list) => {
    list.sort((a, b) => a - b);
    const margin = Math.floor(list.length * 0.04);
    return [list[margin], list[list.length - 1 - margin]];
  });
  const low = new THREE.Vector3(...range.map((r) => r[0]));
  const high = new THREE.Vector3(...range.map((r) => r[1]));
  return { centre: low.clone().add(high).multiplyScalar(0.5),
    radius: Math.max(low.distanceTo(high) / 2, 1e-3) };
}

// The corners of a camera's frustum at `depth`, in the frame of the camera.
export function frustumCorners(camera, depth) {
  const c = camera || { fx: 1, fy: 1, cx: 0.5, cy: 0.375, width: 1, height: 0.75 };
  return [[0, 0], [c.width, 0], [c.width, c.height], [0, c.height]].map(([u, v]) =>
    new THREE.Vector3((u - c.cx) / c.fx * depth, (v - c.cy) / c.fy * depth, depth));
}

// The segments of frusta as positions, two points per segment: `poses` of n cameras.
export function frustumSegments(poses, camera, depth) {
  const corners = frustumCorners(camera, depth);
  const order = [[-1, 0], [-1, 1], [-1, 2], [-1, 3], [0, 1], [1, 2], [2, 3], [3, 0]];
  const count = Math.floor(poses.length / 7);
  const segments = new Float32Array(count * order.length * 6);
  let at = 0;
  for (let i = 0; i < count; ++i) {
    const centre = positionAt(poses, i);
    const rotation = rotationAt(poses, i);
    const turned = corners.map((corner) => corner.clone().applyQuaternion(rotation).add(centre));
    for (const pair of order) {
      for (const index of pair) {
        const point = index < 0 ? centre : turned[index];
        segments.set([point.x, point.y, point.z], at);
        at += 3;
      }
    }
  }
  return segments;
}
