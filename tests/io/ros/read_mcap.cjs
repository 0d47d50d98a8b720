// Reads an MCAP file through its index with the npm package @mcap/core, every checksum checked:
//   node read_mcap.cjs NODE_MODULES FILE [TOPIC COUNT]...
// Ends with 1 unless each topic has that many messages, in the order of their stamps, and a schema.
const fs = require("fs");
const path = require("path");
const [modules, file, ...expected] = process.argv.slice(2);
const load = (name) => require(require.resolve(name, { paths: [path.dirname(path.resolve(modules))] }));
const { McapIndexedReader } = load("@mcap/core");

async function main() {
  const bytes = fs.readFileSync(file);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + length))),
  };
  const reader = await McapIndexedReader.Initialize({ readable });
  const counts = {};
  let last = 0n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(channel.schemaId);
    if (message.logTime < last || schema.encoding !== "ros2msg" || schema.data.length === 0) process.exit(1);
    last = message.logTime;
    counts[channel.topic] = (counts[channel.topic] ?? 0) + 1;
  }
  for (let i = 0; i < expected.length; i += 2) {
    const count = counts[expected[i]] ?? 0;
    if (count !== Number(expected[i + 1]) || reader.statistics.messageCount === 0n) {
      console.error(`${expected[i]}: ${count} messages`);
      process.exit(1);
    }
  }
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
