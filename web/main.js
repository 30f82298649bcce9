// SPDX-License-Identifier: GPL-3.0-or-later
// Puts the parts of the page together.
import { Card } from './card.js';
import { bindTheme, rampAsCss } from './colours.js';
import { Curve } from './curve.js';
import { Live } from './live.js';
import { Moment } from './pictures.js';
import { Player } from './player.js';
import { sections, tiles } from './sections.js';
import { embeddedMessage, openStream } from './source.js';
import { Store } from './store.js';
import { html, length, seconds } from './text.js';
import { LAYERS, View } from './view.js';

const COLOURINGS = [['image', 'by image'], ['age', 'by age'], ['height', 'by height']];

function element(id) {
  return document.getElementById(id);
}

class Page {
  constructor() {
    this.store = new Store();
    const choose = (id) => this.choose(id);
    const showTime = (time) => this.player.showTime(time);
    this.card = new Card(element('card'), this.store, choose, showTime);
    this.moment = new Moment(element('moment'), this.store);
    this.curve = new Curve(element('curve'), this.store, showTime);
    this.view = this.makeView(choose);
    this.time = 0;
    this.player = new Player({ play: element('play'), slider: element('slider'),
      clock: element('clock'), speed: element('speed') }, this.store, (index, time) => {
      this.time = time;
      this.curve.mark(time);
      if (this.isNow(index)) {
        this.showNow();
      } else {
        this.view?.showMoment(index);
        this.moment.show(time);
      }
    });
    this.live = new Live(element('live'), this.store);
    this.bindButtons();
    this.store.listen((changed) => this.update(changed));
  }

  // A browser without WebGL shows everything else.
  makeView(choose) {
    try {
      return new View(element('canvas'), this.store, choose);
    } catch (error) {
      element('canvas').append(html('p', { class: 'fault' },
        `This browser cannot draw in 3D (WebGL): ${error.message}`));
      return null;
    }
  }

  bindButtons() {
    const follow = element('follow');
    follow.addEventListener('click', () => {
      const isOn = follow.getAttribute('aria-pressed') !== 'true';
      follow.setAttribute('aria-pressed', String(isOn));
      this.view?.follow(isOn);
    });
    element('home').addEventListener('click', () => {
      follow.setAttribute('aria-pressed', 'false');
      this.view?.follow(false);
      this.view?.goHome();
    });
    bindTheme(element('theme'), () => this.refresh());
  }

  // All that is coloured is made again in the colours of the theme.
  refresh() {
    if (this.store.get('run')) {
      this.view?.update(null);
      this.card.update();
      this.showSections();
      this.player.update();
      if (!this.isNow(this.player.index)) {
        this.moment.refresh(this.time);
      }
    }
  }

  choose(id) {
    this.card.choose(id);
    this.view?.choose(id);
    this.view?.showMoment(this.player.index);
  }

  // Whether a frame of the trajectory is the last one of a run that is going on.
  isNow(index) {
    return Boolean(this.store.get('run', {}).live && this.store.get('live'))
      && index >= this.player.times().length - 1;
  }

  showNow() {
    const pose = this.store.get('live', {}).pose;
    const image = this.store.get('live_image');
    if (pose) {
      this.view?.showPose(pose);
    }
    if (image) {
      this.moment.showLive(image);
    }
  }

  // Frames come many times a second, and only a few elements show them.
  updateLive(changed) {
    this.live.update();
    if (changed.has('live_image')) {
      this.store.parts.images = this.live.keepPicture();
    }
    if (this.isNow(this.player.index)) {
      this.showNow();
    }
  }

  // Elements that the pointer is on are not replaced during a run, so that clicks are not lost.
  isBusy(id) {
    return Boolean(this.store.get('run', {}).live) && element(id).matches(':hover');
  }

  update(changed) {
    if (changed.has('live')) {
      this.updateLive(changed);
    }
    if ([...changed].some((part) => part !== 'live' && part !== 'live_image')) {
      this.updateMap(changed);
    }
  }

  updateMap(changed) {
    this.showHead();
    this.view?.update(changed);
    if (!this.isBusy('layers')) {
      this.showLayers();
    }
    this.curve.update();
    this.player.update();
    if (changed.has('images') && !this.isNow(this.player.index)) {
      this.moment.refresh(this.time);
    }
    if (['objects', 'relations', 'summary', 'run'].some((part) => changed.has(part))
        && !this.isBusy('card')) {
      this.card.update();
    }
    if (!this.isBusy('sections')) {
      this.showSections();
    }
  }

