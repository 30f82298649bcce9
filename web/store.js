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
