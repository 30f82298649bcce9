// SPDX-License-Identifier: GPL-3.0-or-later
// Where the camera of the view must be to see the whole run.

const MOST_SAMPLES = 3000;

function vectors(coordinates, step) {
  const list = [];
  for (let i = 0; i + 2 < coordinates.length; i += 3 * step) {
    const point = new THREE.Vector3(coordinates[i], coordinates[i + 1], coordinates[i + 2]);
    if (Number.isFinite(point.x + point.y + point.z)) {
      list.push(point);
    }
  }
  return list;
}

function thinned(coordinates) {
  return vectors(coordinates, Math.max(1, Math.ceil(coordinates.length / 3 / MOST_SAMPLES)));
}

// The points that the picture must show: all in `always`, and the landmarks without the fifth that
// is farthest from their middle. Both are lists of coordinates.
export function samplePoints(landmarks, always) {
  const points = thinned(landmarks);
  const middle = ['x', 'y', 'z'].map((axis) => points.map((point) => point[axis])
    .sort((a, b) => a - b)[Math.floor(points.length / 2)] || 0);
  const centre = new THREE.Vector3(...middle);
  points.sort((a, b) => a.distanceTo(centre) - b.distanceTo(centre));
  return thinned(always).concat(points.slice(0, Math.ceil(points.length * 0.8)));
}

// The point to look at from `direction` (a unit vector towards the camera), and the distance from
// which a perspective camera sees all points.
export function fitPoints(points, direction, up, camera) {
  const right = new THREE.Vector3().crossVectors(up, direction).normalize();
  const over = new THREE.Vector3().crossVectors(direction, right);
  const halfY = Math.tan(camera.fov / 360 * Math.PI) * 0.9;
  const halfX = halfY * camera.aspect;
  const middle = (axis) => {
    const values = points.map((point) => point.dot(axis));
    return axis.clone().multiplyScalar((Math.min(...values) + Math.max(...values)) / 2);
  };
  const target = middle(right).add(middle(over)).add(middle(direction));
  let distance = 1;
  // Near points take more of the picture than far ones, so its middle is found step by step.
  for (let step = 0; step < 4; ++step) {
    const seen = points.map((point) => point.clone().sub(target));
    distance = Math.max(1e-6, ...seen.map((point) => point.dot(direction)
      + Math.max(Math.abs(point.dot(right)) / halfX, Math.abs(point.dot(over)) / halfY)));
    for (const [axis, half] of [[right, halfX], [over, halfY]]) {
      const shares = seen.map((point) => point.dot(axis) / (distance - point.dot(direction)) / half);
      const off = (Math.min(...shares) + Math.max(...shares)) / 2;
      target.addScaledVector(axis, off * half * distance * 0.8);
    }
  }
  return { target, distance };
}
