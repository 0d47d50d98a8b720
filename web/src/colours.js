// Colour scales: equally perceptible steps, also for most colour-blind eyes.
const STOPS = {
  // dark to bright: viridis-like, without its darkest end, which a dark ground would swallow
  scale: ['#4c5bd4', '#2f8ee0', '#1fb8c4', '#35d08a', '#a6dd3b', '#fde64a'],
  // the same hues for a light ground
  scaleLight: ['#3b2f9e', '#1f62b5', '#087f8c', '#167a46', '#6d7a00', '#a35a00'],
  // small is calm, large is loud
  residual: ['#2f8ee0', '#7fb7d9', '#e8d36a', '#f5953a', '#ee3d3d'],
  residualLight: ['#1f62b5', '#4f86a8', '#a08a10', '#c8601a', '#c01818'],
  map: ['#3d4d61', '#50657d', '#71879e', '#95a8bb', '#b4c4d3'],
  mapLight: ['#b3bec9', '#97a6b4', '#7d8fa0', '#61758a', '#485d73'],
};

const parse = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255);

/// 256 RGBA colours of a scale.
export function table(name) {
  const stops = STOPS[name].map(parse);
  const bytes = new Uint8Array(256 * 4);
  for (let i = 0; i < 256; ++i) {
    const x = (i / 255) * (stops.length - 1);
    const k = Math.min(Math.floor(x), stops.length - 2);
    for (let c = 0; c < 3; ++c) bytes[4 * i + c] = Math.round(255 * (stops[k][c] + (x - k) * (stops[k + 1][c] - stops[k][c])));
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}
