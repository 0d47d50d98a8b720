// Renderer, camera and what does not change with the run.
import {
  BufferGeometry, Color, Float32BufferAttribute, Group, LineBasicMaterial, LineLoop, Mesh, MeshBasicMaterial,
  PerspectiveCamera, Quaternion, Scene, Shape, ShapeGeometry, Vector3, WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { colour, onTheme, reducedMotion } from './theme.js';

const UP = new Vector3(0, 0, 1);

function ring(radius) {
  const points = [];
  for (let i = 0; i < 96; ++i) {
    const angle = (i / 96) * 2 * Math.PI;
    points.push(radius * Math.cos(angle), radius * Math.sin(angle), 0);
  }
  return new LineLoop(new BufferGeometry().setAttribute('position', new Float32BufferAttribute(points, 3)),
    new LineBasicMaterial({ transparent: true, opacity: 0.35 }));
}

function arrow() {
  const shape = new Shape();
  shape.moveTo(1.5, 0).lineTo(-0.9, 0.85).lineTo(-0.45, 0).lineTo(-0.9, -0.85).closePath();
  return new Mesh(new ShapeGeometry(shape), new MeshBasicMaterial({ side: 2 }));
}

const headingOf = (q) => Math.atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));

export class Stage {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: true, powerPreference: 'high-performance' });
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(50, 1, 0.3, 6000);
    this.camera.up.copy(UP);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.maxPolarAngle = Math.PI * 0.495;
    this.controls.minDistance = 3;
    this.controls.maxDistance = 2500;
    this.controls.addEventListener('change', () => { this.dirty = true; });
    this.sensor = new Group();
    this.rings = new Group();
    [10, 25, 50].forEach((radius) => this.rings.add(ring(radius)));
    this.arrow = arrow();
    this.sensor.add(this.rings, this.arrow);
    this.scene.add(this.sensor);
    this.heading = null;
    this.mode = 'follow';
    this.dirty = true;
    this.place({ position: [0, 0, 0], rotation: [0, 0, 0, 1] }, true);
    this.setMode('follow');
    onTheme(() => this.recolour());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
    this.resize();
  }

  recolour() {
    this.scene.background = new Color(colour('ground'));
    this.rings.children.forEach((line) => line.material.color.set(colour('muted')));
    this.arrow.material.color.set(colour('text'));
    this.dirty = true;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    // Upright screens see as much to the sides as lying ones see up and down.
    this.camera.fov = width < height ? 68 : 50;
    this.camera.updateProjectionMatrix();
    this.dirty = true;
  }

  /// Pixels per unit of size at distance one.
  get pixelScale() {
    return this.renderer.domElement.height / (2 * Math.tan((this.camera.fov * Math.PI) / 360));
  }

  setMode(mode) {
    this.mode = mode;
    this.controls.enablePan = mode !== 'follow';
    const at = this.sensor.position;
    const yaw = this.heading ?? 0;
    const offset = mode === 'top' ? new Vector3(-0.1, 0, 110) : new Vector3(-31, 8, 19);
    if (mode !== 'top') offset.applyAxisAngle(UP, yaw);
    if (mode !== 'orbit') {
      this.controls.target.copy(at);
      this.camera.position.copy(at).add(offset);
    }
    this.controls.update();
    this.dirty = true;
  }

  /// Moves the sensor, and the camera with it. `jump`: at once, as after a seek.
  place(record, jump) {
    const before = this.sensor.position.clone();
    this.sensor.position.fromArray(record.position);
    const rotation = new Quaternion().fromArray(record.rotation).normalize();
    this.sensor.quaternion.copy(rotation);
    const heading = headingOf(rotation);
    const turn = this.heading === null ? 0 : Math.atan2(Math.sin(heading - this.heading), Math.cos(heading - this.heading));
    const share = jump || reducedMotion.matches ? 1 : 0.35; // eases small jitter of the heading
    this.heading = (this.heading ?? heading) + turn * share;
    if (this.mode !== 'orbit') {
      const offset = this.camera.position.clone().sub(before);
      if (this.mode === 'follow') offset.applyAxisAngle(UP, turn * share);
      this.controls.target.add(this.sensor.position).sub(before);
      this.camera.position.copy(this.sensor.position).add(offset);
      this.controls.update();
    }
    this.dirty = true;
  }

  /// By the keyboard: radians to the side and up, and a factor of the distance.
  nudge(side, up, factor) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const radius = offset.length() * factor;
    const polar = Math.min(1.55, Math.max(0.02, Math.acos(offset.z / offset.length()) - up));
    const azimuth = Math.atan2(offset.y, offset.x) + side;
    offset.set(Math.sin(polar) * Math.cos(azimuth), Math.sin(polar) * Math.sin(azimuth), Math.cos(polar));
    this.camera.position.copy(this.controls.target).addScaledVector(offset, radius);
    this.controls.update();
    this.dirty = true;
  }

  render() {
    this.renderer.render(this.scene, this.camera);
    this.dirty = false;
  }
}
