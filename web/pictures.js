// SPDX-License-Identifier: GPL-3.0-or-later
// Images of the run with the outlines of its masks (solid) and the projected ellipsoids (dashed).
import { colourOfClass } from './colours.js';
import { html, seconds, svg } from './text.js';

function pathOf(points) {
  let path = '';
  for (let i = 0; i + 1 < points.length; i += 2) {
    path += `${i === 0 ? 'M' : 'L'}${points[i]} ${points[i + 1]}`;
  }
  return path === '' ? '' : `${path}Z`;
}

// Lines without length, which round ends make to dots.
function dotsOf(points) {
  let path = '';
  for (let i = 0; i + 1 < points.length; i += 2) {
    path += `M${points[i].toFixed(1)} ${points[i + 1].toFixed(1)}h0`;
  }
  return path;
}

export function picture(image) {
  const overlay = svg('svg', { viewBox: `0 0 ${image.width} ${image.height}`,
    preserveAspectRatio: 'none' });
  for (const name of ['unmatched', 'matched']) {
    if (image[name] && image[name].length > 0) {
      overlay.append(svg('path', { class: name, d: dotsOf(image[name]) }));
    }
  }
  for (const [name, shapes] of [['ellipse', image.ellipses], ['outline', image.outlines]]) {
    for (const shape of shapes || []) {
      overlay.append(svg('path', { class: name, d: pathOf(shape.points),
        stroke: colourOfClass(shape.class) }));
    }
  }
  return [html('img', { src: image.image, alt: 'image of the camera', width: image.width,
    height: image.height }), overlay];
}

// The image nearest to a moment, or null.
export function imageAt(images, time) {
  return images.reduce((best, image) => (best === null
    || Math.abs(image.time - time) < Math.abs(best.time - time) ? image : best), null);
}

export class Moment {
  constructor(place, store) {
    Object.assign(this, { place, store, shown: null });
  }

  show(time) {
    const image = imageAt(this.store.get('images', []), time);
    this.place.hidden = image === null;
    if (image === null || image === this.shown) {
      return;
    }
    this.shown = image;
    this.place.replaceChildren(html('figure', {}, ...picture(image)),
      html('figcaption', {}, html('span', {}, `Image of ${seconds(image.time)}`),
        html('span', {}, '— mask   - - ellipsoid')));
  }

  // The image that came last, of a run that is still going on.
  showLive(image) {
    this.shown = image;
    this.place.hidden = false;
    this.place.replaceChildren(html('figure', {}, ...picture(image)),
      html('figcaption', {}, html('span', {}, `Now, ${seconds(image.time)}`),
        html('span', {}, '● matched   — mask   - - ellipsoid')));
  }

  refresh(time) {
    this.shown = null;
    this.show(time);
  }
}

function hasOutline(image) {
  return (image.outlines || []).length > 0;
}

// Up to twelve images, evenly chosen: those with outlines, or all if none has any.
export function strip(store, onTime) {
  const all = store.get('images', []);
  const images = all.some(hasOutline) ? all.filter(hasOutline) : all;
  const step = Math.max(1, Math.ceil(images.length / 12));
  return html('div', { class: 'strip' }, images.filter((_, i) => i % step === 0).map((image) =>
    html('figure', { onclick: () => onTime(image.time) }, ...picture(image),
      html('figcaption', {}, seconds(image.time)))));
}

export function stripTitle(store) {
  return store.get('images', []).some(hasOutline) ? 'Images with outlines' : 'Images';
}
