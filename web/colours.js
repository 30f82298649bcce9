// SPDX-License-Identifier: GPL-3.0-or-later
// One colour per class of the run, and the colours of the theme.

// Hues in an order in which neighbours differ a lot; further classes get them with another
// lightness.
const HUES = [168, 32, 212, 345, 268, 88, 190, 12, 300, 54, 235, 135];

export class ClassColours {
  constructor() {
    this.hues = new Map();
  }

  update(objects) {
    for (const label of [...new Set(objects.map((object) => object.class))].sort()) {
      if (!this.hues.has(label)) {
        this.hues.set(label, this.hues.size);
      }
    }
  }

  of(label) {
    const index = this.hues.get(label) || 0;
    const light = document.documentElement.dataset.theme === 'light';
    const step = Math.floor(index / HUES.length) % 3;
    const lightness = (light ? 42 : 64) + (light ? 9 : -11) * step;
    return `hsl(${HUES[index % HUES.length]}, ${light ? 72 : 68}%, ${lightness}%)`;
  }
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
