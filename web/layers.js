// SPDX-License-Identifier: GPL-3.0-or-later
// The layers of the 3D view, each made from parts of the store. A layer is rebuilt when one of its
// parts has changed.
import { frustumSegments, pieces } from './geometry.js';
import { colourOfClass, ramp, themeColour } from './colours.js';

const MOST_TUBE_POINTS = 3000;

// Round points that grow when they come near, but stay between two sizes on the screen.
const POINT_SHADERS = {
  vertexShader: `
    attribute vec3 tint;
    uniform float size;
    uniform float height;
    varying vec3 vTint;
    void main() {
      vTint = tint;
      vec4 inCamera = modelViewMatrix * vec4(position, 1.0);
      gl_Position = projectionMatrix * inCamera;
      gl_PointSize = clamp(size * height / max(-inCamera.z, 1e-6), 1.6, 9.0);
    }`,
  fragmentShader: `
    varying vec3 vTint;
    uniform float opacity;
    void main() {
      float fromCentre = length(gl_PointCoord - 0.5);
      if (fromCentre > 0.5) discard;
      gl_FragColor = vec4(vTint, opacity * (1.0 - smoothstep(0.36, 0.5, fromCentre)));
    }`,
};

// The heights of points over the origin, along `up`.
function heightsOf(points, up) {
  const heights = new Float32Array(points.length / 3);
  for (let i = 0; i < heights.length; ++i) {
    heights[i] = points[3 * i] * up.x + points[3 * i + 1] * up.y + points[3 * i + 2] * up.z;
  }
  return heights;
}

// The range of the colours: from the 2 % to the 98 % of the values.
function rangeOf(values) {
  const sorted = Float32Array.from(values).filter(Number.isFinite).sort();
  return [0.02, 0.98].map((share) => sorted[Math.floor(sorted.length * share)] || 0);
}

// What the colours of the landmarks stand for, {name, range}; null for colours of the images.
export function scaleOfColours(store, look) {
  const { position, age } = store.get('landmarks', {});
  if (look.colouring === 'age' && age && age.length > 0) {
    return { name: 'age', range: rangeOf(age) };
  }
  return look.colouring === 'height' && position && position.length > 0
    ? { name: 'height', range: rangeOf(heightsOf(position, look.up)) } : null;
}

function tintsByValue(values) {
  const [low, high] = rangeOf(values);
  const tints = new Float32Array(3 * values.length);
  values.forEach((value, i) => {
    tints.set(ramp(high > low ? (value - low) / (high - low) : 0.5), 3 * i);
  });
  return tints;
}

// In light colours bright points would vanish on the bright background, so they are darkened.
function tintsOfImage(colours) {
  const gain = document.documentElement.dataset.theme === 'light' ? 0.9 : 1.12;
  return Float32Array.from(colours, (value) => Math.min(1, value / 255 * gain + (gain > 1 ? 0.05 : 0)));
}

export function landmarksLayer(store, look) {
  const landmarks = store.get('landmarks');
  if (!landmarks || landmarks.position.length === 0) {
    return null;
  }
  const count = landmarks.position.length / 3;
  let tints = null;
  if (look.colouring === 'image' && landmarks.colour && landmarks.colour.length === 3 * count) {
    tints = tintsOfImage(landmarks.colour);
  } else if (look.colouring === 'age' && landmarks.age && landmarks.age.length === count) {
    tints = tintsByValue(landmarks.age);
  } else {
    tints = tintsByValue(heightsOf(landmarks.position, look.up));
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(landmarks.position, 3));
  geometry.setAttribute('tint', new THREE.BufferAttribute(tints, 3));
  const material = new THREE.ShaderMaterial({ ...POINT_SHADERS, transparent: true,
    depthWrite: true,
    uniforms: { size: { value: look.radius * 0.013 }, height: { value: 600 },
      opacity: { value: 0.9 } } });
  const points = new THREE.Points(geometry, material);
  points.onBeforeRender = (renderer) => {
    material.uniforms.height.value = renderer.domElement.height;
  };
  return points;
}

// The surface of `hullslam mesh`, in the colours of the images.
export function surfaceLayer(store) {
  const surface = store.get('surface');
  if (!surface) {
    return null;
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(surface.position, 3));
  geometry.setAttribute('color', new THREE.BufferAttribute(surface.colour, 3, true));
  geometry.setIndex(new THREE.BufferAttribute(surface.triangle, 1));
  return new THREE.Mesh(geometry, new THREE.MeshBasicMaterial({ vertexColors: THREE.VertexColors || true,
    side: THREE.DoubleSide }));
}

