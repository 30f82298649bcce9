// SPDX-License-Identifier: GPL-3.0-or-later
// Where the messages come from. The report has one message inside the page.

export function embeddedMessage() {
  const text = document.getElementById('hullslam-data').textContent.trim();
  return text === '' ? null : JSON.parse(text);
}
