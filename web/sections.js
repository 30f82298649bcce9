// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the page beside the view: the figures at its top, and the sections below it.
import { bars, facts, freeText, sizeText } from './card.js';
import { colourOfClass } from './colours.js';
import { strip, stripTitle } from './pictures.js';
import { html, isNumber, length, milliseconds, number, seconds, whole, words } from './text.js';

function tile(name, value, unit = '', kind = '') {
  return html('div', { class: `tile ${kind}` }, html('b', {}, value,
    unit ? html('small', {}, unit) : null), html('span', {}, name));
}

// A value of summary.json by its path; undefined if it does not exist.
function at(summary, ...keys) {
  return keys.reduce((value, key) => (value === null || value === undefined ? undefined
    : value[key]), summary);
}

export function tiles(store) {
  const summary = store.get('summary', {});
  const trajectory = summary.trajectory || {};
  const counted = store.get('objects', []).filter((object) => object.state === 'mapped').length;
  const landmarks = at(summary, 'map', 'landmarks') ?? at(store.get('landmarks'), 'total')
    ?? (at(store.get('landmarks'), 'position', 'length') || 0) / 3;
  const poses = [trajectory.coverage, isNumber(trajectory.coverage)];
  return [
    isNumber(trajectory.ate_rmse_m) ? tile(`ATE (${trajectory.alignment})`,
      ...length(trajectory.ate_rmse_m, 'm'), 'good') : null,
    poses[1] ? tile('with a pose', number(100 * poses[0], poses[0] === 1 ? 0 : 1),
      '%', poses[0] < 0.9 ? 'bad' : '') : null,
    counted > 0 || summary.objects ? tile('objects', whole(counted)) : null,
    isNumber(at(summary, 'objects', 'siou_mean')) ? tile('mask overlap',
      number(summary.objects.siou_mean)) : null,
    tile('keyframes', whole(at(summary, 'map', 'keyframes')
      ?? store.get('keyframes', { time: [] }).time.length)),
    landmarks > 0 ? tile('landmarks', whole(landmarks)) : null,
    isNumber(at(summary, 'map', 'loops')) && summary.map.keyframes > 0
      && summary.map.landmarks > 0 ? tile('loops closed', whole(summary.map.loops)) : null,
    at(summary, 'timing', 'frames_per_second') > 0 ? tile('frames/s',
      number(summary.timing.frames_per_second, 1)) : null,
    at(summary, 'memory', 'peak_mb') > 0 ? tile('memory', whole(summary.memory.peak_mb),
      'MB') : null].filter((entry) => entry);
}

function section(title, content, isWide = false) {
  return html('section', { class: `panel${isWide ? ' wide' : ''}` }, html('h2', {}, title), content);
}

function table(columns, rows) {
  return html('div', { class: 'scroll' }, html('table', {}, html('thead', {}, html('tr', {},
    columns.map((column) => html('th', { class: column.isText ? 'text' : '' }, column.title)))),
  html('tbody', {}, rows.map((row) => html('tr', { class: row.onclick ? 'link' : '',
    onclick: row.onclick || (() => {}) }, row.cells.map((cell, i) => html('td', {
    class: columns[i].isText ? 'text' : '' }, cell)))))));
}

function objectTable(store, onChoose) {
  const objects = [...store.get('objects', [])].sort((a, b) => (a.state === b.state
    ? (b.quality || 0) - (a.quality || 0) : a.state === 'mapped' ? -1 : 1));
  const columns = [{ title: 'Object', isText: true }, { title: 'State', isText: true },
    { title: 'Quality' }, { title: 'Size' },
    { title: 'Not determined', isText: true }, { title: 'Views' }, { title: 'Angle' },
    { title: 'Overlap' }, { title: 'Misfit' }];
  return table(columns, objects.map((object) => ({ onclick: () => onChoose(object.id), cells: [
    html('span', {}, html('i', { class: 'swatch', style: `background:${colourOfClass(object.class)};`
      + 'margin-right:8px' }), `${object.name || object.class} ${object.id}`),
    object.state === 'mapped' ? 'mapped'
      : `not mapped${object.reason ? `: ${words(object.reason)}` : ''}`,
    number(object.quality), sizeText(object, store.unit()), freeText(object) || '–',
    String(object.observations),
    isNumber(object.parallax_deg) ? `${object.parallax_deg.toFixed(0)}°` : '–',
    number(object.siou), `${number(object.misfit_px, 1)} px`] })));
}