// A tube with the thickness of the scene that is never thicker than a few pixels, so that a path
// does not hide what is near: the shader moves each point of its surface towards the centre line.
const TUBE_SHADERS = {
  vertexShader: `
    uniform float radius;
    uniform float perPixel;
    void main() {
      vec4 centre = modelViewMatrix * vec4(position - normal * radius, 1.0);
      float most = 1.6 * perPixel * max(-centre.z, 0.0);
      gl_Position = projectionMatrix
        * (centre + vec4(normalize(normalMatrix * normal) * min(radius, most), 0.0));
    }`,
  fragmentShader: `
    uniform vec3 colour;
    uniform float opacity;
    void main() {
      gl_FragColor = vec4(colour, opacity);
    }`,
};

function tubeMaterial(radius, colour, opacity) {
  return new THREE.ShaderMaterial({ ...TUBE_SHADERS, transparent: opacity < 1,
    uniforms: { radius: { value: radius }, perPixel: { value: 0 }, opacity: { value: opacity },
      colour: { value: new THREE.Color(colour) } } });
}

function tube(positions, radius, colour, opacity) {
  const step = Math.max(1, Math.ceil(positions.length / MOST_TUBE_POINTS));
  const kept = positions.filter((_, i) => i % step === 0 || i === positions.length - 1);
  const curve = new THREE.CatmullRomCurve3(kept);
  // The points of the curve are taken by number instead of by length along the curve, which
  // CatmullRomCurve3 would have to measure for each of them.
  curve.getPointAt = curve.getPoint;
  curve.getTangentAt = curve.getTangent;
  const geometry = new THREE.TubeBufferGeometry(curve, Math.max(2, kept.length - 1), radius, 6);
  const material = tubeMaterial(radius, colour, opacity);
  const mesh = new THREE.Mesh(geometry, material);
  mesh.onBeforeRender = (renderer, scene, camera) => {
    // The height of the view at distance 1, for each pixel of the page.
    material.uniforms.perPixel.value = 2 * Math.tan(camera.fov / 360 * Math.PI)
      / Math.max(1, renderer.domElement.clientHeight);
  };
  return mesh;
}

// Equal points in a row have no direction, so the tube takes only those that differ.
function pathLayer(times, pointAt, radius, colour, opacity) {
  const group = new THREE.Group();
  for (const [begin, end] of pieces(times)) {
    const positions = [];
    for (let i = begin; i < end; ++i) {
      const point = pointAt(i);
      const last = positions[positions.length - 1];
      if (Number.isFinite(point.x + point.y + point.z)
          && (!last || point.distanceTo(last) > radius * 0.05)) {
        positions.push(point);
      }
    }
    if (positions.length > 1) {
      group.add(tube(positions, radius, colour, opacity));
    }
  }
  return group;
}

function poseAt(poses) {
  return (i) => new THREE.Vector3(poses[7 * i], poses[7 * i + 1], poses[7 * i + 2]);
}

export function trajectoryLayer(store, look) {
  const trajectory = store.get('trajectory');
  return trajectory && pathLayer(trajectory.time, poseAt(trajectory.pose), look.thickness,
    themeColour('accent'), 1);
}

export function groundtruthLayer(store, look) {
  const truth = store.get('groundtruth');
  return truth && pathLayer(truth.time,
    (i) => new THREE.Vector3(...truth.position.subarray(3 * i, 3 * i + 3)), look.thickness * 0.7,
    themeColour('truth'), 0.75);
}

function segments(positions, colour, opacity) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.BufferAttribute(positions, 3));
  return new THREE.LineSegments(geometry,
    new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity, depthWrite: false }));
}

export function keyframesLayer(store, look) {
  const keyframes = store.get('keyframes');
  return keyframes && keyframes.time.length > 0
    ? segments(frustumSegments(keyframes.pose, store.get('camera'), look.thickness * 14),
      themeColour('warm'), 0.75) : null;
}

// Lines between the centres of keyframes: `pairs` has two ids per edge.
function edgeLayer(store, pairs, colour, opacity) {
  const keyframes = store.get('keyframes');
  if (!keyframes || !pairs || pairs.length === 0) {
    return null;
  }
  const index = new Map(Array.from(keyframes.id, (id, i) => [id, i]));
  const positions = [];
  for (let i = 0; i + 1 < pairs.length; i += 2) {
    const ends = [index.get(pairs[i]), index.get(pairs[i + 1])];
    if (ends.every((end) => end !== undefined)) {
      ends.forEach((end) => positions.push(...keyframes.pose.subarray(7 * end, 7 * end + 3)));
    }
  }
  return positions.length > 0 ? segments(Float32Array.from(positions), colour, opacity) : null;
}

