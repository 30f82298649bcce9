// SPDX-License-Identifier: GPL-3.0-or-later
// The 3D view: camera, layers, labels, and what the pointer is on. It draws only after a change.
import { fitPoints, samplePoints } from './fit.js';
import { frustumCorners, frustumSegments, positionAt, robustBounds, rotationAt }
  from './geometry.js';
import { colourOfClass, themeColour } from './colours.js';
import { boxesLayer, covisibilityLayer, gridLayer, groundtruthLayer, keyframesLayer,
  landmarksLayer, loopsLayer, objectsLayer, scaleOfColours, surfaceLayer, trajectoryLayer } from './layers.js';
import { html } from './text.js';

export const LAYERS = [
  { name: 'objects', title: 'Objects', make: objectsLayer, parts: ['objects'], on: true,
    mark: 'hsl(268, 68%, 66%)' },
  { name: 'boxes', title: 'Boxes', make: boxesLayer, parts: ['objects'], on: false,
    mark: 'hsl(268, 68%, 66%)' },
  { name: 'labels', title: 'Labels', parts: ['objects'], on: true, mark: 'var(--text)' },
  { name: 'landmarks', title: 'Landmarks', make: landmarksLayer, parts: ['landmarks', 'up'],
    on: true, mark: 'hsl(212, 60%, 60%)' },
  { name: 'surface', title: 'Surface', make: surfaceLayer, parts: ['surface'], on: true,
    mark: 'hsl(30, 25%, 55%)' },
  { name: 'trajectory', title: 'Trajectory', make: trajectoryLayer, parts: ['trajectory'],
    on: true, mark: 'var(--accent)' },
  { name: 'groundtruth', title: 'Ground truth', make: groundtruthLayer, parts: ['groundtruth'],
    on: true, mark: 'var(--truth)' },
  { name: 'keyframes', title: 'Keyframes', make: keyframesLayer, parts: ['keyframes', 'camera'],
    on: true, mark: 'var(--warm)' },
  { name: 'covisibility', title: 'Covisibility', make: covisibilityLayer,
    parts: ['edges', 'keyframes'], on: false, mark: 'var(--muted)' },
  { name: 'loops', title: 'Loops', make: loopsLayer, parts: ['edges', 'keyframes'], on: true,
    mark: 'var(--bad)' },
  { name: 'grid', title: 'Grid', make: gridLayer, parts: ['landmarks', 'trajectory', 'up'], on: true,
    mark: 'var(--line)' },
];

function dispose(node) {
  node.traverse((part) => {
    if (part.geometry && !(part.geometry instanceof THREE.SphereBufferGeometry)) {
      part.geometry.dispose();
    }
    if (part.material) {
      part.material.dispose();
    }
  });
}

export class View {
  // `onChoose(id)` is called when an object is clicked; null beside all objects.
  constructor(place, store, onChoose) {
    this.place = place;
    this.store = store;
    this.onChoose = onChoose;
    this.look = { colouring: 'image', chosen: null, radius: 1, thickness: 0.003,
      up: new THREE.Vector3(0, -1, 0) };
    this.nodes = {};
    this.shown = Object.fromEntries(LAYERS.map((layer) => [layer.name, layer.on]));
    this.isFollowing = false;
    this.isUntouched = true;
    this.isDue = false;
    this.moment = -1;
    this.labels = new Map();
    this.build();
  }

