// SPDX-License-Identifier: GPL-3.0-or-later
// Plays the run: the slider stands for the frames of the trajectory.
import { nearestAt } from './geometry.js';
import { html, seconds, svg } from './text.js';

const SPEEDS = [1, 2, 4, 8, 0.5];

function icon(path) {
  return svg('svg', { viewBox: '0 0 20 20', width: 16, height: 16, 'aria-hidden': 'true' },
    svg('path', { d: path, fill: 'currentColor' }));
}

export class Player {
  // `elements` has play, slider, clock and speed; `onFrame(index, time)` shows a frame.
  constructor(elements, store, onFrame) {
    Object.assign(this, elements, { store, onFrame, isPlaying: false, wasLive: false, rate: 1,
      index: 0 });
    this.play.addEventListener('click', () => this.setPlaying(!this.isPlaying));
    this.speed.addEventListener('click', () => {
      this.rate = SPEEDS[(SPEEDS.indexOf(this.rate) + 1) % SPEEDS.length];
      this.showSpeed();
    });
    this.slider.addEventListener('input', () => this.show(Number(this.slider.value)));
    this.showSpeed();
    this.setPlaying(false);
  }

  showSpeed() {
    this.speed.replaceChildren(html('span', {}, `${this.rate}×`));
  }

  times() {
    const trajectory = this.store.get('trajectory');
    return trajectory ? trajectory.time : new Float32Array(0);
  }

  // A run that is going on, or whose last poses have just come, is followed to its end.
  update() {
    const count = this.times().length;
    const isLive = Boolean(this.store.get('run', {}).live);
    const isFollowed = (isLive || this.wasLive) && this.index === Number(this.slider.max);
    this.wasLive = isLive;
    this.slider.max = Math.max(0, count - 1);
    this.play.disabled = count < 2;
    this.slider.disabled = count < 2;
    if (count > 0) {
      this.show(isFollowed ? count - 1 : Math.min(this.index, count - 1));
    }
  }

  show(index) {
    const times = this.times();
    if (index < 0 || index >= times.length) {
      return;
    }
    this.index = index;
    this.slider.value = index;
    this.clock.textContent = `${seconds(times[index])} · ${index + 1}/${times.length}`;
    this.onFrame(index, times[index]);
  }

  showTime(time) {
    const times = this.times();
    if (times.length > 0) {
      this.show(nearestAt(times, time));
    }
  }

  setPlaying(isPlaying) {
    this.isPlaying = isPlaying;
    this.play.replaceChildren(icon(isPlaying ? 'M5 3h4v14H5zM11 3h4v14h-4z' : 'M5 3l12 7-12 7z'));
    this.play.setAttribute('aria-label', isPlaying ? 'pause' : 'play the run');
    if (isPlaying) {
      const times = this.times();
      this.now = this.index >= times.length - 1 ? times[0] : times[this.index];
      this.last = null;
      window.requestAnimationFrame((stamp) => this.step(stamp));
    }
  }

  step(stamp) {
    if (!this.isPlaying) {
      return;
    }
    this.now += this.last === null ? 0 : (stamp - this.last) / 1000 * this.rate;
    this.last = stamp;
    this.showTime(this.now);
    if (this.now >= this.times()[this.times().length - 1]) {
      this.setPlaying(false);
    } else {
      window.requestAnimationFrame((next) => this.step(next));
    }
  }
}