export function covisibilityLayer(store) {
  return edgeLayer(store, store.get('edges', {}).covisibility, themeColour('muted'), 0.35);
}

export function loopsLayer(store) {
  return edgeLayer(store, store.get('edges', {}).loop, themeColour('bad'), 1);
}

// A level grid under the scene. The sides of its cells are 1, 2 or 5 times a power of ten.
export function gridLayer(store, look) {
  if (!look.floor) {
    return null;
  }
  const wanted = look.radius / 3;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const cell = power * [1, 2, 5].reduce((best, factor) => (factor * power <= wanted ? factor : best));
  const cells = 2 * Math.ceil(look.radius * 1.6 / cell);
  const colour = new THREE.Color(themeColour('muted'));
  const grid = new THREE.GridHelper(cells * cell, cells, colour, colour);
  grid.material.transparent = true;
  grid.material.opacity = 0.2;
  grid.material.depthWrite = false;
  grid.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), look.up);
  grid.position.copy(look.floor);
  return grid;
}

function ring(axis, colour) {
  const points = [];
  for (let i = 0; i <= 64; ++i) {
    const angle = i / 64 * 2 * Math.PI;
    const point = [Math.cos(angle), Math.sin(angle)];
    point.splice(axis, 0, 0);
    points.push(new THREE.Vector3(...point));
  }
  return new THREE.Line(new THREE.BufferGeometry().setFromPoints(points),
    new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity: 0.85 }));
}

const SPHERE = { geometry: null };

// An ellipsoid: a transparent surface, and the three ellipses in the planes of its axes.
function ellipsoid(object, colour, isChosen) {
  SPHERE.geometry = SPHERE.geometry || new THREE.SphereBufferGeometry(1, 40, 26);
  const group = new THREE.Group();
  const surface = new THREE.Mesh(SPHERE.geometry, new THREE.MeshLambertMaterial({ color: colour,
    emissive: colour, emissiveIntensity: 0.25, transparent: true, opacity: isChosen ? 0.55 : 0.3,
    depthWrite: false }));
  surface.userData.id = object.id;
  group.add(surface);
  for (let axis = 0; axis < 3; ++axis) {
    group.add(ring(axis, isChosen ? themeColour('text') : colour));
  }
  group.position.set(...object.centre);
  group.quaternion.set(...object.rotation);
  group.scale.set(...object.half_axes);
  return group;
}

export function objectsLayer(store, look) {
  const group = new THREE.Group();
  for (const object of store.get('objects', [])) {
    if (object.state === 'mapped' || object.id === look.chosen) {
      group.add(ellipsoid(object, colourOfClass(object.class), object.id === look.chosen));
    }
  }
  return group;
}

// The twelve edges of a box. Those of a side that no mask limits are faint.
function box(object, colour) {
  const { centre, rotation, half_extents: half, sides_seen: seen } = object.body.box;
  const edges = { true: [], false: [] };
  for (let axis = 0; axis < 3; ++axis) {
    for (const [first, second] of [[-1, -1], [-1, 1], [1, -1], [1, 1]]) {
      const across = [(axis + 1) % 3, (axis + 2) % 3];
      const isSeen = !seen || (seen[2 * across[0] + (first > 0)] && seen[2 * across[1] + (second > 0)]);
      for (const end of [-1, 1]) {
        const corner = [0, 0, 0];
        corner[axis] = end * half[axis];
        corner[across[0]] = first * half[across[0]];
        corner[across[1]] = second * half[across[1]];
        edges[Boolean(isSeen)].push(...corner);
      }
    }
  }
  const group = new THREE.Group();
  group.add(segments(Float32Array.from(edges.true), colour, 0.95),
    segments(Float32Array.from(edges.false), colour, 0.3));
  group.position.set(...centre);
  group.quaternion.set(...rotation);
  return group;
}

export function boxesLayer(store) {
  const group = new THREE.Group();
  for (const object of store.get('objects', [])) {
    if (object.body && object.body.box) {
      group.add(box(object, colourOfClass(object.class)));
    }
  }
  return group;
}
