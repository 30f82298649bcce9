// SPDX-License-Identifier: GPL-3.0-or-later
// The colours of classes and of the theme.

// The hue of a class in degrees. It depends on the name alone and is as in objects.ply, so a class
// has the same colour in the live view, in the report and in files. The hash is FNV-1a of 32 bits
// over the name in UTF-8, as ColourOfClass() of the library computes it.
function hueOf(label) {
  let hash = 2166136261;
  for (const byte of new TextEncoder().encode(label)) {
    hash = Math.imul(hash ^ byte, 16777619) >>> 0;
  }
  return (hash >>> 16) % 360;
}

export function colourOfClass(label) {
  const light = document.documentElement.dataset.theme === 'light';
  return `hsl(${hueOf(label)}, ${light ? 72 : 68}%, ${light ? 42 : 64}%)`;
}

export function themeColour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

// From dark violet over teal to yellow, for shares from 0 to 1.
const RAMP = [[0.35, 0.24, 0.62], [0.20, 0.48, 0.74], [0.16, 0.68, 0.58], [0.62, 0.79, 0.30],
  [0.96, 0.76, 0.22]];

export function ramp(share) {
  const at = Math.min(Math.max(share, 0), 1) * (RAMP.length - 1);
  const low = Math.min(Math.floor(at), RAMP.length - 2);
  return RAMP[low].map((value, i) => value + (RAMP[low + 1][i] - value) * (at - low));
}

// The ramp as an image of CSS, from left to right.
export function rampAsCss() {
  const colours = RAMP.map((colour) => `rgb(${colour.map((c) => Math.round(c * 255)).join(' ')})`);
  return `linear-gradient(90deg, ${colours.join(', ')})`;
}

export function bindTheme(button, onChange) {
  const media = window.matchMedia('(prefers-color-scheme: light)');
  const show = (theme) => {
    document.documentElement.dataset.theme = theme;
    button.textContent = theme === 'light' ? 'Dark' : 'Light';
    onChange();
  };
  let chosen = null;
  button.addEventListener('click', () => {
    chosen = document.documentElement.dataset.theme === 'light' ? 'dark' : 'light';
    show(chosen);
  });
  media.addEventListener('change', () => {
    if (!chosen) {
      show(media.matches ? 'light' : 'dark');
    }
  });
  show(media.matches ? 'light' : 'dark');
}
