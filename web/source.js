// SPDX-License-Identifier: GPL-3.0-or-later
// Where the messages come from. The report has one message inside the page. In the live view that
// message names a stream of further ones.

export function embeddedMessage() {
  const text = document.getElementById('hullslam-data').textContent.trim();
  return text === '' ? null : JSON.parse(text);
}

// What the address of the page says about the token, without which the run cannot be controlled.
export function tokenOfPage() {
  return new URLSearchParams(window.location.search).get('token') || '';
}

// Gives the messages of a stream to `onMessage`, and to `onState` whether it is connected. The
// browser connects again by itself. Returns a function that ends the stream.
export function openStream(path, onMessage, onState) {
  const source = new EventSource(`${path}?token=${encodeURIComponent(tokenOfPage())}`);
  source.onopen = () => onState(true);
  source.onerror = () => onState(false);
  source.onmessage = (event) => onMessage(JSON.parse(event.data));
  return () => source.close();
}

// Sends a command to the run. Returns what the run answers; throws an error if it refuses.
export async function sendCommand(name) {
  const reply = await fetch(`control/${name}`, { method: 'POST',
    headers: { 'X-Hullslam-Token': tokenOfPage() } });
  const text = (await reply.text()).trim();
  if (!reply.ok) {
    throw new Error(text);
  }
  return text;
}
