// Frames of src/view/frames.md, version 1. Everything is little endian.
export const VERSION = 1;
const RECORD_BYTES = 216;

class FrameError extends Error {}

function need(view, bytes) {
  if (view.byteLength < bytes) throw new FrameError(`frame of ${view.byteLength} bytes, ${bytes} needed`);
}

function floats(view, offset, count) {
  return Array.from({ length: count }, (_, i) => view.getFloat32(offset + 4 * i, true));
}

function record(view, at) {
  return {
    index: view.getUint32(at, true),
    status: view.getUint8(at + 4),
    source: view.getUint8(at + 5),
    reason: view.getUint8(at + 6),
    coarseRan: (view.getUint8(at + 7) & 1) !== 0,
    converged: (view.getUint8(at + 7) & 2) !== 0,
    hasTruth: (view.getUint8(at + 7) & 4) !== 0,
    fullCovariance: (view.getUint8(at + 7) & 8) !== 0,
    stampNs: view.getBigInt64(at + 8, true),
    position: [0, 8, 16].map((o) => view.getFloat64(at + 16 + o, true)),
    rotation: floats(view, at + 40, 4),
    truth: floats(view, at + 56, 3),
    sigmaTh: view.getFloat32(at + 68, true),
    inlierRatio: view.getFloat32(at + 72, true),
    inliers: view.getUint32(at + 76, true),
    iterations: view.getUint16(at + 80, true),
    coarseIterations: view.getUint16(at + 82, true),
    residual: view.getFloat32(at + 84, true),
    ms: floats(view, at + 88, 5),
    speed: view.getFloat32(at + 108, true),
    turn: view.getFloat32(at + 112, true),
    mapScore: view.getFloat32(at + 116, true),
    predictionScore: view.getFloat32(at + 120, true),
    eigenvalues: floats(view, at + 124, 6),
    covariance: floats(view, at + 148, 6),
    evidence: floats(view, at + 172, 6),
    sigmaRotation: floats(view, at + 196, 3),
    pointsIn: view.getUint32(at + 208, true),
    mapVoxels: view.getUint32(at + 212, true),
  };
}

function records(view, count) {
  need(view, 16 + count * RECORD_BYTES);
  const list = [];
  for (let i = 0; i < count; ++i) list.push(record(view, 16 + i * RECORD_BYTES));
  return { type: 'records', first: view.getUint32(8, true), list };
}

function map(view, flags, count) {
  need(view, 48 + 8 * count);
  return {
    type: 'map',
    begins: (flags & 1) !== 0,
    origin: [8, 16, 24].map((o) => view.getFloat64(o, true)),
    scale: view.getFloat32(32, true),
    voxel: view.getFloat32(36, true),
    first: view.getUint32(40, true),
    count,
    positions: new Int16Array(view.buffer, 48, 4 * count), // x y z, sweep − first
  };
}

function sweep(view, flags, count) {
  const columns = [1, 2, 4].filter((bit) => flags & bit).length;
  need(view, 40 + (6 + columns) * count);
  const frame = {
    type: 'sweep',
    number: view.getUint32(8, true),
    scale: view.getFloat32(12, true),
    intensitySpan: floats(view, 16, 2),
    residualMost: view.getFloat32(24, true),
    timeSpan: floats(view, 28, 2),
    count,
    positions: new Int16Array(view.buffer, 40, 3 * count),
    intensity: null,
    residual: null,
    time: null,
  };
  let at = 40 + 6 * count;
  for (const [bit, name] of [[1, 'intensity'], [2, 'residual'], [4, 'time']]) {
    if (!(flags & bit)) continue;
    frame[name] = new Uint8Array(view.buffer, at, count);
    at += count;
  }
  return frame;
}

/// An ArrayBuffer as an object with a `type`. Throws when it is not a frame of this version.
export function parseFrame(buffer) {
  const view = new DataView(buffer);
  need(view, 8);
  if (view.getUint8(1) !== VERSION) throw new FrameError(`protocol version ${view.getUint8(1)}, this page has ${VERSION}`);
  const flags = view.getUint16(2, true);
  const count = view.getUint32(4, true);
  switch (view.getUint8(0)) {
    case 1:
      need(view, 8 + count);
      return { type: 'info', ...JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 8, count))) };
    case 2:
      return records(view, count);
    case 3:
      return map(view, flags, count);
    case 4:
      return sweep(view, flags, count);
    case 5:
      need(view, 24);
      return {
        type: 'progress',
        finished: (flags & 1) !== 0,
        sweeps: view.getUint32(8, true),
        total: view.getUint32(12, true),
        dropped: view.getUint32(16, true),
      };
    default:
      throw new FrameError(`unknown frame ${view.getUint8(0)}`);
  }
}

function request(op, value) {
  const view = new DataView(new ArrayBuffer(8));
  view.setUint8(0, op);
  view.setUint8(1, VERSION);
  view.setUint32(4, value, true);
  return view.buffer;
}

export const requestSweep = (number) => request(1, number);
export const requestFollow = (on) => request(2, on ? 1 : 0);
