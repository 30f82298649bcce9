// SPDX-License-Identifier: GPL-3.0-or-later
// The bar of a run that is going on: its state, its times, and the buttons that control it.
import { sendCommand, tokenOfPage } from './source.js';
import { html, isNumber, number, seconds, whole, words } from './text.js';

// Pictures of the past that the slider can go back to.
const MOST_PICTURES = 100;

const PHASES = { paused: 'paused', finishing: 'adjusting the whole map', ended: 'the run has ended' };

export class Live {
  constructor(place, store) {
    Object.assign(this, { place, store, isConnected: false, refusal: '', pictures: [], gap: 0.5 });
  }

  // The elements stay the same, because a click on one that is replaced meanwhile would be lost.
  build() {
    const control = (title, help, command) => html('button', { type: 'button', title: help,
      onclick: () => this.send(command()) }, title);
    this.chip = html('b', { class: 'chip' });
    this.bar = html('progress', { 'aria-label': 'progress of the run' });
    this.position = html('span', {});
    this.figures = html('span', { class: 'figures' });
    this.pause = control('Pause', 'wait before the next frame',
      () => (this.store.get('live', {}).phase === 'paused' ? 'resume' : 'pause'));
    this.fixMap = control('Localise only', 'find poses in the map and leave the map as it is',
      () => (this.store.get('live', {}).localising ? 'map' : 'localise'));
    this.controls = html('span', { class: 'controls' }, this.pause,
      control('Step', 'track one frame, then pause', () => 'step'),
      control('Save map', 'write the map as it is now to a file', () => 'save-map'), this.fixMap);
    this.notice = html('span', { class: 'notice', role: 'status' });
    this.place.replaceChildren(this.chip, html('span', { class: 'progress' }, this.bar,
      this.position), this.figures, this.controls, this.notice);
    this.place.hidden = false;
  }

  send(command) {
    sendCommand(command).then(() => this.showRefusal(''),
      (error) => this.showRefusal(error.message));
  }

  showRefusal(text) {
    this.refusal = text;
    this.update();
  }

  setConnected(isConnected) {
    this.isConnected = isConnected;
    this.update();
  }

  update() {
    if (!this.chip) {
      this.build();
    }
    const live = this.store.get('live', {});
    const isEnded = live.phase === 'ended';
    const isOff = !this.isConnected && !isEnded;
    this.chip.textContent = isOff ? 'not connected'
      : PHASES[live.phase] || live.state || 'waiting for the first frame';
    this.chip.className = `chip ${isOff || isEnded ? '' : live.state || ''}`;
    const hasFrame = isNumber(live.frame);
    this.bar.max = live.frames || 1;
    this.bar.value = live.frame || 0;
    this.position.textContent = hasFrame
      ? `${whole(live.frame)} of ${whole(live.frames)} · ${seconds(live.time)}` : '';
    this.figures.textContent = hasFrame ? this.describe(live) : '';
    this.pause.textContent = live.phase === 'paused' ? 'Resume' : 'Pause';
    this.fixMap.setAttribute('aria-pressed', String(Boolean(live.localising)));
    this.fixMap.hidden = !live.can_localise;
    this.controls.hidden = tokenOfPage() === ''
      || !(live.phase === 'running' || live.phase === 'paused');
    this.notice.textContent = this.explain(live, isOff);
  }

  describe(live) {
    return `${live.localising ? 'map fixed · ' : ''}${whole(live.inliers)} matched · features `
      + `${number(live.build_ms, 1)} ms · tracking ${number(live.track_ms, 1)} ms · `
      + `${number(live.rate, 1)} frames/s`;
  }

  explain(live, isOff) {
    return [isOff && live.phase ? 'The connection to the run is lost; the page tries again and '
        + 'shows what came last.' : '',
    live.phase === 'ended' ? 'The command "view" with the output folder of the run shows it again.'
      : '',
    live.reason ? `${live.state}: ${words(live.reason)}` : '',
    live.elsewhere ? 'The camera is in a new part of the map, which is not joined to the shown '
        + 'one yet.' : '',
    this.refusal || live.notice].filter((part) => part).join(' · ');
  }

  // Keeps some of the pictures that came, evenly spread over the run.
  keepPicture() {
    const image = this.store.get('live_image');
    const last = this.pictures[this.pictures.length - 1];
    if (image && (!last || image.time - last.time >= this.gap)) {
      this.pictures.push(image);
      if (this.pictures.length > MOST_PICTURES) {
        this.pictures = this.pictures.filter((_, i) => i % 2 === 0);
        this.gap *= 2;
      }
    }
    return this.pictures;
  }
}
