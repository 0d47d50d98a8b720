// Colour scales.
const STOPS = {
  // without the dark ends, which a dark ground would swallow
  scale: ['#2f7bff', '#18b6f2', '#22dfb8', '#8ff05f', '#ffe14d', '#ff9d4a', '#ff6b6b'],
  // the same hues for a light ground
  scaleLight: ['#1740b8', '#0b6fc2', '#00857f', '#2b7d1e', '#8a6d00', '#b84a00', '#b3152f'],
  // small is calm, large is loud
  residual: ['#2f8ee0', '#7fb7d9', '#e8d36a', '#f5953a', '#ee3d3d'],
  residualLight: ['#1f62b5', '#4f86a8', '#a08a10', '#c8601a', '#c01818'],
  map: ['#334155', '#43546a', '#64788f', '#8b9db0', '#b3c0cd'],
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
