// Writes MCAP files with the npm package @mcap/core: node write_mcap.cjs NODE_MODULES FOLDER.
// Each has 5 PointCloud2 messages in CDR, 0.1 s apart; point k of message i is (i + 0.5, k, -k) with t = 10000000 k ns.
const fs = require("fs");
const path = require("path");
const [modules, folder] = process.argv.slice(2);
const load = (name) => require(require.resolve(name, { paths: [path.dirname(path.resolve(modules))] }));
const { McapWriter } = load("@mcap/core");
const zstd = load("@foxglove/wasm-zstd");
const lz4 = load("lz4js");

class Cdr {
  constructor() {
    this.bytes = [0, 1, 0, 0];
  }
  align(size) {
    while ((this.bytes.length - 4) % size !== 0) this.bytes.push(0);
    return this;
  }
  u8(value) {
    this.bytes.push(value);
    return this;
  }
  u32(value) {
    this.align(4);
    const view = new DataView(new ArrayBuffer(4));
    view.setUint32(0, value, true);
    this.bytes.push(...new Uint8Array(view.buffer));
    return this;
  }
  string(value) {
    this.u32(value.length + 1);
    this.bytes.push(...Buffer.from(value + "\0"));
    return this;
  }
}

function cloud(i) {
  const points = 10;
  const data = new DataView(new ArrayBuffer(16 * points));
  for (let k = 0; k < points; ++k) {
    data.setFloat32(16 * k, i + 0.5, true);
    data.setFloat32(16 * k + 4, k, true);
    data.setFloat32(16 * k + 8, -k, true);
    data.setUint32(16 * k + 12, 10000000 * k, true);
  }
  const cdr = new Cdr().u32(1700000000).u32(100000000 * i).string("os_sensor").u32(1).u32(points).u32(4);
  cdr.string("x").u32(0).u8(7).u32(1).string("y").u32(4).u8(7).u32(1).string("z").u32(8).u8(7).u32(1);
  cdr.string("t").u32(12).u8(6).u32(1).u8(0).u32(16).u32(16 * points).u32(16 * points);
  cdr.bytes.push(...new Uint8Array(data.buffer));
  return Uint8Array.from(cdr.u8(1).bytes);
}

async function write(name, options) {
  const chunks = [];
  let size = 0n;
  const writable = {
    position: () => size,
    write: async (bytes) => {
      chunks.push(Buffer.from(bytes));
      size += BigInt(bytes.byteLength);
    },
  };
  const writer = new McapWriter({ writable, ...options });
  await writer.start({ profile: "ros2", library: "test" });
  const schemaId = await writer.registerSchema({
    name: "sensor_msgs/msg/PointCloud2", encoding: "ros2msg", data: new Uint8Array(),
  });
  const channelId = await writer.registerChannel({
    topic: "/points", schemaId, messageEncoding: "cdr", metadata: new Map([["offered_qos_profiles", ""]]),
  });
  for (let i = 0; i < 5; ++i) {
    const time = 1700000000000000000n + 100000000n * BigInt(i);
    await writer.addMessage({ channelId, sequence: i, logTime: time, publishTime: time, data: cloud(i) });
  }
  await writer.end();
  fs.writeFileSync(path.join(folder, name), Buffer.concat(chunks));
}

async function main() {
  await zstd.isLoaded;
  const by = (compression, compress) => (data) => ({ compression, compressedData: compress(data) });
  await write("none.mcap", { useChunks: true, chunkSize: 500 });
  await write("unchunked.mcap", { useChunks: false });
  await write("no_index.mcap", { useChunks: true, useChunkIndex: false, useStatistics: false, repeatChannels: false });
  await write("zstd.mcap", { useChunks: true, chunkSize: 500, compressChunk: by("zstd", (data) => zstd.compress(data)) });
  await write("lz4.mcap", {
    useChunks: true, chunkSize: 500, compressChunk: by("lz4", (data) => Uint8Array.from(lz4.compress(data))),
  });
}

main().catch((error) => {
  console.error(error);
  process.exit(1);
});