  showHead() {
    const run = this.store.get('run', {});
    document.title = `${run.title || 'run'} – HullSLAM`;
    element('title').textContent = run.title || 'HullSLAM';
    element('subtitle').textContent = [run.program, run.sequence].filter((text) => text)
      .join(' · ');
    element('tiles').replaceChildren(...tiles(this.store));
    const notes = run.notes || [];
    element('notes').hidden = notes.length === 0;
    element('notes').replaceChildren(...notes.map((note) => html('li', {}, note)));
    element('footer').textContent = `HullSLAM ${run.version || ''} · lengths in `
      + `${this.store.unit() === 'm' ? 'metres' : 'units of the map, because a monocular camera does not know the metre'}`;
  }

  showSections() {
    element('sections').replaceChildren(...sections(this.store,
      (id) => {
        this.choose(id);
        this.view?.lookAt(id);
        element('canvas').scrollIntoView({ block: 'center', behavior: 'smooth' });
      },
      (time) => {
        this.player.showTime(time);
        element('moment').scrollIntoView({ block: 'nearest', behavior: 'smooth' });
      }));
  }

  isThere(layer) {
    const edges = this.store.get('edges', {});
    return { grid: this.view?.bounds !== undefined, covisibility: edges.covisibility?.length > 0, loops: edges.loop?.length > 0,
      labels: this.store.get('objects', []).length > 0,
      boxes: this.store.get('objects', []).some((object) => object.body?.box) }[layer.name]
      ?? layer.parts.slice(0, 1).every((part) => {
        const value = this.store.get(part);
        return value && (Array.isArray(value) ? value.length > 0
          : (value.time || value.position).length > 0);
      });
  }

  showLayers() {
    const switches = LAYERS.filter((layer) => this.isThere(layer)).map((layer) => html('label', {},
      html('input', { type: 'checkbox', 'data-layer': layer.name,
        checked: this.view ? this.view.shown[layer.name] : layer.on,
        onchange: (event) => this.view?.show(layer.name, event.target.checked) }),
      html('i', { style: `--mark:${layer.mark}` }), layer.title));
    element('layers').replaceChildren(...switches, this.legend(), this.colouring());
  }

  // From what to what the colours of the landmarks go.
  legend() {
    const scale = this.view?.scaleOfColours();
    if (!scale || this.colouring() === '') {
      return '';
    }
    const text = (value) => (scale.name === 'age' ? seconds(value)
      : length(value, this.store.unit()).join(' '));
    return html('span', { class: 'legend' }, text(scale.range[0]),
      html('i', { style: `background:${rampAsCss()}` }), text(scale.range[1]));
  }

  colouring() {
    const landmarks = this.store.get('landmarks', {});
    const able = COLOURINGS.filter(([name]) => name === 'height'
      || (name === 'image' ? landmarks.colour : landmarks.age));
    if (!landmarks.position || able.length < 2) {
      return '';
    }
    return html('select', { 'aria-label': 'colour of the landmarks',
      onchange: (event) => {
        this.view?.colourBy(event.target.value);
        this.showLayers();
      } },
    able.map(([name, title]) => html('option', { value: name,
      selected: this.view?.look.colouring === name }, title)));
  }

  apply(message) {
    this.store.apply(message);
    if (message.stream && !this.closeStream) {
      this.watch(message.stream);
    }
  }

  // Shows the messages of a stream until the run has ended.
  watch(path) {
    this.closeStream = openStream(path, (message) => {
      this.apply(message);
      if (this.store.get('live', {}).phase === 'ended') {
        this.closeStream();
      }
    }, (isConnected) => this.live.setConnected(isConnected));
    this.live.update();
  }
}

function start() {
  const page = new Page();
  // For tests, and for pages that give messages of their own.
  window.hullslam = page;
  try {
    const message = embeddedMessage();
    if (message) {
      page.apply(message);
    }
  } catch (error) {
    element('notes').hidden = false;
    element('notes').replaceChildren(html('li', {}, `The data cannot be shown: ${error.message}`));
  }
}

start();
