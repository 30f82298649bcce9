// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and elements of the page. Texts of the data only become text nodes, never HTML.

const SVG = 'http://www.w3.org/2000/svg';

function fill(element, attributes, children) {
  for (const [key, value] of Object.entries(attributes || {})) {
    if (key.startsWith('on')) {
      element.addEventListener(key.slice(2), value);
    } else if (value === true) {
      element.setAttribute(key, '');
    } else if (value !== false && value !== null && value !== undefined) {
      element.setAttribute(key, value);
    }
  }
  for (const child of children.flat(Infinity)) {
    if (child !== null && child !== undefined) {
      element.append(child);
    }
  }
  return element;
}

export function html(name, attributes, ...children) {
  return fill(document.createElement(name), attributes, children);
}

export function svg(name, attributes, ...children) {
  return fill(document.createElementNS(SVG, name), attributes, children);
}

export function isNumber(value) {
  return typeof value === 'number' && Number.isFinite(value);
}

export function number(value, digits = 2) {
  return isNumber(value) ? value.toFixed(digits) : '–';
}

// Short times have two digits that say something, such as 0.034 ms.
export function milliseconds(value) {
  return isNumber(value) && value > 0 && value < 0.1 ? `${Number(value.toPrecision(2))} ms`
    : `${number(value, 1)} ms`;
}

export function whole(value) {
  return isNumber(value) ? String(Math.round(value)).replace(/\B(?=(\d{3})+$)/g, '\u202f') : '–';
}

// A length in metres as [number, unit]: 0.0093 m is 9.3 mm. Units of a map stay as they are.
export function length(value, unit) {
  if (!isNumber(value)) {
    return ['–', ''];
  }
  if (unit !== 'm') {
    return [value.toFixed(3), unit];
  }
  if (Math.abs(value) < 0.1) {
    return [(value * 1000).toFixed(1), 'mm'];
  }
  return Math.abs(value) < 1 ? [(value * 100).toFixed(1), 'cm'] : [value.toFixed(2), 'm'];
}

export function seconds(value) {
  if (!isNumber(value)) {
    return '–';
  }
  const minutes = Math.floor(value / 60);
  return minutes > 0 ? `${minutes}:${(value - 60 * minutes).toFixed(1).padStart(4, '0')}`
    : `${value.toFixed(2)} s`;
}

// "few_views" as people write it.
export function words(text) {
  return String(text).replaceAll('_', ' ');
}
