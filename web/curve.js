// SPDX-License-Identifier: GPL-3.0-or-later
// The error over time, or without ground truth the distance from the first pose. Frames without a
// pose are shaded. A click chooses the moment.
import { pieces } from './geometry.js';
import { length, seconds, svg } from './text.js';

const MARGIN = { left: 60, right: 8, top: 16, bottom: 18 };

function distances(trajectory) {
  const pose = trajectory.pose;
  return Float32Array.from(trajectory.time, (_, i) => Math.hypot(pose[7 * i] - pose[0],
    pose[7 * i + 1] - pose[1], pose[7 * i + 2] - pose[2]));
}

export class Curve {
  constructor(place, store, onTime) {
    Object.assign(this, { place, store, onTime, time: 0 });
    place.addEventListener('click', (event) => this.pick(event));
    new ResizeObserver(() => this.update()).observe(place);
  }

  series() {
    const errors = this.store.get('errors');
    if (errors && errors.time.length > 1) {
      return { time: errors.time, value: errors.value, unit: 'm',
        title: 'error of the position over time' };
    }
    const trajectory = this.store.get('trajectory');
    return trajectory && trajectory.time.length > 1 ? { time: trajectory.time,
      value: distances(trajectory), unit: this.store.unit(),
      title: 'distance from the first pose over time (no ground truth)' } : null;
  }

  update() {
    const series = this.series();
    const { clientWidth, clientHeight } = this.place;
    this.place.hidden = !series;
    if (!series || clientWidth === 0) {
      return;
    }
    const [width, height] = [clientWidth - 24, clientHeight - 10];
    const trajectory = this.store.get('trajectory');
    const losses = this.store.get('losses', []);
    const all = [series.time[0], series.time[series.time.length - 1],
      ...(trajectory ? [trajectory.time[0], trajectory.time[trajectory.time.length - 1]] : []),
      ...losses.flatMap((loss) => [loss.from, loss.to])];
    this.range = [Math.min(...all), Math.max(...all)];
    const most = series.value.reduce((a, b) => (b > a ? b : a), 1e-9) * 1.08;
    const x = (time) => MARGIN.left + (time - this.range[0]) / (this.range[1] - this.range[0] || 1)
      * (width - MARGIN.left - MARGIN.right);
    const y = (value) => height - MARGIN.bottom - value / most
      * (height - MARGIN.top - MARGIN.bottom);
    this.x = x;
    this.cursor = svg('line', { y1: MARGIN.top - 4, y2: height - MARGIN.bottom,
      stroke: 'var(--text)', 'stroke-width': 1 });
    this.place.replaceChildren(svg('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img',
      'aria-label': series.title }, ...this.grid(series, most, x, y, width),
    ...losses.map((loss) => svg('rect', { x: x(loss.from), width: Math.max(2, x(loss.to)
      - x(loss.from)), y: MARGIN.top, height: height - MARGIN.top - MARGIN.bottom,
    fill: 'var(--bad)', opacity: 0.22 }, svg('title', {}, `no pose: ${loss.reason}`))),
    ...this.paths(series, x, y), this.cursor));
    this.mark(this.time);
  }

  grid(series, most, x, y, width) {
    const parts = [svg('text', { class: 'axis', x: MARGIN.left, y: 11 }, series.title)];
    for (const share of [0, 0.5, 1]) {
      const value = most / 1.08 * share;
      parts.push(svg('line', { x1: MARGIN.left, x2: width - MARGIN.right, y1: y(value),
        y2: y(value), stroke: 'var(--line)' }), svg('text', { class: 'axis', x: MARGIN.left - 6,
        y: y(value) + 4, 'text-anchor': 'end' }, length(value, series.unit).join(' ')));
    }
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      const time = this.range[0] + (this.range[1] - this.range[0]) * share;
      parts.push(svg('text', { class: 'axis', x: x(time), y: y(0) + 14,
        'text-anchor': share === 0 ? 'start' : share === 1 ? 'end' : 'middle' }, seconds(time)));
    }
    return parts;
  }

  paths(series, x, y) {
    return pieces(series.time).map(([begin, end]) => {
      let path = '';
      for (let i = begin; i < end; ++i) {
        path += `${i === begin ? 'M' : 'L'}${x(series.time[i]).toFixed(1)} ${
          y(series.value[i]).toFixed(1)}`;
      }
      return svg('path', { d: path, fill: 'none', stroke: 'var(--accent)', 'stroke-width': 1.6,
        'stroke-linejoin': 'round' });
    });
  }

  mark(time) {
    this.time = time;
    if (this.cursor) {
      this.cursor.setAttribute('x1', this.x(time));
      this.cursor.setAttribute('x2', this.x(time));
    }
  }

  pick(event) {
    const box = this.place.querySelector('svg');
    if (box && this.range) {
      const bounds = box.getBoundingClientRect();
      const share = (event.clientX - bounds.left - MARGIN.left)
        / (bounds.width - MARGIN.left - MARGIN.right);
      this.onTime(this.range[0] + Math.min(1, Math.max(0, share)) * (this.range[1] - this.range[0]));
    }
  }
}
