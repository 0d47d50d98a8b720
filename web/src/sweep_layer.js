// The current sweep, coloured.
import { BufferAttribute, BufferGeometry, DataTexture, Points, ShaderMaterial } from 'three';
import { table } from './colours.js';
import { isLight, onTheme } from './theme.js';

const VERTEX = `
attribute float level; // −1: none
uniform float pixels, size, ratio;
uniform sampler2D scale;
uniform vec3 none;
varying vec3 tint;
void main() {
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * eye;
  gl_PointSize = clamp(pixels * size / -eye.z, 2.2 * ratio, 5.0 * ratio);
  tint = level < 0.0 ? none : texture2D(scale, vec2(level * 0.99 + 0.005, 0.5)).rgb;
}`;
const FRAGMENT = `
varying vec3 tint;
void main() {
  if (length(gl_PointCoord - 0.5) > 0.5) discard;
  gl_FragColor = vec4(tint, 1.0);
}`;

const HEIGHT = [-2, 6]; // m over the sensor
const metres = (value) => `${value.toFixed(value < 1 ? 2 : 0)} m`;

export class SweepLayer {
  constructor(stage) {
    this.stage = stage;
    this.mode = 'height';
    this.frame = null;
    this.texture = new DataTexture(table('scale'), 256, 1);
    this.material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { pixels: { value: 1 }, size: { value: 0.16 }, ratio: { value: 1 }, scale: { value: this.texture },
        none: { value: [0.5, 0.5, 0.5] } },
    });
    this.points = new Points(new BufferGeometry(), this.material);
    this.points.frustumCulled = false;
    this.points.visible = false;
    stage.scene.add(this.points);
    onTheme(() => this.colour());
  }

  /// What this sweep can be coloured by.
  has(mode) {
    return mode === 'height' || Boolean(this.frame?.[mode]);
  }

  clear() {
    this.frame = null;
    this.points.visible = false;
  }

  take(frame, record) {
    this.frame = frame;
    const positions = new Float32Array(3 * frame.count);
    for (let i = 0; i < positions.length; ++i) positions[i] = frame.positions[i] * frame.scale;
    this.points.geometry.dispose();
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(positions, 3));
    geometry.setAttribute('level', new BufferAttribute(new Float32Array(frame.count), 1));
    this.points.geometry = geometry;
    this.points.position.fromArray(record.position);
    this.points.quaternion.fromArray(record.rotation).normalize();
    this.points.visible = true;
    this.colour();
  }

  setMode(mode) {
    this.mode = mode;
    this.colour();
  }

  /// Ends of the scale, as text.
  get span() {
    const frame = this.frame;
    if (!frame || !this.has(this.mode)) return [`no ${this.mode} in this sweep`, ''];
    if (this.mode === 'intensity') return frame.intensitySpan.map((value) => value.toPrecision(3));
    if (this.mode === 'residual') return ['0', `≥ ${metres(frame.residualMost)}`];
    if (this.mode === 'time') return frame.timeSpan.map((value) => `${(1000 * value).toFixed(0)} ms`);
    return HEIGHT.map((value) => `${value > 0 ? '+' : '−'}${metres(Math.abs(value))}`);
  }

  colour() {
    const name = this.mode === 'residual' ? 'residual' : 'scale';
    this.texture.image.data.set(table(isLight() ? `${name}Light` : name));
    this.texture.needsUpdate = true;
    this.material.uniforms.none.value = isLight() ? [0.62, 0.66, 0.7] : [0.34, 0.38, 0.43];
    this.stage.dirty = true;
    if (!this.frame) return;
    const level = this.points.geometry.getAttribute('level');
    const column = this.mode === 'height' ? null : this.frame[this.mode];
    for (let i = 0; i < this.frame.count; ++i) {
      if (column) level.array[i] = this.mode === 'residual' ? (column[i] - 1) / 254 : column[i] / 255;
      else if (this.mode === 'height') {
        const z = this.frame.positions[3 * i + 2] * this.frame.scale;
        level.array[i] = Math.sqrt(Math.min(1, Math.max(0, (z - HEIGHT[0]) / (HEIGHT[1] - HEIGHT[0]))));
      } else level.array[i] = -1;
    }
    level.needsUpdate = true;
  }

  prepare(pixels, ratio) {
    this.material.uniforms.pixels.value = pixels;
    this.material.uniforms.ratio.value = ratio;
    return this.points.visible ? this.frame?.count ?? 0 : 0;
  }
}
