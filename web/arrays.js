// SPDX-License-Identifier: GPL-3.0-or-later
// Decodes the values of a message (docs/live_view.md): an object with the only key f32, u32 or u8
// is an array of numbers in base64, least significant byte first.

const KINDS = { f32: Float32Array, u32: Uint32Array, u8: Uint8Array };

export function decodeArray(kind, text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) {
    bytes[i] = binary.charCodeAt(i);
  }
  return kind === 'u8' ? bytes : new KINDS[kind](bytes.buffer);
}

export function decode(value) {
  if (Array.isArray(value)) {
    return value.map(decode);
  }
  if (value === null || typeof value !== 'object') {
    return value;
  }
  const keys = Object.keys(value);
  if (keys.length === 1 && keys[0] in KINDS && typeof value[keys[0]] === 'string') {
    return decodeArray(keys[0], value[keys[0]]);
  }
  return Object.fromEntries(keys.map((key) => [key, decode(value[key])]));
}

export function isTyped(value) {
  return ArrayBuffer.isView(value);
}

export function joinTyped(first, second) {
  const joined = new first.constructor(first.length + second.length);
  joined.set(first);
  joined.set(second, first.length);
  return joined;
}
