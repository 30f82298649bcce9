// SPDX-License-Identifier: GPL-3.0-or-later
// The card beside the view: the list of objects, or everything about the chosen one.
import { colourOfClass } from './colours.js';
import { html, isNumber, number, words } from './text.js';
import { picture } from './pictures.js';

export function facts(rows) {
  return html('dl', { class: 'facts' }, rows.filter((row) => row).map(([name, value]) =>
    [html('dt', {}, name), html('dd', {}, value)]));
}

export function bars(entries, colour) {
  const most = Math.max(...entries.map((entry) => entry.value), 1e-12);
  return html('div', { class: 'bars' }, entries.map((entry) => html('div', {},
    html('span', {}, entry.name),
    html('u', {}, html('i', { style: `width:${Math.max(0, entry.value) / most * 100}%;`
      + `background:${entry.colour || colour}` })),
    html('b', {}, entry.text))));
}

export function sizeText(object, unit) {
  const sizes = [...object.half_axes].sort((a, b) => b - a).map((axis) => 2 * axis);
  return unit === 'm' ? `${sizes.map((size) => (size * 100).toFixed(1)).join(' × ')}\u00a0cm`
    : `${sizes.map((size) => size.toFixed(3)).join(' × ')} ${unit}`;
}

// What the masks leave free: 'round about z', 'length of x', of the axes of the ellipsoid.
export function freeText({ body }) {
  const axes = (key) => ((body && body[key]) || []).join(', ');
  return [axes('round_axes') && `round about ${axes('round_axes')}`,
    axes('undetermined_axes') && `length of ${axes('undetermined_axes')}`].filter((text) => text).join('; ');
}

export class Card {
  // `onChoose(id)` chooses an object, `onTime(t)` a moment.
  constructor(place, store, onChoose, onTime) {
    Object.assign(this, { place, store, onChoose, onTime, id: null });
  }

  choose(id) {
    this.id = id;
    this.update();
  }

  update() {
    const objects = this.store.get('objects', []);
    const chosen = objects.find((object) => object.id === this.id);
    this.place.replaceChildren(...(chosen ? this.object(chosen) : this.list(objects)));
    this.place.dataset.object = chosen ? chosen.id : '';
    this.place.scrollTop = 0;
  }

  swatch(label) {
    return html('i', { class: 'swatch', style: `background:${colourOfClass(label)}` });
  }

  list(objects) {
    const mapped = objects.filter((object) => object.state === 'mapped');
    if (mapped.length === 0) {
      return [html('h2', {}, 'No objects'), html('p', { class: 'hint' },
        this.store.get('summary', {}).objects ? 'No object of this run has a valid shape.'
          : 'The run had no masks. With --masks it also maps objects.')];
    }
    mapped.sort((a, b) => (b.quality || 0) - (a.quality || 0));
    return [html('h2', {}, `${mapped.length} objects`),
      html('p', { class: 'hint' }, 'Click an ellipsoid or a line. The number is the quality, from 0 to 1.'),
      html('ul', { class: 'list' }, mapped.map((object) => html('li', {},
        html('button', { type: 'button', onclick: () => this.onChoose(object.id) },
          this.swatch(object.class), html('span', {}, `${object.name || object.class} ${object.id}`),
          html('span', {}, number(object.quality))))))];
  }

  object(object) {
    const votes = Object.entries(object.votes || {}).sort((a, b) => b[1] - a[1]);
    const parts = [
      html('h2', {}, this.swatch(object.class), html('span', {}, `${object.name || object.class} ${object.id}`),
        html('button', { type: 'button', class: 'quiet', onclick: () => this.onChoose(null) },
          'All objects')),
      this.factsOf(object)];
    if (object.cutouts && object.cutouts.length > 0) {
      parts.push(html('h3', {}, 'Best views'), html('div', { class: 'cutouts' },
        object.cutouts.map((cutout) => html('figure', {
          onclick: () => this.onTime(cutout.time) }, ...picture(cutout)))));
    }
    parts.push(html('h3', {}, 'Votes for classes'), bars(votes.slice(0, 8).map(([name, value]) => ({
      name, value, text: number(value, 1), colour: colourOfClass(object.class) }))));
    return parts.concat(this.relations(object));
  }

  factsOf(object) {
    const unit = this.store.unit();
    const centre = object.centre.map((value) => value.toFixed(3)).join('  ');
    return facts([
      object.state !== 'mapped' && ['State', object.reason ? `not mapped: ${words(object.reason)}`
        : 'not mapped'],
      ['Quality', number(object.quality)],
      ['Size', sizeText(object, unit)],
      object.body && object.body.box && ['Box', sizeText({ half_axes: object.body.box.half_extents },
        unit)],
      freeText(object) && ['Not determined', freeText(object)],
      ['Centre', `${centre} ${unit}`],
      ['Views', String(object.observations)],
      ['Angle between views', isNumber(object.parallax_deg)
        ? `${object.parallax_deg.toFixed(0)}°` : '–'],
      ['Overlap with hulls', number(object.siou)],
      ['Overlap with masks', number(object.siou_mask)],
      ['Distance of tangents', `${number(object.tangent_px, 1)} px`],
      ['Misfit', `${number(object.misfit_px, 1)} px`]]);
  }

  relations(object) {
    const relations = this.store.get('relations', []).filter((relation) =>
      relation.subject === object.id || relation.object === object.id);
    if (relations.length === 0) {
      return [];
    }
    const named = new Map(this.store.get('objects', []).map((entry) => [entry.id, entry]));
    const name = (id) => (named.has(id) ? `${named.get(id).class} ${id}` : `object ${id}`);
    return [html('h3', {}, 'Relations'), html('ul', { class: 'list' }, relations.map((relation) => {
      const other = relation.subject === object.id ? relation.object : relation.subject;
      return html('li', {}, html('button', { type: 'button', onclick: () => this.onChoose(other) },
        this.swatch(named.has(other) ? named.get(other).class : ''),
        html('span', {}, `${name(relation.subject)} ${relation.relation} ${name(relation.object)}`),
        html('span', {})));
    }))];
  }
}
