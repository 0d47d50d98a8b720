// The map: blocks of points, each with the sweep it was first seen in, so that seeking is a number in the shader.
import {
  BufferAttribute, BufferGeometry, Color, DataTexture, DynamicDrawUsage, Group, Points, ShaderMaterial, Sphere, Vector3,
} from 'three';
import { table } from './colours.js';
import { colour, onTheme } from './theme.js';

const BLOCK = 16384;

// Points go to places of a block in this order: a part of the block is then a fair sample of it.
const ORDER = (() => {
  const order = Uint16Array.from({ length: BLOCK }, (_, i) => i);
  let seed = 12345;
  for (let i = BLOCK - 1; i > 0; --i) {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    const j = seed % (i + 1);
    [order[i], order[j]] = [order[j], order[i]];
  }
  return order;
})();

const VERTEX = `
attribute vec2 seen; // number of the sweep, height over the sensor then
uniform float shown, pixels, size, most, ratio;
uniform sampler2D scale;
uniform vec3 ground;
varying vec3 tint;
void main() {
  vec4 eye = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * eye;
  if (seen.x > shown) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = clamp(pixels * size / -eye.z, 1.2 * ratio, most * ratio);
  float level = clamp((seen.y + 2.2) / 10.0, 0.0, 1.0);
  tint = texture2D(scale, vec2(sqrt(level) * 0.99 + 0.005, 0.5)).rgb;
  tint = mix(tint, ground, 0.75 * smoothstep(70.0, 320.0, -eye.z)); // the air between
}`;
const FRAGMENT = `
varying vec3 tint;
void main() { gl_FragColor = vec4(tint, 1.0); }`;

class Block {
  constructor(origin, material) {
    this.used = 0;
    this.first = Infinity;
    this.origin = origin;
    this.positions = new BufferAttribute(new Float32Array(3 * BLOCK), 3).setUsage(DynamicDrawUsage);
    this.seen = new BufferAttribute(new Float32Array(2 * BLOCK).fill(1e9), 2).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.positions);
    geometry.setAttribute('seen', this.seen);
    geometry.boundingSphere = new Sphere(new Vector3(), 0);
    this.points = new Points(geometry, material);
    this.points.position.fromArray(origin);
  }

  add(x, y, z, number, height) {
    const place = ORDER[this.used++];
    this.positions.setXYZ(place, x, y, z);
    this.seen.setXY(place, number, height);
    this.first = Math.min(this.first, number);
    const sphere = this.points.geometry.boundingSphere;
    sphere.radius = Math.max(sphere.radius, Math.hypot(x, y, z));
  }
}

export class MapLayer {
  constructor(stage) {
    this.stage = stage;
    this.group = new Group();
    this.blocks = [];
    this.count = 0;
    this.share = 1;
    this.shown = 0;
    this.texture = new DataTexture(table('map'), 256, 1);
    this.material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { shown: { value: 0 }, pixels: { value: 1 }, size: { value: 0.2 }, most: { value: 2.4 }, ratio: { value: 1 },
        scale: { value: this.texture }, ground: { value: new Color() } },
    });
    stage.scene.add(this.group);
    onTheme((light) => {
      this.texture.image.data.set(table(light ? 'mapLight' : 'map'));
      this.texture.needsUpdate = true;
      this.material.uniforms.ground.value.set(colour('ground')).convertLinearToSRGB();
      stage.dirty = true;
    });
  }

  clear() {
    this.blocks.forEach((block) => block.points.geometry.dispose());
    this.group.clear();
    this.blocks = [];
    this.count = 0;
  }

  add(frame, records) {
    if (frame.begins) this.clear();
    const { positions, scale, origin } = frame;
    this.material.uniforms.size.value = frame.voxel * 0.9;
    let block = this.blocks.at(-1);
    for (let i = 0; i < frame.count; ++i) {
      if (!block || block.used === BLOCK) block = this.begin(origin);
      const number = frame.first + (positions[4 * i + 3] & 0xffff);
      const x = origin[0] - block.origin[0] + positions[4 * i] * scale;
      const y = origin[1] - block.origin[1] + positions[4 * i + 1] * scale;
      const z = origin[2] - block.origin[2] + positions[4 * i + 2] * scale;
      block.add(x, y, z, number, z + block.origin[2] - (records[number]?.position[2] ?? 0));
      block.positions.needsUpdate = true;
      block.seen.needsUpdate = true;
    }
    this.count += frame.count;
    this.stage.dirty = true;
  }

  begin(origin) {
    const block = new Block(origin, this.material);
    this.blocks.push(block);
    this.group.add(block.points);
    return block;
  }

  /// The map as it was at that sweep.
  show(number) {
    this.shown = number;
    this.material.uniforms.shown.value = number + 0.5;
    this.stage.dirty = true;
  }

  /// Before drawing: skips what is not there yet, and a part of the rest where time is short.
  prepare(pixels, ratio) {
    this.material.uniforms.pixels.value = pixels;
    this.material.uniforms.ratio.value = ratio;
    let drawn = 0;
    for (const block of this.blocks) {
      block.points.visible = block.first <= this.shown;
      const count = Math.ceil(BLOCK * this.share);
      block.points.geometry.setDrawRange(0, count);
      if (block.points.visible) drawn += Math.round(block.used * this.share);
    }
    return this.group.visible ? drawn : 0;
  }
}