// What has changed since the earlier sessions, the departures first.
function changeTable(store, onChoose) {
  const kinds = ['gone', 'moved', 'new', 'seen_again', 'not_seen', 'first_seen'];
  const at = (located) => (located ? located.centre.map((value) => value.toFixed(2)).join(', ') : '–');
  const changes = [...store.get('changes', [])].sort((a, b) => kinds.indexOf(a.change)
    - kinds.indexOf(b.change));
  const columns = [{ title: 'Object', isText: true }, { title: 'Change', isText: true },
    { title: 'Before', isText: true }, { title: 'Now', isText: true }, { title: 'Found in' }];
  return table(columns, changes.map((changed) => ({
    onclick: changed.now ? () => onChoose(changed.now.id) : undefined,
    cells: [`${changed.class} ${(changed.now || changed.former).id}`, words(changed.change),
      at(changed.former), at(changed.now), `${changed.found} of ${changed.expected}`] })));
}

function rejections(summary) {
  const counts = Object.entries(at(summary, 'objects', 'rejections') || {})
    .filter((entry) => isNumber(entry[1]) && entry[1] > 0).sort((a, b) => b[1] - a[1]);
  return counts.length > 0 ? bars(counts.map(([name, value]) => ({ name: words(name), value,
    text: whole(value) })), 'var(--warm)') : html('p', { class: 'hint' }, 'Nothing was rejected.');
}

function timing(summary) {
  const stages = Object.entries(at(summary, 'timing', 'stages_ms') || {})
    .filter((entry) => entry[1] && isNumber(entry[1].median))
    .sort((a, b) => b[1].median - a[1].median);
  // A final bundle adjustment takes a thousand times as long as a step of tracking, so the bars are
  // logarithmic. The shortest one has a tenth of the length.
  const logs = stages.map(([, value]) => Math.log(Math.max(value.median, 1e-3)));
  const [most, least] = [Math.max(...logs), Math.min(...logs)];
  const lengthOf = (log) => (most > least ? 0.1 + 0.9 * (log - least) / (most - least) : 1);
  return [html('p', { class: 'hint' }, `${seconds(at(summary, 'timing', 'total_s'))} in all; a frame`
    + ` takes ${number(at(summary, 'timing', 'track_ms', 'median'), 1)} ms (median), `
    + `${number(at(summary, 'timing', 'track_ms', 'p95'), 1)} ms (95 %). Medians of the stages, on a logarithmic scale:`),
  bars(stages.map(([name, value], i) => ({ name: words(name), value: lengthOf(logs[i]),
    text: milliseconds(value.median) })), 'var(--accent)')];
}

function losses(store) {
  return table([{ title: 'From' }, { title: 'To' }, { title: 'Frames' },
    { title: 'Reason', isText: true }], store.get('losses', []).map((loss) => ({ cells: [
    seconds(loss.from), seconds(loss.to), whole(loss.frames), loss.reason] })));
}

function settings(store) {
  const { changed, from } = store.get('settings', { changed: [], from: '' });
  return [html('p', { class: 'hint' }, from), changed.length === 0 ? null
    : table([{ title: 'Setting', isText: true }, { title: 'Value' },
      { title: 'Default' }], changed.map((entry) => ({ cells: [entry.key, entry.value,
      entry.default] })))];
}

function provenance(summary) {
  const rows = Object.entries(summary.provenance || {}).filter(([, value]) => value !== null
    && typeof value !== 'object');
  return facts(rows.map(([key, value]) => [words(key), String(value)]));
}

export function sections(store, onChoose, onTime) {
  const summary = store.get('summary', {});
  const list = [];
  if (store.get('images', []).length > 0) {
    list.push(section(stripTitle(store), strip(store, onTime), true));
  }
  if (store.get('objects', []).length > 0) {
    list.push(section('Objects', objectTable(store, onChoose), true));
  }
  if (store.get('changes', []).length > 0) {
    const map = at(summary, 'provenance', 'loaded_map');
    list.push(section(`Changes since ${map ? `the map ${map}` : 'the earlier sessions'}`,
      changeTable(store, onChoose), true));
  }
  if (Object.keys(at(summary, 'timing', 'stages_ms') || {}).length > 0) {
    list.push(section('Time', timing(summary)));
  }
  if (summary.objects) {
    list.push(section('Rejected masks and shapes', rejections(summary)));
  }
  if (store.get('losses', []).length > 0) {
    list.push(section('Frames without a pose', losses(store)));
  }
  if (store.get('settings')) {
    list.push(section('Settings that differ from the default', settings(store)));
  }
  if (summary.provenance) {
    list.push(section('Where it comes from', provenance(summary)));
  }
  return list;
}
