// SPDX-License-Identifier: GPL-3.0-or-later
// The data that the page shows. Every source (the data in this file, or a stream of a run that is
// still going on) gives messages, and apply() takes them one after the other.
import { decode, isTyped, joinTyped } from './arrays.js';

export const VERSION = 1;

// Appends a part of a message to the same part of the store: arrays are joined, and entries of
// lists that have an id replace the entry with the same id.
function append(old, more) {
  if (old === undefined || old === null) {
    return more;
  }
  if (isTyped(old)) {
    return joinTyped(old, more);
  }
  if (Array.isArray(old)) {
    const fresh = new Map(more.filter((entry) => entry && entry.id !== undefined)
      .map((entry) => [entry.id, entry]));
    return old.filter((entry) => !(entry && fresh.has(entry.id))).concat(more);
  }
  if (typeof old === 'object') {
    const joined = { ...old };
    for (const [key, value] of Object.entries(more)) {
      joined[key] = append(old[key], value);
    }
    return joined;
  }
  return more;
}

// Changes rows of a table whose columns are arrays: `at` are the numbers of the changed rows, and
// `count` is how many rows there are afterwards. The other keys are the columns of these rows.
function patchTable(old, patch) {
  const { count, at, ...columns } = patch;
  const table = { ...old };
  for (const [name, values] of Object.entries(columns)) {
    const before = table[name] || new values.constructor(0);
    const width = at.length > 0 ? values.length / at.length
      : before.length / Math.max(1, rowCount(old));
    const column = new values.constructor(count * width);
    column.set(before.subarray(0, Math.min(before.length, column.length)));
    at.forEach((row, i) => {
      column.set(values.subarray(i * width, (i + 1) * width), row * width);
    });
    table[name] = column;
  }
  return table;
}

// The rows of a table are counted by its column with one number per row.
function rowCount(table) {
  const column = table && (table.age || table.time);
  return column ? column.length : 0;
}

export class Store {
  constructor() {
    this.parts = {};
    this.listeners = [];
  }

  // `listener(changed)` is called after each message with the set of the names of changed parts.
  listen(listener) {
    this.listeners.push(listener);
  }

  apply(message) {
    if (!message || message.view !== VERSION) {
      throw new Error(`the data has version ${message && message.view}, expected ${VERSION}`);
    }
    const changed = new Set();
    for (const [name, value] of Object.entries(message.set || {})) {
      this.parts[name] = decode(value);
      changed.add(name);
    }
    for (const [name, value] of Object.entries(message.patch || {})) {
      this.parts[name] = patchTable(this.parts[name], decode(value));
      changed.add(name);
    }
    for (const [name, value] of Object.entries(message.add || {})) {
      this.parts[name] = append(this.parts[name], decode(value));
      changed.add(name);
    }
    for (const listener of this.listeners) {
      listener(changed);
    }
  }

  // The part with this name, or `other` if no message had it.
  get(name, other = null) {
    const value = this.parts[name];
    return value === undefined || value === null ? other : value;
  }

  // The unit of length for texts: "m", or "u" for a map whose unit is unknown.
  unit() {
    return this.get('run', {}).unit || 'm';
  }
}