  build() {
    this.renderer = new THREE.WebGLRenderer({ antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio || 1, 2));
    this.place.append(this.renderer.domElement);
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.01, 1000);
    this.scene.add(new THREE.AmbientLight(0xffffff, 0.75));
    this.light = new THREE.DirectionalLight(0xffffff, 0.65);
    this.scene.add(this.light);
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableKeys = false;
    this.controls.screenSpacePanning = true;
    this.bindControls();
    this.bindPointer();
    new ResizeObserver(() => this.resize()).observe(this.place);
    this.resize();
  }

  bindControls() {
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => { this.isUntouched = false; });
  }

  bindPointer() {
    const canvas = this.renderer.domElement;
    let down = null;
    canvas.addEventListener('pointerdown', (event) => { down = [event.clientX, event.clientY]; });
    canvas.addEventListener('pointerup', (event) => {
      if (down && Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 6) {
        this.onChoose(this.objectAt(event.clientX, event.clientY));
      }
      down = null;
    });
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.place;
    if (width > 0 && height > 0) {
      this.renderer.setSize(width, height);
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
      this.draw();
    }
  }

  // Rebuilds the layers of these parts; all layers without `changed`.
  update(changed) {
    const before = this.bounds;
    const up = this.store.get('up');
    this.look.up = up ? new THREE.Vector3(...up).normalize() : new THREE.Vector3(0, -1, 0);
    if (!before || !changed || (this.store.get('run', {}).live && changed.has('landmarks'))) {
      this.measure();
    }
    // A map that is still growing is shown in whole, unless the user looks at a part of it.
    const isResized = this.bounds
      && !(before && Math.abs(this.bounds.radius / before.radius - 1) < 0.12);
    for (const layer of LAYERS) {
      if (layer.make && (!changed || isResized || layer.parts.some((part) => changed.has(part)))) {
        this.replace(layer.name, layer.make(this.store, this.look));
      }
    }
    if (isResized && (!before || (this.isUntouched && !this.isFollowing))) {
      this.goHome();
    }
    this.moment = -1;
    this.draw();
  }

  measure() {
    const landmarks = this.store.get('landmarks');
    const poses = this.store.get('trajectory') || this.store.get('keyframes');
    const points = landmarks ? Array.from(landmarks.position) : [];
    const path = [];
    for (let i = 0; poses && i < poses.pose.length; i += 7) {
      path.push(...poses.pose.subarray(i, i + 3));
    }
    const objects = this.store.get('objects', []).filter((object) => object.state === 'mapped')
      .flatMap((object) => [-1, 1].flatMap((side) => object.centre.map((value) =>
        value + side * Math.max(...object.half_axes))));
    const all = points.length > 0 ? points : path.concat(objects);
    if (all.length === 0) {
      return;
    }
    this.bounds = robustBounds(all);
    this.look.radius = this.bounds.radius;
    // The camera's path belongs into the picture even if all landmarks are on one side of it.
    this.path = path.length > 0 ? robustBounds(path) : this.bounds;
    this.look.thickness = Math.min(this.bounds.radius * 0.0032, this.path.radius * 0.012);
    this.look.floor = this.floorUnder(points.length > 0 ? points : path);
    this.samples = samplePoints(points, path.concat(objects));
    this.camera.near = this.bounds.radius / 500;
    this.camera.far = this.bounds.radius * 200;
    this.camera.updateProjectionMatrix();
  }

  // The point under the middle of the scene that is as low as the lowest points, without the lowest
  // 2 %, which may be wrong.
  floorUnder(points) {
    const heights = [];
    for (let i = 0; i + 2 < points.length; i += 3) {
      heights.push(points[i] * this.look.up.x + points[i + 1] * this.look.up.y
        + points[i + 2] * this.look.up.z);
    }
    heights.sort((a, b) => a - b);
    const centre = this.bounds.centre;
    return centre.clone().addScaledVector(this.look.up,
      heights[Math.floor(heights.length * 0.02)] - centre.dot(this.look.up));
  }

  replace(name, node) {
    if (this.nodes[name]) {
      this.scene.remove(this.nodes[name]);
      dispose(this.nodes[name]);
    }
    this.nodes[name] = node;
    if (node) {
      node.visible = this.shown[name] !== false;
      this.scene.add(node);
    }
  }

  show(name, isShown) {
    this.shown[name] = isShown;
    if (this.nodes[name]) {
      this.nodes[name].visible = isShown;
    }
    this.draw();
  }

  colourBy(colouring) {
    this.look.colouring = colouring;
    this.update(new Set(['landmarks']));
  }

  scaleOfColours() {
    return scaleOfColours(this.store, this.look);
  }

  choose(id) {
    this.look.chosen = id;
    this.update(new Set(['objects']));
  }

  // From behind the cameras of the run and above them.
  goHome() {
    if (!this.bounds) {
      return;
    }
    this.isUntouched = true;
    const poses = this.store.get('keyframes') || this.store.get('trajectory');
    const forward = new THREE.Vector3();
    for (let i = 0; poses && i < poses.time.length; ++i) {
      forward.add(new THREE.Vector3(0, 0, 1).applyQuaternion(rotationAt(poses.pose, i)));
    }
    const up = this.look.up;
    forward.addScaledVector(up, -forward.dot(up));
    if (forward.length() < 1e-3) {
      forward.set(0.3, 0.2, 1).addScaledVector(up, -up.dot(new THREE.Vector3(0.3, 0.2, 1)));
    }
    forward.normalize();
    const side = new THREE.Vector3().crossVectors(forward, up);
    const direction = forward.clone().multiplyScalar(-1).addScaledVector(up, 0.62)
      .addScaledVector(side, 0.42).normalize();
    this.camera.up.copy(up);
    this.rebuildControls();
    const { target, distance } = fitPoints(this.samples, direction, up, this.camera);
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(direction, distance);
    this.controls.update();
    this.draw();
  }

  // OrbitControls reads the direction of `up` only when it is made.
  rebuildControls() {
    const old = this.controls;
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    for (const key of ['enableKeys', 'screenSpacePanning']) {
      this.controls[key] = old[key];
    }
    old.dispose();
    this.bindControls();
  }

  // Shows the camera of the run at frame `index` of the trajectory, and follows it if asked to.
  showMoment(index) {
    const trajectory = this.store.get('trajectory');
    if (!trajectory || trajectory.time.length === 0) {
      return;
    }
    this.moment = index;
    this.showPose(trajectory.pose.subarray(7 * index, 7 * index + 7));
  }

  showPose(pose) {
    this.replace('now', this.makeNow(pose));
    if (this.isFollowing) {
      this.followPose(pose);
    }
    this.draw();
  }

  makeNow(pose) {
    const depth = Math.max(this.look.thickness * 30, this.look.radius * 0.07);
    const group = new THREE.Group();
    const lines = new THREE.BufferGeometry();
    lines.setAttribute('position', new THREE.BufferAttribute(
      frustumSegments(pose, this.store.get('camera'), depth), 3));
    group.add(new THREE.LineSegments(lines,
      new THREE.LineBasicMaterial({ color: themeColour('text') })));
    const face = new THREE.BufferGeometry().setFromPoints(
      frustumCorners(this.store.get('camera'), depth));
    face.setIndex([0, 1, 2, 0, 2, 3]);
    const plane = new THREE.Mesh(face, new THREE.MeshBasicMaterial({ color: themeColour('accent'),
      transparent: true, opacity: 0.25, side: THREE.DoubleSide, depthWrite: false }));
    plane.position.copy(positionAt(pose, 0));
    plane.quaternion.copy(rotationAt(pose, 0));
    group.add(plane);
    return group;
  }

  followPose(pose) {
    const centre = positionAt(pose, 0);
    const forward = new THREE.Vector3(0, 0, 1).applyQuaternion(rotationAt(pose, 0));
    const back = this.look.radius * 0.42;
    this.camera.up.copy(this.look.up);
    this.camera.position.copy(centre).addScaledVector(forward, -back)
      .addScaledVector(this.look.up, back * 0.42);
    this.controls.target.copy(centre).addScaledVector(forward, this.look.radius * 0.6);
    this.controls.update();
  }

  follow(isFollowing) {
    this.isFollowing = isFollowing;
    if (this.moment >= 0) {
      this.showMoment(this.moment);
    }
  }

  lookAt(id) {
    const object = this.store.get('objects', []).find((entry) => entry.id === id);
    if (object) {
      const shift = new THREE.Vector3(...object.centre).sub(this.controls.target);
      this.controls.target.add(shift);
      this.camera.position.add(shift);
      this.controls.update();
      this.draw();
    }
  }

  objectAt(x, y) {
    const box = this.renderer.domElement.getBoundingClientRect();
    const ray = new THREE.Raycaster();
    ray.setFromCamera({ x: (x - box.left) / box.width * 2 - 1,
      y: 1 - (y - box.top) / box.height * 2 }, this.camera);
    if (!this.nodes.objects || !this.nodes.objects.visible) {
      return null;
    }
    const hits = ray.intersectObjects(this.nodes.objects.children, true)
      .filter((hit) => hit.object.userData.id !== undefined);
    // Where ellipsoids are inside of others, a click means the smallest one.
    const volume = (hit) => hit.object.parent.scale.x * hit.object.parent.scale.y
      * hit.object.parent.scale.z;
    hits.sort((a, b) => volume(a) - volume(b));
    return hits.length > 0 ? hits[0].object.userData.id : null;
  }

  // The pixel of the page at which the centre of an object is drawn; null outside of the view.
  screenOf(id) {
    const object = this.store.get('objects', []).find((entry) => entry.id === id);
    if (!object) {
      return null;
    }
    this.camera.updateMatrixWorld();
    const point = new THREE.Vector3(...object.centre).project(this.camera);
    const box = this.renderer.domElement.getBoundingClientRect();
    return Math.abs(point.x) > 1 || Math.abs(point.y) > 1 || point.z > 1 ? null
      : [box.left + (point.x + 1) / 2 * box.width, box.top + (1 - point.y) / 2 * box.height];
  }

  draw() {
    if (!this.isDue) {
      this.isDue = true;
      window.requestAnimationFrame(() => {
        this.isDue = false;
        this.light.position.copy(this.camera.position);
        this.renderer.render(this.scene, this.camera);
        this.placeLabels();
      });
    }
  }

  // Labels of near objects are placed first; one that would lie on another label is left out.
  placeLabels() {
    const objects = this.shown.labels && this.shown.objects
      ? this.store.get('objects', []).filter((object) => object.state === 'mapped'
        || object.id === this.look.chosen) : [];
    const near = objects.map((object) => ({ object,
      distance: object.id === this.look.chosen ? -1
        : this.camera.position.distanceTo(new THREE.Vector3(...object.centre)) }))
      .sort((a, b) => a.distance - b.distance).slice(0, 60);
    const used = new Map();
    const boxes = [];
    const origin = this.renderer.domElement.getBoundingClientRect();
    for (const { object } of near) {
      const at = this.screenOf(object.id);
      const label = at && this.labelOf(object);
      if (!label) {
        continue;
      }
      const [x, y] = [at[0] - origin.left, at[1] - origin.top];
      const [w, h] = [label.width, 20];
      if (boxes.every((b) => Math.abs(b.x - x) > (b.w + w) / 2 + 3 || Math.abs(b.y - y) > h + 2)) {
        boxes.push({ x, y, w });
        label.node.style.transform = `translate(${Math.round(x - w / 2)}px, ${Math.round(y - 10)}px)`;
        label.node.style.borderColor = colourOfClass(object.class);
        label.node.classList.toggle('chosen', object.id === this.look.chosen);
        used.set(object.id, label);
      }
    }
    for (const [id, label] of this.labels) {
      label.node.style.visibility = used.has(id) ? 'visible' : 'hidden';
    }
  }

  labelOf(object) {
    const text = `${object.name || object.class} ${object.id}`;
    let label = this.labels.get(object.id);
    if (!label || label.text !== text) {
      if (label) {
        label.node.remove();
      }
      const node = html('div', { class: 'label' }, text);
      this.place.append(node);
      label = { node, text, width: node.offsetWidth };
      this.labels.set(object.id, label);
    }
    return label;
  }
}
