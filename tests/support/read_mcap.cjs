// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an MCAP file of ROS 2 through its index, with the libraries of Foxglove, and prints what is
// in it as JSON: the numbers of messages, the checksums and messages of some topics. `node
// read_mcap.cjs FILE NODE_MODULES`
"use strict";

const fs = require("node:fs/promises");
const { createRequire } = require("node:module");
const path = require("node:path");

const [file, modules] = process.argv.slice(2);
const load = createRequire(path.resolve(modules, "..", "index.js"));
const { McapIndexedReader } = load("@mcap/core");
const { loadDecompressHandlers } = load("@mcap/support");
const { parse } = load("@foxglove/rosmsg");
const { MessageReader } = load("@foxglove/rosmsg2-serialization");

// Images as base64, other lists of bytes as lists.
function toJson(key, value) {
  if (typeof value === "bigint") return Number(value);
  if (value instanceof Uint8Array) return Buffer.from(value).toString("base64");
  return ArrayBuffer.isView(value) ? Array.from(value) : value;
}

async function main() {
  const handle = await fs.open(file, "r");
  const readable = {
    size: async () => BigInt((await handle.stat()).size),
    read: async (offset, size) => {
      const bytes = new Uint8Array(Number(size));
      await handle.read(bytes, 0, bytes.length, Number(offset));
      return bytes;
    },
  };
  const reader = await McapIndexedReader.Initialize({
    readable,
    decompressHandlers: await loadDecompressHandlers(),
  });
  const topics = {};
  for await (const message of reader.readMessages()) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    const topic = (topics[channel.topic] ??= { type: schema.name, count: 0, times: [], messages: [] });
    topic.reader ??= new MessageReader(parse(new TextDecoder().decode(schema.data), { ros2: true }));
    const decoded = topic.reader.readMessage(message.data);
    topic.count += 1;
    topic.times.push(message.logTime);
    // One image is enough.
    if (!channel.topic.includes("image") || topic.count === 1) topic.messages.push(decoded);
  }
  for (const topic of Object.values(topics)) delete topic.reader;
  const statistics = reader.statistics;
  const result = {
    profile: reader.header.profile,
    chunks: reader.chunkIndexes.length,
    messages: statistics.messageCount,
    start: statistics.messageStartTime,
    end: statistics.messageEndTime,
    topics,
  };
  process.stdout.write(JSON.stringify(result, toJson));
  await handle.close();
}

main().catch((error) => {
  process.stderr.write(`${error.stack}\n`);
  process.exitCode = 1;
});
