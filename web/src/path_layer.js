// Trajectory, truth, and where the coarse stage chose the initial pose.
import { BufferAttribute, BufferGeometry, Color, Points, ShaderMaterial } from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import { colour, onTheme } from './theme.js';

/// A line of constant width on the screen that grows at its end and is drawn up to any of its points.
class Path {
  constructor(scene, width, name) {
    // Where both lie on one another the one drawn later is seen.
    this.material = new LineMaterial({ linewidth: width, worldUnits: false, transparent: true, depthWrite: false });
    this.name = name;
    this.mesh = new LineSegments2(new LineSegmentsGeometry(), this.material);
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
    this.wanted = true;
    this.clear();
    scene.add(this.mesh);
  }

  clear() {
    this.points = [];
    this.numbers = []; // sweep of each segment's end
    this.built = 0;
    this.mesh.visible = false;
  }

  add(position, number) {
    const before = this.points.at(-1);
    // A stationary sensor adds nothing visible.
    if (before && Math.hypot(...position.map((p, i) => p - before[i])) < 0.05) return;
    this.points.push(position);
    if (before) this.numbers.push(number);
  }

  show(number) {
    if (this.built !== this.numbers.length) this.build();
    let low = 0;
    let high = this.numbers.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.numbers[middle] <= number) low = middle + 1;
      else high = middle;
    }
    this.mesh.geometry.instanceCount = low;
    this.mesh.visible = this.wanted && low > 0;
  }

  build() {
    const flat = new Float32Array(6 * this.numbers.length);
    this.numbers.forEach((_, i) => flat.set([...this.points[i], ...this.points[i + 1]], 6 * i));
    this.mesh.geometry.dispose();
    this.mesh.geometry = new LineSegmentsGeometry().setPositions(flat);
    this.built = this.numbers.length;
  }
}

const MARK_VERTEX = `
attribute float number;
uniform float shown, ratio;
void main() {
  gl_Position = number > shown ? vec4(2.0, 2.0, 2.0, 1.0) : projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = 11.0 * ratio;
}`;
const MARK_FRAGMENT = `
uniform vec3 tint;
void main() {
  vec2 p = abs(gl_PointCoord - 0.5);
  if (p.x + p.y > 0.5) discard;
  gl_FragColor = vec4(tint, 1.0);
}`;

export class PathLayer {
  constructor(stage) {
    this.stage = stage;
    this.truth = new Path(stage.scene, 7, 'truth');
    this.estimate = new Path(stage.scene, 3, 'estimate');
    this.estimate.mesh.renderOrder = 2;
    this.truth.mesh.renderOrder = 1;
    this.marks = new Points(new BufferGeometry(), new ShaderMaterial({
      vertexShader: MARK_VERTEX, fragmentShader: MARK_FRAGMENT, transparent: true, depthTest: false,
      uniforms: { shown: { value: 0 }, ratio: { value: 1 }, tint: { value: new Color() } },
    }));
    this.marks.frustumCulled = false;
    this.marks.renderOrder = 3;
    stage.scene.add(this.marks);
    this.marksWanted = true;
    this.clear();
    onTheme(() => {
      for (const path of [this.truth, this.estimate]) path.material.color.set(colour(path.name));
      this.marks.material.uniforms.tint.value.set(colour('coarse'));
      stage.dirty = true;
    });
  }

  clear() {
    this.truth.clear();
    this.estimate.clear();
    this.chosen = [];
    this.marks.visible = false;
  }

  /// Records from `first` on are new. `coarse`: number of that source.
  add(records, first, coarse) {
    for (let i = first; i < records.length; ++i) {
      const record = records[i];
      this.estimate.add(record.position, i);
      if (record.hasTruth) this.truth.add(record.truth, i);
      if (record.source === coarse) this.chosen.push([...record.position, i]);
    }
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new BufferAttribute(new Float32Array(this.chosen.flatMap((c) => c.slice(0, 3))), 3));
    geometry.setAttribute('number', new BufferAttribute(new Float32Array(this.chosen.map((c) => c[3])), 1));
    this.marks.geometry.dispose();
    this.marks.geometry = geometry;
  }

  show(number) {
    this.truth.show(number);
    this.estimate.show(number);
    this.marks.visible = this.marksWanted && this.chosen.length > 0;
    this.marks.material.uniforms.shown.value = number + 0.5;
    this.marks.material.uniforms.ratio.value = this.stage.renderer.getPixelRatio();
    this.stage.dirty = true;
  }
}
